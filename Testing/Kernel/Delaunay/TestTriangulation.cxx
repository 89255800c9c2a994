// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Triangulation<D> against a brute-force oracle after every insertion and removal.
#include "Delaunay/Triangulation.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/**
 * Inserts all points, then removes those off the box in random order, checking after every step; the
 * result of removal must be the triangulation of what is left, inserted in another order.
 */
template <int D>
void InsertAndRemove(std::vector<Point<D>> points, double size, unsigned seed)
{
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  Triangulation<D> t(UnitBox<D>(size));
  typename Triangulation<D>::Worker worker(t);
  ExpectDelaunay(t, size);
  std::vector<Point<D>> inside;
  for (const Point<D>& p : points)
  {
    const InsertionOutcome outcome = Insert(t, worker, p, KindOf<D>(p, size));
    const bool corner =
      std::all_of(p.begin(), p.end(), [&](double x) { return x == 0.0 || x == size; });
    ASSERT_EQ(outcome, corner ? InsertionOutcome::Duplicate : InsertionOutcome::Inserted);
    ExpectDelaunay(t, size);
    if (::testing::Test::HasFatalFailure())
    {
      return;
    }
    if (KindOf<D>(p, size) != VertexKind::Box)
    {
      inside.push_back(p);
    }
  }
  {
    Triangulation<D> other(UnitBox<D>(size));
    typename Triangulation<D>::Worker otherWorker(other);
    std::shuffle(points.begin(), points.end(), random);
    for (const Point<D>& p : points)
    {
      Insert(other, otherWorker, p, KindOf<D>(p, size));
    }
    ASSERT_EQ(Simplices(t), Simplices(other)) << "the order of insertion matters";
  }
  std::shuffle(inside.begin(), inside.end(), random);
  while (!inside.empty())
  {
    const Point<D> p = inside.back();
    inside.pop_back();
    const SimplexSet<D> before = inside.size() % 4 == 0 ? Simplices(t) : SimplexSet<D>();
    ASSERT_EQ(t.Remove(worker, FindVertex(t, p)), RemovalOutcome::Removed);
    ExpectDelaunay(t, size);
    if (::testing::Test::HasFatalFailure())
    {
      return;
    }
    if (!before.empty())
    {
      ASSERT_EQ(Insert(t, worker, p), InsertionOutcome::Inserted);
      ASSERT_EQ(Simplices(t), before) << "insertion does not undo removal";
      ASSERT_EQ(t.Remove(worker, FindVertex(t, p)), RemovalOutcome::Removed);
    }
  }
}

} // namespace

TEST(Triangulation, RandomPoints)
{
  std::mt19937 random(1);
  InsertAndRemove<3>(RandomPoints<3>(60, 10.0, random), 10.0, 1);
  InsertAndRemove<4>(RandomPoints<4>(25, 10.0, random), 10.0, 5);
}

// Also of a spacing that is no sum of a few powers of two, and of a lattice in which no point is missing.
TEST(Triangulation, LatticePoints)
{
  std::mt19937 random(2);
  InsertAndRemove<3>(LatticePoints<3>(70, 4, 2.5, random), 10.0, 2);
  InsertAndRemove<3>(LatticePoints<3>(50, 3, 0.277, random), 3 * 0.277, 3);
  InsertAndRemove<3>(LatticePoints<3>(64, 3, 1.0, random), 3.0, 4);
  InsertAndRemove<4>(LatticePoints<4>(30, 2, 1.0, random), 2.0, 6);
}

// The cube's corners seen from its centre: the star of the only inner point is bounded by the box.
TEST(Triangulation, RemovalBesideTheHull)
{
  Triangulation<3> t(UnitBox<3>(2.0));
  Triangulation<3>::Worker worker(t);
  const SimplexSet<3> before = Simplices(t);
  ASSERT_EQ(Insert<3>(t, worker, { 1.0, 1.0, 1.0 }), InsertionOutcome::Inserted);
  ASSERT_EQ(Insert<3>(t, worker, { 1.0, 1.0, 0.5 }), InsertionOutcome::Inserted);
  ExpectDelaunay(t, 2.0);
  for (const Point<3>& p : { Point<3>{ 1.0, 1.0, 1.0 }, Point<3>{ 1.0, 1.0, 0.5 } })
  {
    ASSERT_EQ(t.Remove(worker, FindVertex(t, p)), RemovalOutcome::Removed);
  }
  EXPECT_EQ(Simplices(t), before);
  EXPECT_EQ(t.Remove(worker, 0), RemovalOutcome::OnBox);
}

