// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Triangulation<D> under two workers, step by step: locks, and operations that have to give up.
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

/** Everything that a triangulation stores of living simplices, their ids included. */
template <int D>
std::vector<std::uint64_t> Records(const Triangulation<D>& t)
{
  std::vector<std::uint64_t> records;
  for (const SimplexId s : AliveIn(t))
  {
    const auto& simplex = t.GetSimplex(s);
    records.push_back(s);
    records.push_back(t.State(s).Generation);
    records.insert(records.end(), simplex.V.begin(), simplex.V.end());
    records.insert(records.end(), simplex.N.begin(), simplex.N.end());
  }
  for (VertexId v = 0; v < t.VertexIdEnd(); ++v)
  {
    if (t.GetVertex(v).Alive)
    {
      records.push_back(v);
      records.push_back(t.GetVertex(v).Incident);
    }
  }
  return records;
}

/** The vertices of the simplices in conflict with a point (brute force). */
template <int D>
std::set<VertexId> CavityVertices(const Triangulation<D>& t, const Point<D>& p)
{
  typename Triangulation<D>::Worker worker(t);
  std::set<VertexId> vertices;
  for (const SimplexId s : AliveIn(t))
  {
    if (t.InConflict(worker, s, p))
    {
      vertices.insert(t.GetSimplex(s).V.begin(), t.GetSimplex(s).V.end());
    }
  }
  return vertices;
}

template <int D>
std::set<VertexId> StarVertices(const Triangulation<D>& t, VertexId v)
{
  std::set<VertexId> vertices;
  for (SimplexId s = 0; s < t.SimplexIdEnd(); ++s)
  {
    const auto& w = t.GetSimplex(s).V;
    if (t.IsAlive(s) && std::find(w.begin(), w.end(), v) != w.end())
    {
      vertices.insert(w.begin(), w.end());
    }
  }
  return vertices;
}

/** A few dozen points and two workers. */
class TwoWorkers : public ::testing::Test
{
protected:
  TwoWorkers()
    : T(UnitBox<3>(1.0))
    , Alone(T)
    , One(T, 1)
    , Two(T, 2)
  {
    std::mt19937 random(1);
    for (const Point<3>& p : RandomPoints<3>(40, 1.0, random))
    {
      Insert(this->T, this->Alone, p);
      this->Inside.push_back(this->Alone.NewVertex);
    }
  }

  SimplexId Conflict(const Point<3>& p)
  {
    return this->T.FindConflict(this->Alone, p, AnyAlive(this->T));
  }
  LockOutcome Lock(Triangulation<3>::Worker& worker, SimplexId s)
  {
    return this->T.Lock(worker, s, this->T.State(s).Generation);
  }

  Triangulation<3> T;
  Triangulation<3>::Worker Alone, One, Two;
  std::vector<VertexId> Inside;
};

} // namespace

TEST_F(TwoWorkers, ALockedSimplexIsContendedUntilItIsUnlocked)
{
  const SimplexId s = this->Conflict({ 0.5, 0.5, 0.5 });
  ASSERT_EQ(this->Lock(this->One, s), LockOutcome::Locked);
  const std::array<VertexId, 4> v = this->T.GetSimplex(s).V;
  EXPECT_EQ(LockedVertices(this->T).size(), 4u);
  ASSERT_EQ(this->Lock(this->One, s), LockOutcome::Locked) << "its own locks do not hinder it";
  ASSERT_EQ(this->Lock(this->Two, s), LockOutcome::Contended);
  EXPECT_EQ(this->Two.Winner, 1);
  this->T.Unlock(this->Two);
  for (const VertexId w : v)
  {
    EXPECT_EQ(this->T.GetVertex(w).Owner, 1);
    EXPECT_FALSE(this->T.TryLock(this->Two, w));
    EXPECT_TRUE(this->T.TryLock(this->One, w));
  }
  this->T.Unlock(this->One);
  EXPECT_TRUE(LockedVertices(this->T).empty());
  EXPECT_EQ(this->Lock(this->Two, s), LockOutcome::Locked);
  EXPECT_EQ(this->Lock(this->One, s), LockOutcome::Contended);
  EXPECT_EQ(this->One.Winner, 2);
  this->T.Unlock(this->One);
  this->T.Unlock(this->Two);
  EXPECT_TRUE(LockedVertices(this->T).empty());
}

// One vertex in common is enough; what was taken before the conflict was met is given back.
TEST_F(TwoWorkers, ASimplexIsContendedIfOneVertexIs)
{
  const SimplexId s = this->Conflict({ 0.5, 0.5, 0.5 });
  for (const VertexId w : this->T.GetSimplex(s).V)
  {
    ASSERT_TRUE(this->T.TryLock(this->One, w));
    EXPECT_EQ(this->Lock(this->Two, s), LockOutcome::Contended);
    EXPECT_EQ(this->Two.Winner, 1);
    this->T.Unlock(this->Two);
    EXPECT_EQ(LockedVertices(this->T), std::vector<VertexId>{ w });
    this->T.Unlock(this->One);
  }
}

