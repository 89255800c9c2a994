// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Workers without locks, each in a zone of its own.
#include "Delaunay/Triangulation.h"
#include "Sanitizers.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <thread>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

constexpr double Size = 10.0;

template <int D>
HalfOpenBox<D> Everywhere()
{
  HalfOpenBox<D> box;
  box.Min.fill(-std::numeric_limits<double>::infinity());
  box.Max.fill(std::numeric_limits<double>::infinity());
  return box;
}

/** Tries to insert points by walking, which is safe as long as all simplices met are in the zone. */
template <int D>
struct ZoneThread
{
  ZoneThread(Triangulation<D>& t, const HalfOpenBox<D>& zone)
    : T(t)
    , Zone(zone)
    , Worker(t)
  {
    this->Worker.Zone = &this->Zone;
  }

  /** Inserts points in edges of the zone's own simplices, again and again. */
  void Work(const std::vector<SimplexId>& start)
  {
    std::vector<std::pair<SimplexId, std::uint32_t>> list;
    for (const SimplexId s : start)
    {
      list.push_back({ s, this->T.State(s).Generation });
    }
    for (std::size_t k = 0; k < list.size() && k < 6 * start.size(); ++k)
    {
      const auto [s, generation] = list[k];
      if (this->T.State(s).CurrentGeneration() != generation)
      {
        continue;
      }
      if (this->T.Lock(this->Worker, s, generation) != LockOutcome::Locked)
      {
        ++this->Contended;
        continue;
      }
      // The middle of an edge: its cavity is as small as any.
      const auto& simplex = this->T.GetSimplex(s);
      const Point<D> centre =
        Interpolate(this->T.Position(simplex.V[0]), this->T.Position(simplex.V[1]), 0.4);
      const InsertionOutcome outcome = this->T.Insert(this->Worker, centre, VertexKind::Free, s);
      this->Contended += outcome == InsertionOutcome::Contended ? 1 : 0;
      if (outcome == InsertionOutcome::Inserted)
      {
        this->Inserted.push_back(centre);
        for (const SimplexId created : this->Worker.Created)
        {
          list.push_back({ created, this->T.State(created).Generation });
        }
        if (++this->Insertions % 5 == 0 &&
          this->T.Remove(this->Worker, this->Worker.NewVertex) == RemovalOutcome::Removed)
        {
          this->Inserted.pop_back();
        }
      }
    }
  }

  Triangulation<D>& T;
  const HalfOpenBox<D> Zone;
  typename Triangulation<D>::Worker Worker;
  std::vector<Point<D>> Inserted;
  std::size_t Insertions = 0;
  std::size_t Contended = 0;
};

/** Two halves of the box are refined at the same time, or one after the other. */
template <int D>
std::vector<Point<D>> RefineHalves(bool atOnce, std::size_t number, SimplexSet<D>& simplices)
{
  std::mt19937 random(3);
  Triangulation<D> t(UnitBox<D>(Size));
  typename Triangulation<D>::Worker alone(t);
  for (const Point<D>& p : RandomPoints<D>(number, Size, random))
  {
    t.Insert(alone, p, VertexKind::Free, t.FindConflict(alone, p, t.FirstAlive()));
  }
  HalfOpenBox<D> lower = Everywhere<D>();
  HalfOpenBox<D> upper = lower;
  lower.Max[0] = upper.Min[0] = 0.5 * Size;
  ZoneThread<D> one(t, lower);
  ZoneThread<D> other(t, upper);
  std::vector<SimplexId> ofOne;
  std::vector<SimplexId> ofOther;
  for (const SimplexId s : AliveIn(t))
  {
    (lower.Contains(t.Position(t.GetSimplex(s).V[0])) ? ofOne : ofOther).push_back(s);
  }
  if (atOnce)
  {
    std::jthread first([&] { one.Work(ofOne); });
    std::jthread second([&] { other.Work(ofOther); });
  }
  else
  {
    other.Work(ofOther);
    one.Work(ofOne);
  }
  EXPECT_GT(one.Contended, 0u);
  EXPECT_GT(other.Contended, 0u);
  EXPECT_GT(one.Inserted.size(), number / 8);
  EXPECT_GT(other.Inserted.size(), number / 8);
  for (const Point<D>& p : one.Inserted)
  {
    EXPECT_TRUE(lower.Contains(p));
  }
  ExpectSound(t);
  simplices = Simplices(t);
  std::vector<Point<D>> points = one.Inserted;
  points.insert(points.end(), other.Inserted.begin(), other.Inserted.end());
  return points;
}

template <int D>
void TestHalves(std::size_t number)
{
  SimplexSet<D> inTurn;
  const std::vector<Point<D>> expected = RefineHalves<D>(false, number, inTurn);
  for (int run = 0; run < (Sanitized ? 2 : 5); ++run)
  {
    SimplexSet<D> atOnce;
    EXPECT_TRUE(RefineHalves<D>(true, number, atOnce) == expected);
    EXPECT_TRUE(atOnce == inTurn);
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(Zones, WhatIsDoneInOneDoesNotDependOnTheOther)
{
  TestHalves<3>(Sanitized ? 500 : 3000);
  TestHalves<4>(Sanitized ? 200 : 600);
}

TEST(Zones, HalfOpenBoxesTileSpace)
{
  HalfOpenBox<3> box{ { 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 } };
  EXPECT_TRUE(box.Contains({ 0.0, 0.5, 0.0 }));
  EXPECT_FALSE(box.Contains({ 1.0, 0.5, 0.0 }));
  EXPECT_FALSE(box.Contains({ 0.5, 0.5, -0.1 }));
  EXPECT_TRUE(box.ContainsBall({ 0.5, 0.5, 0.5 }, 0.4));
  EXPECT_FALSE(box.ContainsBall({ 0.5, 0.5, 0.5 }, 0.5)) << "its upper faces are not part of it";
  EXPECT_FALSE(box.ContainsBall({ 0.3, 0.5, 0.5 }, 0.4));
  EXPECT_TRUE(
    Everywhere<3>().ContainsBall({ 1e300, 0.0, 0.0 }, std::numeric_limits<double>::infinity()));
}
