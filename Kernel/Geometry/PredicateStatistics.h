// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PredicateStatistics.h
 * @brief Counts of predicate calls, by the stage that decided.
 */
#ifndef voxplex_PredicateStatistics_h
#define voxplex_PredicateStatistics_h

#include <cstdint>

namespace voxplex
{

/** Counts of predicate calls, by the stage that decided. */
struct PredicateStatistics
{
  std::uint64_t Calls = 0; ///< orientation and in-sphere tests, including the cached-ball filter
  std::uint64_t StaticFailures = 0; ///< not decided by the static or cached-ball filter
  std::uint64_t ExactCalls = 0;     ///< decided only by exact arithmetic
  std::uint64_t Perturbed = 0;      ///< exact zeros, decided by symbolic perturbation

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
