// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Measures of shape.
#include "Geometry/SimplexQuality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace voxplex;

namespace
{

/** Normalized volume of a tetrahedron in 4D. */
double NormalizedVolumeOfFacet(const std::array<Point<4>, 4>& v)
{
  // The same tetrahedron in a frame of its own, by Gram-Schmidt.
  std::array<Point<4>, 3> axes{};
  std::array<Point<3>, 4> inFrame{};
  for (std::size_t k = 1; k < 4; ++k)
  {
    Point<4> rest = Subtract(v[k], v[0]);
    for (std::size_t a = 0; a + 1 < k; ++a)
    {
      inFrame[k][a] = Dot(rest, axes[a]);
      for (std::size_t i = 0; i < 4; ++i)
      {
        rest[i] -= inFrame[k][a] * axes[a][i];
      }
    }
    inFrame[k][k - 1] = std::sqrt(Dot(rest, rest));
    for (std::size_t i = 0; i < 4; ++i)
    {
      axes[k - 1][i] = rest[i] / inFrame[k][k - 1];
    }
  }
  const std::array<const Point<3>*, 4> points = { &inFrame[0], &inFrame[1], &inFrame[2],
    &inFrame[3] };
  return NormalizedVolume<3>(points.data());
}

} // namespace

// So a pentatope that is no sliver has no sliver among its facets (Algorithm.md).
TEST(SimplexQuality, NoFacetHasASmallerNormalizedVolumeThanItsPentatope)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  double smallestExcess = 1.0;
  for (int n = 0; n < 20000; ++n)
  {
    const double flatness = std::pow(10.0, -(n % 4)); // of the last axis
    std::array<Point<4>, 5> p;
    std::array<const Point<4>*, 5> points;
    for (std::size_t k = 0; k < 5; ++k)
    {
      p[k] = { coordinate(random), coordinate(random), coordinate(random),
        flatness * coordinate(random) };
      points[k] = &p[k];
    }
    const double ofPentatope = NormalizedVolume<4>(points.data());
    for (std::size_t opposite = 0; opposite < 5; ++opposite)
    {
      std::array<Point<4>, 4> facet;
      std::copy_if(
        p.begin(), p.end(), facet.begin(), [&](const Point<4>& x) { return &x != &p[opposite]; });
      const double ofFacet = NormalizedVolumeOfFacet(facet);
      EXPECT_GE(ofFacet, ofPentatope * (1.0 - 1e-6));
      smallestExcess = std::min(smallestExcess, ofFacet / ofPentatope - 1.0);
    }
  }
  EXPECT_LT(smallestExcess, 0.01) << "the bound is sharp";
}

TEST(SimplexQuality, RegularSimplicesHaveTheNormalizedVolumeOne)
{
  const double h = 1.0 / std::sqrt(5.0);
  const std::array<Point<4>, 5> p = { { { 1, 1, 1, -h }, { 1, -1, -1, -h }, { -1, 1, -1, -h },
    { -1, -1, 1, -h }, { 0, 0, 0, 4 * h } } };
  const std::array<const Point<4>*, 5> points = { &p[0], &p[1], &p[2], &p[3], &p[4] };
  EXPECT_NEAR(NormalizedVolume<4>(points.data()), 1.0, 1e-12);
  EXPECT_NEAR(NormalizedVolumeOfFacet({ p[0], p[1], p[2], p[3] }), 1.0, 1e-12);
}
