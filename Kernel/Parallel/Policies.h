// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Policies.h
 * @brief How threads that refine together get along: names for what the user can choose.
 */
#ifndef voxplex_Policies_h
#define voxplex_Policies_h

#include <array>
#include <string_view>

namespace voxplex
{

/** What a thread does after a rollback (thesis, section 3.3). */
enum class ContentionPolicy
{
  Aggressive, ///< tries again at once
  Random,     ///< sleeps for a random time after several rollbacks in a row
  Global,     ///< waits in one list until a thread that makes progress wakes it
  Local       ///< waits in the list of the thread that it lost to
};

/** From whom an idle thread gets work (thesis, sections 3.2.4 and 3.4.1). */
enum class BalancePolicy
{
  Random,      ///< from whichever thread looks first (random work stealing, RWS)
  Hierarchical ///< from the nearest that has some (hierarchical work stealing, HWS)
};

/** In the order of the enumerators; as users write them. */
inline constexpr std::array<std::string_view, 4> ContentionPolicyNames = { "aggressive", "random",
  "global", "local" };
inline constexpr std::array<std::string_view, 2> BalancePolicyNames = { "rws", "hws" };

} // namespace voxplex

#endif
