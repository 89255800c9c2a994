// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Points to triangulate, and a brute-force oracle of what the triangulation of them is.
#ifndef voxplex_TriangulationChecks_h
#define voxplex_TriangulationChecks_h

#include "Delaunay/Triangulation.h"
#include "MeshChecks.h"
#include "TriangulationVerifier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace voxplex::checks
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
  for (const SimplexId s : AliveIn(t))
  {
    std::array<Point<D>, D + 1> points;
    for (unsigned i = 0; i <= D; ++i)
    {
      points[i] = t.Position(t.GetSimplex(s).V[i]);
    }
    std::sort(points.begin(), points.end());
    simplices.insert(points);
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
  const std::vector<std::string> complaints = checks::Verify(t);
  ASSERT_TRUE(complaints.empty()) << complaints.front();
  typename Triangulation<D>::Worker worker(t);
  const std::vector<Point<D>> points = Points(t);
  double volume = 0.0;
  std::set<Point<D>> used;
  for (const SimplexId s : AliveIn(t))
  {
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
    std::array<Point<D>, D> edges;
    for (unsigned i = 0; i < D; ++i)
    {
      edges[i] = Subtract(*p[i + 1], *p[0]);
    }
    volume += std::abs(Determinant(edges));
  }
  ASSERT_EQ(used.size(), points.size());
  ASSERT_NEAR(volume / (D == 3 ? 6.0 : 24.0), std::pow(size, D), 1e-9 * std::pow(size, D));
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

/** A point of numbers that are drawn one after the other. */
template <int D, typename Draw>
Point<D> Drawn(Draw&& draw)
{
  Point<D> p;
  for (double& x : p)
  {
    x = draw();
  }
  return p;
}

template <int D>
std::vector<Point<D>> RandomPoints(int n, double size, std::mt19937& random)
{
  std::uniform_real_distribution<double> uniform(0.0, size);
  std::vector<Point<D>> points(static_cast<std::size_t>(n));
  for (Point<D>& p : points)
  {
    p = Drawn<D>([&] { return uniform(random); });
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
    points.insert(Drawn<D>([&] { return spacing * uniform(random); }));
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

/** Vertices that some worker owns. */
template <int D>
std::vector<VertexId> LockedVertices(const Triangulation<D>& t)
{
  std::vector<VertexId> locked;
  for (VertexId v = 0; v < t.VertexIdEnd(); ++v)
  {
    if (t.GetVertex(v).Owner != 0)
    {
      locked.push_back(v);
    }
  }
  return locked;
}

template <int D>
void ExpectSound(const Triangulation<D>& t)
{
  const std::vector<std::string> complaints = checks::Verify(t);
  EXPECT_TRUE(complaints.empty()) << complaints.size()
                                  << " complaints, first: " << complaints.front();
}

/** Sound, and nobody owns anything any more. */
template <int D>
void ExpectSoundAndUnlocked(const Triangulation<D>& t)
{
  ExpectSound(t);
  EXPECT_TRUE(LockedVertices(t).empty());
}

} // namespace voxplex::checks

#endif
