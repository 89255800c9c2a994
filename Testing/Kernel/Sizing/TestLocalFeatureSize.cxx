// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Samples of interfaces, their triangulation and poles, and local feature sizes of known shapes.
#include "Base/Error.h"
#include "Domain/ImageDomain.h"
#include "FeatureSizeTesting.h"
#include "Phantoms.h"
#include "Sizing/GradedDelta.h"
#include "Sizing/Grading/InterfaceSamples.h"
#include "Sizing/Grading/LocalFeatureSize.h"
#include "Sizing/Grading/MedialAxis.h"
#include "Sizing/Grading/PointBounds.h"
#include "Sizing/Grading/SampleTriangulation.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <span>

using namespace voxplex;
using checks::Measure;
using checks::Parameters;
using checks::Quantile;
using checks::SizesWhere;

namespace
{

std::vector<Point<3>> Sample(const LabelImage<3>& image, double spacing, unsigned threads = 1)
{
  const ImageDomain<3> domain(image, 1.0);
  return SampleLabelChanges<3>(image, domain, spacing, threads, {}).Points;
}

Point<3> Centre(const LabelImage<3>& image)
{
  Point<3> c;
  for (std::size_t a = 0; a < 3; ++a)
  {
    c[a] = 0.5 * static_cast<double>(image.Grid().Dimensions[a] - 1) *
      image.Grid().Spacing(static_cast<int>(a));
  }
  return c;
}

/** Evenly spread over a sphere (Fibonacci's lattice). */
std::vector<Point<3>> Sphere(const Point<3>& centre, double radius, int count)
{
  std::vector<Point<3>> points;
  for (int k = 0; k < count; ++k)
  {
    const double z = 1.0 - (2.0 * k + 1.0) / count;
    const double r = std::sqrt(1.0 - z * z);
    const double angle = k * 2.399963229728653;
    points.push_back({ centre[0] + radius * r * std::cos(angle),
      centre[1] + radius * r * std::sin(angle), centre[2] + radius * z });
  }
  return points;
}

std::vector<Point<3>> RandomPoints(int count, unsigned seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> x(0.0, 10.0);
  std::vector<Point<3>> points;
  for (int k = 0; k < count; ++k)
  {
    points.push_back({ x(random), x(random), x(random) });
  }
  return points;
}

} // namespace

TEST(InterfaceSamples, LieOnTheInterfaceAndCoverIt)
{
  const LabelImage<3> image = phantoms::Ball(10.0);
  const Point<3> c = Centre(image);
  for (const double spacing : { 0.5, 2.0, 3.0 })
  {
    const std::vector<Point<3>> sample = Sample(image, spacing);
    for (const Point<3>& p : sample)
    {
      ASSERT_NEAR(Distance(p, c), 10.0, 0.6);
    }
    // A cell of two voxels or more has at most one point of each side.
    const double area = 4.0 * 3.14159265 * 100.0;
    EXPECT_LT(static_cast<double>(sample.size()), 4.0 * area / std::max(1.0, spacing * spacing));
    for (const Point<3>& q : Sphere(c, 10.0, 500))
    {
      EXPECT_TRUE(std::any_of(sample.begin(), sample.end(),
        [&](const Point<3>& p) { return Distance(p, q) < 1.8 * std::max(1.0, spacing); }))
        << spacing;
    }
  }
}

TEST(InterfaceSamples, BothSidesOfASheetNotTheBorder)
{
  const LabelImage<3> image = phantoms::Sheet(20);
  const double middle = std::floor(static_cast<double>(image.Grid().Dimensions[2]) / 2);
  const std::vector<Point<3>> sample = Sample(image, 4.0);
  int above = 0;
  int below = 0;
  for (const Point<3>& p : sample)
  {
    above += p[2] > middle ? 1 : 0;
    below += p[2] < middle ? 1 : 0;
  }
  EXPECT_GE(above, 25);
  EXPECT_GE(below, 25);

  // The image ends at the ball's equator. The face there is flat with every sampling distance, so the only points
  // are those of the ball's own surface, up to the face.
  const LabelImage<3> cut = phantoms::CutBall(12);
  int beside = 0;
  for (const Point<3>& p : Sample(cut, 2.0))
  {
    EXPECT_GT(p[2], -0.01);
    beside += p[2] < 1.0 ? 1 : 0;
  }
  EXPECT_GT(beside, 20);
}

