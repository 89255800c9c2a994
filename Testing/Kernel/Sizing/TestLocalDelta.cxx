// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/LabelImage.h"
#include "Sizing/LocalDelta.h"
#include "Sizing/LoweredCells.h"
#include "Sizing/SparseCells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

using namespace voxplex;

//------------------------------------------------------------------------------------------------
TEST(LocalDelta, HoldsAboutRunsAndGrowsWithDistance)
{
  const auto grid = GridGeometry<3>::Orthogonal({ 64, 64, 64 }, { 1.0, 2.0, 0.5 });
  const LabelImage<3> image =
    LabelImage<3>::FromScalars<std::uint8_t>(std::vector<std::uint8_t>(64 * 64 * 64, 1), grid);
  LocalDelta<3> local(image);
  EXPECT_TRUE(std::isinf(local.Smallest()));
  EXPECT_TRUE(std::isinf(local.At({ 20.0, 40.0, 10.0 }).Delta));
  EXPECT_TRUE(std::isinf(local.GradedAt({ 20.0, 40.0, 10.0 })));
  local.SetBound({ 20, 20, 20 }, 10, 3, 0.25);
  local.SetBound({ 20, 20, 20 }, 1, 5, 0.75); // does not raise what is there
  local.Grade();
  EXPECT_EQ(local.Smallest(), 0.25);
  for (std::int64_t i = 19; i <= 30; ++i) // a voxel around, and all of the voxels
  {
    for (const double j : { 19.0, 21.0 })
    {
      const Point<3> p = grid.ToFrame({ static_cast<double>(i), j, 20.4 });
      EXPECT_EQ(local.At(p).Delta, 0.25f) << i;
      EXPECT_EQ(local.At(p).Label, 3) << i;
    }
  }
  EXPECT_TRUE(std::isinf(local.At(grid.ToFrame({ 36.0, 20.0, 20.0 })).Delta));
  const Point<3> middle = grid.ToFrame({ 25.0, 20.0, 20.0 });
  EXPECT_TRUE(local.HasLowered());
  const LoweredCells<3> lowered(local);
  EXPECT_TRUE(lowered.AnyWithin(middle, 0.0));
  EXPECT_TRUE(lowered.AnyWithin(grid.ToFrame({ 40.0, 20.0, 20.0 }), 10.0));
  EXPECT_FALSE(lowered.AnyWithin(grid.ToFrame({ 40.0, 20.0, 20.0 }), 7.0));
  EXPECT_TRUE(lowered.AnyWithin(grid.ToFrame({ 25.0, 20.0, 40.0 }), 9.5));
  EXPECT_FALSE(lowered.AnyWithin(grid.ToFrame({ 25.0, 20.0, 40.0 }), 9.0));
  EXPECT_FALSE(lowered.AnyWithin(grid.ToFrame({ 25.0, 40.0, 20.0 }), 9.0));
  EXPECT_TRUE(lowered.AnyWithin({ -1000.0, 0.0, 0.0 }, 2000.0));
  // The cells along the first axis end half a voxel behind voxel 31, however far the point and large the ball.
  for (double i = 32.0; i < 64.0; i += 0.5)
  {
    for (double radius = 0.25; radius < 40.0; radius += 0.5)
    {
      ASSERT_EQ(lowered.AnyWithin(grid.ToFrame({ i, 20.0, 20.0 }), radius), i - radius < 31.5)
        << i << " " << radius;
    }
  }
  local.ForgetLowered();
  EXPECT_FALSE(local.HasLowered());
  EXPECT_FALSE(LoweredCells<3>(local).AnyWithin(middle, 100.0));
  local.SetBound({ 20, 20, 20 }, 10, 3, 0.5); // is less there already
  EXPECT_FALSE(local.HasLowered());
  local.SetBound({ 60, 60, 60 }, 1, 3, 0.5);
  EXPECT_TRUE(LoweredCells<3>(local).AnyWithin(grid.ToFrame({ 60.0, 60.0, 60.0 }), 0.0));
  EXPECT_FALSE(LoweredCells<3>(local).AnyWithin(middle, 0.0));
  // As of Grade(): cells 9 to 15 and 9 to 10, and those next to them, have the bound; from these it grows.
  constexpr double cell = LocalDelta<3>::Cell;
  const auto cells = [](double c, double first, double last) {
    return std::max({ first - 1.0 - c, c - last - 1.0, 0.0 });
  };
  for (double z = 0.0; z < 16.0; ++z)
  {
    for (double y = 0.0; y < 16.0; ++y)
    {
      for (double x = 0.0; x < 16.0; ++x)
      {
        const Point<3> p = grid.ToFrame({ cell * x + 0.5, cell * y + 0.5, cell * z + 0.5 });
        const double away =
          cell * (cells(x, 9.0, 15.0) + 2.0 * cells(y, 9.0, 10.0) + 0.5 * cells(z, 9.0, 10.0));
        ASSERT_NEAR(local.GradedAt(p), 0.25 + LocalDelta<3>::Slope * away, 1e-4);
      }
    }
  }
}

