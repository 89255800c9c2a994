// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Vertices that lie on the box and go again, as those of flat ends do: inside a facet of the box and inside
// its edges and faces of any dimension. What is left must be the triangulation of what is left.
#include "Delaunay/Triangulation.h"
#include "Sanitizers.h"
#include "TriangulationChecks.h"
#include "TriangulationStorm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

constexpr int Fraction = Sanitized ? 4 : 1;

/** On how many planes of the box a point lies. */
template <int D>
std::size_t PlanesOf(const Point<D>& p, double size)
{
  return static_cast<std::size_t>(
    std::count_if(p.begin(), p.end(), [&](double x) { return x == 0.0 || x == size; }));
}

/** Random points, moved onto 0 to D - 1 planes of the box, as many of each. */
template <int D>
std::vector<Point<D>> PointsOnFaces(int n, double size, std::mt19937& random)
{
  std::vector<Point<D>> points = RandomPoints<D>(n, size, random);
  std::array<std::size_t, static_cast<std::size_t>(D)> axes;
  for (std::size_t a = 0; a < axes.size(); ++a)
  {
    axes[a] = a;
  }
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    std::shuffle(axes.begin(), axes.end(), random);
    for (std::size_t k = 0; k < i % axes.size(); ++k)
    {
      points[i][axes[k]] = random() % 2 == 0 ? 0.0 : size;
    }
  }
  return points;
}

template <int D>
SimplexSet<D> TriangulationOf(const std::vector<Point<D>>& points, double size)
{
  Triangulation<D> t(UnitBox<D>(size));
  typename Triangulation<D>::Worker worker(t);
  for (const Point<D>& p : points)
  {
    EXPECT_EQ(Insert<D>(t, worker, p), InsertionOutcome::Inserted);
  }
  return Simplices(t);
}

/** Removes the points one by one and compares with the triangulation of the others. */
template <int D>
void RemoveOneByOne(std::vector<Point<D>> points, double size, unsigned seed)
{
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  Triangulation<D> t(UnitBox<D>(size));
  typename Triangulation<D>::Worker worker(t);
  for (const Point<D>& p : points)
  {
    const VertexKind kind = random() % 2 == 0 ? VertexKind::Free : VertexKind::Feature;
    ASSERT_EQ(Insert<D>(t, worker, p, kind), InsertionOutcome::Inserted);
  }
  ExpectDelaunay(t, size);
  std::shuffle(points.begin(), points.end(), random);
  std::array<int, static_cast<std::size_t>(D)> removed{};
  while (!points.empty() && !testing::Test::HasFatalFailure())
  {
    const Point<D> p = points.back();
    points.pop_back();
    const std::size_t planes = PlanesOf<D>(p, size);
    SCOPED_TRACE(std::to_string(points.size()) + " points left, the last lay on " +
      std::to_string(planes) + " planes");
    ASSERT_EQ(t.Remove(worker, FindVertex<D>(t, p)), RemovalOutcome::Removed);
    ++removed[planes];
    ASSERT_EQ(FindVertex<D>(t, p), None);
    ExpectSound(t);
    for (const SimplexId s : worker.Created)
    {
      ASSERT_TRUE(t.IsAlive(s));
    }
    ASSERT_TRUE(Simplices(t) == TriangulationOf<D>(points, size));
    if (points.size() % 8 == 0)
    {
      ExpectDelaunay(t, size);
    }
  }
  for (const int count : removed)
  {
    EXPECT_GT(count, 0) << "the test tests less than it says";
  }
}

/** Lattice points, none at a corner. At least half of them lie on the box. */
template <int D>
std::vector<Point<D>> LatticeOnFaces(int n, int side, double spacing, std::mt19937& random)
{
  const double size = side * spacing;
  std::vector<Point<D>> points =
    WithoutCorners<D>(LatticePoints<D>(2 * n, side, spacing, random), size);
  std::stable_partition(
    points.begin(), points.end(), [&](const Point<D>& p) { return PlanesOf<D>(p, size) > 0; });
  std::vector<Point<D>> chosen;
  for (std::size_t i = 0; i < points.size() && chosen.size() < static_cast<std::size_t>(n); ++i)
  {
    // From both ends: on the box, inside.
    chosen.push_back(i % 3 == 2 ? points[points.size() - 1 - i / 3] : points[i - i / 3]);
  }
  return chosen;
}

} // namespace

TEST(TriangulationOnBox, RandomPoints)
{
  for (const unsigned seed : { 1u, 2u, 3u })
  {
    std::mt19937 random(seed);
    RemoveOneByOne<3>(PointsOnFaces<3>(40, 10.0, random), 10.0, seed);
    RemoveOneByOne<4>(PointsOnFaces<4>(28, 10.0, random), 10.0, seed);
  }
}

TEST(TriangulationOnBox, LatticePoints)
{
  for (const unsigned seed : { 4u, 5u, 6u })
  {
    std::mt19937 random(seed);
    RemoveOneByOne<3>(LatticeOnFaces<3>(40, 4, 0.277, random), 4 * 0.277, seed);
    RemoveOneByOne<4>(LatticeOnFaces<4>(26, 2, 1.0, random), 2.0, seed);
  }
}

// All points of a mesh's flat end: one facet of the box and nothing else.
TEST(TriangulationOnBox, OneFacetIsEmptied)
{
  std::mt19937 random(11);
  std::vector<Point<4>> points = RandomPoints<4>(120, 1.0, random);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    points[i][3] = i % 2 == 0 ? 1.0 : points[i][3];
  }
  Triangulation<4> t(UnitBox<4>(1.0));
  Triangulation<4>::Worker worker(t);
  std::vector<Point<4>> inside;
  for (const Point<4>& p : points)
  {
    ASSERT_EQ(Insert<4>(t, worker, p), InsertionOutcome::Inserted);
    if (p[3] != 1.0)
    {
      inside.push_back(p);
    }
  }
  for (const Point<4>& p : points)
  {
    if (p[3] == 1.0)
    {
      ASSERT_EQ(t.Remove(worker, FindVertex<4>(t, p)), RemovalOutcome::Removed);
    }
  }
  ExpectSound(t);
  EXPECT_TRUE(Simplices(t) == TriangulationOf<4>(inside, 1.0));
}

TEST(TriangulationOnBox, Storms)
{
  for (unsigned seed = 0; seed < 8u / Fraction; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(100 + seed);
    const unsigned threads = 2u << (seed % 3);
    StormAndCheck<3>(
      PointsOnFaces<3>(1000 / Fraction, 10.0, random), 10.0, threads, false, nullptr, OnBox::MayGo);
    StormAndCheck<3>(
      LatticeOnFaces<3>(60, 4, 0.277, random), 4 * 0.277, threads, true, nullptr, OnBox::MayGo);
    StormAndCheck<4>(
      PointsOnFaces<4>(160 / Fraction, 10.0, random), 10.0, threads, false, nullptr, OnBox::MayGo);
    StormAndCheck<4>(
      LatticeOnFaces<4>(40, 2, 1.0, random), 2.0, threads, true, nullptr, OnBox::MayGo);
    if (HasFailure())
    {
      return;
    }
  }
}