// Where the image cuts an object there is no interface that could be sampled more coarsely.
TEST(InterfaceSamples, LeaveFacesOfTheImageOut)
{
  const LabelImage<3> block =
    phantoms::Make(GridGeometry<3>::Orthogonal({ 9, 8, 7 }, { 1.0, 0.5, 2.0 }),
      [](const Point<3>&) { return std::int16_t{ 1 }; });
  EXPECT_TRUE(Sample(block, 1.0).empty());
  const LabelImage<3> half = phantoms::CutBall(14);
  const double c = 0.5 * static_cast<double>(half.Grid().Dimensions[0] - 1);
  for (const double spacing : { 1.0, 3.0 })
  {
    const std::vector<Point<3>> sample = Sample(half, spacing);
    EXPECT_GT(sample.size(), 100u);
    for (const Point<3>& p : sample)
    {
      ASSERT_NEAR(Distance(p, { c, c, 0.0 }), 11.5, 0.9); // on the sphere, not on the disk
    }
  }
  // Two labels that touch the border: what is between them is sampled up to it.
  const LabelImage<3> two = phantoms::Make(
    phantoms::Cube(10), [](const Point<3>& p) -> std::int16_t { return p[1] < 4.5 ? 1 : 2; });
  const std::vector<Point<3>> between = Sample(two, 1.0);
  EXPECT_EQ(between.size(), 100u);
  for (const Point<3>& p : between)
  {
    ASSERT_NEAR(p[1], 4.5, 0.1);
  }
}

TEST(InterfaceSamples, AreTheSameForAnyNumberOfThreads)
{
  const LabelImage<3> image = phantoms::NestedBalls(15.0);
  const std::vector<Point<3>> one = Sample(image, 1.5, 1);
  EXPECT_EQ(one, Sample(image, 1.5, 3));
  EXPECT_EQ(one, Sample(image, 1.5, 8));
}

TEST(InterfaceSamples, CanBeStopped)
{
  const LabelImage<3> image = phantoms::Ball(10.0);
  const ImageDomain<3> domain(image, 1.0);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(SampleLabelChanges<3>(image, domain, 1.0, 2, stop.get_token()), Cancelled);
}

TEST(SampleTriangulation, IsDelaunayAndHasEveryPointWithAnyThreads)
{
  std::vector<Point<3>> points = RandomPoints(9000, 1);
  const std::vector<Point<3>> sphere = Sphere({ 5.0, 5.0, 5.0 }, 4.0, 9000);
  points.insert(points.end(), sphere.begin(), sphere.end());
  checks::SimplexSet<3> expected;
  for (const unsigned threads : { 1u, 2u, 4u })
  {
    const SampleTriangulation<3> triangulation(points, 1.0, threads, {});
    const Triangulation<3>& mesh = triangulation.Mesh();
    checks::ExpectSound(mesh);
    std::set<Point<3>> vertices;
    for (VertexId v = 0; v < mesh.VertexIdEnd(); ++v)
    {
      if (mesh.GetVertex(v).Alive)
      {
        vertices.insert(mesh.Position(v));
        EXPECT_EQ(mesh.GetVertex(v).Owner, 0) << "a vertex is locked still";
      }
    }
    EXPECT_EQ(vertices.size(), points.size() + 8);
    for (const Point<3>& p : points)
    {
      ASSERT_TRUE(vertices.count(p));
    }
    const checks::SimplexSet<3> simplices = checks::Simplices(mesh);
    expected = threads == 1 ? simplices : expected;
    EXPECT_EQ(simplices, expected) << threads << " threads";
  }
}

