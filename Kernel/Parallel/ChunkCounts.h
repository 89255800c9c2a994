// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChunkCounts.h
 * @brief Lets the chunks of a parallel loop append to one array.
 */
#ifndef voxplex_ChunkCounts_h
#define voxplex_ChunkCounts_h

#include <cstddef>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief Counts the elements that each chunk of a ParallelFor() yields, and computes their offsets.
 *
 * The output array holds the elements of all chunks, one chunk after the other. A first loop sets
 * OfChunk() to the number of elements of each chunk. TurnIntoPlaces() replaces each number by the
 * offset of the chunk's first element in the array. A second loop, with the same chunks, writes the
 * elements there. The array is the same as if one thread had appended all elements in order.
 */
class ChunkCounts
{
public:
  static constexpr std::size_t Grain = 8192; ///< iterations of a chunk; both loops begin at 0

  explicit ChunkCounts(std::size_t iterations = 0)
    : Counts((iterations + Grain - 1) / Grain)
  {
  }

  /**
   * The entry of the chunk that begins with iteration `first`. Threads may access different chunks
   * at the same time.
   */
  std::size_t& OfChunk(std::size_t first) { return this->Counts[first / Grain]; }

  /** Replaces the counts by offsets. @return the number of elements of all chunks */
  std::size_t TurnIntoPlaces()
  {
    std::size_t sum = 0;
    for (std::size_t& count : this->Counts)
    {
      sum += std::exchange(count, sum);
    }
    return sum;
  }

private:
  std::vector<std::size_t> Counts;
};

} // namespace voxplex

#endif
