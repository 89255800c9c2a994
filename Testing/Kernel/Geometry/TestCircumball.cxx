// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Circumballs against the exact predicates: certified balls may not contradict them. Every random
 * test prints its seed; VOXPLEX_TEST_SEED repeats a run.
 */
#include "Geometry/Circumball.h"
#include "Geometry/Predicates.h"
#include "PredicateTesting.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

using namespace voxplex;
using namespace voxplex::predicatetesting;

namespace
{

/** A simplex that is, as round says, round, flat, needle-like or a sliver, to very different
 * degrees. */
template <int D>
std::vector<Point<D>> MakeShape(int round, double distance, std::mt19937_64& engine)
{
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double thickness = std::pow(10.0, -4.0 * (round % 4) - 2.0 * std::abs(uniform(engine)));
  const int shape = round % 5;
  const std::size_t thinAxes = shape == 0 ? 0 : (shape == 1 ? static_cast<std::size_t>(D - 1) : 1);
  std::vector<Point<D>> points(static_cast<std::size_t>(D + 1));
  for (Point<D>& p : points)
  {
    for (std::size_t k = 0; k < p.size(); ++k)
    {
      p[k] = uniform(engine) * (k < thinAxes ? thickness : 1.0);
    }
    if (shape >= 3) // a sliver: near the equator of the unit sphere
    {
      const double norm = std::sqrt(Dot(p, p));
      for (double& x : p)
      {
        x /= norm;
      }
    }
    for (double& x : p)
    {
      x += distance;
    }
  }
  return points;
}

} // namespace

template <class T>
class CircumballTest : public RandomTest<T>
{
};
TYPED_TEST_SUITE(CircumballTest, Dimensions);

//------------------------------------------------------------------------------
TYPED_TEST(CircumballTest, CertifiedBallsNeverContradictExactInSphere)
{
  constexpr int D = TypeParam::value;
  constexpr std::size_t Axes = static_cast<std::size_t>(D);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  std::array<int, 3> answers{};
  int certified = 0;
  int exactlyCertified = 0;
  const int rounds = 4000;
  for (int round = 0; round < rounds; ++round)
  {
    // Of all shapes, at the origin and far from it.
    const double distance =
      round % 3 == 0 ? 0.0 : std::pow(10.0, 3.0 + 4.0 * uniform(this->Engine));
    const std::vector<Point<D>> points = MakeShape<D>(round, distance, this->Engine);
    auto simplex = Pointers<D>(points);
    const int orientation = ExactOrientation<D>(simplex.data());
    if (orientation == 0)
    {
      continue;
    }
    if (orientation < 0)
    {
      std::swap(simplex[0], simplex[1]);
    }
    Circumball<D> ball;
    if (ComputeCircumball<D>(simplex.data(), ball))
    {
      ++certified;
    }
    else if (ComputeCircumballExactly<D>(simplex.data(), ball))
    {
      ++exactlyCertified;
    }
    else
    {
      continue;
    }
    for (int query = 0; query < 8; ++query)
    {
      // Points at a relative distance of 1e-12 to 1e-6 from the sphere, and vertices.
      Point<D> p = points[static_cast<std::size_t>(query) % points.size()];
      if (query >= 3)
      {
        const Point<D> direction = checks::Drawn<D>([&] { return normal(this->Engine); });
        const double offset = std::pow(10.0, -9.0 + 3.0 * uniform(this->Engine));
        const double radius = std::sqrt(ball.Radius2 / Dot(direction, direction)) *
          (query % 2 == 0 ? 1.0 + offset : 1.0 - offset);
        for (std::size_t k = 0; k < Axes; ++k)
        {
          p[k] = ball.Center[k] + radius * direction[k];
        }
      }
      const int side = SideOfCircumball(ball, p);
      ++answers[static_cast<std::size_t>(side + 1)];
      if (side != 0)
      {
        ASSERT_EQ(side, ExactInSphere<D>(simplex.data(), p)) << Print<D>(points);
      }
    }
  }
  EXPECT_GT(certified, rounds / 4);
  EXPECT_GT(exactlyCertified, rounds / 50);
  EXPECT_GT(answers[0], rounds / 4);
  EXPECT_GT(answers[1], rounds / 4);
  EXPECT_GT(answers[2], rounds / 4);
}

//------------------------------------------------------------------------------
TYPED_TEST(CircumballTest, CertifiedCentersAreAsAccurateAsTheySay)
{
  constexpr int D = TypeParam::value;
  int certified = 0;
  for (int round = 0; round < 2000; ++round)
  {
    const std::vector<Point<D>> points = MakeShape<D>(round, 0.0, this->Engine);
    const auto simplex = Pointers<D>(points);
    Circumball<D> ball;
    Circumball<D> exact;
    if (!ComputeCircumball<D>(simplex.data(), ball) ||
      !RoundedExactCircumball<D>(simplex.data(), exact))
    {
      continue;
    }
    ++certified;
    EXPECT_LE(
      Distance(ball.Center, exact.Center), 0.25 * CircumballTolerance * std::sqrt(exact.Radius2));
    EXPECT_NEAR(ball.Radius2 / exact.Radius2, 1.0, 0.5 * CircumballTolerance);
  }
  EXPECT_GT(certified, 600);
}

//------------------------------------------------------------------------------
TYPED_TEST(CircumballTest, FlatSimplexHasNoBall)
{
  constexpr int D = TypeParam::value;
  std::vector<Point<D>> points(static_cast<std::size_t>(D + 1));
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (Point<D>& p : points)
  {
    for (double& x : p)
    {
      x = uniform(this->Engine);
    }
    p[1] = 0.3;
  }
  const auto simplex = Pointers<D>(points);
  Circumball<D> ball;
  EXPECT_FALSE(ComputeCircumball<D>(simplex.data(), ball));
  EXPECT_FALSE(ComputeCircumballExactly<D>(simplex.data(), ball));
  EXPECT_EQ(ball.Radius2, std::numeric_limits<double>::infinity());
}