TEST(SampleTriangulation, CanBeStopped)
{
  std::stop_source stop;
  stop.request_stop();
  for (const unsigned threads : { 1u, 4u })
  {
    EXPECT_THROW(
      SampleTriangulation<3>(RandomPoints(9000, 2), 1.0, threads, stop.get_token()), Cancelled);
  }
}

TEST(MedialAxis, OfASphereIsItsCentre)
{
  const Point<3> centre = { 1.0, 2.0, 3.0 };
  MedialBalls balls;
  balls.LargestRadius = 20.0;
  const std::vector<Point<3>> poles = FindPoles<3>(Sphere(centre, 7.0, 2000), balls, 1, {});
  ASSERT_FALSE(poles.empty());
  for (const Point<3>& pole : poles)
  {
    EXPECT_NEAR(Distance(pole, centre), 0.0, 1e-6);
  }
  balls.LargestRadius = 6.9;
  EXPECT_TRUE(FindPoles<3>(Sphere(centre, 7.0, 2000), balls, 1, {}).empty()) << "lambda";
}

// If delta is large compared with the image, one cell holds all of it, with one or two points.
TEST(MedialAxis, OfFewOrFlatPointsIsEmpty)
{
  const Point<3> p = { 3.0, 1.0, 2.0 };
  std::vector<std::vector<Point<3>>> samples = { {}, { p }, std::vector<Point<3>>(7, p) };
  for (const int count : { 2, 3, 4, 5, 40 })
  {
    std::vector<Point<3>> line;
    std::vector<Point<3>> plane;
    for (int k = 0; k < count; ++k)
    {
      line.push_back({ 3.0 + k, 1.0 + 2.0 * k, 2.0 - k });
      plane.push_back({ 3.0 + k % 3, 1.0, 2.0 + k / 3 }); // corners of squares lie on a circle
    }
    samples.push_back(line);
    samples.push_back(plane);
    plane.insert(plane.end(), plane.begin(), plane.end());
    samples.push_back(plane);
  }
  for (const std::vector<Point<3>>& sample : samples)
  {
    const Box<3> bounds =
      sample.empty() ? Box<3>{ p, p } : BoundsOf<3>(std::span<const Point<3>>(sample));
    for (const double radius : { Distance(bounds.Min, bounds.Max), 0.1, 5.0 })
    {
      MedialBalls balls;
      balls.LargestRadius = radius;
      EXPECT_TRUE(FindPoles<3>(sample, balls, 1, {}).empty()) << sample.size() << ", " << radius;
    }
  }
}

TEST(LocalFeatureSize, OfFewSamplesIsWhatIsAskedFor)
{
  const auto make = [](const std::function<std::int16_t(const Point<3>&)>& label)
  { return phantoms::Make(phantoms::Cube(7), label); };
  const std::array images = {
    make(
      [](const Point<3>& p) -> std::int16_t {
        return Distance(p, { 3, 3, 3 }) < 0.5;
      }),
    make([](const Point<3>& p) -> std::int16_t { return p[1] == 3 && p[2] == 3 ? 1 : 0; }),
    make([](const Point<3>& p) -> std::int16_t { return p[2] == 3 ? 1 : 0; }),
    make([](const Point<3>& p) -> std::int16_t { return p[2] < 3 ? 1 : 2; }),
    make([](const Point<3>&) -> std::int16_t { return 1; }),
  };
  for (const LabelImage<3>& image : images)
  {
    for (const double finest : { 0.3, 3.0, 10.0, 1000.0 })
    {
      const LocalFeatureSize<3> lfs = Measure(image, Parameters(finest, 12.0));
      for (const Point<3>& p : lfs.Sample())
      {
        EXPECT_GE(lfs.Delta().At(p), finest * (1.0 - 1e-6));
        EXPECT_LE(lfs.Delta().At(p), std::max(12.0, finest) * (1.0 + 1e-6));
      }
      EXPECT_GE(lfs.Largest(), finest);
      EXPECT_GT(lfs.Equivalent(), 0.99 * finest);
    }
  }
}

