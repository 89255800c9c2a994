// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Surroundings.h
 * @brief The simplices around a mesh.
 */
#ifndef voxplex_Surroundings_h
#define voxplex_Surroundings_h

#include "Delaunay/Triangulation.h"
#include "Geometry/Point.h"
#include "Mesh/SimplexLabels.h"
#include "Mesh/Subdivision.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxplex
{

/** The simplices outside of the object that have points of the mesh. */
template <int D>
struct Surroundings
{
  std::vector<Point<D>> Points; ///< numbered after the points of the mesh
  std::vector<std::array<std::uint32_t, static_cast<std::size_t>(D + 1)>>
    Simplices; ///< positively oriented
};

/**
 * @param labels of each simplex id
 * @param parts the pieces that replace some simplices
 * @param positions of each vertex id; empty: those of the triangulation
 * @param numbers the point of each vertex id, then of each point of the parts; None if it is not in
 *   the mesh
 * @param points number of points of the mesh
 */
Surroundings<4> SurroundingsOf(const Triangulation<4>& triangulation, const SimplexLabels& labels,
  const Subdivision<4>& parts, std::span<const Point<4>> positions,
  std::span<const std::uint32_t> numbers, std::size_t points);

} // namespace voxplex

#endif
