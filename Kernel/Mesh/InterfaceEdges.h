// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceEdges.h
 * @brief Edges at which the boundaries of labels are not surfaces.
 */
#ifndef voxplex_InterfaceEdges_h
#define voxplex_InterfaceEdges_h

#include "Mesh/SimplexMesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxplex
{

/** An edge of an interface. */
struct InterfaceEdge
{
  std::array<std::uint32_t, 2> Ends; ///< point numbers, ascending
  bool IsJunction;                   ///< three labels or more meet there; background counts
};

/**
 * Edges at which some label other than background has another number of boundary facets than two, in the
 * order of their ends. Takes time linear in the numbers of points and facets.
 */
std::vector<InterfaceEdge> FindNonManifoldEdges(const SimplexMesh<3>& mesh);

} // namespace voxplex

#endif
