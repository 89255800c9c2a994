// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Boxes cut into tetrahedra by hand, so that everything about them is known.
#ifndef voxplex_CubeMeshes_h
#define voxplex_CubeMeshes_h

#include "Geometry/SimplexQuality.h"
#include "Mesh/SimplexMesh.h"

#include <array>
#include <cstdint>
#include <map>
#include <utility>

namespace voxplex
{

/** Builds meshes out of boxes that share the points in which they touch. Facets are not set. */
class CubeMesh
{
public:
  SimplexMesh<3> Mesh;

  std::uint32_t PointAt(const Point<3>& p)
  {
    const auto [known, isNew] =
      this->Ids.try_emplace(p, static_cast<std::uint32_t>(this->Mesh.Points.size()));
    if (isNew)
    {
      this->Mesh.Points.push_back(p);
    }
    return known->second;
  }

  /** A tetrahedron, turned so that its volume is positive. */
  void AddTetrahedron(std::array<Point<3>, 4> p, std::int64_t label)
  {
    const std::array<const Point<3>*, 4> v{ &p[0], &p[1], &p[2], &p[3] };
    if (SignedVolume<3>(v.data()) < 0.0)
    {
      std::swap(p[2], p[3]);
    }
    this->Mesh.Simplices.push_back(
      { this->PointAt(p[0]), this->PointAt(p[1]), this->PointAt(p[2]), this->PointAt(p[3]) });
    this->Mesh.Labels.push_back(label);
  }

  /** The six tetrahedra of Kuhn's split. They all share the diagonal from min to max. */
  void AddBox(const Point<3>& min, const Point<3>& max, std::int64_t label)
  {
    constexpr std::array<std::array<std::size_t, 3>, 6> orders{ { { 0, 1, 2 }, { 0, 2, 1 },
      { 1, 0, 2 }, { 1, 2, 0 }, { 2, 0, 1 }, { 2, 1, 0 } } };
    for (const auto& order : orders)
    {
      std::array<Point<3>, 4> p{ min, min, min, max };
      p[1][order[0]] = max[order[0]];
      p[2] = p[1];
      p[2][order[1]] = max[order[1]];
      this->AddTetrahedron(p, label);
    }
  }

private:
  std::map<Point<3>, std::uint32_t> Ids;
};

} // namespace voxplex

#endif