namespace
{

/** Two squares that meet in an edge along the third axis, at an angle in degrees. */
std::vector<Point<3>> Wedge(double degrees)
{
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> x(0.0, 20.0);
  std::vector<Point<3>> points;
  const double angle = degrees * 3.14159265358979 / 180.0;
  for (int k = 0; k < 6000; ++k)
  {
    const double r = x(random);
    const double z = x(random);
    points.push_back({ r, 0.0, z });
    points.push_back({ x(random) * std::cos(angle), 0.0, x(random) });
    points.back()[1] = points.back()[0] * std::tan(angle);
  }
  return points;
}

} // namespace

// From a ball in a wedge the points of contact are seen at 180 degrees less the angle of the wedge.
TEST(MedialAxis, LeavesObtuseEdgesOut)
{
  MedialBalls balls;
  balls.LargestRadius = 4.0;
  balls.ContactAngle = 90.0;
  const auto count = [&](double degrees)
  {
    const std::vector<Point<3>> poles = FindPoles<3>(Wedge(degrees), balls, 1, {});
    // In the inside of the wedge, away from where the squares end.
    return std::count_if(poles.begin(), poles.end(),
      [&](const Point<3>& p)
      { return p[0] > 0.5 && p[0] < 9.0 && p[1] > 0.5 && p[2] > 3.0 && p[2] < 17.0; });
  };
  EXPECT_GT(count(60.0), 100);
  EXPECT_LT(count(120.0), 5);
  balls.ContactAngle = 40.0;
  EXPECT_GT(count(120.0), 100);
}

// In a wedge of 60 degrees the edge is as far from a ball's surface as the ball's radius.
TEST(MedialAxis, LeavesLowEdgesOut)
{
  MedialBalls balls;
  balls.LargestRadius = 4.0;
  const auto countBelow = [&](double radius, double salience)
  {
    balls.Salience = salience;
    const std::vector<Point<3>> poles = FindPoles<3>(Wedge(60.0), balls, 1, {});
    return std::count_if(poles.begin(), poles.end(),
      [&](const Point<3>& p) {
        return p[0] > 0.0 && p[1] > 0.3 && p[1] < radius && p[0] < 9.0 && p[2] > 3.0 && p[2] < 17.0;
      });
  };
  EXPECT_GT(countBelow(1.4, 0.0), 300);
  EXPECT_LT(countBelow(1.4, 2.0), 60);
  EXPECT_GT(countBelow(3.5, 2.0), 100);
}

// Between the two in the middle the poles are the farthest ones of their points, elsewhere the others.
TEST(MedialAxis, LiesOnBothSides)
{
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> x(0.0, 20.0);
  std::vector<Point<3>> points;
  for (const double height : { 0.0, 2.0, 8.0, 10.0 })
  {
    for (int k = 0; k < 3000; ++k)
    {
      points.push_back({ x(random), x(random), height });
    }
  }
  MedialBalls balls;
  balls.LargestRadius = 5.0;
  balls.Salience = 1.0;
  const std::vector<Point<3>> poles = FindPoles<3>(points, balls, 1, {});
  for (const double height : { 1.0, 5.0, 9.0 })
  {
    EXPECT_GT(std::count_if(poles.begin(), poles.end(),
                [&](const Point<3>& p) { return std::abs(p[2] - height) < 0.2; }),
      300)
      << height;
  }
}

TEST(MedialAxis, IsTheSameForAnyNumberOfThreads)
{
  std::vector<Point<3>> points = Sphere({ 0.0, 0.0, 0.0 }, 7.0, 9000);
  const std::vector<Point<3>> other = Sphere({ 3.0, 0.0, 0.0 }, 9.0, 9000);
  points.insert(points.end(), other.begin(), other.end());
  MedialBalls balls;
  balls.LargestRadius = 12.0;
  const std::vector<Point<3>> one = FindPoles<3>(points, balls, 1, {});
  EXPECT_GT(one.size(), 100u);
  EXPECT_TRUE(std::is_sorted(one.begin(), one.end()));
  EXPECT_EQ(one, FindPoles<3>(points, balls, 2, {}));
  EXPECT_EQ(one, FindPoles<3>(points, balls, 4, {}));
  EXPECT_TRUE(FindPoles<3>({}, balls, 2, {}).empty());
}

