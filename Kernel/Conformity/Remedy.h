// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Remedy.h
 * @brief The result of a check of a refined triangulation.
 */
#ifndef voxplex_Remedy_h
#define voxplex_Remedy_h

#include "Refinement/FeatureSeed.h"

#include <vector>

namespace voxplex
{

/** Whether and how refinement is resumed. */
template <int D>
struct Remedy
{
  bool IsNeeded = false; ///< false: nothing is wrong, or nothing more can be done
  std::vector<FeatureSeed<D>>
    Points; ///< to be inserted; the check may also have lowered local bounds

  Remedy& operator+=(const Remedy& other)
  {
    this->IsNeeded |= other.IsNeeded;
    this->Points.insert(this->Points.end(), other.Points.begin(), other.Points.end());
    return *this;
  }
};

} // namespace voxplex

#endif
