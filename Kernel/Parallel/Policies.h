// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Policies.h
 * @brief Policies for contention and load balance among refining threads, with their names.
 */
#ifndef voxplex_Policies_h
#define voxplex_Policies_h

#include <array>
#include <string_view>

namespace voxplex
{

/** The contention manager: what a thread does after a rollback (thesis, section 3.3). */
enum class ContentionPolicy
{
  Aggressive, ///< the thread tries again at once
  Random,     ///< after several rollbacks in a row, the thread sleeps for a random time
  Global,     ///< the thread waits in one common list until a thread that makes progress wakes it
  Local       ///< the thread waits in the list of the thread that owned the contended vertex
};

/** The load balancer: how idle threads get work (thesis, sections 3.2.4 and 3.4.1). */
enum class BalancePolicy
{
  Random,      ///< from the first busy thread that looks for idle ones (random work stealing, RWS)
  Hierarchical ///< from the nearest thread that has work (hierarchical work stealing, HWS)
};

/** The names that users write, in the order of the enumerators. */
inline constexpr std::array<std::string_view, 4> ContentionPolicyNames = { "aggressive", "random",
  "global", "local" };
inline constexpr std::array<std::string_view, 2> BalancePolicyNames = { "rws", "hws" };

} // namespace voxplex

#endif
