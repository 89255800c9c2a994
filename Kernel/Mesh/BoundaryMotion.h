// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryMotion.h
 * @brief How the boundary of a space-time mesh moves, in physical space and time.
 */
#ifndef voxplex_BoundaryMotion_h
#define voxplex_BoundaryMotion_h

#include "Geometry/Point.h"
#include "Image/SpaceTimeFrame.h"
#include "Mesh/SimplexMesh.h"

#include <cstddef>
#include <vector>

namespace voxplex
{

/** Where a boundary tetrahedron lies. */
enum class BoundarySide : unsigned char
{
  Lateral,
  Initial, ///< the flat end at the time of the first frame
  Final
};

BoundarySide SideOf(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, std::size_t facet);

/**
 * The velocity of a lateral tetrahedron along its normal in space, out of the region of its first
 * label: -n_t / |n_x|, where n is the normal in space-time. NaN if n_x is 0.
 */
double NormalVelocity(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, std::size_t facet);

/**
 * The velocity of each point, in the directions that are normal to lateral boundaries; 0 elsewhere.
 * Takes O(points + facets), and 96 bytes a point.
 * @param threads 0 means all cores; the result does not depend on it
 */
std::vector<Point<3>> BoundaryVelocities(
  const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, unsigned threads);

} // namespace voxplex

#endif
