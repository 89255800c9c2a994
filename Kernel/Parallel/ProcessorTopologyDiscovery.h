// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProcessorTopologyDiscovery.h
 * @brief Topologies of described machines. Private to ProcessorTopology.cxx and its test.
 */
#ifndef voxplex_ProcessorTopologyDiscovery_h
#define voxplex_ProcessorTopologyDiscovery_h

#include "Parallel/ProcessorTopology.h"

#include <string>
#include <vector>

namespace voxplex
{

/** False if the kernel was built without hwloc. Then DiscoverTopology() returns FlatTopology(). */
bool CanDiscoverTopology();

/**
 * The result of DiscoverTopology() on a described machine.
 *
 * @param description the machine, in hwloc's synthetic notation: "pack:2 numa:1 core:4 pu:2"
 * @param allowed the processors that the process may use, as numbered by the operating system;
 *   empty means all
 * @return the flat topology if hwloc does not understand the description or was not built in
 */
ProcessorTopology DescribedTopology(
  const std::string& description, const std::vector<unsigned>& allowed, unsigned threads);

} // namespace voxplex

#endif
