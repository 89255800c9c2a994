// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PredicateStatistics.h
 * @brief How often predicates were asked, and what answered.
 */
#ifndef voxplex_PredicateStatistics_h
#define voxplex_PredicateStatistics_h

#include <cstdint>

namespace voxplex
{

/** How often a predicate was asked and what answered. */
struct PredicateStatistics
{
  std::uint64_t Calls = 0; ///< orientation and in-sphere tests, the cached-ball filter included
  std::uint64_t StaticFailures = 0; ///< not decided by the static or cached-ball filter
  std::uint64_t ExactCalls = 0;     ///< decided by exact arithmetic only
  std::uint64_t Perturbed = 0;      ///< exact zeros, decided by the symbolic perturbation

  PredicateStatistics& operator+=(const PredicateStatistics& other)
  {
    this->Calls += other.Calls;
    this->StaticFailures += other.StaticFailures;
    this->ExactCalls += other.ExactCalls;
    this->Perturbed += other.Perturbed;
    return *this;
  }
};

} // namespace voxplex

#endif
