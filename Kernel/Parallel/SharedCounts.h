// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SharedCounts.h
 * @brief Lets several threads sort into lists that lie in one array.
 */
#ifndef voxplex_SharedCounts_h
#define voxplex_SharedCounts_h

#include "Base/UninitialisedVector.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <stop_token>

namespace voxplex
{

/**
 * @brief Counts the entries of many short lists, and computes their places in one array: a counting
 * sort.
 *
 * A first loop calls Add() with the list of each entry. After TurnIntoPlaces(), a second loop calls
 * Next() with the same lists, and writes each entry to the place that it returns. With one thread a
 * list has its entries in the order of the second loop; with several, in any order.
 *
 * There are fewer than 2^32 entries.
 */
class SharedCounts
{
public:
  /** @param threads how many call Add() and Next(); 0 means all cores */
  SharedCounts(std::size_t lists, unsigned threads, const std::stop_token& stop)
    : Places(lists + 1)
    , IsAlone(NumberOfThreads(threads) == 1)
  {
    constexpr std::size_t Grain = std::size_t{ 1 } << 16;
    ParallelFor(
      0, this->Places.size(), Grain, threads,
      [this](std::size_t first, std::size_t last)
      { std::fill(this->Places.data() + first, this->Places.data() + last, 0u); },
      stop);
  }

  /** One more entry in a list. */
  void Add(std::size_t list) { this->CountUp(this->Places[list]); }

  /** Replaces the counts by places. @return the number of all entries */
  std::uint32_t TurnIntoPlaces()
  {
    std::uint32_t sum = 0;
    for (std::uint32_t& place : this->Places)
    {
      const std::uint32_t count = place;
      place = sum;
      sum += count;
    }
    return sum;
  }

  /** The place of the next entry of a list. */
  std::uint32_t Next(std::size_t list) { return this->CountUp(this->Places[list]); }

  // After the second loop: the places of a list's entries are BeginOf() ... EndOf() - 1.
  std::uint32_t BeginOf(std::size_t list) const { return list == 0 ? 0u : this->Places[list - 1]; }
  std::uint32_t EndOf(std::size_t list) const { return this->Places[list]; }

private:
  /** @return the old value */
  std::uint32_t CountUp(std::uint32_t& number) const
  {
    if (this->IsAlone)
    {
      return number++;
    }
    // Relaxed: the end of the loop orders it before its readers.
    return std::atomic_ref<std::uint32_t>(number).fetch_add(1, std::memory_order_relaxed);
  }

  UninitialisedVector<std::uint32_t> Places; ///< counts; then begins; then ends
  const bool IsAlone;
};

} // namespace voxplex

#endif
