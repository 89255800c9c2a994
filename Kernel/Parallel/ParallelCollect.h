// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParallelCollect.h
 * @brief A loop of several threads that collects values in order.
 */
#ifndef voxplex_ParallelCollect_h
#define voxplex_ParallelCollect_h

#include "Parallel/ParallelFor.h"

#include <cstddef>
#include <stop_token>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * Calls function(first, last, found) on the chunks of a ParallelFor() over [0, end). The function
 * appends to `found`, a std::vector<T>&. Returns the values of all chunks, in the order of chunks,
 * as if one thread had appended them all.
 *
 * For the other parameters and exceptions, see ParallelFor().
 */
template <typename T, typename Function>
std::vector<T> ParallelCollect(std::size_t end, std::size_t grain, unsigned threads,
  Function&& function, const std::stop_token& stop = {})
{
  std::vector<std::vector<T>> parts(end == 0 ? 0 : (end - 1) / grain + 1);
  ParallelFor(
    0, end, grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      // Not parts[...] itself: threads would write to the same cache line at each value.
      std::vector<T> found;
      function(first, last, found);
      parts[first / grain] = std::move(found);
    },
    stop);
  std::size_t size = 0;
  for (const std::vector<T>& part : parts)
  {
    size += part.size();
  }
  std::vector<T> all;
  all.reserve(size);
  for (const std::vector<T>& part : parts)
  {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

} // namespace voxplex

#endif
