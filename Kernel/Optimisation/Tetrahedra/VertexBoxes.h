// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VertexBoxes.h
 * @brief Divides vertices into boxes. They can be the blocks of patches (Patch).
 */
#ifndef voxplex_VertexBoxes_h
#define voxplex_VertexBoxes_h

#include "Geometry/Point.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** Disjoint boxes that have all vertices. */
struct VertexBoxes
{
  std::size_t Number = 0; ///< some may be without vertices
  std::vector<std::uint32_t> OfVertex;
};

/**
 * Divides vertices by planes across each axis, with about as many vertices between any two
 * neighbouring planes.
 *
 * With `shift`, planes lie half a box further, and one box more is along each axis. An element
 * between boxes is seldom between shifted boxes, too. So patches of shifted boxes can change most of
 * what patches of the others could not.
 *
 * Complexity: linear. Thread safe.
 * @param points in the order of vertices
 * @param perAxis the number of boxes along each axis, without shift; 1 to 1024
 * @param threads 0 means all cores; boxes do not depend on it
 * @throws Cancelled
 */
VertexBoxes DivideIntoBoxes(std::span<const Point<3>> points, std::size_t perAxis, bool shift,
  unsigned threads, const std::stop_token& stop);

} // namespace voxplex

#endif
