// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The lengths of a sizing field, from one source at a time and from all of them.
#include "BallDomain.h"
#include "Base/GridIndex.h"
#include "CallableSize.h"
#include "Domain/ImageDomain.h"
#include "Phantoms.h"
#include "Sizing/SizingField.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <vector>

using namespace voxplex;

namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t Any = InterfaceSize::AnyLabel;

/** Delta, the same everywhere. */
template <int D = 3>
BaseDistance<D> Uniform(double delta)
{
  BaseDistance<D> base;
  base.Delta = delta;
  base.Equivalent = delta;
  base.Asked = delta;
  return base;
}

/** Balls of label 3 (id 1) within 7 (id 2) within 200 (id 3), about a centre. */
class SizingFieldOnBalls : public testing::Test
{
protected:
  static constexpr double Middle = 15.5;
  static constexpr Point<3> Centre{ Middle, Middle, Middle };
  /** Centres of voxel faces, on the interfaces along the first axis. */
  static constexpr Point<3> Between1And2{ Middle + 4.0, 15.0, 15.0 };
  static constexpr Point<3> Between2And3{ Middle + 8.0, 15.0, 15.0 };
  static constexpr Point<3> AtBackground{ Middle + 12.0, 15.0, 15.0 };
  static constexpr Point<3> Corner{ 0.0, 0.0, 0.0 };

  /** Lowers the bound about a point of the frame. */
  void Bound(const Point<3>& p, LabelId label, double delta)
  {
    LocalDelta<3>::Index voxel;
    for (std::size_t a = 0; a < 3; ++a)
    {
      voxel[a] = std::llround(p[a]) - this->Image.CropOrigin()[a];
    }
    this->Local.SetBound(voxel, 1, label, delta);
    this->Local.Grade();
  }

  SizingField<3> Field() const { return { this->Domain, this->Sources }; }

  const LabelImage<3> Image = phantoms::NestedBalls(12.0);
  const ImageDomain<3> Domain{ Image, 1.0 };
  LocalDelta<3> Local{ Image };
  SizingSources<3> Sources{ .Base = Uniform(2.0) };
};

