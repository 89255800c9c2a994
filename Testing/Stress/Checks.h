// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Checks.h
 * @brief What must hold of a mesh, by code that shares nothing with the kernel but the types of its results.
 *
 * A bound that refinement may give up in favour of its end is checked as far as the statistics allow: what was
 * refused or kept excuses as many elements. Nothing is checked that the headers and Algorithm.md do not promise.
 */
#ifndef voxplex_stress_Checks_h
#define voxplex_stress_Checks_h

#include "Findings.h"
#include "Mesh/SimplexMesh.h"
#include "Mesher/MeshingStatistics.h"
#include "SimplexGeometry.h"
#include "StressCase.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxplex::stress
{

/** A mesh and all that it is measured by. */
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

  /** Around an edge that was opened so many pieces of tetrahedra, or new vertices, may break a bound. */
  static constexpr std::uint64_t PiecesOfAnEdge = 40;

  /**
   * Operations that refinement did not do, and pieces around edges that were opened: so many elements may break a bound.
   * All may where rules gave way.
   */
  std::uint64_t Excused() const
  {
    const RuleStatistics& rules = this->Stats.Rules;
    return this->Stats.Yielding.empty()
      ? rules.RefusedTooClose + rules.RefusedNoConflict + rules.RefusedDuplicate +
        rules.RemovalsFailed + PiecesOfAnEdge * this->Stats.Interfaces.NonManifoldOpened
      : this->Mesh.Simplices.size() * (D + 1);
  }
};

/** What is counted but is no failure by itself. */
struct MeshFigures
{
  std::uint64_t NonManifold =
    0;                    ///< edges (4D: triangles) of the boundaries of labels, once a label
  std::uint64_t Lost = 0; ///< components that are listed as lost
};

/** Arrays fit together, points are finite, used and different, labels are the image's. False: nothing else can be checked. */
template <int D>
bool CheckArrays(const Subject<D>& subject, Findings& findings);

/** Positive volumes, without error. */
template <int D>
void CheckOrientation(const Subject<D>& subject, Findings& findings);

/**
 * Each facet has one or two simplices, on its two sides; Facets and FacetLabels are those between different labels;
 * simplices do not overlap, by samples; if the mesh was not optimised it is Delaunay.
 */
template <int D>
void CheckConformity(const Subject<D>& subject, Findings& findings);

/** Radius-edge ratios, sizes, angles of facets, slivers. */
template <int D>
void CheckShapes(const Subject<D>& subject, Findings& findings);

/** Interface vertices are in cells of the image where labels differ, all is near the object, volumes are plausible. */
template <int D>
void CheckAgainstImage(const Subject<D>& subject, Findings& findings);

/** Connected components that are neither there nor listed, and listed ones that are there or do not exist. */
template <int D>
void CheckComponents(const Subject<D>& subject, MeshFigures& figures, Findings& findings);

/** Boundaries of labels: closed, and in 3D manifold at their edges. */
template <int D>
void CheckBoundaries(const Subject<D>& subject, MeshFigures& figures, Findings& findings);

/** What the statistics say is what was asked for, and what is seen. */
template <int D>
void CheckStatistics(const Subject<D>& subject, const MeshFigures& figures, Findings& findings);

/** All of the above. */
template <int D>
MeshFigures CheckMesh(const Subject<D>& subject, Findings& findings);

} // namespace voxplex::stress

#endif
