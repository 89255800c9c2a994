// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeTopology.h
 * @brief How the pentatopes of a mesh meet: boundary facets, connected components.
 */
#ifndef voxplex_SpaceTimeTopology_h
#define voxplex_SpaceTimeTopology_h

#include "Mesh/SimplexMesh.h"

#include <cstdint>
#include <map>
#include <stop_token>

namespace voxplex
{

struct SpaceTimeTopology
{
  /** Tetrahedra of one pentatope only, or between two pentatopes of different labels. */
  std::uint64_t InterfaceFacets = 0;
  std::uint64_t FacetsOfThreeElements = 0; ///< which no conforming mesh has
  /** For each label, its components: pentatopes of one label that are connected through facets. */
  std::map<std::int64_t, std::uint64_t> Components;
};

/**
 * Takes O(n log n) time for n pentatopes, one thread, and 120 bytes for each.
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
SpaceTimeTopology MeasureTopology(const SimplexMesh<4>& mesh, const std::stop_token& stop = {});

} // namespace voxplex

#endif
