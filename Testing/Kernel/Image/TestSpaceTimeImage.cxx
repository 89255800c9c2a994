// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Label field and domain of a space-time image near its first and last frame and beyond them, where the
// object goes on unchanged if it is cut there.
#include "Base/GridIndex.h"
#include "Domain/ImageDomain.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** Balls that move through a grid of 7 frames; foreground in frames `first` to `last` only. */
LabelImage<4> MovingBalls(const GridGeometry<4>& grid, std::int64_t first, std::int64_t last)
{
  const double step = grid.IndexToFrame[3][3];
  return ImageOf({ grid,
    [=](const Point<4>& p) -> std::uint8_t
    {
      const double frame = p[3] / step;
      if (frame < static_cast<double>(first) - 0.5 || frame > static_cast<double>(last) + 0.5)
      {
        return 0;
      }
      const Point<4> a = grid.ToFrame({ 5.0 + 0.4 * frame, 6.0, 6.0, 0.0 });
      const Point<4> b = grid.ToFrame({ 9.0, 7.0 - 0.3 * frame, 7.0, 0.0 });
      const auto near = [&](const Point<4>& c, double r)
      { return std::hypot(p[0] - c[0], p[1] - c[1], p[2] - c[2]) < r; };
      return near(a, 3.2) ? 1 : near(b, 3.4) ? 2 : 0;
    } });
}

GridGeometry<4> Grid(bool tilted, double timeScale = 1.5)
{
  GridGeometry<4> grid =
    GridGeometry<4>::Orthogonal({ 15, 14, 14, 7 }, { 1.0, 0.9, 1.1, timeScale });
  if (tilted)
  {
    grid.IndexToFrame[0][1] = 0.3;
    grid.IndexToFrame[1][2] = -0.2;
  }
  return grid;
}

/** Anywhere in a box, and in time up to `beyond` units outside of it. */
Point<4> RandomPoint(const Box<4>& box, double beyond, std::mt19937& random)
{
  Point<4> p;
  for (std::size_t a = 0; a < 4; ++a)
  {
    const double more = a == 3 ? beyond : 0.0;
    p[a] = std::uniform_real_distribution<double>(box.Min[a] - more, box.Max[a] + more)(random);
  }
  return p;
}

Point<4> OnEnds(Point<4> p, const ImageDomain<4>& domain)
{
  const Box<4> box = domain.Bounds();
  p[3] = domain.HasTimeBorder(0) ? std::max(p[3], box.Min[3]) : p[3];
  p[3] = domain.HasTimeBorder(1) ? std::min(p[3], box.Max[3]) : p[3];
  return p;
}

/** Whether a point is on an interface of a label: others within 0.03 voxel, at the same time too. */
bool IsOnInterface(const ImageDomain<4>& domain, const Point<4>& z, bool inTime)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.03, 0.03);
  const LabelId label = domain.Label(z);
  for (int i = 0; i < 2000; ++i)
  {
    Point<4> p = z;
    for (std::size_t a = 0; a < (inTime ? 4u : 3u); ++a)
    {
      p[a] += uniform(random);
    }
    if (domain.Label(p) != label)
    {
      return true;
    }
  }
  return false;
}

/** Interface points of a time, random ones. */
std::vector<Point<4>> InterfaceAt(
  const ImageDomain<4>& domain, double time, std::size_t count, std::mt19937& random)
{
  std::vector<Point<4>> samples;
  while (samples.size() < count)
  {
    Point<4> a = RandomPoint(domain.Bounds(), 0.0, random);
    a[3] = time;
    Point<4> b = a;
    for (std::size_t k = 0; k < 3; ++k)
    {
      b[k] += std::uniform_real_distribution<double>(-1.0, 1.0)(random);
    }
    const LabelId label = domain.Label(a);
    if (label == domain.Label(b))
    {
      continue;
    }
    for (int i = 0; i < 24; ++i)
    {
      const Point<4> middle = Interpolate(a, b, 0.5);
      (domain.Label(middle) == label ? a : b) = middle;
    }
    samples.push_back(a);
  }
  return samples;
}

double NearestSample(const std::vector<Point<4>>& samples, const Point<4>& p)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (const Point<4>& s : samples)
  {
    nearest = std::min(nearest, Distance(p, s));
  }
  return nearest;
}

struct Cut
{
  std::int64_t First;
  std::int64_t Last;
  bool AtStart;
  bool AtEnd;
};
constexpr std::array<Cut, 4> Borders = { { { 0, 6, true, true }, { 0, 4, true, false },
  { 2, 6, false, true }, { 2, 4, false, false } } };

} // namespace

