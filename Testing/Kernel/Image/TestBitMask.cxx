// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/GridIndex.h"
#include "Image/BitMask.h"
#include "Parallel/ParallelFor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <random>
#include <vector>

using namespace voxplex;

// Runs of any length that begin and end anywhere in words; overlapping ones by several threads at once.
TEST(BitMask, ClearsRuns)
{
  using Index = BitMask<3>::Index;
  std::mt19937 random(2);
  const Index n{ 200, 3, 2 };
  for (const unsigned threads : { 1u, 4u })
  {
    BitMask<3> mask(n);
    std::vector<bool> expected(CountCells(n));
    const auto place = [&](const Index& p) { return OffsetOf(p, n); };
    struct Run
    {
      Index First;
      std::int64_t Last;
    };
    std::vector<Run> runs{ { { 64, 0, 0 }, 127 }, { { 0, 1, 0 }, 199 }, { { 5, 2, 1 }, 4 } };
    const auto any = [&](std::int64_t end)
    { return static_cast<std::int64_t>(random() % static_cast<unsigned>(end)); };
    for (int i = 0; i < 60; ++i)
    {
      const std::int64_t first = any(n[0]);
      runs.push_back({ { first, any(n[1]), any(n[2]) }, std::min(first + any(9), n[0] - 1) });
    }
    for (std::size_t k = 0; k < expected.size(); ++k)
    {
      if (random() % 8 != 0)
      {
        mask.Set(IndexAt(k, n));
        expected[k] = true;
      }
    }
    for (const Run& run : runs)
    {
      for (Index p = run.First; p[0] <= run.Last; ++p[0])
      {
        expected[place(p)] = false;
      }
    }
    ParallelFor(0, runs.size(), 1, threads,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t k = first; k < last; ++k)
        {
          mask.ClearRun(runs[k].First, runs[k].Last);
        }
      });
    for (std::size_t k = 0; k < expected.size(); ++k)
    {
      ASSERT_EQ(mask.Test(IndexAt(k, n)), expected[k]) << k;
    }
    EXPECT_GT(std::count(expected.begin(), expected.end(), true), 300);
  }
}

// Neighbours share words. Each bit is set by one call.
TEST(BitMask, ThreadsSetEachBitOnce)
{
  using Index = BitMask<3>::Index;
  const Index n{ 70, 3, 2 };
  constexpr std::size_t Calls = 20000;
  BitMask<3> mask(n);
  std::atomic<int> set = 0;
  ParallelFor(0, Calls, 16, 4,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        const auto x = static_cast<std::int64_t>(k * 7919 % 65); // not all of a row
        set +=
          mask.SetIfClear({ x, static_cast<std::int64_t>(k % 3), static_cast<std::int64_t>(k % 2) })
          ? 1
          : 0;
      }
    });
  EXPECT_EQ(set, 65 * 3 * 2);
  for (std::size_t k = 0; k < CountCells(n); ++k)
  {
    ASSERT_EQ(mask.Test(IndexAt(k, n)), k % 70 < 65) << k;
  }
}