//------------------------------------------------------------------------------------------------
// What is made for a fine place must not be too near by the measure of a place just beside it.
TEST(LocalDelta, GrowsSteadilyFromTheBordersOfCells)
{
  const auto grid = GridGeometry<3>::Orthogonal({ 40, 40, 40 }, { 1.0, 2.0, 0.5 });
  const LabelImage<3> image =
    LabelImage<3>::FromScalars<std::uint8_t>(std::vector<std::uint8_t>(40 * 40 * 40, 1), grid);
  LocalDelta<3> local(image);
  local.SetBound({ 20, 20, 20 }, 3, 3, 0.25);
  local.SetSpacing({ 33, 21, 20 }, 1, 0.5);
  local.Grade();
  for (const std::size_t axis : { 0, 1, 2 })
  {
    constexpr double Step = 0.01; // voxels
    const double most = LocalDelta<3>::Slope * Step * grid.Spacing(static_cast<int>(axis)) + 1e-6;
    Point<3> index{ 21.0, 20.5, 19.7 };
    double before = 0.0;
    for (index[axis] = -3.0; index[axis] < 45.0; index[axis] += Step)
    {
      const Point<3> p = grid.ToFrame(index);
      const double here = local.GradedAt(p);
      if (index[axis] > -3.0)
      {
        ASSERT_LE(std::abs(here - before), most) << axis << " " << index[axis];
      }
      ASSERT_LE(here, static_cast<double>(local.At(p).Delta) + 1e-9) << axis << " " << index[axis];
      before = here;
    }
  }
}

//------------------------------------------------------------------------------------------------
namespace
{

struct RandomBounds
{
  LabelImage<3> Image =
    LabelImage<3>::FromScalars<std::uint8_t>(std::vector<std::uint8_t>(60 * 50 * 40, 1),
      GridGeometry<3>::Orthogonal({ 60, 50, 40 }, { 0.5, 0.5, 1.0 }));
  std::mt19937 Random{ 7 };

  double Uniform(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(this->Random);
  }
  Point<3> Place()
  {
    return this->Image.Grid().ToFrame(
      { this->Uniform(-4.0, 64.0), this->Uniform(-4.0, 54.0), this->Uniform(-4.0, 44.0) });
  }
  LocalDelta<3>::Index Voxel()
  {
    return { static_cast<std::int64_t>(this->Uniform(0.0, 59.0)),
      static_cast<std::int64_t>(this->Uniform(0.0, 49.0)),
      static_cast<std::int64_t>(this->Uniform(0.0, 39.0)) };
  }
};

} // namespace

