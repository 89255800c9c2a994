// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ComponentStatistics.h
 * @brief Statistics of ComponentCheck.
 */
#ifndef voxplex_ComponentStatistics_h
#define voxplex_ComponentStatistics_h

#include "Image/DropComponents.h"

#include <cstdint>
#include <vector>

namespace voxplex
{

struct ComponentStatistics
{
  std::uint64_t Found = 0;           ///< components of all labels; 0 if none were looked for
  std::uint64_t Seeds = 0;           ///< feature points inserted for small or thin ones, at most
  unsigned Rounds = 0;               ///< times refinement was resumed for lost components
  std::vector<ComponentReport> Lost; ///< components that have no element
};

} // namespace voxplex

#endif