TEST(MedialAxis, OfOnePointIsEmpty)
{
  MedialBalls balls;
  balls.LargestRadius = 0.0; // the extent of the sample
  EXPECT_TRUE(FindPoles<3>({ { 1.0, 2.0, 3.0 } }, balls, 1, {}).empty());
}

TEST(GradedDelta, SpreadsTheSmallestValues)
{
  const Box<3> box{ { 0.0, 0.0, 0.0 }, { 11.5, 7.5, 9.5 } };
  GradedDelta<3> graded(box, 1.0);
  const std::vector<std::pair<Point<3>, double>> set = { { { 2.5, 2.5, 2.5 }, 1.0 },
    { { 9.5, 6.5, 8.5 }, 2.0 }, { { 2.6, 2.4, 2.3 }, 1.5 }, { { 5.5, 1.5, 5.5 }, 50.0 } };
  for (const auto& [p, delta] : set)
  {
    graded.Lower(p, delta);
  }
  graded.Grade(0.5, 2, {});
  EXPECT_EQ(graded.Finest(), 1.0);
  for (double x = 0.5; x < 12.0; x += 1.0)
  {
    for (double y = 0.5; y < 8.0; y += 1.0)
    {
      for (double z = 0.5; z < 10.0; z += 1.0)
      {
        double expected = 1e9;
        for (const auto& [p, delta] : set)
        {
          const auto cells = [](double a, double b)
          { return std::abs(std::floor(a) - std::floor(b)); };
          expected =
            std::min(expected, delta + 0.5 * (cells(p[0], x) + cells(p[1], y) + cells(p[2], z)));
        }
        ASSERT_NEAR(graded.At({ x, y, z }), expected, 1e-5);
      }
    }
  }
  EXPECT_EQ(graded.At({ -5.0, 2.5, 2.5 }), graded.At({ 0.5, 2.5, 2.5 })) << "the nearest cell";
  EXPECT_EQ(graded.At({ 30.0, 2.5, 20.0 }), graded.At({ 11.5, 2.5, 9.5 }));
}

TEST(LocalFeatureSize, OfABallIsItsRadius)
{
  for (const double spacing : { 1.0, 0.25 })
  {
    const LocalFeatureSize<3> lfs = Measure(phantoms::Ball(10.0 * spacing, spacing),
      [&]
      {
        GradingParameters p = Parameters(2.0 * spacing, 100.0 * spacing);
        p.Salience = spacing;
        return p;
      }());
    EXPECT_GT(Quantile(lfs.Sizes(), 0.02), 8.2 * spacing);
    EXPECT_NEAR(Quantile(lfs.Sizes(), 0.5), 9.3 * spacing, 0.9 * spacing);
    EXPECT_LT(Quantile(lfs.Sizes(), 0.98), 10.6 * spacing);
  }
}

TEST(LocalFeatureSize, IsTheDistanceToTheNearestPole)
{
  const LabelImage<3> image = phantoms::Torus(13.0, 9.0);
  const GradingParameters parameters = Parameters(2.0, 14.0);
  const LocalFeatureSize<3> lfs = Measure(image, parameters);
  MedialBalls balls;
  balls.LargestRadius = parameters.Lambda;
  balls.Salience = parameters.Salience;
  const std::vector<Point<3>> poles = FindPoles<3>(lfs.Sample(), balls, 1, {});
  EXPECT_EQ(poles.size(), lfs.NumberOfPoles());
  for (std::size_t k = 0; k < lfs.Sample().size(); k += 3)
  {
    double nearest = parameters.Lambda;
    for (const Point<3>& pole : poles)
    {
      nearest = std::min(nearest, Distance(pole, lfs.Sample()[k]));
    }
    ASSERT_NEAR(lfs.Sizes()[k], nearest, 0.5) << "a quarter of Finest, along the diagonal";
  }
}

