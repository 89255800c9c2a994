// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Triangulation<D> against a brute-force oracle after every insertion and removal.
#include "Delaunay/Triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <vector>

using namespace voxplex;

namespace
{

template <int D>
Box<D> UnitBox(double size)
{
  Box<D> box;
  box.Min.fill(0.0);
  box.Max.fill(size);
  return box;
}

template <int D>
using SimplexSet = std::set<std::array<Point<D>, D + 1>>;

/** The simplices by the coordinates of their vertices, so that numbering does not matter. */
template <int D>
SimplexSet<D> Simplices(const Triangulation<D>& t)
{
  SimplexSet<D> simplices;
  for (SimplexId s = 0; s < t.SimplexIdEnd(); ++s)
  {
    if (t.IsAlive(s))
    {
      std::array<Point<D>, D + 1> points;
      for (unsigned i = 0; i <= D; ++i)
      {
        points[i] = t.Position(t.GetSimplex(s).V[i]);
      }
      std::sort(points.begin(), points.end());
      simplices.insert(points);
    }
  }
  return simplices;
}

template <int D>
std::vector<Point<D>> Points(const Triangulation<D>& t)
{
  std::vector<Point<D>> points;
  for (VertexId v = 0; v < t.VertexIdEnd(); ++v)
  {
    if (t.GetVertex(v).Alive)
    {
      points.push_back(t.Position(v));
    }
  }
  return points;
}

/** Every simplex of the triangulation must have no other vertex in conflict, and fill the box. */
template <int D>
void ExpectDelaunay(const Triangulation<D>& t, double size)
{
  typename Triangulation<D>::Worker worker(t);
  const std::vector<std::string> complaints = t.Verify(worker);
  ASSERT_TRUE(complaints.empty()) << complaints.front();
  const std::vector<Point<D>> points = Points(t);
  double volume = 0.0;
  std::set<Point<D>> used;
  for (SimplexId s = 0; s < t.SimplexIdEnd(); ++s)
  {
    if (!t.IsAlive(s))
    {
      continue;
    }
    std::array<const Point<D>*, D + 1> p;
    for (unsigned i = 0; i <= D; ++i)
    {
      p[i] = &t.Position(t.GetSimplex(s).V[i]);
      used.insert(*p[i]);
    }
    for (const Point<D>& q : points)
    {
      const bool own = std::any_of(p.begin(), p.end(), [&](const Point<D>* x) { return *x == q; });
      ASSERT_TRUE(own || !worker.Predicates.InSpherePerturbed(p.data(), q));
      ASSERT_EQ(t.InConflict(worker, s, q), false);
    }
    // Gaussian elimination of the edge matrix
    std::array<Point<D>, D> m;
    for (unsigned i = 0; i < D; ++i)
    {
      m[i] = Subtract(*p[i + 1], *p[0]);
    }
    double det = 1.0;
    for (unsigned c = 0; c < D; ++c)
    {
      unsigned pivot = c;
      for (unsigned r = c + 1; r < D; ++r)
      {
        pivot = std::abs(m[r][c]) > std::abs(m[pivot][c]) ? r : pivot;
      }
      std::swap(m[c], m[pivot]);
      det *= m[c][c];
      for (unsigned r = c + 1; r < D && m[c][c] != 0.0; ++r)
      {
        const double f = m[r][c] / m[c][c];
        for (unsigned k = c; k < D; ++k)
        {
          m[r][k] -= f * m[c][k];
        }
      }
    }
    volume += std::abs(det);
  }
  ASSERT_EQ(used.size(), points.size());
  double factorial = 1.0;
  for (int i = 2; i <= D; ++i)
  {
    factorial *= i;
  }
  ASSERT_NEAR(volume / factorial, std::pow(size, D), 1e-9 * std::pow(size, D));
}

template <int D>
SimplexId AnyAlive(const Triangulation<D>& t)
{
  SimplexId s = 0;
  while (!t.IsAlive(s))
  {
    ++s;
  }
  return s;
}

template <int D>
InsertionOutcome Insert(Triangulation<D>& t, typename Triangulation<D>::Worker& w,
  const Point<D>& p, VertexKind kind = VertexKind::Free)
{
  const SimplexId seed = t.FindConflict(w, p, AnyAlive(t));
  return seed == None ? InsertionOutcome::Duplicate : t.Insert(w, p, kind, seed);
}

template <int D>
VertexId FindVertex(const Triangulation<D>& t, const Point<D>& p)
{
  for (VertexId v = 0; v < t.VertexIdEnd(); ++v)
  {
    if (t.GetVertex(v).Alive && t.Position(v) == p)
    {
      return v;
    }
  }
  return None;
}

template <int D>
std::vector<Point<D>> RandomPoints(int n, double size, std::mt19937& random)
{
  std::uniform_real_distribution<double> uniform(0.0, size);
  std::vector<Point<D>> points(static_cast<std::size_t>(n));
  for (Point<D>& p : points)
  {
    for (double& x : p)
    {
      x = uniform(random);
    }
  }
  return points;
}

/** Distinct points of a lattice, faces, edges and corners of the box among them. */
template <int D>
std::vector<Point<D>> LatticePoints(int n, int side, double spacing, std::mt19937& random)
{
  std::uniform_int_distribution<int> uniform(0, side);
  std::set<Point<D>> points;
  while (points.size() < static_cast<std::size_t>(n))
  {
    Point<D> p;
    for (double& x : p)
    {
      x = spacing * uniform(random);
    }
    points.insert(p);
  }
  std::vector<Point<D>> shuffled(points.begin(), points.end());
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  return shuffled;
}

template <int D>
VertexKind KindOf(const Point<D>& p, double size)
{
  const bool onBox =
    std::any_of(p.begin(), p.end(), [&](double x) { return x == 0.0 || x == size; });
  return onBox ? VertexKind::Box : VertexKind::Free;
}

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

TEST(Triangulation, RandomPoints3D)
{
  std::mt19937 random(1);
  InsertAndRemove<3>(RandomPoints<3>(60, 10.0, random), 10.0, 1);
}

TEST(Triangulation, LatticePoints3D)
{
  std::mt19937 random(2);
  InsertAndRemove<3>(LatticePoints<3>(70, 4, 2.5, random), 10.0, 2);
}

TEST(Triangulation, LatticeWithNonDyadicSpacing3D)
{
  std::mt19937 random(3);
  InsertAndRemove<3>(LatticePoints<3>(50, 3, 0.277, random), 3 * 0.277, 3);
}

TEST(Triangulation, FullLattice3D)
{
  std::mt19937 random(4);
  InsertAndRemove<3>(LatticePoints<3>(64, 3, 1.0, random), 3.0, 4);
}

TEST(Triangulation, RandomPoints4D)
{
  std::mt19937 random(5);
  InsertAndRemove<4>(RandomPoints<4>(25, 10.0, random), 10.0, 5);
}

TEST(Triangulation, LatticePoints4D)
{
  std::mt19937 random(6);
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
  const std::vector<std::string> complaints = t.Verify(worker);
  EXPECT_TRUE(complaints.empty()) << complaints.front();
  EXPECT_EQ(t.SimplexIdEnd(), end) << "removal should live on what it frees";
}
