// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SimplexMesh.h
 * @brief The mesh that the kernel returns.
 */
#ifndef voxplex_SimplexMesh_h
#define voxplex_SimplexMesh_h

#include "Base/UninitialisedVector.h"
#include "Geometry/Point.h"
#include "Geometry/Triangle.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxplex
{

/**
 * @brief Simplices with labels, and the interfaces between labels.
 *
 * - Points: D coordinates in the mesher's frame (GridGeometry). Every point is used by a simplex. The
 *   order of points and simplices is mostly that of places along a Hilbert curve.
 * - Simplices: D+1 point indices, positively oriented: det(p1-p0, ..., pD-p0) > 0 in the frame. In
 *   3D this is the vertex order of VTK_TETRA.
 * - Labels: the image's own label value of each simplex; never background.
 * - Facets: D point indices of each facet that separates two labels, or a label and background,
 *   once per facet. In 3D the right-hand normal points out of the region of the first label of
 *   FacetLabels.
 * - FacetLabels: the two labels of a facet, the larger first, 0 for background.
 * - Slabs: for a mesh that conforms to time planes, the slab of each simplex, from 0 on in the order of time. Else empty.
 * - Twins: for a periodic mesh, pairs of points at the first and at the last time, with the same position in space to the bit. Else empty.
 *
 * resize() leaves new entries uninitialised.
 */
template <int D>
struct SimplexMesh
{
  UninitialisedVector<Point<D>> Points;
  UninitialisedVector<std::array<std::uint32_t, static_cast<std::size_t>(D + 1)>> Simplices;
  UninitialisedVector<std::int64_t> Labels;
  UninitialisedVector<std::array<std::uint32_t, static_cast<std::size_t>(D)>> Facets;
  UninitialisedVector<std::array<std::int64_t, 2>> FacetLabels;
  std::vector<std::uint32_t> Slabs;
  std::vector<std::array<std::uint32_t, 2>> Twins;

  /** The points of a simplex, for the functions of Geometry/. */
  std::array<const Point<D>*, static_cast<std::size_t>(D + 1)> PointsOf(std::size_t simplex) const
  {
    std::array<const Point<D>*, static_cast<std::size_t>(D + 1)> points;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      points[i] = &this->Points[this->Simplices[simplex][i]];
    }
    return points;
  }
};

/** The triangles of a mesh's interfaces. */
inline std::vector<Triangle> TrianglesOf(const SimplexMesh<3>& mesh)
{
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.Facets.size());
  for (const auto& facet : mesh.Facets)
  {
    triangles.push_back({ mesh.Points[facet[0]], mesh.Points[facet[1]], mesh.Points[facet[2]] });
  }
  return triangles;
}

} // namespace voxplex

#endif
