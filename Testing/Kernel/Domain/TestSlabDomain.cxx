// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The part of a space-time domain between two times.
#include "Domain/SlabDomain.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();

class SlabDomainTest : public ::testing::Test
{
protected:
  const LabelImage<4> Image = ImageOf(phantoms::MergingBalls());
  const ImageDomain<4> Whole{ Image, 1.0 };
  std::mt19937 Random{ 7 };

  Point<4> RandomPoint()
  {
    const Box<4> box = this->Whole.Bounds();
    Point<4> p;
    for (std::size_t a = 0; a < 4; ++a)
    {
      p[a] =
        std::uniform_real_distribution<double>(box.Min[a] - 3.0, box.Max[a] + 3.0)(this->Random);
    }
    return p;
  }
};

} // namespace

TEST_F(SlabDomainTest, BoundsAndEnds)
{
  const SlabDomain slab(this->Whole, 5.0, 9.5);
  EXPECT_EQ(slab.Bounds().Min[3], 5.0);
  EXPECT_EQ(slab.Bounds().Max[3], 9.5);
  EXPECT_EQ(slab.Bounds().Min[0], this->Whole.Bounds().Min[0]);
  EXPECT_TRUE(slab.HasTimeBorder(0) && slab.HasTimeBorder(1));
  const SlabDomain all(this->Whole, -Infinity, Infinity);
  EXPECT_EQ(all.Bounds().Max[3], this->Whole.Bounds().Max[3]);
  EXPECT_EQ(all.HasTimeBorder(1), this->Whole.HasTimeBorder(1));
  const LabelImage<4> ball = ImageOf(phantoms::FourBall(6.0));
  const ImageDomain<4> inside(ball, 1.0);
  EXPECT_FALSE(SlabDomain(inside, -Infinity, 8.0).HasTimeBorder(0));
  EXPECT_TRUE(SlabDomain(inside, -Infinity, 8.0).HasTimeBorder(1));
}

// Interface points of a slab lie in it, have different labels around them, and are exactly on planes if they
// are beyond them.
TEST_F(SlabDomainTest, InterfacePointsLieInTheSlab)
{
  const double first = 5.3;
  const double last = 8.0;
  const SlabDomain slab(this->Whole, first, last);
  std::size_t closest = 0;
  std::size_t asked = 0;
  std::size_t crossings = 0;
  std::size_t onPlane = 0;
  for (int k = 0; k < 20000; ++k)
  {
    const Point<4> a = this->RandomPoint();
    const Point<4> b = this->RandomPoint();
    Point<4> at = a;
    at[3] = std::clamp(a[3], first, last);
    const LabelId label = slab.Label(a);
    EXPECT_EQ(label, this->Whole.Label(at));
    Point<4> z;
    if (slab.FirstCrossing(a, label, b, z))
    {
      ++crossings;
      ASSERT_GE(z[3], first);
      ASSERT_LE(z[3], last);
      onPlane += z[3] == first || z[3] == last ? 1 : 0;
      ASSERT_LE(this->Whole.DistanceBound(z), 0.05);
    }
    if (slab.DistanceBound(a) < 1.5)
    {
      ++asked;
      if (slab.ClosestSurfacePoint(a, label, z))
      {
        ++closest;
        ASSERT_GE(z[3], first);
        ASSERT_LE(z[3], last);
        ASSERT_LE(this->Whole.DistanceBound(z), 0.05);
      }
    }
  }
  EXPECT_GT(asked, 500u);
  EXPECT_GT(
    closest, asked * 7 / 10); // seen: 78 %; the others have no interface near them in the slab
  EXPECT_GT(crossings, 1000u);
  EXPECT_GT(onPlane, 100u);
}

TEST_F(SlabDomainTest, SegmentsBeyondBothPlanesAreProjected)
{
  const SlabDomain slab(this->Whole, 7.9, 8.1); // the balls touch
  // From background before the slab to label 2 after it; the crossing is at constant time or within.
  const Point<4> a = { 45.0, 13.5, 13.5, -20.0 };
  const Point<4> b = { 29.5, 13.5, 13.5, 40.0 };
  Point<4> z;
  ASSERT_EQ(slab.Label(a), 0);
  ASSERT_NE(slab.Label(b), 0);
  ASSERT_TRUE(slab.FirstCrossing(a, 0, b, z));
  EXPECT_GE(z[3], 7.9);
  EXPECT_LE(z[3], 8.1);
  EXPECT_GT(z[0], 29.5);
  EXPECT_LT(z[0], 45.0);
}

// Circumcentres of flat simplices may be anywhere.
TEST_F(SlabDomainTest, FarPointsAreAnswered)
{
  const SlabDomain slab(this->Whole, 5.3, 8.0);
  for (const double far : { 1e3, 1e9, 1e17, 1e30 })
  {
    for (int k = 0; k < 200; ++k)
    {
      Point<4> p = this->RandomPoint();
      Point<4> q = this->RandomPoint();
      for (std::size_t a = 0; a < 4; ++a)
      {
        p[a] = far * (p[a] - 14.0);
      }
      Point<4> z;
      if (slab.ClosestSurfacePoint(p, slab.Label(p), z))
      {
        ASSERT_LE(this->Whole.DistanceBound(z), 0.05);
      }
      if (slab.FirstCrossing(p, slab.Label(p), q, z) || slab.FirstCrossing(q, slab.Label(q), p, z))
      {
        ASSERT_TRUE(z[3] >= 5.3 && z[3] <= 8.0);
      }
    }
  }
}
