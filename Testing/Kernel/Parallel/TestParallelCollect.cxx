// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/ParallelCollect.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <stdexcept>
#include <stop_token>
#include <vector>

using namespace voxplex;

namespace
{

/** Each multiple of 3, twice. */
std::vector<std::size_t> MultiplesOfThree(std::size_t end, std::size_t grain, unsigned threads)
{
  return ParallelCollect<std::size_t>(end, grain, threads,
    [](std::size_t first, std::size_t last, std::vector<std::size_t>& found)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        if (i % 3 == 0)
        {
          found.insert(found.end(), { i, i });
        }
      }
    });
}

TEST(ParallelCollect, KeepsTheOrderOfIterations)
{
  for (const unsigned threads : { 1u, 2u, 7u })
  {
    for (const std::size_t grain : { 1u, 10u, 4096u })
    {
      const std::vector<std::size_t> found = MultiplesOfThree(1000, grain, threads);
      ASSERT_EQ(found.size(), 668u);
      for (std::size_t k = 0; k < found.size(); ++k)
      {
        ASSERT_EQ(found[k], k / 2 * 3) << threads << " threads, grain " << grain;
      }
    }
  }
}

TEST(ParallelCollect, OfNothing)
{
  EXPECT_TRUE(MultiplesOfThree(0, 10, 2).empty());
}

TEST(ParallelCollect, PassesOnWhatAChunkThrows)
{
  const auto fail = [](std::size_t first, std::size_t, std::vector<int>& found)
  {
    found.push_back(1);
    if (first == 50)
    {
      throw std::runtime_error("");
    }
  };
  EXPECT_THROW(ParallelCollect<int>(100, 10, 3, fail), std::runtime_error);
}

TEST(ParallelCollect, CanBeStopped)
{
  std::stop_source stop;
  stop.request_stop();
  const auto nothing = [](std::size_t, std::size_t, std::vector<int>&) {};
  EXPECT_THROW(ParallelCollect<int>(100, 10, 3, nothing, stop.get_token()), Cancelled);
}

} // namespace
