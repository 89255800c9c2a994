// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProcessorTopologyDiscovery.h
 * @brief Topologies of machines that are not there. Private to ProcessorTopology.cxx and its test.
 */
#ifndef voxplex_ProcessorTopologyDiscovery_h
#define voxplex_ProcessorTopologyDiscovery_h

#include "Parallel/ProcessorTopology.h"

#include <string>
#include <vector>

namespace voxplex
{

/** False if the kernel was built without hwloc: DiscoverTopology() is FlatTopology() then. */
bool CanDiscoverTopology();

/**
 * What DiscoverTopology() would find on another machine.
 *
 * @param description the machine, in hwloc's synthetic notation: "pack:2 numa:1 core:4 pu:2"
 * @param allowed the processors that the process may use, by the operating system's number; empty
 *   means all
 * @return the flat topology if hwloc does not understand the description or was not built in
 */
ProcessorTopology DescribedTopology(
  const std::string& description, const std::vector<unsigned>& allowed, unsigned threads);

} // namespace voxplex

#endif
