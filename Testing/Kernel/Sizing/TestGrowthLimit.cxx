// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// LimitGrowth() against the smallest value over all cells. Values and steps are multiples of 1/64,
// so sums are exact and results must be equal.
#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Sizing/GrowthLimit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <span>
#include <stop_token>
#include <vector>

using namespace voxplex;

namespace
{

constexpr float Infinity = std::numeric_limits<float>::infinity();

template <std::size_t D>
struct Grid
{
  std::array<std::size_t, D> Cells;
  std::array<float, D> Steps;
  std::vector<float> Values;

  /** @param given how many of 100 cells have a finite value */
  Grid(const std::array<std::size_t, D>& cells, unsigned given, std::mt19937& random)
    : Cells(cells)
  {
    std::size_t count = 1;
    for (std::size_t a = 0; a < D; ++a)
    {
      count *= cells[a];
      this->Steps[a] = static_cast<float>(random() % 64) / 64.0f;
    }
    this->Values.resize(count);
    for (float& value : this->Values)
    {
      value = random() % 100 < given ? static_cast<float>(random() % 1024) / 64.0f : Infinity;
    }
  }

  std::array<std::int64_t, D> Extent() const
  {
    std::array<std::int64_t, D> extent;
    std::copy(this->Cells.begin(), this->Cells.end(), extent.begin());
    return extent;
  }

  /** Each cell's smallest value by all cells that have one. */
  std::vector<float> BruteForce() const
  {
    const std::array<std::int64_t, D> extent = this->Extent();
    std::vector<float> limited(this->Values.size(), Infinity);
    for (std::size_t from = 0; from < this->Values.size(); ++from)
    {
      if (std::isinf(this->Values[from]))
      {
        continue;
      }
      const std::array<std::int64_t, D> source = IndexAt(from, extent);
      std::array<std::int64_t, D> last;
      std::transform(extent.begin(), extent.end(), last.begin(), [](auto n) { return n - 1; });
      ForEachIndex({}, last,
        [&](const std::array<std::int64_t, D>& index)
        {
          float value = this->Values[from];
          for (std::size_t a = 0; a < D; ++a)
          {
            value += this->Steps[a] * static_cast<float>(std::abs(index[a] - source[a]));
          }
          float& least = limited[OffsetOf(index, extent)];
          least = std::min(least, value);
        });
    }
    return limited;
  }

  std::vector<float> Limited(unsigned threads) const
  {
    std::vector<float> values = this->Values;
    LimitGrowth(std::span<float>(values), this->Cells, this->Steps, threads);
    return values;
  }

  /** With 1, 2 and 4 threads. */
  void ExpectRight() const
  {
    const std::vector<float> expected = this->BruteForce();
    for (const unsigned threads : { 1u, 2u, 4u })
    {
      ASSERT_EQ(this->Limited(threads), expected)
        << threads << " threads, " << testing::PrintToString(this->Cells);
    }
  }
};

template <std::size_t D>
void ExpectRightOnSmallGrids(unsigned seed)
{
  std::mt19937 random(seed);
  for (int i = 0; i < 60; ++i)
  {
    std::array<std::size_t, D> cells;
    for (std::size_t& n : cells)
    {
      n = 1 + random() % (D == 3 ? 8 : 5);
    }
    Grid<D>(cells, i % 3 == 0 ? 3 : i % 3 == 1 ? 30 : 100, random).ExpectRight();
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(LimitGrowth, IsTheLeastOverAllCells)
{
  ExpectRightOnSmallGrids<3>(1);
  ExpectRightOnSmallGrids<4>(2);
}

// Threads share such layers in strips of 4096 values: one strip, one and a little, two, three; and
// several blocks of them.
TEST(LimitGrowth, SharesLargeLayers)
{
  std::mt19937 random(3);
  constexpr unsigned Given = 1;
  Grid<3>({ 64, 64, 5 }, Given, random).ExpectRight();
  Grid<3>({ 17, 241, 6 }, Given, random).ExpectRight(); // 4097
  Grid<3>({ 128, 64, 4 }, Given, random).ExpectRight();
  Grid<3>({ 5000, 2, 3 }, Given, random).ExpectRight();
  Grid<4>({ 23, 20, 21, 3 }, Given, random).ExpectRight(); // 9660
  Grid<4>({ 70, 60, 3, 2 }, Given, random).ExpectRight();
}

//------------------------------------------------------------------------------------------------
TEST(LimitGrowth, LeavesAGridWithoutValuesAlone)
{
  std::mt19937 random(4);
  const Grid<3> none({ 6, 5, 4 }, 0, random);
  EXPECT_EQ(none.Limited(2), none.Values);
  const Grid<3> empty({ 6, 0, 4 }, 100, random);
  EXPECT_TRUE(empty.Limited(2).empty());
}

TEST(LimitGrowth, EndsIfAStopIsRequested)
{
  std::mt19937 random(5);
  Grid<3> grid({ 6, 5, 4 }, 100, random);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(
    LimitGrowth(std::span<float>(grid.Values), grid.Cells, grid.Steps, 1, stop.get_token()),
    Cancelled);
}
