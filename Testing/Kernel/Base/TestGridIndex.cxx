// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/GridIndex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

using namespace voxplex;

namespace
{

template <std::size_t D>
using Index = std::array<std::int64_t, D>;

template <std::size_t D>
std::size_t CellsOf(const Index<D>& extent)
{
  std::size_t count = 1;
  for (const std::int64_t n : extent)
  {
    count *= static_cast<std::size_t>(n);
  }
  return count;
}

/** The indices that ForEachIndex() visits, in this order. */
template <std::size_t D>
std::vector<Index<D>> Visited(const Index<D>& low, const Index<D>& high)
{
  std::vector<Index<D>> visited;
  ForEachIndex(low, high, [&](const Index<D>& index) { visited.push_back(index); });
  return visited;
}

template <std::size_t D>
Index<D> LastOf(Index<D> extent)
{
  for (std::int64_t& n : extent)
  {
    --n;
  }
  return extent;
}

/** Cell by cell: numbers begin at 0, and the first axis is the fastest. */
template <std::size_t D>
void ExpectNumbersOf(const Index<D>& extent)
{
  Index<D> index{};
  for (std::size_t offset = 0; offset < CellsOf(extent); ++offset)
  {
    ASSERT_EQ(OffsetOf(index, extent), offset);
    ASSERT_EQ(IndexAt(offset, extent), index);
    for (std::size_t a = 0; a < D && ++index[a] == extent[a]; ++a)
    {
      index[a] = 0;
    }
  }
}

/** All cells of the grid, and of every box inside of it. */
template <std::size_t D>
void ExpectVisitsOf(const Index<D>& extent)
{
  const std::vector<Index<D>> all = Visited({}, LastOf(extent));
  ASSERT_EQ(all.size(), CellsOf(extent));
  for (std::size_t offset = 0; offset < all.size(); ++offset)
  {
    ASSERT_EQ(OffsetOf(all[offset], extent), offset);
  }
  for (const Index<D>& low : all)
  {
    for (const Index<D>& high : all)
    {
      std::vector<Index<D>> inside;
      std::copy_if(all.begin(), all.end(), std::back_inserter(inside),
        [&](const Index<D>& index)
        {
          bool isInside = true;
          for (std::size_t a = 0; a < D; ++a)
          {
            isInside &= low[a] <= index[a] && index[a] <= high[a];
          }
          return isInside;
        });
      ASSERT_EQ(Visited(low, high), inside);
    }
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(GridIndex, NumbersAndIndicesAreInverse)
{
  ExpectNumbersOf<3>({ 4, 3, 5 });
  ExpectNumbersOf<3>({ 1, 1, 1 });
  ExpectNumbersOf<3>({ 1, 7, 2 });
  ExpectNumbersOf<3>({ 6, 1, 1 });
  ExpectNumbersOf<4>({ 4, 3, 5, 2 });
  ExpectNumbersOf<4>({ 3, 1, 4, 1 });
  ExpectNumbersOf<4>({ 1, 1, 1, 9 });
}

TEST(GridIndex, RowsLieAlongTheFirstAxis)
{
  const Index<4> extent{ 4, 3, 5, 2 };
  EXPECT_EQ(CountCells(extent), 120u);
  for (std::size_t k = 0; k < CountCells(extent); ++k)
  {
    EXPECT_EQ(RowOf(IndexAt(k, extent), extent), k / 4);
  }
}

TEST(GridIndex, NumbersMayNeedMoreThan32Bits)
{
  const Index<3> extent{ 70000, 80000, 90000 };
  const Index<3> last{ 69999, 79999, 89999 };
  EXPECT_EQ(OffsetOf(last, extent), 503999999999999u);
  EXPECT_EQ(IndexAt(503999999999999u, extent), last);
  const Index<4> extent4{ 2000, 3000, 4000, 5000 };
  const Index<4> last4{ 1999, 2999, 3999, 4999 };
  EXPECT_EQ(OffsetOf(last4, extent4), 119999999999999u);
  EXPECT_EQ(IndexAt(119999999999999u, extent4), last4);
}

TEST(GridIndex, VisitsEachIndexOnceInOrder)
{
  ExpectVisitsOf<3>({ 4, 3, 2 });
  ExpectVisitsOf<3>({ 1, 1, 1 });
  ExpectVisitsOf<3>({ 1, 5, 1 });
  ExpectVisitsOf<3>({ 2, 1, 4 });
  ExpectVisitsOf<4>({ 2, 3, 2, 3 });
  ExpectVisitsOf<4>({ 1, 3, 1, 2 });
}

TEST(GridIndex, VisitsBoxesAnywhere)
{
  const std::vector<Index<3>> expected{ { -1, 5, -8 }, { 0, 5, -8 }, { -1, 5, -7 }, { 0, 5, -7 } };
  EXPECT_EQ(Visited<3>({ -1, 5, -8 }, { 0, 5, -7 }), expected);
}

TEST(GridIndex, VisitsNothingOfAnEmptyBox)
{
  for (std::size_t a = 0; a < 3; ++a)
  {
    Index<3> high{ 2, 2, 2 };
    high[a] = -1;
    EXPECT_TRUE(Visited<3>({}, high).empty()) << a;
  }
  for (std::size_t a = 0; a < 4; ++a)
  {
    Index<4> high{ 2, 2, 2, 2 };
    high[a] = -5;
    EXPECT_TRUE(Visited<4>({}, high).empty()) << a;
  }
}