//------------------------------------------------------------------------------------------------
TEST(LocalDelta, GradesNewBoundsAsIfAllWereSetAtOnce)
{
  RandomBounds random;
  LocalDelta<3> together(random.Image);
  LocalDelta<3> step(random.Image);
  LocalDelta<3> near(random.Image);
  constexpr double Needed = 1.5;
  for (int round = 0; round < 5; ++round)
  {
    for (int i = 0; i < 6; ++i)
    {
      const LocalDelta<3>::Index voxel = random.Voxel();
      const double spacing = random.Uniform(0.2, 1.0);
      together.SetSpacing(voxel, 1, spacing);
      step.SetSpacing(voxel, 1, spacing);
      near.SetSpacing(voxel, 1, spacing);
    }
    step.Grade();
    near.Grade(Needed);
  }
  together.Grade();
  int below = 0;
  for (int i = 0; i < 5000; ++i)
  {
    const Point<3> p = random.Place();
    const double expected = together.GradedAt(p);
    ASSERT_NEAR(step.GradedAt(p), expected, 1e-5);
    if (expected < Needed)
    {
      ASSERT_NEAR(near.GradedAt(p), expected, 1e-5);
      ++below;
    }
    else
    {
      ASSERT_GE(near.GradedAt(p), Needed);
    }
  }
  EXPECT_GT(below, 500);
  EXPECT_LT(below, 4500);
}

//------------------------------------------------------------------------------------------------
TEST(LocalDelta, LoweredCellsAreFoundInBallsOfAllSizes)
{
  RandomBounds random;
  LocalDelta<3> local(random.Image);
  for (int i = 0; i < 3; ++i)
  {
    local.SetBound(random.Voxel(), 1, 1, 0.5);
  }
  const LoweredCells<3> lowered(local);
  int reached = 0;
  for (int i = 0; i < 20000; ++i)
  {
    const Point<3> p = random.Place();
    const double radius = std::pow(10.0, random.Uniform(-2.0, 1.5));
    const auto [low, high] = local.CellsAround(p, radius);
    const bool expected = std::any_of(local.Lowered().begin(), local.Lowered().end(),
      [&, first = low, last = high](const LocalDelta<3>::Index& cell)
      {
        bool isBetween = true;
        for (std::size_t a = 0; a < 3; ++a)
        {
          isBetween = isBetween && cell[a] >= first[a] && cell[a] <= last[a];
        }
        return isBetween;
      });
    ASSERT_EQ(lowered.AnyWithin(p, radius), expected) << radius;
    reached += expected ? 1 : 0;
  }
  EXPECT_GT(reached, 2000);
  EXPECT_LT(reached, 18000);
}

//------------------------------------------------------------------------------------------------
TEST(SparseCells, HoldWhatWasWrittenAndTheInitialValue)
{
  using Cells = SparseCells<3, int>;
  Cells cells({ 20, 9, 17 }, -1);
  const std::size_t before = cells.MemoryBytes();
  EXPECT_TRUE(cells.IsEmpty());
  EXPECT_TRUE(cells.HasNone({ 0, 0, 0 }, { 1, 1, 1 }));
  cells.Write({ 0, 0, 0 }) = 1;
  cells.Write({ 19, 8, 16 }) = 2;
  cells.Write({ 8, 0, 0 }) = 3;
  EXPECT_EQ(cells.At({ 0, 0, 0 }), 1);
  EXPECT_EQ(cells.At({ 19, 8, 16 }), 2);
  EXPECT_EQ(cells.At({ 8, 0, 0 }), 3);
  EXPECT_EQ(cells.At({ 7, 0, 0 }), -1);
  EXPECT_EQ(cells.At({ 0, 8, 0 }), -1);
  EXPECT_FALSE(cells.IsEmpty());
  EXPECT_FALSE(cells.HasNone({ 1, 1, 1 }, { 2, 2, 2 }));
  EXPECT_FALSE(cells.HasNone({ 7, 0, 0 }, { 8, 0, 0 })); // in two blocks
  EXPECT_TRUE(cells.HasNone({ 0, 8, 0 }, { 1, 8, 1 }));
  EXPECT_EQ(cells.MemoryBytes(), before + 3 * 512 * sizeof(int));
}
