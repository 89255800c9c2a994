// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Samples, poles and local feature sizes of known shapes in space-time.
#include "../../Phantoms/SpaceTimePhantoms.h"
#include "Base/Error.h"
#include "Domain/ImageDomain.h"
#include "FeatureSizeTesting.h"
#include "Sanitizers.h"
#include "Sizing/Grading/InterfaceSamples.h"
#include "Sizing/Grading/LocalFeatureSize.h"
#include "Sizing/Grading/MedialAxis.h"
#include "Sizing/Grading/SampleTriangulation.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

using namespace voxplex;
using checks::Measure;
using checks::Parameters;
using checks::Quantile;
using checks::SizesWhere;

namespace
{

template <typename Label>
LabelImage<4> Image(
  const GridGeometry<4>::Index& dimensions, const Point<4>& spacing, Label&& label)
{
  const phantoms::SpaceTimePhantom phantom{ GridGeometry<4>::Orthogonal(dimensions, spacing),
    std::forward<Label>(label) };
  return LabelImage<4>::FromScalars<std::uint8_t>(phantom.Scalars(), phantom.Grid);
}

/** A ball of radius 10 that rests; its first and last frame are flat ends. */
LabelImage<4> RestingBall(double timeStep = 1.0)
{
  return Image({ 26, 26, 26, 13 }, { 1.0, 1.0, 1.0, timeStep },
    [](const Point<4>& p) -> std::uint8_t
    { return std::hypot(p[0] - 12.5, p[1] - 12.5, p[2] - 12.5) < 10.0; });
}

} // namespace

// Flat ends are as flat with every sampling distance, and have no points.
TEST(SpaceTimeSamples, LieOnLateralInterfacesOnly)
{
  const LabelImage<4> image = RestingBall();
  const ImageDomain<4> domain(image, 1.0);
  for (const double spacing : { 1.0, 2.0 })
  {
    const std::vector<Point<4>> sample =
      SampleLabelChanges<4>(image, domain, spacing, 1, {}).Points;
    std::set<int> frames;
    for (const Point<4>& p : sample)
    {
      ASSERT_NEAR(std::hypot(p[0] - 12.5, p[1] - 12.5, p[2] - 12.5), 10.0, 0.7);
      frames.insert(static_cast<int>(std::lround(p[3])));
    }
    EXPECT_EQ(frames.size(), spacing < 2.0 ? 13u : 7u);
    const double area = 4.0 * 3.14159265 * 100.0 * 13.0;
    const double cell = spacing * spacing * spacing;
    EXPECT_LT(static_cast<double>(sample.size()), 4.0 * area / cell);
    EXPECT_GT(static_cast<double>(sample.size()), 0.5 * area / cell);
    EXPECT_EQ(sample, SampleLabelChanges<4>(image, domain, spacing, 3, {}).Points);
  }
}

// What appears and vanishes between the ends has interfaces across time, too.
TEST(SpaceTimeSamples, AreOnInterfacesAcrossTime)
{
  const LabelImage<4> image = Image({ 10, 10, 10, 12 }, { 1.0, 1.0, 1.0, 2.0 },
    [](const Point<4>& p) -> std::uint8_t { return p[3] > 5.0 && p[3] < 15.0 && p[0] > 2.5; });
  const ImageDomain<4> domain(image, 1.0);
  const std::vector<Point<4>> sample = SampleLabelChanges<4>(image, domain, 2.0, 1, {}).Points;
  EXPECT_GT(std::count_if(sample.begin(), sample.end(),
              [](const Point<4>& p) { return std::abs(p[3] - 5.0) < 0.5 && p[0] > 4.0; }),
    20);
}

TEST(SpaceTimeSamples, AreTriangulatedTheSameByAnyThreads)
{
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> x(0.0, 10.0);
  std::vector<Point<4>> points;
  for (int k = 0; k < 6000; ++k)
  {
    points.push_back({ x(random), x(random), x(random), k % 2 == 0 ? 5.0 : x(random) });
  }
  checks::SimplexSet<4> expected;
  for (const unsigned threads : { 1u, 3u })
  {
    const SampleTriangulation<4> triangulation(points, 1.0, threads, {});
    const Triangulation<4>& mesh = triangulation.Mesh();
    checks::ExpectSound(mesh);
    const checks::SimplexSet<4> simplices = checks::Simplices(mesh);
    expected = threads == 1 ? simplices : expected;
    EXPECT_EQ(simplices, expected);
  }
}

// The medial axis of a ball that rests is a segment along time, and so is that of steps of another length.
TEST(SpaceTimeFeatureSize, OfARestingBallIsItsRadius)
{
  for (const double step : { 1.0, 3.0 })
  {
    const LocalFeatureSize<4> lfs = Measure(RestingBall(step), Parameters(2.0, 100.0));
    EXPECT_GT(lfs.NumberOfPoles(), 10u);
    EXPECT_NEAR(Quantile(lfs.Sizes(), 0.5), 9.3, 0.9) << step;
    EXPECT_GT(Quantile(lfs.Sizes(), 0.05), 7.5) << step;
  }
}

TEST(SpaceTimeFeatureSize, OfABallOfSpaceTimeIsItsRadius)
{
  const phantoms::SpaceTimePhantom phantom = phantoms::FourBall(9.0);
  const LabelImage<4> image =
    LabelImage<4>::FromScalars<std::uint8_t>(phantom.Scalars(), phantom.Grid);
  const LocalFeatureSize<4> lfs = Measure(image, Parameters(2.0, 100.0));
  EXPECT_NEAR(Quantile(lfs.Sizes(), 0.5), 8.5, 0.8);
  EXPECT_GT(Quantile(lfs.Sizes(), 0.05), 6.5);
}

