// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Curvatures of sampled spheres, cylinders, saddles and planes, at several scales.
#include "Sizing/Grading/SampleCurvature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace voxplex;

namespace
{

constexpr SampleCurvature<3>::Labels Labels = { 1, 2 };

SampleCurvature<3> Make(const std::vector<Point<3>>& points, double spacing)
{
  return { points, std::vector<SampleCurvature<3>::Labels>(points.size(), Labels), spacing };
}

/** Evenly spread over a disc around the origin. */
template <typename Height>
std::vector<Point<3>> Disc(double radius, int count, Height&& height)
{
  std::vector<Point<3>> points;
  for (int k = 0; k < count; ++k)
  {
    const double r = radius * std::sqrt((k + 0.5) / count);
    const double angle = k * 2.399963229728653;
    const double x = r * std::cos(angle);
    const double y = r * std::sin(angle);
    points.push_back({ x, y, height(x, y) });
  }
  return points;
}

} // namespace

TEST(SampleCurvature, OfASphereIsThatOfItsRadiusAtAnyScale)
{
  constexpr double radius = 10.0;
  constexpr int count = 20000;
  std::vector<Point<3>> points;
  for (int k = 0; k < count; ++k)
  {
    const double z = 1.0 - (2.0 * k + 1.0) / count;
    const double r = std::sqrt(1.0 - z * z);
    const double angle = k * 2.399963229728653;
    points.push_back({ 3.0 + radius * r * std::cos(angle), radius * r * std::sin(angle) - 7.0,
      radius * z + 20.0 });
  }
  const double spacing = std::sqrt(4.0 * std::numbers::pi * radius * radius / count);
  const SampleCurvature<3> curvature = Make(points, spacing);
  for (const double scale : { 4.0, 11.0, 13.0, 23.0 }) // the last two with a part of the points
  {
    for (std::size_t k = 0; k < points.size(); k += 997)
    {
      ASSERT_NEAR(curvature.At(points[k], Labels, scale * spacing, 0.0), 1.0 / radius,
        scale < 12.0 ? 0.005 : 0.025)
        << scale;
    }
  }
}

TEST(SampleCurvature, OfBentSheetsIsAsDocumented)
{
  const Point<3> middle{};
  const auto at = [&](auto&& height)
  { return Make(Disc(1.2, 4000, height), 0.1).At(middle, Labels, 1.0, 0.0); };
  EXPECT_LT(at([](double x, double y) { return 0.4 * x - 0.7 * y; }), 1e-6);
  EXPECT_NEAR(at([](double x, double y) { return 0.05 * (x * x + y * y); }), 0.1, 0.005);
  EXPECT_NEAR(at([](double x, double) { return 0.05 * x * x; }), 0.087, 0.005);
  EXPECT_NEAR(
    at([](double x, double y) { return 0.05 * (x * x - y * y); }) / 0.1, std::sqrt(2.0), 0.05);
}

TEST(SampleCurvature, OfWhatIsRoughIsThatWithoutTheRoughness)
{
  std::minstd_rand random(7);
  std::uniform_real_distribution<double> noise(-0.1, 0.1);
  const double roughness = 0.1 / std::sqrt(3.0);
  for (const double bend : { 0.0, 0.6 })
  {
    const SampleCurvature<3> curvature =
      Make(Disc(1.2, 4000,
             [&](double x, double y) { return 0.5 * bend * (x * x + y * y) + noise(random); }),
        0.1);
    EXPECT_GT(curvature.At({}, Labels, 1.0, 0.0), bend + 0.1);
    EXPECT_NEAR(curvature.At({}, Labels, 1.0, roughness), bend, bend > 0.0 ? 0.05 : 0.1);
    EXPECT_EQ(curvature.At({}, Labels, 1.0, 2.0 * roughness), 0.0);
  }
}

TEST(SampleCurvature, OfOneSurfaceIsNotThatOfAnother)
{
  std::vector<Point<3>> points = Disc(2.0, 2000, [](double, double) { return 0.0; });
  std::vector<SampleCurvature<3>::Labels> labels(points.size(), Labels);
  for (const Point<3>& p : Disc(2.0, 2000, [](double, double) { return 0.5; }))
  {
    points.push_back(p);
    labels.push_back({ 1, 3 });
  }
  const SampleCurvature<3> apart(points, labels, 0.08);
  EXPECT_LT(apart.At({ 0.0, 0.0, 0.0 }, Labels, 1.0, 0.0), 1e-6);
  EXPECT_LT(apart.At({ 0.0, 0.0, 0.5 }, { 1, 3 }, 1.0, 0.0), 1e-6);
  EXPECT_GT(Make(points, 0.08).At({ 0.0, 0.0, 0.0 }, Labels, 1.0, 0.0), 0.5);
}

TEST(SampleCurvature, OfFewPointsIsNone)
{
  std::vector<Point<3>> points = { { 0.0, 0.0, 0.0 }, { 1.0, 0.0, 0.2 }, { 0.0, 1.0, 0.2 },
    { -1.0, 0.0, 0.2 }, { 0.0, -1.0, 0.2 }, { 0.7, 0.7, 0.2 }, { -0.7, 0.7, 0.2 } };
  EXPECT_EQ(Make(points, 1.0).At(points[0], Labels, 2.0, 0.0), 0.0);
  points.push_back({ 0.7, -0.7, 0.2 });
  EXPECT_GT(Make(points, 1.0).At(points[0], Labels, 2.0, 0.0), 0.1);
  EXPECT_EQ(Make(points, 1.0).At({ 50.0, 50.0, 50.0 }, Labels, 2.0, 0.0), 0.0);
  const std::vector<Point<3>> same(20, { 4.0, 5.0, 6.0 });
  EXPECT_EQ(Make(same, 1.0).At(same[0], Labels, 2.0, 0.0), 0.0);
}

namespace
{

/** The curvature at the origin of x[3] = height(x[0], x[1], x[2]), from random points of a ball of radius 1. */
template <typename Height>
double CurvatureInSpaceTime(double radius, Height&& height)
{
  std::minstd_rand random(3);
  std::uniform_real_distribution<double> x(-1.5, 1.5);
  std::vector<Point<4>> points;
  for (int k = 0; k < 60000; ++k)
  {
    const double a = x(random);
    const double b = x(random);
    const double c = x(random);
    points.push_back({ a, b, c, height(a, b, c) });
  }
  const double spacing = std::cbrt(27.0 / 60000.0);
  return SampleCurvature<4>(
    points, std::vector<SampleCurvature<4>::Labels>(points.size(), Labels), spacing)
    .At({}, Labels, radius, 0.0);
}

} // namespace

TEST(SampleCurvature, InSpaceTimeIsAsDocumented)
{
  for (const double radius : { 0.3, 1.0 }) // from all points, and from a part of them
  {
    const auto at = [&](auto&& height) { return CurvatureInSpaceTime(radius, height); };
    EXPECT_LT(at([](double x, double y, double z) { return 0.4 * x - 0.7 * y + z; }), 1e-6);
    EXPECT_NEAR(
      at([](double x, double y, double z) { return 0.05 * (x * x + y * y + z * z); }), 0.1, 0.01);
    // The interface of a ball that rests: two axes are bent, the third is time.
    EXPECT_NEAR(at([](double x, double y, double) { return 0.05 * (x * x + y * y); }), 0.1, 0.01);
    EXPECT_NEAR(at([](double x, double, double) { return 0.05 * x * x; }), 0.082, 0.01);
  }
}
