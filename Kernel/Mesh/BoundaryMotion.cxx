// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/BoundaryMotion.h"

#include "Geometry/SimplexQuality.h"
#include "Geometry/SymmetricEigen.h"
#include "Parallel/ParallelFor.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace voxplex
{

namespace
{

/** A normal of a boundary tetrahedron in the world; its length is proportional to the area. */
Point<4> NormalOf(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, std::size_t facet)
{
  std::array<Point<4>, 4> p;
  for (std::size_t k = 0; k < 4; ++k)
  {
    p[k] = frame.ToWorld(mesh.Points[mesh.Facets[facet][k]]);
  }
  return Cross(Subtract(p[1], p[0]), Subtract(p[2], p[0]), Subtract(p[3], p[0]));
}

/** A direction is normal to a boundary if this part of its area faces it. Less is curvature. */
constexpr double NormalShare = 0.15;

/** What the lateral tetrahedra around a point say about its velocity. */
struct VelocityEquations
{
  std::array<Point<3>, 3> Matrix{};
  Point<3> Right{};

  /** The tetrahedron stays on the boundary: n_x . v + n_t = 0. */
  void Add(const Point<4>& normal)
  {
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    for (std::size_t a = 0; a < 3 && length > 0.0; ++a)
    {
      for (std::size_t b = 0; b < 3; ++b)
      {
        this->Matrix[a][b] += normal[a] * normal[b] / length;
      }
      this->Right[a] -= normal[a] * normal[3] / length;
    }
  }

  /** Least squares, in the directions that are normal to a boundary. 0 in all others. */
  Point<3> Solve() const
  {
    const SymmetricEigen<3> eigen = EigenOf<3>(this->Matrix);
    const double trace = eigen.Values[0] + eigen.Values[1] + eigen.Values[2];
    Point<3> velocity{};
    for (std::size_t k = 0; k < 3; ++k)
    {
      if (eigen.Values[k] > NormalShare * trace)
      {
        const double part = Dot(eigen.Vectors[k], this->Right) / eigen.Values[k];
        for (std::size_t a = 0; a < 3; ++a)
        {
          velocity[a] += part * eigen.Vectors[k][a];
        }
      }
    }
    return velocity;
  }
};

} // namespace

//------------------------------------------------------------------------------------------------
BoundarySide SideOf(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, std::size_t facet)
{
  if (mesh.FacetLabels[facet][1] != 0)
  {
    return BoundarySide::Lateral;
  }
  bool isInitial = true;
  bool isFinal = true;
  for (const std::uint32_t id : mesh.Facets[facet])
  {
    const double time = frame.Time(mesh.Points[id]);
    isInitial &= time == frame.FirstTime;
    isFinal &= time == frame.LastTime;
  }
  return isInitial ? BoundarySide::Initial : isFinal ? BoundarySide::Final : BoundarySide::Lateral;
}

double NormalVelocity(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, std::size_t facet)
{
  // That of the frame, or its opposite if axes are left-handed.
  const Point<4> normal = NormalOf(mesh, frame, facet);
  const double sign = frame.Space.LeftHanded ? -1.0 : 1.0;
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  return length > 0.0 ? -sign * normal[3] / length : std::numeric_limits<double>::quiet_NaN();
}

std::vector<Point<3>> BoundaryVelocities(
  const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, unsigned threads)
{
  constexpr std::size_t Grain = 32768;
  std::vector<VelocityEquations> equations(mesh.Points.size());
  for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
  {
    if (SideOf(mesh, frame, f) == BoundarySide::Lateral)
    {
      const Point<4> normal = NormalOf(mesh, frame, f);
      for (const std::uint32_t id : mesh.Facets[f])
      {
        equations[id].Add(normal);
      }
    }
  }
  std::vector<Point<3>> velocities(equations.size());
  ParallelFor(0, equations.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        velocities[i] = equations[i].Solve();
      }
    });
  return velocities;
}

} // namespace voxplex
