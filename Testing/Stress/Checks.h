// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Checks.h
 * @brief The invariants of a mesh, checked by code that shares only the types of the results with
 *   the kernel.
 *
 * Refinement may give up some bounds in order to end. The number of elements that may break such a
 * bound follows from the statistics: the operations that were refused and the elements that were
 * kept. Only promises of the headers and of Algorithm.md are checked.
 */
#ifndef voxplex_stress_Checks_h
#define voxplex_stress_Checks_h

#include "Findings.h"
#include "Mesh/SimplexMesh.h"
#include "Mesher/MeshingStatistics.h"
#include "SimplexGeometry.h"
#include "StressCase.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace voxplex::stress
{

/** A mesh, and the input and statistics against which it is checked. */
template <int D>
struct Subject
{
  const StressCase<D>& Of;
  const SimplexMesh<D>& Mesh;
  const MeshingStatistics& Stats;

  std::array<Vector<D>, static_cast<std::size_t>(D + 1)> Corners(std::size_t simplex) const
  {
    std::array<Vector<D>, static_cast<std::size_t>(D + 1)> corners;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
      corners[i] = this->Mesh.Points[this->Mesh.Simplices[simplex][i]];
    }
    return corners;
  }

  /** Whether vertices of interfaces may have been moved off them, so that volumes are right. */
  bool IsFitted() const
  {
    return this->Of.Options.Interfaces.Fit && (D == 4 || this->Of.Options.Optimisation.Run);
  }

  /** The times of planes and of the ends of a periodic mesh, ascending. */
  std::vector<double> PlaneTimes() const
  {
    std::vector<double> times = this->Stats.Planes.Times;
    if (this->Stats.Planes.Periodic && !this->Mesh.Points.empty())
    {
      const auto [low, high] =
        std::minmax_element(this->Mesh.Points.begin(), this->Mesh.Points.end(),
          [](const Point<D>& p, const Point<D>& q) { return p[D - 1] < q[D - 1]; });
      times.insert(times.begin(), (*low)[D - 1]);
      times.push_back((*high)[D - 1]);
    }
    return times;
  }

  /**
   * Number of pieces of simplices, or new vertices, around an opened ridge that may break a bound. A
   * tetrahedron is cut in at most 5 pieces, a pentatope in 7.
   */
  static constexpr std::uint64_t PiecesOfARidge = D == 3 ? 40 : 56;

  /**
   * The number of elements that may break a bound: operations that refinement did not do, and
   * pieces around opened ridges. If rules gave way, all elements may.
   */
  std::uint64_t Excused() const
  {
    const RuleStatistics& rules = this->Stats.Rules;
    return this->Stats.RelaxedRegions.empty() ? rules.RefusedTooClose + rules.RefusedOnClosedEnd +
        rules.RefusedNoConflict + rules.RefusedDuplicate + rules.RemovalsFailed +
        PiecesOfARidge * this->Stats.Interfaces.NonManifoldOpened
                                              : this->Mesh.Simplices.size() * (D + 1);
  }
};

/** The largest number of vertices that lie on one of the planes. */
template <int D, std::size_t N>
std::size_t OnOnePlane(const Subject<D>& subject, const std::vector<double>& planes,
  const std::array<std::uint32_t, N>& vertices)
{
  std::size_t most = 0;
  for (const double time : planes)
  {
    const auto there = std::count_if(vertices.begin(), vertices.end(),
      [&](std::uint32_t v) { return subject.Mesh.Points[v][D - 1] == time; });
    most = std::max(most, static_cast<std::size_t>(there));
  }
  return most;
}

/** Counts that are no failure by themselves. */
struct MeshFigures
{
  std::uint64_t NonManifold =
    0;                    ///< edges (4D: triangles) of boundaries of labels, once for each label
  std::uint64_t Lost = 0; ///< components that are listed as lost
};

/**
 * Arrays fit together; points are finite, used and different; labels are the image's.
 * @return false if nothing else can be checked
 */
template <int D>
bool CheckArrays(const Subject<D>& subject, Findings& findings);

/** Volumes are positive; exact signs. */
template <int D>
void CheckOrientation(const Subject<D>& subject, Findings& findings);

/**
 * Each facet has one or two simplices, on its two sides. Facets and FacetLabels are those between
 * different labels. Samples show that simplices do not overlap. If the mesh was not optimised, it
 * is Delaunay.
 */
template <int D>
void CheckConformity(const Subject<D>& subject, Findings& findings);

/** Radius-edge ratios, sizes, angles of facets, slivers. */
template <int D>
void CheckShapes(const Subject<D>& subject, Findings& findings);

/**
 * Interface vertices are in cells of the image where labels differ; the mesh is near the object;
 * volumes are plausible.
 */
template <int D>
void CheckAgainstImage(const Subject<D>& subject, Findings& findings);

/**
 * Finds components that are neither in the mesh nor listed as lost, and listed ones that are in it
 * or do not exist.
 */
template <int D>
void CheckComponents(const Subject<D>& subject, MeshFigures& figures, Findings& findings);

/**
 * Components in several pieces, pieces that unite components, and labels that touch where they do not in
 * the image, are listed in the statistics.
 */
template <int D>
void CheckTopology(const Subject<D>& subject, Findings& findings);

/**
 * Boundaries of labels: closed, and manifold at their edges (4D: triangles) if that is asked for. At time planes, where
 * pentatopes keep their labels, a triangle need not be manifold.
 */
template <int D>
void CheckBoundaries(const Subject<D>& subject, MeshFigures& figures, Findings& findings);

/**
 * No pentatope crosses a time plane. Both sides of a plane, and both ends of a periodic mesh, have the same tetrahedra
 * with the same labels. Numbers of slabs and pairs of twins are right.
 */
void CheckTimePlanes(const Subject<4>& subject, Findings& findings);

/** The statistics agree with the options and with the mesh. */
template <int D>
void CheckStatistics(const Subject<D>& subject, const MeshFigures& figures, Findings& findings);

/** All of the above. */
template <int D>
MeshFigures CheckMesh(const Subject<D>& subject, Findings& findings);

} // namespace voxplex::stress

#endif
