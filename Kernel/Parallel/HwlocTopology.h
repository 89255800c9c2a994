// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HwlocTopology.h
 * @brief Threads on the processors that hwloc knows. Private to ProcessorTopology.cxx and its test.
 */
#ifndef voxplex_HwlocTopology_h
#define voxplex_HwlocTopology_h

#include "Parallel/ProcessorTopology.h"

#include <hwloc.h>

namespace voxplex
{

/** What DiscoverTopology() does on a machine with the allowed processors. */
ProcessorTopology SpreadThreads(
  hwloc_topology_t machine, hwloc_const_bitmap_t allowed, unsigned threads);

} // namespace voxplex

#endif
