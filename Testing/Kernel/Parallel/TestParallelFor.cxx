// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/ParallelFor.h"

#include "Parallel/ChunkShares.h"
#include "Parallel/ThreadTeam.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace voxplex;

//------------------------------------------------------------------------------------------------
TEST(ChunkShares, AThreadTakesItsOwnThenTheLastOfTheLargest)
{
  ChunkShares shares(10, 3); // 0 to 2, 3 to 5, 6 to 9
  std::vector<std::size_t> taken;
  while (const std::optional<std::size_t> chunk = shares.Take(0))
  {
    taken.push_back(*chunk);
  }
  EXPECT_EQ(taken, (std::vector<std::size_t>{ 0, 1, 2, 9, 5, 8, 4, 7, 3, 6 }));
  EXPECT_FALSE(shares.Take(1));
}

TEST(ChunkShares, OneShareIsThatOfAllThreads)
{
  ChunkShares shares(3, 1);
  EXPECT_EQ(shares.Take(2), 0u);
  EXPECT_EQ(shares.Take(0), 1u);
  EXPECT_EQ(shares.Take(5), 2u);
  EXPECT_FALSE(shares.Take(0));
}

TEST(ChunkShares, NothingIsLeftOnceCleared)
{
  ChunkShares shares(100, 4);
  shares.Clear();
  EXPECT_FALSE(shares.Take(1));
}

TEST(ChunkShares, ThreadsTakeEachChunkOnce)
{
  constexpr std::size_t Chunks = 20000;
  constexpr std::size_t Threads = 4;
  ChunkShares shares(Chunks, Threads);
  std::vector<std::atomic<int>> times(Chunks);
  std::vector<std::jthread> threads;
  for (std::size_t t = 0; t < Threads; ++t)
  {
    threads.emplace_back(
      [&, t]
      {
        while (const std::optional<std::size_t> chunk = shares.Take(t))
        {
          ++times[*chunk];
        }
      });
  }
  threads.clear();
  for (const std::atomic<int>& n : times)
  {
    ASSERT_EQ(n, 1);
  }
}

//------------------------------------------------------------------------------------------------
TEST(ParallelFor, CoversTheRangeOnce)
{
  constexpr std::size_t largest = std::numeric_limits<std::size_t>::max();
  for (const unsigned threads : { 0u, 1u, 2u, 5u, 16u })
  {
    for (const std::size_t grain :
      { std::size_t{ 0 }, std::size_t{ 1 }, std::size_t{ 7 }, largest })
    {
      std::vector<std::atomic<int>> times(100);
      ParallelFor(3, times.size(), grain, threads,
        [&](std::size_t first, std::size_t last)
        {
          EXPECT_TRUE(grain == 0 || (first - 3) % grain == 0);
          for (std::size_t i = first; i < last; ++i)
          {
            ++times[i];
          }
        });
      for (std::size_t i = 0; i < times.size(); ++i)
      {
        ASSERT_EQ(times[i], i < 3 ? 0 : 1) << threads << " threads, grain " << grain;
      }
    }
  }
}

// Each chunk waits until all have begun, so each thread takes one.
TEST(ParallelFor, LoopsOverARangeGiveThreadsTheSameParts)
{
  constexpr unsigned Threads = 3;
  const ThreadTeam team(Threads);
  ASSERT_EQ(team.NumberOfHelpers(), Threads - 1);
  std::vector<std::thread::id> before;
  for (int loop = 0; loop < 5; ++loop)
  {
    std::vector<std::thread::id> threads(Threads);
    std::atomic<unsigned> arrived = 0;
    ParallelFor(0, Threads, 1, Threads,
      [&](std::size_t first, std::size_t)
      {
        threads[first] = std::this_thread::get_id();
        ++arrived;
        while (arrived < Threads)
        {
          std::this_thread::yield();
        }
      });
    EXPECT_TRUE(before.empty() || threads == before);
    before = threads;
  }
}

TEST(ParallelFor, PassesOnWhatAChunkThrowsAndStops)
{
  for (const unsigned threads : { 1u, 3u })
  {
    std::atomic<int> chunks = 0;
    const auto fail = [&](std::size_t, std::size_t)
    {
      ++chunks;
      throw std::runtime_error("full");
    };
    EXPECT_THROW(ParallelFor(0, 1000, 1, threads, fail), std::runtime_error);
    EXPECT_LE(chunks, static_cast<int>(threads));
  }
}

//------------------------------------------------------------------------------------------------
TEST(ParallelTasks, BeginInOrder)
{
  for (const unsigned threads : { 1u, 2u, 6u })
  {
    std::vector<std::atomic<int>> times(50);
    std::atomic<std::size_t> begun = 0;
    ParallelTasks(times.size(), threads,
      [&](std::size_t task)
      {
        // Of the tasks before this one, others may have been taken but not begun.
        EXPECT_LT(task, begun++ + threads);
        ++times[task];
      });
    for (const std::atomic<int>& n : times)
    {
      ASSERT_EQ(n, 1);
    }
  }
  ParallelTasks(0, 3, [](std::size_t) { FAIL(); });
}