TEST(Triangulation, OutcomesSayWhatHappened)
{
  Triangulation<3> t(UnitBox<3>(1.0));
  Triangulation<3>::Worker worker(t);
  ASSERT_EQ(
    Insert<3>(t, worker, { 0.5, 0.5, 0.5 }, VertexKind::Feature), InsertionOutcome::Inserted);
  EXPECT_EQ(t.GetVertex(worker.NewVertex).Kind, VertexKind::Feature);
  for (SimplexId s : worker.Created)
  {
    const auto& v = t.GetSimplex(s).V;
    EXPECT_NE(std::find(v.begin(), v.end(), worker.NewVertex), v.end());
  }
  const SimplexSet<3> before = Simplices(t);
  EXPECT_EQ(t.FindConflict(worker, { 0.5, 0.5, 0.5 }, AnyAlive(t)), None);
  for (SimplexId s = 0; s < t.SimplexIdEnd(); ++s)
  {
    if (t.IsAlive(s))
    {
      EXPECT_NE(
        t.Insert(worker, { 0.5, 0.5, 0.5 }, VertexKind::Free, s), InsertionOutcome::Inserted);
    }
  }
  const Point<3> close = { 0.5, 0.5, 0.51 };
  const SimplexId seed = t.FindConflict(worker, close, AnyAlive(t));
  EXPECT_EQ(t.Insert(worker, close, VertexKind::Feature, seed, 0.02), InsertionOutcome::TooClose);
  EXPECT_EQ(Simplices(t), before) << "a refused insertion changed the triangulation";
  EXPECT_EQ(t.Insert(worker, close, VertexKind::Feature, seed, 0.005), InsertionOutcome::Inserted);
  ExpectDelaunay(t, 1.0);
}

// Free vertices give way to feature points: they do not make them refused.
TEST(Triangulation, FreeVerticesGiveWay)
{
  Triangulation<3> t(UnitBox<3>(1.0));
  Triangulation<3>::Worker worker(t);
  ASSERT_EQ(Insert<3>(t, worker, { 0.5, 0.5, 0.5 }), InsertionOutcome::Inserted);
  const Point<3> close = { 0.5, 0.5, 0.51 };
  const SimplexId seed = t.FindConflict(worker, close, AnyAlive(t));
  EXPECT_EQ(t.Insert(worker, close, VertexKind::Free, seed, 0.02), InsertionOutcome::TooClose);
  EXPECT_EQ(t.Insert(worker, close, VertexKind::Feature, seed, 0.02), InsertionOutcome::Inserted);
}

// Many points, hint from the last insertion, ids reused: only the local checks.
TEST(Triangulation, ManyPointsAndReuse)
{
  std::mt19937 random(7);
  Triangulation<3> t(UnitBox<3>(1.0));
  Triangulation<3>::Worker worker(t);
  SimplexId hint = AnyAlive(t);
  std::vector<VertexId> vertices;
  for (const Point<3>& p : RandomPoints<3>(3000, 1.0, random))
  {
    ASSERT_EQ(t.Insert(worker, p, VertexKind::Free, t.FindConflict(worker, p, hint)),
      InsertionOutcome::Inserted);
    hint = worker.Created.Back();
    vertices.push_back(worker.NewVertex);
  }
  const SimplexId end = t.SimplexIdEnd();
  for (std::size_t i = 0; i < vertices.size(); i += 2)
  {
    ASSERT_EQ(t.Remove(worker, vertices[i]), RemovalOutcome::Removed);
  }
  ExpectSound(t);
  EXPECT_EQ(t.SimplexIdEnd(), end) << "removal should live on what it frees";
}