TEST(SpaceTimeImage, KnowsWhereItIsCut)
{
  for (const Cut& cut : Borders)
  {
    const LabelImage<4> image = MovingBalls(Grid(false), cut.First, cut.Last);
    EXPECT_EQ(image.ReachesBorderInTime(0), cut.AtStart);
    EXPECT_EQ(image.ReachesBorderInTime(1), cut.AtEnd);
    const ImageDomain<4> domain(image, 1.0);
    EXPECT_EQ(domain.HasTimeBorder(0), cut.AtStart);
    EXPECT_EQ(domain.HasTimeBorder(1), cut.AtEnd);
    const Box<4> box = domain.Bounds();
    // Where it is not cut there is a layer of background, as in space.
    EXPECT_EQ(box.Min[3], cut.AtStart ? 0.0 : 1.5 * static_cast<double>(cut.First - 1));
    EXPECT_EQ(box.Max[3], cut.AtEnd ? 9.0 : 1.5 * static_cast<double>(cut.Last + 1));
    const std::array<double, 2> ends = domain.GetLabelField().FlatEnds();
    EXPECT_EQ(ends[0], cut.AtStart ? 1.0 : -std::numeric_limits<double>::infinity());
    EXPECT_EQ(ends[1],
      cut.AtEnd ? static_cast<double>(image.CropDimensions()[3])
                : std::numeric_limits<double>::infinity());
  }
}

TEST(SpaceTimeImage, GoesOnUnchangedBeyondACut)
{
  std::mt19937 random(1);
  for (const bool tilted : { false, true })
  {
    for (const Cut& cut : Borders)
    {
      const LabelImage<4> image = MovingBalls(Grid(tilted), cut.First, cut.Last);
      const ImageDomain<4> domain(image, 1.0);
      const LabelField<4>& field = domain.GetLabelField();
      int foreground = 0;
      for (int q = 0; q < 1000; ++q)
      {
        const Point<4> p = RandomPoint(domain.Bounds(), 40.0, random);
        const Point<4> onEnd = OnEnds(p, domain);
        ASSERT_EQ(domain.Label(p), domain.Label(onEnd));
        ASSERT_EQ(field.Margin(p, 1), field.Margin(onEnd, 1));
        const bool before = p[3] < domain.Bounds().Min[3];
        const bool after = p[3] > domain.Bounds().Max[3];
        if ((before && !cut.AtStart) || (after && !cut.AtEnd))
        {
          ASSERT_EQ(domain.Label(p), 0);
        }
        foreground += (before || after) && domain.Label(p) != 0 ? 1 : 0;
      }
      EXPECT_EQ(foreground > 0, cut.AtStart || cut.AtEnd);
    }
  }
}

// The smoothing sees the first frame again before it: what does not move is the same at all times.
TEST(SpaceTimeImage, WhatStandsStillIsTheSameAtAllTimes)
{
  const GridGeometry<4> grid = Grid(false);
  const LabelImage<4> image =
    ImageOf({ grid, [](const Point<4>& p) -> std::uint8_t {
               return std::hypot(p[0] - 7.1, p[1] - 6.2, p[2] - 7.3) < 4.3;
             } });
  const ImageDomain<4> domain(image, 1.0);
  std::mt19937 random(2);
  for (int q = 0; q < 1000; ++q)
  {
    Point<4> p = RandomPoint(domain.Bounds(), 5.0, random);
    const double margin = domain.GetLabelField().Margin(p, 1);
    p[3] = 4.5;
    ASSERT_NEAR(domain.GetLabelField().Margin(p, 1), margin, 2e-3);
  }
}

TEST(SpaceTimeImage, EveryVoxelKeepsItsLabel)
{
  for (const Cut& cut : Borders)
  {
    const LabelImage<4> image = MovingBalls(Grid(true), cut.First, cut.Last);
    const ImageDomain<4> domain(image, 1.0);
    for (std::size_t i = 0; i < image.Ids().size(); ++i)
    {
      ASSERT_EQ(domain.Label(image.CentreOf(IndexAt(i, image.CropDimensions()))), image.Ids()[i]);
    }
  }
}

