// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ComponentStatistics.h
 * @brief Statistics of ComponentCheck and FragmentCheck.
 */
#ifndef voxplex_ComponentStatistics_h
#define voxplex_ComponentStatistics_h

#include "Image/DropComponents.h"

#include <cstdint>
#include <vector>

namespace voxplex
{

/** A connected component of the image whose elements are not all connected through faces. */
struct BrokenComponent
{
  ComponentReport Component;
  std::uint64_t Fragments = 0;
  double Largest = 0.0; ///< the part of its volume in the mesh that the largest fragment has
};

struct ComponentStatistics
{
  std::uint64_t Found = 0;             ///< components of all labels; 0 if none were looked for
  std::uint64_t Seeds = 0;             ///< feature points inserted for small or thin ones, at most
  unsigned Rounds = 0;                 ///< times refinement was resumed for lost or broken ones
  std::vector<ComponentReport> Lost;   ///< components that have no element
  std::vector<BrokenComponent> Broken; ///< only in 3D; see ComponentOptions::Exact
};

} // namespace voxplex

#endif
