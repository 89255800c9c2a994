// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// LinkCoordinates<D>: the guess of an apex against a search with exact predicates.
#include "Delaunay/LinkCoordinates.h"
#include "Geometry/Predicates.h"
#include "Geometry/SimplexQuality.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

using namespace voxplex;

namespace
{

template <int D>
Point<D> RandomPoint(std::mt19937_64& random)
{
  std::uniform_real_distribution<double> coordinate(0.0, 1.0);
  return checks::Drawn<D>([&] { return coordinate(random); });
}

/** Normal of the facet of the first D points, on the side of the last one. */
template <int D>
Point<D> NormalTowards(const std::array<Point<D>, D + 1>& v)
{
  std::array<Point<D>, static_cast<std::size_t>(D)> facet;
  std::copy_n(v.begin(), facet.size(), facet.begin());
  Point<D> normal = FacetNormal(facet);
  const double sign = Dot(normal, Subtract(v[D], v[0])) < 0.0 ? -1.0 : 1.0;
  for (double& x : normal)
  {
    x *= sign;
  }
  return normal;
}

/**
 * A facet with a point below it, and other points outside their ball. The apex is the point above
 * the facet whose ball has no other point inside.
 */
template <int D>
void CompareWithExactSearch()
{
  Point<D> low;
  Point<D> high;
  low.fill(0.0);
  high.fill(1.0);
  Predicates<D> predicates(low, high);
  std::mt19937_64 random(5);
  int found = 0;
  for (int trial = 0; trial < 300; ++trial)
  {
    std::array<Point<D>, D + 1> below;
    std::array<const Point<D>*, D + 1> simplex;
    for (std::size_t i = 0; i < below.size(); ++i)
    {
      below[i] = RandomPoint<D>(random);
      simplex[i] = &below[i];
    }
    Circumball<D> ball;
    if (!ComputeCircumball<D>(simplex.data(), ball))
    {
      continue;
    }
    std::vector<Point<D>> link(below.begin(), below.end());
    while (link.size() < 24)
    {
      const Point<D> p = RandomPoint<D>(random);
      if (SideOfCircumball(ball, p) < 0)
      {
        link.push_back(p);
      }
    }
    Point<D> up = NormalTowards<D>(below);
    for (double& x : up)
    {
      x = -x;
    }
    LinkCoordinates<D> coordinates;
    coordinates.Resize(link.size());
    for (std::size_t k = 0; k < link.size(); ++k)
    {
      coordinates.Set(k, link[k]);
    }
    std::array<std::uint32_t, D + 1> facet;
    for (std::uint32_t i = 0; i < facet.size(); ++i)
    {
      facet[i] = i;
    }
    const std::uint32_t guess = coordinates.FirstOfPencil(ball, below[0], up, facet, D);

    const int belowSign = predicates.Orientation(simplex.data());
    std::uint32_t apex = LinkCoordinates<D>::Nothing;
    for (std::uint32_t k = D + 1; k < link.size(); ++k)
    {
      simplex[D] = &link[k];
      const int sign = predicates.Orientation(simplex.data());
      if (sign != -belowSign)
      {
        continue;
      }
      std::array<const Point<D>*, D + 1> positive = simplex;
      if (sign < 0)
      {
        std::swap(positive[0], positive[1]);
      }
      bool empty = true;
      for (std::uint32_t m = 0; m < link.size() && empty; ++m)
      {
        empty = m < D || m == k || !predicates.InSpherePerturbed(positive.data(), link[m]);
      }
      Circumball<D> own;
      if (ComputeCircumball<D>(simplex.data(), own))
      {
        EXPECT_EQ(coordinates.IsCertainlyEmpty(own), empty) << trial << ", " << k;
      }
      apex = empty ? k : apex;
    }
    EXPECT_EQ(guess, apex) << trial;
    found += apex != LinkCoordinates<D>::Nothing ? 1 : 0;
  }
  EXPECT_GT(found, 200);
}

TEST(LinkCoordinates, GuessTheApex)
{
  CompareWithExactSearch<3>();
  CompareWithExactSearch<4>();
}

TEST(LinkCoordinates, AnUnknownBallGivesNoGuess)
{
  LinkCoordinates<3> coordinates;
  coordinates.Resize(4);
  coordinates.Set(0, { 0, 0, 0 });
  coordinates.Set(1, { 1, 0, 0 });
  coordinates.Set(2, { 0, 1, 0 });
  coordinates.Set(3, { 0, 0, 1 });
  Circumball<3> ball{ { 0, 0, 0 }, std::numeric_limits<double>::quiet_NaN() };
  EXPECT_EQ(coordinates.FirstOfPencil(ball, { 0, 0, 0 }, { 0, 0, 1 }, { 0, 1, 2, 0 }, 3),
    LinkCoordinates<3>::Nothing);
}

TEST(LinkCoordinates, CospherePointsAreNotCertainlyOutside)
{
  // The corners of a cube: the ball of four of them passes through all.
  LinkCoordinates<3> coordinates;
  coordinates.Resize(8);
  for (std::uint32_t k = 0; k < 8; ++k)
  {
    coordinates.Set(k, { double(k & 1), double((k >> 1) & 1), double(k >> 2) });
  }
  EXPECT_FALSE(coordinates.IsCertainlyEmpty({ { 0.5, 0.5, 0.5 }, 0.75 }));
}

} // namespace
