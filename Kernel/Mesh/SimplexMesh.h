// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SimplexMesh.h
 * @brief The mesh that the kernel returns.
 */
#ifndef voxplex_SimplexMesh_h
#define voxplex_SimplexMesh_h

#include "Geometry/Point.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxplex
{

/**
 * @brief Simplices with labels, and the interfaces between labels.
 *
 * - Points: D coordinates in the mesher's frame (GridGeometry), sorted along a Hilbert curve; every
 *   point is used by a simplex.
 * - Simplices: D+1 point indices, positively oriented: det(p1-p0, ..., pD-p0) > 0 in the frame. In 3D
 *   this is the vertex order of VTK_TETRA.
 * - Labels: the image's own label value of each simplex; never background.
 * - Facets: D point indices of each facet that separates two labels (or a label and background), once
 *   per facet. In 3D the right-hand normal points out of the region of the first label of FacetLabels.
 * - FacetLabels: the two labels of a facet, the larger first, 0 for background.
 */
template <int D>
struct SimplexMesh
{
  std::vector<Point<D>> Points;
  std::vector<std::array<std::uint32_t, static_cast<std::size_t>(D + 1)>> Simplices;
  std::vector<std::int64_t> Labels;
  std::vector<std::array<std::uint32_t, static_cast<std::size_t>(D)>> Facets;
  std::vector<std::array<std::int64_t, 2>> FacetLabels;
};

} // namespace voxplex

#endif
