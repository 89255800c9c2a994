// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Teams of threads, and the loops that use them.
#include "Parallel/ParallelFor.h"
#include "Parallel/ThreadTeam.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace voxplex;

namespace
{

/** Counts the threads that call Visit(). */
class Visitors
{
public:
  void Visit()
  {
    thread_local int last = 0;
    if (last != this->Id)
    {
      last = this->Id;
      ++this->Number;
    }
  }
  int Count() const { return this->Number; }

private:
  static inline std::atomic<int> Ids = 0;
  const int Id = ++Ids;
  std::atomic<int> Number = 0;
};

/** The sum of 0 ... n-1, by a loop. */
std::size_t SumBelow(std::size_t n, unsigned threads)
{
  std::atomic<std::size_t> sum = 0;
  ParallelFor(0, n, 3, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        sum += k;
      }
    });
  return sum;
}

} // namespace

// Each waits for all others, so the test would not end if they took turns.
TEST(ThreadTeam, ItsThreadsWorkAtTheSameTime)
{
  ThreadTeam team(4);
  ASSERT_EQ(team.NumberOfHelpers(), 3u);
  for (const int number : { 4, 2, 3, 4, 1 })
  {
    std::atomic<int> arrived = 0;
    std::vector<std::atomic<int>> calls(4);
    auto work = [&](std::size_t thread)
    {
      ++calls[thread];
      ++arrived;
      while (arrived < number)
      {
        std::this_thread::yield();
      }
    };
    team.Run(static_cast<std::size_t>(number - 1), work);
    EXPECT_EQ(arrived, number);
    for (int thread = 0; thread < 4; ++thread)
    {
      EXPECT_EQ(calls[static_cast<std::size_t>(thread)], thread < number ? 1 : 0);
    }
  }
}

// Each chunk waits for the others, so that all threads take one.
TEST(ThreadTeam, ALoopUsesTheTeamOfItsThread)
{
  constexpr int Threads = 3;
  Visitors visitors;
  const auto loop = [&]
  {
    std::atomic<int> arrived = 0;
    ParallelFor(0, Threads, 1, Threads,
      [&](std::size_t, std::size_t)
      {
        visitors.Visit();
        ++arrived;
        while (arrived < Threads)
        {
          std::this_thread::yield();
        }
      });
  };
  {
    const ThreadTeam team(Threads);
    for (int k = 0; k < 40; ++k)
    {
      loop();
    }
    EXPECT_EQ(visitors.Count(), Threads);
  }
  EXPECT_EQ(ThreadTeam::Idle(), nullptr);
  loop(); // starts threads
  EXPECT_EQ(visitors.Count(), 2 * Threads - 1);
}

// Neither side uses atomics, so the thread sanitizer sees what the team does not order.
TEST(ThreadTeam, WhatIsWrittenIsSeenOnBothSides)
{
  const ThreadTeam team(4);
  std::vector<std::size_t> values(1000, 0);
  for (std::size_t round = 1; round <= 300; ++round)
  {
    ParallelFor(0, values.size(), 16, 4,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t k = first; k < last; ++k)
        {
          ++values[k];
        }
      });
    for (std::size_t& value : values) // by the leader
    {
      ASSERT_EQ(value, 2 * round - 1);
      ++value;
    }
  }
}

TEST(ThreadTeam, LoopsWithinALoopDoNotNeedIt)
{
  const ThreadTeam team(3);
  std::atomic<int> right = 0;
  ParallelFor(0, 30, 1, 3,
    [&](std::size_t, std::size_t)
    {
      EXPECT_EQ(ThreadTeam::Idle(), nullptr); // for the leader, it works; a helper has none
      right += SumBelow(100, 2) == 4950 ? 1 : 0;
    });
  EXPECT_EQ(right, 30);
  EXPECT_EQ(ThreadTeam::Idle(), &team);
}

TEST(ThreadTeam, AnExceptionLeavesItReady)
{
  const ThreadTeam team(3);
  for (int k = 0; k < 20; ++k)
  {
    EXPECT_THROW(ParallelFor(0, 100, 1, 3,
                   [](std::size_t first, std::size_t)
                   {
                     if (first == 50)
                     {
                       throw std::runtime_error("50");
                     }
                   }),
      std::runtime_error);
    EXPECT_EQ(ThreadTeam::Idle(), &team);
    EXPECT_EQ(SumBelow(1000, 3), 499500u);
  }
}

TEST(ThreadTeam, ThreadsHaveTeamsOfTheirOwn)
{
  std::atomic<int> right = 0;
  std::vector<std::jthread> leaders;
  for (int t = 0; t < 3; ++t)
  {
    leaders.emplace_back(
      [&]
      {
        const ThreadTeam team(3);
        for (int k = 0; k < 50; ++k)
        {
          right += SumBelow(1000, 3) == 499500 ? 1 : 0;
        }
      });
  }
  leaders.clear();
  EXPECT_EQ(right, 150);
}

TEST(ThreadTeam, TheLatestIsUsed)
{
  const ThreadTeam outer(2);
  {
    const ThreadTeam inner(3);
    EXPECT_EQ(ThreadTeam::Idle(), &inner);
    EXPECT_EQ(SumBelow(1000, 3), 499500u);
  }
  EXPECT_EQ(ThreadTeam::Idle(), &outer);
  EXPECT_EQ(SumBelow(1000, 3), 499500u); // with fewer threads than asked for
}

TEST(ThreadTeam, OfOneThreadHasNoHelpers)
{
  const ThreadTeam team(1);
  EXPECT_EQ(team.NumberOfHelpers(), 0u);
  EXPECT_EQ(SumBelow(1000, 4), 499500u);
}