// Interfaces are those at times between the ends: beyond them there is nothing to mesh.
TEST(SpaceTimeImage, DistanceBoundHoldsNearAndBeyondEnds)
{
  std::mt19937 random(3);
  for (const bool tilted : { false, true })
  {
    for (const Cut& cut : Borders)
    {
      const LabelImage<4> image = MovingBalls(Grid(tilted), cut.First, cut.Last);
      const ImageDomain<4> domain(image, 1.0);
      std::vector<Point<4>> samples;
      for (int k = 0; k <= 40; ++k)
      {
        const double frame =
          static_cast<double>(cut.First) + static_cast<double>(cut.Last - cut.First) * k / 40.0;
        const auto more = InterfaceAt(domain, 1.5 * frame, 100, random);
        samples.insert(samples.end(), more.begin(), more.end());
      }
      for (int q = 0; q < 400; ++q)
      {
        const Point<4> p = RandomPoint(domain.Bounds(), q % 4 == 0 ? 30.0 : 3.0, random);
        const double nearest = NearestSample(samples, p);
        ASSERT_LE(domain.DistanceBound(p), nearest + 1e-5);
      }
    }
  }
}

TEST(SpaceTimeImage, InterfacePointsAreNeverBeyondAnEnd)
{
  std::mt19937 random(4);
  for (const bool tilted : { false, true })
  {
    for (const Cut& cut : Borders)
    {
      const LabelImage<4> image = MovingBalls(Grid(tilted), cut.First, cut.Last);
      const ImageDomain<4> domain(image, 1.0);
      int crossings = 0;
      int checked = 0;
      for (int q = 0; q < 400; ++q)
      {
        const Point<4> p = RandomPoint(domain.Bounds(), 12.0, random);
        const LabelId label = domain.Label(p);
        Point<4> z;
        const auto expectInside = [&]
        {
          EXPECT_TRUE(OnEnds(z, domain) == z) << "beyond a flat end";
          if (++checked % 8 == 0)
          {
            EXPECT_TRUE(IsOnInterface(domain, z, true));
          }
        };
        ASSERT_TRUE(domain.ClosestSurfacePoint(p, label, z));
        expectInside();
        double error;
        ASSERT_TRUE(domain.NearSurfacePoint(p, label, z, error));
        EXPECT_TRUE(OnEnds(z, domain) == z);
        const Point<4> b = RandomPoint(domain.Bounds(), 12.0, random);
        if (domain.FirstCrossing(p, label, b, z))
        {
          ++crossings;
          expectInside();
          // It is the projection of a point of the segment, and the segment has the label up to there.
          double t = 0.0;
          for (std::size_t a = 0; a < 3; ++a)
          {
            t += (z[a] - p[a]) * (b[a] - p[a]);
          }
          double length2 = 0.0;
          for (std::size_t a = 0; a < 3; ++a)
          {
            length2 += (b[a] - p[a]) * (b[a] - p[a]);
          }
          EXPECT_LT(Distance(OnEnds(Interpolate(p, b, t / length2), domain), z), 0.05);
        }
      }
      EXPECT_GT(crossings, 40);
    }
  }
}

TEST(SpaceTimeImage, ClosestPointsOnAnEnd)
{
  std::mt19937 random(5);
  for (const bool tilted : { false, true })
  {
    for (const Cut& cut : Borders)
    {
      const LabelImage<4> image = MovingBalls(Grid(tilted, 0.7), cut.First, cut.Last);
      const ImageDomain<4> domain(image, 1.0);
      for (const unsigned end : { 0u, 1u })
      {
        if (!domain.HasTimeBorder(end))
        {
          continue;
        }
        const double time = end == 0 ? domain.Bounds().Min[3] : domain.Bounds().Max[3];
        const std::vector<Point<4>> samples = InterfaceAt(domain, time, 3000, random);
        int found = 0;
        int asked = 0;
        double excess = 0.0;
        while (asked < 150)
        {
          Point<4> p = RandomPoint(domain.Bounds(), 0.0, random);
          p[3] = time;
          const double nearest = NearestSample(samples, p);
          if (nearest > 1.0)
          {
            continue;
          }
          ++asked;
          Point<4> z;
          if (domain.ClosestSurfacePointOnEnd(p, z))
          {
            ++found;
            ASSERT_EQ(z[3], time);
            ASSERT_TRUE(IsOnInterface(domain, z, false));
            ASSERT_LT(Distance(p, z), 4.0) << "three voxels along the gradient, at most";
            excess += std::max(0.0, Distance(p, z) - nearest);
          }
        }
        EXPECT_GT(found, asked * 7 / 8);
        EXPECT_LT(excess / found, 0.15);
      }
    }
  }
}