TEST(LocalFeatureSize, OfATorusIsItsRadiusOrThatOfItsHole)
{
  // The hole has radius 4, the tube 9; at the outside the medial axis is the circle in the tube.
  const LabelImage<3> image = phantoms::Torus(13.0, 9.0);
  const Point<3> c = Centre(image);
  const LocalFeatureSize<3> lfs = Measure(image, Parameters(2.0, 100.0));
  const std::vector<double> outside =
    SizesWhere(lfs, [&](const Point<3>& p) { return std::hypot(p[0] - c[0], p[1] - c[1]) > 20.0; });
  EXPECT_NEAR(Quantile(outside, 0.5), 9.0, 0.8);
  EXPECT_GT(Quantile(outside, 0.05), 7.0);
  const std::vector<double> inside =
    SizesWhere(lfs, [&](const Point<3>& p) { return std::hypot(p[0] - c[0], p[1] - c[1]) < 4.5; });
  EXPECT_NEAR(Quantile(inside, 0.5), 4.0, 0.6);
}

TEST(LocalFeatureSize, BetweenConcentricSpheresIsHalfTheGap)
{
  // Radii 8, 16 and 24: half the gap is 4.
  const LabelImage<3> image = phantoms::NestedBalls(24.0);
  const Point<3> c = Centre(image);
  const LocalFeatureSize<3> lfs = Measure(image, Parameters(2.0, 100.0));
  for (const double radius : { 8.0, 16.0, 24.0 })
  {
    const std::vector<double> sizes =
      SizesWhere(lfs, [&](const Point<3>& p) { return std::abs(Distance(p, c) - radius) < 1.0; });
    EXPECT_NEAR(Quantile(sizes, 0.5), 4.0, 0.4) << radius;
    EXPECT_GT(Quantile(sizes, 0.05), 2.2) << radius;
  }
}

TEST(LocalFeatureSize, OfASheetIsHalfItsThickness)
{
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(60),
    [](const Point<3>& p) -> std::int16_t
    {
      const double height = (p[2] - 30.0 + 0.3 * (p[0] - 30.0)) / std::hypot(1.0, 0.3);
      return Distance(p, { 30.0, 30.0, 30.0 }) < 28.0 && std::abs(height) < 3.0 ? 1 : 0;
    });
  const LocalFeatureSize<3> lfs = Measure(image, Parameters(2.0, 12.0));
  const std::vector<double> sizes = SizesWhere(lfs,
    [&](const Point<3>& p) {
      return Distance(p, { 30.0, 30.0, 30.0 }) < 20.0;
    });
  EXPECT_NEAR(Quantile(sizes, 0.5), 3.1, 0.3);
  EXPECT_LT(Quantile(sizes, 0.95), 3.9);
}

// Three labels that meet in a curve have a local feature size of 0 there: it must not count.
TEST(LocalFeatureSize, DoesNotVanishAtJunctions)
{
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(60),
    [](const Point<3>& p) -> std::int16_t
    {
      if (Distance(p, { 30.0, 30.0, 30.0 }) > 25.0)
      {
        return 0;
      }
      const double angle = std::atan2(p[1] - 30.2, p[0] - 30.1);
      return angle < -1.0471975 ? 1 : angle < 1.0471975 ? 2 : 3;
    });
  const LocalFeatureSize<3> lfs = Measure(image, Parameters(2.0, 12.0));
  const std::vector<double> near = SizesWhere(lfs,
    [&](const Point<3>& p)
    { return std::hypot(p[0] - 30.1, p[1] - 30.2) < 2.0 && std::abs(p[2] - 30.0) < 10.0; });
  ASSERT_GT(near.size(), 20u);
  EXPECT_GT(Quantile(near, 0.2), 1.9);
}