TEST_F(TwoWorkers, ADeadSimplexCannotBeLocked)
{
  const Point<3> p = { 0.5, 0.5, 0.5 };
  const SimplexId seed = this->Conflict(p);
  struct Entry
  {
    SimplexId Id;
    std::uint32_t Generation;
  };
  std::vector<Entry> before;
  for (const SimplexId s : AliveIn(this->T))
  {
    if (this->T.InConflict(this->Alone, s, p))
    {
      before.push_back({ s, this->T.State(s).Generation });
    }
  }
  ASSERT_EQ(this->Lock(this->One, seed), LockOutcome::Locked);
  ASSERT_EQ(this->T.Insert(this->One, p, VertexKind::Free, seed), InsertionOutcome::Inserted);
  ASSERT_EQ(before.size(), this->One.Deleted.Size());
  for (const Entry& e : before)
  {
    EXPECT_EQ(this->T.Lock(this->Two, e.Id, e.Generation), LockOutcome::Dead)
      << "although its vertices are locked";
  }
  this->T.Unlock(this->Two);
  this->T.Unlock(this->One);
  // Now their ids are used again.
  ASSERT_EQ(this->T.Remove(this->Alone, this->One.NewVertex), RemovalOutcome::Removed);
  for (const Entry& e : before)
  {
    EXPECT_EQ(this->T.Lock(this->Two, e.Id, e.Generation), LockOutcome::Dead);
    this->T.Unlock(this->Two);
  }
  EXPECT_EQ(this->T.Lock(this->Alone, before[0].Id, before[0].Generation), LockOutcome::Dead);
  EXPECT_TRUE(LockedVertices(this->T).empty());
}

TEST_F(TwoWorkers, AWorkerThatIsAloneTakesNoLocks)
{
  const SimplexId seed = this->Conflict({ 0.4, 0.5, 0.6 });
  EXPECT_EQ(this->Lock(this->Alone, seed), LockOutcome::Locked);
  EXPECT_EQ(this->T.Insert(this->Alone, { 0.4, 0.5, 0.6 }, VertexKind::Free, seed),
    InsertionOutcome::Inserted);
  EXPECT_TRUE(LockedVertices(this->T).empty());
}

// If another worker owns any vertex of the cavity, nothing changes, and it can be tried again.
TEST_F(TwoWorkers, AContendedInsertionChangesNothing)
{
  const Point<3> p = { 0.45, 0.55, 0.5 };
  const std::vector<std::uint64_t> before = Records(this->T);
  const SimplexId seed = this->Conflict(p);
  const std::array<VertexId, 4> own = this->T.GetSimplex(seed).V;
  const std::set<VertexId> cavity = CavityVertices(this->T, p);
  ASSERT_GT(cavity.size(), 4u);
  for (const VertexId v : cavity)
  {
    if (std::find(own.begin(), own.end(), v) != own.end())
    {
      continue;
    }
    ASSERT_TRUE(this->T.TryLock(this->Two, v));
    ASSERT_EQ(this->Lock(this->One, seed), LockOutcome::Locked);
    EXPECT_EQ(this->T.Insert(this->One, p, VertexKind::Free, seed), InsertionOutcome::Contended);
    EXPECT_EQ(this->One.Winner, 2);
    EXPECT_EQ(this->One.NumberOfCreated, 0u);
    this->T.Unlock(this->One);
    EXPECT_EQ(LockedVertices(this->T), std::vector<VertexId>{ v });
    EXPECT_TRUE(Records(this->T) == before);
    ExpectSound(this->T);
    this->T.Unlock(this->Two);
  }
  ASSERT_EQ(this->Lock(this->One, seed), LockOutcome::Locked);
  EXPECT_EQ(this->T.Insert(this->One, p, VertexKind::Free, seed), InsertionOutcome::Inserted);
  std::vector<VertexId> locked(cavity.begin(), cavity.end());
  locked.push_back(this->One.NewVertex);
  std::sort(locked.begin(), locked.end());
  EXPECT_EQ(LockedVertices(this->T), locked) << "the cavity and the new vertex, nothing else";
  this->T.Unlock(this->One);
  ExpectDelaunay(this->T, 1.0);
}

TEST_F(TwoWorkers, AContendedRemovalChangesNothing)
{
  const std::vector<std::uint64_t> before = Records(this->T);
  const VertexId doomed = this->Inside[17];
  const std::set<VertexId> star = StarVertices(this->T, doomed);
  for (const VertexId v : star)
  {
    if (v == doomed)
    {
      continue;
    }
    ASSERT_TRUE(this->T.TryLock(this->Two, v));
    ASSERT_TRUE(this->T.TryLock(this->One, doomed));
    EXPECT_EQ(this->T.Remove(this->One, doomed), RemovalOutcome::Contended);
    EXPECT_EQ(this->One.Winner, 2);
    this->T.Unlock(this->One);
    EXPECT_EQ(LockedVertices(this->T), std::vector<VertexId>{ v });
    EXPECT_TRUE(Records(this->T) == before);
    EXPECT_TRUE(this->T.GetVertex(doomed).Alive);
    ExpectSound(this->T);
    this->T.Unlock(this->Two);
  }
  ASSERT_TRUE(this->T.TryLock(this->One, doomed));
  EXPECT_EQ(this->T.Remove(this->One, doomed), RemovalOutcome::Removed);
  EXPECT_EQ(LockedVertices(this->T), std::vector<VertexId>(star.begin(), star.end()));
  this->T.Unlock(this->One);
  EXPECT_FALSE(this->T.GetVertex(doomed).Alive);
  ExpectDelaunay(this->T, 1.0);
}