// A sheet 6 thick in space that moves by one voxel a frame is 6 / sqrt(2) thick in space-time.
TEST(SpaceTimeFeatureSize, OfAMovingSheetIsHalfItsThicknessInSpaceTime)
{
  for (const double speed : { 0.0, 1.0 })
  {
    const LabelImage<4> image = Image({ 36, 16, 16, 16 }, { 1.0, 1.0, 1.0, 1.0 },
      [&](const Point<4>& p) -> std::uint8_t
      {
        return std::abs(p[0] - 10.3 - speed * p[3]) < 3.0 && p[1] > 1.5 && p[1] < 13.5 &&
          p[2] > 1.5 && p[2] < 13.5;
      });
    const LocalFeatureSize<4> lfs = Measure(image, Parameters(2.0, 12.0));
    const std::vector<double> sizes = SizesWhere(lfs,
      [](const Point<4>& p) {
        return p[1] > 5.0 && p[1] < 10.0 && p[2] > 5.0 && p[2] < 10.0 && p[3] > 4.0 && p[3] < 11.0;
      });
    ASSERT_GT(sizes.size(), 20u);
    EXPECT_NEAR(Quantile(sizes, 0.5), 3.0 / std::sqrt(1.0 + speed * speed), 0.5) << speed;
  }
}

TEST(SpaceTimeFeatureSize, IsTheDistanceToTheNearestPole)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const phantoms::SpaceTimePhantom phantom = phantoms::OpeningTube();
  const LabelImage<4> image =
    LabelImage<4>::FromScalars<std::uint8_t>(phantom.Scalars(), phantom.Grid);
  const GradingParameters parameters = Parameters(3.0, 8.0);
  const LocalFeatureSize<4> lfs = Measure(image, parameters);
  MedialBalls balls;
  balls.LargestRadius = parameters.Lambda;
  balls.Salience = parameters.Salience;
  const std::vector<Point<4>> poles = FindPoles<4>(lfs.Sample(), balls, 1, {});
  EXPECT_EQ(poles.size(), lfs.NumberOfPoles());
  std::size_t below = 0;
  for (std::size_t k = 0; k < lfs.Sample().size(); k += 17)
  {
    double nearest = parameters.Lambda;
    for (const Point<4>& pole : poles)
    {
      nearest = std::min(nearest, Distance(pole, lfs.Sample()[k]));
    }
    below += nearest < parameters.Lambda ? 1 : 0;
    ASSERT_NEAR(lfs.Sizes()[k], nearest, 1.5) << "a quarter of the cell's diagonal";
  }
  EXPECT_GT(below, 50u);
}

// Delta of a ball of radius R is sqrt(1.2 R Tolerance), and grows by 0.3 at most from place to place.
TEST(SpaceTimeFeatureSize, DeltaIsBoundedByTheBend)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  GradingParameters parameters = Parameters(2.0, 100.0);
  parameters.Ratio = 2.0;
  EXPECT_GT(Measure(RestingBall(), parameters).Largest(), 15.0);
  parameters.Tolerance = 1.5;
  const LocalFeatureSize<4> lfs = Measure(RestingBall(), parameters);
  const double expected = std::sqrt(1.2 * 10.0 * 1.5);
  EXPECT_NEAR(lfs.Largest(), expected, 0.2 * expected);
  EXPECT_NEAR(lfs.Equivalent(), expected, 0.2 * expected);
  const std::vector<Point<4>>& sample = lfs.Sample();
  for (std::size_t k = 0; k < sample.size(); ++k)
  {
    const double delta = lfs.Delta().At(sample[k]);
    ASSERT_GE(delta, 2.0);
    ASSERT_LE(delta, 2.0 * lfs.Sizes()[k] + 1e-5);
    const Point<4>& other = sample[(k * 7919 + 13) % sample.size()];
    double along = 4 * 2.0; // a point may be a cell's diagonal from where its value holds
    for (std::size_t a = 0; a < 4; ++a)
    {
      along += std::abs(sample[k][a] - other[a]);
    }
    ASSERT_LE(std::abs(delta - lfs.Delta().At(other)), 0.3 * along + 1e-5);
  }
}

TEST(SpaceTimeFeatureSize, IsTheSameForAnyNumberOfThreads)
{
  const phantoms::SpaceTimePhantom phantom = phantoms::MergingBalls(9);
  const LabelImage<4> image =
    LabelImage<4>::FromScalars<std::uint8_t>(phantom.Scalars(), phantom.Grid);
  GradingParameters parameters = Parameters(2.0, 8.0);
  parameters.Tolerance = 0.6;
  checks::ExpectSameSizes(image, parameters, 101);
}

TEST(SpaceTimeFeatureSize, OfFewSamplesIsWhatIsAskedFor)
{
  for (const int extent : { 1, 2, 3 })
  {
    const LabelImage<4> image = Image({ 4, 4, 4, 4 }, { 1.0, 1.0, 1.0, 1.0 },
      [&](const Point<4>& p) -> std::uint8_t
      { return p[0] < extent && p[1] < extent && p[2] < extent; });
    for (const double finest : { 0.3, 3.0, 1000.0 })
    {
      const LocalFeatureSize<4> lfs = Measure(image, Parameters(finest, 12.0));
      for (const Point<4>& p : lfs.Sample())
      {
        EXPECT_GE(lfs.Delta().At(p), finest * (1.0 - 1e-6));
        EXPECT_LE(lfs.Delta().At(p), std::max(12.0, finest) * (1.0 + 1e-6));
      }
      EXPECT_GE(lfs.Largest(), finest);
    }
  }
}

TEST(SpaceTimeFeatureSize, CanBeStopped)
{
  checks::ExpectStop(RestingBall());
}