TEST(LocalFeatureSize, DeltaIsBoundedAndLipschitz)
{
  const LabelImage<3> image = phantoms::NestedBalls(24.0);
  GradingParameters parameters = Parameters(1.5, 6.0);
  parameters.Ratio = 0.8;
  const LocalFeatureSize<3> lfs = Measure(image, parameters);
  EXPECT_LE(lfs.Largest(), 0.8 * 6.0 + 1e-6);
  EXPECT_GT(lfs.Largest(), 2.5);
  EXPECT_GE(lfs.Equivalent(), 1.5);
  EXPECT_LE(lfs.Equivalent(), lfs.Largest());
  const std::vector<Point<3>>& sample = lfs.Sample();
  for (std::size_t k = 0; k < sample.size(); ++k)
  {
    const double delta = lfs.Delta().At(sample[k]);
    ASSERT_GE(delta, 1.5 - 1e-6);
    ASSERT_LE(delta, std::max(1.5, 0.8 * lfs.Sizes()[k]) + 1e-5);
    const Point<3>& other = sample[(k * 7919 + 13) % sample.size()];
    // Cells of 1.5: a point may be a cell's diagonal from where its value holds.
    const double along = std::abs(sample[k][0] - other[0]) + std::abs(sample[k][1] - other[1]) +
      std::abs(sample[k][2] - other[2]);
    ASSERT_LE(std::abs(delta - lfs.Delta().At(other)), 0.3 * (along + 3 * 1.5) + 1e-5);
  }
}

// A ball of radius R may have triangles with a circumradius of sqrt(2 R Tolerance), with every ratio.
TEST(LocalFeatureSize, DeltaIsBoundedByTheBend)
{
  GradingParameters parameters = Parameters(1.5, 100.0);
  parameters.Ratio = 2.0;
  const LabelImage<3> image = phantoms::Ball(20.0);
  EXPECT_GT(Measure(image, parameters).Largest(), 30.0);
  for (const double tolerance : { 1.0, 2.0 })
  {
    parameters.Tolerance = tolerance;
    const LocalFeatureSize<3> lfs = Measure(image, parameters);
    const double expected = std::sqrt(1.2 * 20.0 * tolerance);
    EXPECT_NEAR(lfs.Largest(), expected, 0.1 * expected);
    EXPECT_NEAR(lfs.Equivalent(), expected, 0.2 * expected);
  }
}

// What is thin is not bent for that: of a spherical shell, radii 16 and 24, the bend is that of its spheres.
TEST(LocalFeatureSize, WhatIsThinIsNotBent)
{
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(56),
    [](const Point<3>& p) -> std::int16_t
    {
      const double r = Distance(p, { 27.5, 27.5, 27.5 });
      return r > 16.0 && r < 24.0 ? 1 : 0;
    });
  GradingParameters parameters = Parameters(1.0, 100.0);
  parameters.Ratio = 3.0; // Delta = 12: within it is the other sphere, too
  const LocalFeatureSize<3> free = Measure(image, parameters);
  parameters.Tolerance =
    6.0; // the outer sphere's bend would allow 13; half the gap, taken for its radius, 5.4
  const LocalFeatureSize<3> lfs = Measure(image, parameters);
  EXPECT_EQ(lfs.Sizes(), free.Sizes());
  std::vector<double> outer;
  for (std::size_t k = 0; k < lfs.Sample().size(); ++k)
  {
    if (Distance(lfs.Sample()[k], { 27.5, 27.5, 27.5 }) > 20.0)
    {
      outer.push_back(lfs.Delta().At(lfs.Sample()[k]) / free.Delta().At(lfs.Sample()[k]));
    }
  }
  EXPECT_GT(Quantile(outer, 0.1), 0.95);
}

TEST(LocalFeatureSize, IsTheSameForAnyNumberOfThreads)
{
  const LabelImage<3> image = phantoms::Torus(20.0, 10.0);
  GradingParameters parameters = Parameters(1.5, 8.0);
  parameters.Tolerance = 1.6;
  checks::ExpectSameSizes(image, parameters);
}

TEST(LocalFeatureSize, CanBeStopped)
{
  checks::ExpectStop(phantoms::Ball(10.0));
}
