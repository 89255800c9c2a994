// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PositionDifference.h
 * @brief The positions that are in one of two lists only.
 */
#ifndef voxplex_PositionDifference_h
#define voxplex_PositionDifference_h

#include "Base/UninitialisedVector.h"
#include "Geometry/Point.h"
#include "Parallel/ParallelFor.h"
#include "Parallel/ParallelSort.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

template <int D>
struct PositionDifference
{
  std::vector<Point<D>> OfFirst;  ///< those that the second list does not have
  std::vector<Point<D>> OfSecond; ///< those that the first list does not have
};

/**
 * Compares two lists of positions, each of them without repetitions, by sorting hash values. Both
 * results are in the order of their lists.
 *
 * Takes linear time.
 * @param threads 0 means all cores; the result does not depend on it
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
PositionDifference<D> DifferenceOf(std::span<const Point<D>> first,
  std::span<const Point<D>> second, unsigned threads, const std::stop_token& stop)
{
  struct Keyed
  {
    std::uint32_t Hash;
    std::uint32_t Index; ///< in both lists, the second behind the first
  };
  constexpr std::size_t Grain = 4096;
  constexpr unsigned Bits = 32;
  const auto at = [&](std::size_t i) -> const Point<D>&
  { return i < first.size() ? first[i] : second[i - first.size()]; };
  const std::size_t number = first.size() + second.size();
  UninitialisedVector<Keyed> memory(2 * number);
  const std::span<Keyed> all(memory);
  ParallelFor(
    0, number, Grain, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        std::uint64_t hash = 0;
        for (const double x : at(i))
        {
          hash = (hash ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15; // -0 is 0
          hash ^= hash >> Bits;
        }
        all[i] = { static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(i) };
      }
    },
    stop);
  const std::span<const Keyed> sorted = ParallelRadixSort(
    all.first(number), all.last(number), Bits, [](const Keyed& k) { return k.Hash; }, threads,
    stop);
  std::vector<bool> isInBoth(number);
  for (std::size_t k = 0; k < number; ++k)
  {
    const std::size_t i = sorted[k].Index;
    for (std::size_t m = k + 1; m < number && sorted[m].Hash == sorted[k].Hash; ++m)
    {
      const std::size_t j = sorted[m].Index; // above i, because the sort is stable
      if (at(i) == at(j))
      {
        isInBoth[i] = true;
        isInBoth[j] = true;
      }
    }
  }
  PositionDifference<D> difference;
  for (std::size_t i = 0; i < number; ++i)
  {
    if (!isInBoth[i])
    {
      (i < first.size() ? difference.OfFirst : difference.OfSecond).push_back(at(i));
    }
  }
  return difference;
}

} // namespace voxplex

#endif
