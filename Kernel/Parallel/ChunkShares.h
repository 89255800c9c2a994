// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChunkShares.h
 * @brief Hands the chunks of a parallel loop out to its threads.
 */
#ifndef voxplex_ChunkShares_h
#define voxplex_ChunkShares_h

#include "Parallel/CacheLine.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace voxplex
{

/**
 * @brief Chunks 0 ... n - 1 in consecutive shares, one for each thread, or one for all.
 *
 * A thread takes the chunks of its own share in order. When its share is empty, it takes the last
 * chunk of the largest share.
 *
 * So a thread seldom works next to another one. And if loops over the same range follow each other,
 * a thread has most of the chunks that it had before, and their data in its caches.
 *
 * All functions may be called by several threads at the same time.
 */
class ChunkShares
{
public:
  /** @param chunks less than 2^32 @param shares at least 1 */
  ChunkShares(std::size_t chunks, std::size_t shares)
    : Shares(shares)
  {
    assert(chunks <= std::numeric_limits<std::uint32_t>::max());
    for (std::size_t k = 0; k < shares; ++k)
    {
      this->Shares[k].Range.store(
        Pack(k * chunks / shares, (k + 1) * chunks / shares), std::memory_order_relaxed);
    }
  }

  /**
   * The next chunk for a thread, or none if all have been taken.
   * @param thread its share, if there are several; one share is that of all threads
   */
  std::optional<std::size_t> Take(std::size_t thread)
  {
    Share& share = this->Shares.size() == 1 ? this->Shares[0] : this->Shares[thread];
    if (const std::optional<std::size_t> own = share.TakeFirst())
    {
      return own;
    }
    for (;;)
    {
      const auto largest = std::max_element(this->Shares.begin(), this->Shares.end(),
        [](const Share& a, const Share& b) { return a.Size() < b.Size(); });
      if (largest->Size() == 0)
      {
        return std::nullopt;
      }
      if (const std::optional<std::size_t> last = largest->TakeLast())
      {
        return last;
      }
    }
  }

  /** Nothing is left to take. */
  void Clear()
  {
    for (Share& share : this->Shares)
    {
      share.Range.store(0, std::memory_order_relaxed);
    }
  }

private:
  static constexpr unsigned HalfBits = 32;

  static std::uint64_t Pack(std::uint64_t first, std::uint64_t end)
  {
    return first << HalfBits | end;
  }
  static std::uint64_t FirstOf(std::uint64_t range) { return range >> HalfBits; }
  static std::uint64_t EndOf(std::uint64_t range)
  {
    return range & std::numeric_limits<std::uint32_t>::max();
  }

  // Relaxed: the ranges only hand out numbers. The end of the loop orders the results of the chunks.
  struct alignas(CacheLineSize) Share
  {
    std::atomic<std::uint64_t> Range{ 0 }; ///< the first chunk, and the end

    std::uint64_t Size() const
    {
      const std::uint64_t range = this->Range.load(std::memory_order_relaxed);
      return EndOf(range) - FirstOf(range);
    }

    std::optional<std::size_t> TakeFirst()
    {
      std::uint64_t range = this->Range.load(std::memory_order_relaxed);
      while (FirstOf(range) < EndOf(range))
      {
        if (this->Range.compare_exchange_weak(
              range, Pack(FirstOf(range) + 1, EndOf(range)), std::memory_order_relaxed))
        {
          return FirstOf(range);
        }
      }
      return std::nullopt;
    }

    std::optional<std::size_t> TakeLast()
    {
      std::uint64_t range = this->Range.load(std::memory_order_relaxed);
      while (FirstOf(range) < EndOf(range))
      {
        if (this->Range.compare_exchange_weak(
              range, Pack(FirstOf(range), EndOf(range) - 1), std::memory_order_relaxed))
        {
          return EndOf(range) - 1;
        }
      }
      return std::nullopt;
    }
  };

  std::vector<Share> Shares;
};

} // namespace voxplex

#endif
