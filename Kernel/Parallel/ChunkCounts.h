// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChunkCounts.h
 * @brief How chunks of a parallel loop append to one array.
 */
#ifndef voxplex_ChunkCounts_h
#define voxplex_ChunkCounts_h

#include <cstddef>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief Counts the elements that each chunk of a ParallelFor() yields, and says where they belong.
 *
 * A first loop sets OfChunk() to the number of elements of each chunk. TurnIntoPlaces() makes of
 * these where each chunk's elements begin in an array that has the elements of all chunks one after
 * the other; a second loop, in the same chunks, writes them there. What comes out is what one thread
 * would have appended.
 */
class ChunkCounts
{
public:
  static constexpr std::size_t Grain = 8192; ///< for both loops, which begin at 0

  explicit ChunkCounts(std::size_t iterations = 0)
    : Counts((iterations + Grain - 1) / Grain)
  {
  }

  /** The chunk that begins with this iteration. Threads may access different chunks at once. */
  std::size_t& OfChunk(std::size_t first) { return this->Counts[first / Grain]; }

  /** Returns the number of all elements. */
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