TEST_F(TwoWorkers, ARefusedInsertionKeepsItsLocksAndChangesNothing)
{
  const Point<3> v = this->T.Position(this->Inside[5]);
  const Point<3> p = { v[0] + 1e-3, v[1], v[2] };
  const SimplexId seed = this->Conflict(p);
  const std::vector<std::uint64_t> before = Records(this->T);
  ASSERT_EQ(this->Lock(this->One, seed), LockOutcome::Locked);
  EXPECT_EQ(this->T.Insert(this->One, p, VertexKind::Free, seed, 0.01), InsertionOutcome::TooClose);
  const std::set<VertexId> cavity = CavityVertices(this->T, p);
  EXPECT_EQ(LockedVertices(this->T), std::vector<VertexId>(cavity.begin(), cavity.end()));
  this->T.Unlock(this->One);
  EXPECT_TRUE(Records(this->T) == before);
  ExpectSound(this->T);
}

// Somebody may have guessed that a vertex belongs to a simplex that died meanwhile.
TEST_F(TwoWorkers, AFreedVertexThatIsLockedIsNotReused)
{
  const auto insert = [this](const Point<3>& p)
  {
    const SimplexId seed = this->Conflict(p);
    EXPECT_EQ(this->Lock(this->One, seed), LockOutcome::Locked);
    EXPECT_EQ(this->T.Insert(this->One, p, VertexKind::Free, seed), InsertionOutcome::Inserted);
    this->T.Unlock(this->One);
    return this->One.NewVertex;
  };
  const VertexId v = insert({ 0.3, 0.4, 0.5 });
  ASSERT_TRUE(this->T.TryLock(this->One, v));
  ASSERT_EQ(this->T.Remove(this->One, v), RemovalOutcome::Removed);
  this->T.Unlock(this->One);

  ASSERT_TRUE(this->T.TryLock(this->Two, v));
  EXPECT_NE(insert({ 0.6, 0.4, 0.5 }), v);
  EXPECT_FALSE(this->T.GetVertex(v).Alive);
  EXPECT_EQ(LockedVertices(this->T), std::vector<VertexId>{ v });
  this->T.Unlock(this->Two);

  const VertexId w = insert({ 0.3, 0.4, 0.6 });
  ASSERT_TRUE(this->T.TryLock(this->One, w));
  ASSERT_EQ(this->T.Remove(this->One, w), RemovalOutcome::Removed);
  this->T.Unlock(this->One);
  EXPECT_EQ(insert({ 0.3, 0.45, 0.6 }), w) << "otherwise it is";
  ExpectDelaunay(this->T, 1.0);
}

// Assertions are on in builds with a sanitizer. They find a worker that changes a simplex without its locks.
#ifndef NDEBUG
using TwoWorkersDeathTest = TwoWorkers;

TEST_F(TwoWorkersDeathTest, NobodyRemovesAVertexThatItDoesNotOwn)
{
  EXPECT_DEATH(this->T.Remove(this->One, this->Inside[0]), "Owns");
}

TEST_F(TwoWorkersDeathTest, NobodyInsertsFromASimplexThatItDoesNotOwn)
{
  const Point<3> p = { 0.4, 0.5, 0.6 };
  const SimplexId seed = this->Conflict(p);
  EXPECT_DEATH(this->T.Insert(this->One, p, VertexKind::Free, seed), "OwnsFacet");
}

TEST_F(TwoWorkersDeathTest, NobodyDeletesACavityThatItOwnsNoMore)
{
  struct Careless final : Triangulation<3>::InsertionVeto
  {
    bool Accepts(const Triangulation<3>::Worker&) override
    {
      this->T.Unlock(this->Own);
      return true;
    }
    Triangulation<3>& T;
    Triangulation<3>::Worker& Own;
    Careless(Triangulation<3>& t, Triangulation<3>::Worker& own)
      : T(t)
      , Own(own)
    {
    }
  };
  const Point<3> p = { 0.4, 0.5, 0.6 };
  const SimplexId seed = this->Conflict(p);
  ASSERT_EQ(this->Lock(this->One, seed), LockOutcome::Locked);
  Careless careless(this->T, this->One);
  EXPECT_DEATH(this->T.Insert(this->One, p, VertexKind::Free, seed, 0.0, &careless), "OwnsAll");
}
#endif
