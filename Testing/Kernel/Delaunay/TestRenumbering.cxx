// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Triangulation<D>::Renumber(): numbers that depend on the points alone.
#include "Delaunay/Triangulation.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** Inserts points in the given order, and removes every third one that is not on the box. */
template <int D>
void Fill(Triangulation<D>& t, const std::vector<Point<D>>& points, const std::set<Point<D>>& gone)
{
  typename Triangulation<D>::Worker worker(t);
  std::vector<VertexId> toRemove;
  for (const Point<D>& p : points)
  {
    const SimplexId conflict = t.FindConflict(worker, p, t.FirstAlive());
    ASSERT_NE(conflict, None);
    ASSERT_EQ(t.Insert(worker, p, VertexKind::Free, conflict), InsertionOutcome::Inserted);
    if (gone.count(p) != 0)
    {
      toRemove.push_back(worker.NewVertex);
    }
  }
  for (const VertexId v : toRemove)
  {
    ASSERT_EQ(t.Remove(worker, v), RemovalOutcome::Removed);
  }
}

template <int D>
std::vector<Point<D>> PositionsInOrder(const Triangulation<D>& t)
{
  std::vector<Point<D>> positions;
  for (VertexId v = 0; v < t.VertexIdEnd(); ++v)
  {
    EXPECT_TRUE(t.GetVertex(v).Alive) << v;
    positions.push_back(t.Position(v));
  }
  return positions;
}

template <int D>
VertexId Smallest(const Triangulation<D>& t, SimplexId s)
{
  const auto& v = t.GetSimplex(s).V;
  return *std::min_element(v.begin(), v.end());
}

/** The vertices of each simplex, and its neighbours beyond them. */
template <int D>
std::vector<std::array<std::array<std::uint32_t, 2>, D + 1>> SimplicesInOrder(
  const Triangulation<D>& t)
{
  std::vector<std::array<std::array<std::uint32_t, 2>, D + 1>> simplices;
  for (SimplexId s = 0; s < t.SimplexIdEnd(); ++s)
  {
    EXPECT_TRUE(t.IsAlive(s)) << s;
    EXPECT_TRUE(s == 0 || Smallest(t, s - 1) <= Smallest(t, s)) << s;
    std::array<std::array<std::uint32_t, 2>, D + 1> simplex;
    for (unsigned i = 0; i <= D; ++i)
    {
      simplex[i] = { t.GetSimplex(s).V[i], t.GetSimplex(s).N[i] };
    }
    std::sort(simplex.begin(), simplex.end());
    simplices.push_back(simplex);
  }
  return simplices;
}

template <int D>
void TestTwoOrders(std::size_t number)
{
  constexpr double size = 10.0;
  std::mt19937 random(7);
  std::vector<Point<D>> points = RandomPoints<D>(number, size, random);
  std::set<Point<D>> gone;
  for (std::size_t i = 0; i < points.size(); i += 3)
  {
    gone.insert(points[i]);
  }
  Triangulation<D> one(UnitBox<D>(size));
  Fill<D>(one, points, gone);
  std::shuffle(points.begin(), points.end(), random);
  Triangulation<D> other(UnitBox<D>(size));
  Fill<D>(other, points, gone);
  const SimplexSet<D> before = Simplices(one);

  one.Renumber(1);
  other.Renumber(3);

  ExpectSound(one);
  EXPECT_TRUE(Simplices(one) == before);
  EXPECT_EQ(one.VertexIdEnd(), points.size() - gone.size() + (std::size_t{ 1 } << D));
  EXPECT_EQ(one.SimplexIdEnd(), before.size());
  EXPECT_TRUE(PositionsInOrder(one) == PositionsInOrder(other));
  EXPECT_TRUE(SimplicesInOrder(one) == SimplicesInOrder(other));
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(Renumbering, DependsOnThePointsAlone)
{
  TestTwoOrders<3>(3000);
  TestTwoOrders<3>(32000); // three blocks: what is in the way may be so twice
  TestTwoOrders<4>(400);
}

TEST(Renumbering, VerticesFollowACurve)
{
  constexpr double size = 10.0;
  std::mt19937 random(8);
  Triangulation<3> t(UnitBox<3>(size));
  Fill<3>(t, RandomPoints<3>(4000, size, random), {});
  const auto pathLength = [&]
  {
    double length = 0.0;
    for (VertexId v = 1; v < 4000; ++v)
    {
      length += Distance(t.Position(v - 1), t.Position(v));
    }
    return length;
  };
  const double before = pathLength();
  t.Renumber(2);
  EXPECT_LT(pathLength(), 0.2 * before);
}

TEST(Renumbering, OperationsGoOn)
{
  constexpr double size = 10.0;
  std::mt19937 random(9);
  const std::vector<Point<3>> points = RandomPoints<3>(600, size, random);
  Triangulation<3> t(UnitBox<3>(size));
  const auto middle = points.begin() + 300;
  const std::set<Point<3>> gone(points.begin(), points.begin() + 50);
  Fill<3>(t, { points.begin(), middle }, gone);
  t.Renumber(1);
  Fill<3>(t, { middle, points.end() }, { points.end() - 50, points.end() });
  ExpectDelaunay(t, size);
  EXPECT_EQ(Points(t).size(), 500u + 8u);
}