template <int D>
void ExpectUniform()
{
  const checks::BallDomainOf<D> ball(10.0);
  const SizingField<D> field(ball, { .Base = Uniform<D>(2.0) });
  Point<D> p{};
  for (p[0] = -20.0; p[0] <= 20.0; p[0] += 2.5)
  {
    EXPECT_EQ(field.BaseAt(p), 2.0);
    EXPECT_EQ(field.AskedDistance(p, 1, 0), 2.0);
    EXPECT_EQ(field.SamplingDistance(p, 1, 0), 2.0);
    EXPECT_EQ(field.SamplingDistance(p, 1, 1), 2.0);
    EXPECT_EQ(field.SamplingDistanceBehind(Point<D>{}, 1, p), 2.0);
    EXPECT_EQ(field.AskedNear(p), 2.0);
    EXPECT_EQ(field.Spacing(p), 2.0);
    EXPECT_EQ(field.Spacing(p, 1), 2.0);
    EXPECT_EQ(field.ElementSize(p, 1), Infinity);
    EXPECT_FALSE(field.DependsOnLabels(p));
  }
  EXPECT_TRUE(field.IsUniform());
  EXPECT_EQ(field.Largest(), 2.0);
  EXPECT_EQ(field.LargestOf(1), 2.0);
  EXPECT_EQ(field.Equivalent(), 2.0);
  EXPECT_EQ(field.SizeFloor(), 0.2);
  EXPECT_EQ(field.SpacingFloor(), 0.2);
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(SizingField, IsDeltaWithoutOtherSources)
{
  ExpectUniform<3>();
  ExpectUniform<4>();
}

TEST(SizingField, FollowsAGradedDelta)
{
  const checks::BallDomain ball(10.0);
  GradedDelta<3> graded(ball.Bounds(), 1.0);
  graded.Lower({ -10.0, 0.0, 0.0 }, 0.5);
  graded.Grade(0.25, 1, {});
  graded.Cap(4.0);
  BaseDistance<3> base = Uniform(4.0);
  base.Graded = &graded;
  base.Equivalent = 2.5;
  const SizingField<3> field(ball, { .Base = base });
  EXPECT_FALSE(field.IsUniform());
  for (double x = -10.0; x <= 10.0; x += 0.7)
  {
    const Point<3> p{ x, 0.0, 0.0 };
    EXPECT_EQ(field.SamplingDistance(p, 1, 0), graded.At(p));
    EXPECT_EQ(field.Spacing(p), graded.At(p));
  }
  EXPECT_EQ(field.Spacing({ -10.0, 0.0, 0.0 }), 0.5);
  EXPECT_EQ(field.Spacing({ 10.0, 0.0, 0.0 }), 4.0);
  EXPECT_EQ(field.Largest(), 4.0);
  EXPECT_EQ(field.LargestOf(1), 4.0);
  EXPECT_EQ(field.Equivalent(), 2.5);
  EXPECT_EQ(field.SizeFloor(), 0.05);
  EXPECT_EQ(field.SpacingFloor(), 0.05);
  EXPECT_EQ(SizingField<3>(ball, { .Base = base, .SizeFloor = 1.0 }).SpacingFloor(), 0.05);
}

//------------------------------------------------------------------------------------------------
// If delta kept points apart, interfaces with smaller sizes would lose theirs.
TEST_F(SizingFieldOnBalls, SpacingIsThatOfInterfacesIfAllAreBelowDelta)
{
  const InterfaceSizes<3> same(this->Image, { { 3, Any, 0.5 }, { 7, Any, 0.5 }, { 200, Any, 0.5 } },
    this->Sources.Base, 0.3, 1);
  this->Sources.Interfaces = &same;
  for (const Point<3>& p : { Centre, Between1And2, Between2And3, AtBackground, Corner })
  {
    EXPECT_EQ(this->Field().Spacing(p), 0.5);
    EXPECT_EQ(this->Field().AskedNear(p), 0.5);
  }
  const InterfaceSizes<3> different(
    this->Image, { { 3, Any, 0.5 }, { 7, 200, 1.0 }, { 200, 0, 1.5 } }, this->Sources.Base, 0.1, 1);
  this->Sources.Interfaces = &different;
  const SizingField<3> field = this->Field();
  EXPECT_EQ(field.Spacing(Between1And2), 0.5);
  EXPECT_NEAR(field.Spacing(Between2And3), 0.9, 0.05); // the gradation allows no more
  EXPECT_NEAR(field.Spacing(AtBackground), 1.3, 0.05);
  EXPECT_EQ(field.Spacing(Corner), 1.5);
  // Delta bounds all distances although no interface has it; a label's bound is exact.
  EXPECT_EQ(field.Largest(), 2.0);
  EXPECT_EQ(field.LargestOf(1), 0.5);
  EXPECT_EQ(field.LargestOf(2), 1.0);
  EXPECT_EQ(field.LargestOf(3), 1.5);
  EXPECT_EQ(field.Equivalent(), different.Equivalent());
}

TEST_F(SizingFieldOnBalls, InterfacesMayBeCoarserThanDelta)
{
  const InterfaceSizes<3> sizes(this->Image, { { 200, 0, 5.0 } }, this->Sources.Base, 0.0, 1);
  this->Sources.Interfaces = &sizes;
  const SizingField<3> field = this->Field();
  EXPECT_FALSE(field.IsUniform());
  EXPECT_TRUE(field.DependsOnLabels(Centre));
  EXPECT_EQ(field.Largest(), 5.0);
  EXPECT_EQ(field.LargestOf(3), 5.0);
  EXPECT_EQ(field.LargestOf(2), 2.0);
  EXPECT_EQ(field.AskedDistance(AtBackground, 3, 0), 5.0);
  EXPECT_EQ(field.SamplingDistance(AtBackground, 3, 0), 5.0);
  EXPECT_EQ(field.SamplingDistance(Between1And2, 1, 2), 2.0);
  EXPECT_EQ(field.Spacing(Between1And2), 2.0);
  EXPECT_EQ(field.Spacing(Corner), 5.0);
  EXPECT_EQ(field.SpacingFloor(), 0.2);
}

TEST_F(SizingFieldOnBalls, ALabelWithoutVoxelsHasDelta)
{
  LabelImage<3> image = this->Image;
  ForEachIndex<3>({}, { 23, 23, 23 },
    [&](const auto& voxel)
    {
      if (image.Ids()[OffsetOf(voxel, image.CropDimensions())] == 1)
      {
        image.Relabel(voxel, 1, 2);
      }
    });
  ASSERT_EQ(image.Counts()[1], 0);
  const InterfaceSizes<3> sizes(
    image, { { 3, Any, 0.5 }, { 200, 7, 0.5 }, { 200, 0, 1.0 } }, this->Sources.Base, 0.3, 1);
  this->Sources.Interfaces = &sizes;
  EXPECT_EQ(this->Field().LargestOf(1), 2.0);
  EXPECT_EQ(this->Field().LargestOf(2), 0.5);
}

//------------------------------------------------------------------------------------------------
TEST_F(SizingFieldOnBalls, LocalBoundsCountForTheirLabelOnly)
{
  this->Sources.Local = &this->Local;
  this->Bound(Between2And3, 2, 0.5);
  const SizingField<3> field = this->Field();
  EXPECT_EQ(field.SamplingDistance(Between2And3, 2, 3), 0.5);
  EXPECT_EQ(field.SamplingDistance(Between2And3, 1, 2), 0.5);
  EXPECT_EQ(field.SamplingDistance(Between2And3, 1, 3), 2.0);
  EXPECT_EQ(field.SamplingDistance(Between2And3, 3, 0), 2.0);
  EXPECT_EQ(field.AskedDistance(Between2And3, 2, 3), 2.0);
  EXPECT_EQ(field.AskedNear(Between2And3), 2.0);
  EXPECT_TRUE(field.DependsOnLabels(Between2And3));
  // Vertices of that label are spared by the rules for any label.
  EXPECT_EQ(field.Spacing(Between2And3), 0.5);
  EXPECT_EQ(field.SamplingDistance(Between2And3, 3, 3), 0.5);
  // Elsewhere no bound holds; the spacing grows to delta.
  EXPECT_EQ(field.SamplingDistance(AtBackground, 2, 3), 2.0);
  EXPECT_FALSE(field.DependsOnLabels(AtBackground));
  EXPECT_GT(field.Spacing(Centre), 0.5);
  EXPECT_LT(field.Spacing(Centre), 2.0);
  EXPECT_EQ(field.Spacing(Corner), 2.0);
}

TEST_F(SizingFieldOnBalls, LocalBoundsRaiseNothing)
{
  this->Sources.Local = &this->Local;
  this->Bound(Between2And3, 2, 9.0);
  const SizingField<3> field = this->Field();
  EXPECT_EQ(field.SamplingDistance(Between2And3, 2, 3), 2.0);
  EXPECT_EQ(field.Spacing(Between2And3), 2.0);
  EXPECT_FALSE(field.DependsOnLabels(Between2And3));
  EXPECT_EQ(field.SpacingFloor(), 0.2);
}

//------------------------------------------------------------------------------------------------
TEST_F(SizingFieldOnBalls, SizesOfElementsLowerTheSamplingDistanceOfTheirLabels)
{
  std::set<std::int64_t> asked;
  const CallableSize size(
    [&](const Point<3>& p, std::int64_t label)
    {
      asked.insert(label);
      return label == 200 ? 1.25 : label == 7 ? p[0] : 50.0;
    });
  this->Sources.Size = &size;
  const SizingField<3> field = this->Field();
  EXPECT_EQ(field.ElementSize({ 1.5, 0.0, 0.0 }, 2), 1.5);
  EXPECT_EQ(field.ElementSize(Centre, 3), 1.25);
  EXPECT_TRUE(field.DependsOnLabels(Centre));
  EXPECT_EQ(field.SamplingDistance(Between2And3, 2, 3), 1.25);
  EXPECT_EQ(field.SamplingDistance(Between2And3, 3, 2), 1.25);
  EXPECT_EQ(field.SamplingDistance(Between2And3, 3, 3), 1.25);
  EXPECT_EQ(field.SamplingDistance(AtBackground, 3, 0), 1.25);
  EXPECT_EQ(field.SamplingDistance(AtBackground, 0, 3), 1.25);
  EXPECT_EQ(field.SamplingDistance(Between1And2, 1, 2), 2.0); // sizes above delta
  EXPECT_EQ(field.AskedDistance(Between2And3, 2, 3), 2.0);
  EXPECT_EQ(field.Spacing(Between2And3, 3), 1.25);
  EXPECT_EQ(field.Spacing(Between2And3, 2), 2.0);
  EXPECT_EQ(field.Spacing(Between2And3, 0), 2.0);
  EXPECT_EQ(field.Spacing(Between2And3), 2.0);
  EXPECT_EQ(asked, (std::set<std::int64_t>{ 3, 7, 200 })); // never background
}

TEST_F(SizingFieldOnBalls, ElementSizesHaveAFloor)
{
  double value = 0.0;
  const CallableSize size([&](const Point<3>&, std::int64_t) { return value; });
  this->Sources.Size = &size;
  const SizingField<3> usual = this->Field();
  EXPECT_EQ(usual.SizeFloor(), 0.2);
  this->Sources.SizeFloor = 0.7;
  const SizingField<3> given = this->Field();
  EXPECT_EQ(given.SizeFloor(), 0.7);
  EXPECT_EQ(given.SpacingFloor(), 0.2);
  for (const double small : { 1e-300, 0.01, 0.2 })
  {
    value = small;
    EXPECT_EQ(usual.ElementSize(Centre, 1), 0.2) << small;
    EXPECT_EQ(given.ElementSize(Centre, 1), 0.7) << small;
    EXPECT_EQ(usual.SamplingDistance(Between1And2, 1, 2), 0.2) << small;
  }
  for (const double none : { 0.0, -1.0, std::nan(""), Infinity })
  {
    value = none;
    EXPECT_EQ(usual.ElementSize(Centre, 1), Infinity) << none;
    EXPECT_EQ(usual.SamplingDistance(Between1And2, 1, 2), 2.0) << none;
  }
}

//------------------------------------------------------------------------------------------------
TEST_F(SizingFieldOnBalls, TheSpacingFloorFollowsTheSmallestDistance)
{
  const InterfaceSizes<3> sizes(this->Image, { { 3, 7, 0.5 } }, this->Sources.Base, 0.3, 1);
  this->Sources.Interfaces = &sizes;
  this->Sources.Local = &this->Local;
  const SizingField<3> field = this->Field();
  EXPECT_EQ(field.SpacingFloor(), 0.05);
  EXPECT_EQ(field.SizeFloor(), 0.2); // of delta
  this->Bound(AtBackground, 3, 0.125);
  EXPECT_EQ(field.SpacingFloor(), 0.0125);
  EXPECT_EQ(field.SizeFloor(), 0.2);
  this->Sources.SizeFloor = 0.01; // elements may be smaller
  EXPECT_EQ(this->Field().SpacingFloor(), 0.01);
}

//------------------------------------------------------------------------------------------------
TEST_F(SizingFieldOnBalls, TheOtherLabelIsFoundBehindTheInterface)
{
  const InterfaceSizes<3> sizes(
    this->Image, { { 3, 7, 0.5 }, { 7, 200, 1.0 }, { 200, 0, 1.5 } }, this->Sources.Base, 0.0, 1);
  this->Sources.Interfaces = &sizes;
  const SizingField<3> field = this->Field();
  const auto behind = [&](double from, double towards)
  {
    const Point<3> p{ Middle + from, Middle, Middle };
    const LabelId label = this->Domain.Label(p);
    Point<3> z;
    EXPECT_TRUE(this->Domain.FirstCrossing(p, label, { Middle + towards, Middle, Middle }, z));
    return field.SamplingDistanceBehind(p, label, z);
  };
  EXPECT_EQ(behind(6.0, 3.0), 0.5);
  EXPECT_EQ(behind(6.0, 9.0), 1.0);
  EXPECT_EQ(behind(2.0, 6.0), 0.5);
  EXPECT_EQ(behind(10.0, 6.0), 1.0);
  EXPECT_EQ(behind(10.0, 13.0), 1.5);
  EXPECT_EQ(behind(13.0, 10.0), 1.5);
  // There is nothing behind a point of no distance: the spacing.
  EXPECT_EQ(field.SamplingDistanceBehind(Centre, 1, Centre), field.Spacing(Centre, 1));
}

//------------------------------------------------------------------------------------------------
// With all sources: each of them only lowers what was before.
TEST_F(SizingFieldOnBalls, NoDistanceIsAboveWhatIsAskedFor)
{
  const InterfaceSizes<3> sizes(
    this->Image, { { 3, 7, 0.5 }, { 200, 0, 3.0 } }, this->Sources.Base, 0.2, 1);
  const CallableSize size(
    [](const Point<3>& p, std::int64_t label) {
      return label == 7 ? 0.1 * p[0] : label == 200 ? 0.7 : 0.0;
    });
  this->Bound(AtBackground, 3, 0.3);
  this->Bound(Between1And2, 1, 0.2);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-3.0, 35.0);
  for (unsigned with = 0; with < 8; ++with)
  {
    this->Sources.Interfaces = (with & 1u) != 0 ? &sizes : nullptr;
    this->Sources.Local = (with & 2u) != 0 ? &this->Local : nullptr;
    this->Sources.Size = (with & 4u) != 0 ? &size : nullptr;
    const SizingField<3> field = this->Field();
    for (int i = 0; i < 2000; ++i)
    {
      const Point<3> p{ anywhere(random), anywhere(random), anywhere(random) };
      const auto a = static_cast<LabelId>(random() % 4);
      const auto b = static_cast<LabelId>(random() % 4);
      const double distance = field.SamplingDistance(p, a, b);
      ASSERT_EQ(distance, field.SamplingDistance(p, b, a)) << with;
      ASSERT_LE(distance, field.Largest()) << with;
      ASSERT_GE(distance, field.SpacingFloor()) << with;
      if (a != b)
      {
        ASSERT_LE(distance, field.AskedDistance(p, a, b)) << with;
      }
      if (!this->Sources.Interfaces)
      {
        ASSERT_LE(distance, 2.0) << with;
      }
      ASSERT_LE(field.Spacing(p, a), field.Spacing(p)) << with;
      ASSERT_LE(field.Spacing(p), field.AskedNear(p)) << with;
    }
  }
}
