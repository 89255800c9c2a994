// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Storms: several threads insert and remove points of one triangulation, and what must come of it.
#ifndef voxplex_TriangulationStorm_h
#define voxplex_TriangulationStorm_h

#include "Delaunay/Triangulation.h"
#include "Parallel/LoopSharing.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <latch>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace voxplex::checks
{

/** What becomes of points on the box: they are of kind Box and stay, or are as any others. */
enum class OnBox
{
  Stays,
  MayGo
};

template <int D>
VertexKind KindOf(const Point<D>& p, double size, OnBox onBox)
{
  return onBox == OnBox::Stays ? KindOf<D>(p, size) : VertexKind::Free;
}

//------------------------------------------------------------------------------------------------
/** One thread's part of a storm. */
template <int D>
class StormThread
{
public:
  using Kernel = Triangulation<D>;

  StormThread(Kernel& t, WorkerId id, double size, std::vector<Point<D>> points, OnBox onBox)
    : T(t)
    , Worker(t, id)
    , Id(id)
    , Size(size)
    , ToInsert(std::move(points))
    , PointsOnBox(onBox)
    , Random(id)
  {
  }

  using Team = std::vector<typename Kernel::Worker*>;

  /** From now on a thread that would wait helps another one. */
  void HelpEachOther(LoopSharing& sharing, Team& team)
  {
    this->Worker.Help.Sharing = &sharing;
    this->Worker.Help.Number = static_cast<unsigned>(team.size());
    this->Worker.Help.Team = &team;
    this->Worker.Help.FewestSimplices = 1;
    this->Worker.Help.FewestBalls = 1;
    this->Worker.Help.Grain = 1 + team.size() % 3;
    team.push_back(&this->Worker);
  }

  /** Helps until all threads have done what is theirs. */
  void HelpOthers(const std::atomic<unsigned>& working)
  {
    while (this->Worker.Help.Sharing && working != 0)
    {
      this->Worker.Help.Sharing->HelpUntil(
        this->Worker.Help.Number, [&working]() { return working == 0; });
    }
  }

  /** Inserts all of its points, half of the free ones for a while only. */
  void Run()
  {
    for (const Point<D>& p : this->ToInsert)
    {
      if (!this->InsertPoint(p))
      {
        continue;
      }
      const bool stays = this->KindOfPoint(p) == VertexKind::Box || this->Chance(2);
      (stays ? this->Staying : this->Doomed).push_back({ p, this->Worker.NewVertex });
      if (!this->Doomed.empty() && this->Chance(2))
      {
        this->RemoveOne();
      }
    }
    while (!this->Doomed.empty())
    {
      this->RemoveOne();
    }
  }

  std::vector<Point<D>> Survivors() const
  {
    std::vector<Point<D>> points;
    for (const Inserted& i : this->Staying)
    {
      points.push_back(i.Position);
    }
    return points;
  }

  std::uint64_t Contended = 0;
  std::uint64_t Duplicates = 0;

private:
  struct Inserted
  {
    Point<D> Position;
    VertexId Id;
  };
  struct Met
  {
    SimplexId Id;
    std::uint32_t Generation;
  };

  VertexKind KindOfPoint(const Point<D>& p) const
  {
    return KindOf<D>(p, this->Size, this->PointsOnBox);
  }

  bool Chance(unsigned oneIn) { return this->Random() % oneIn == 0; }

  /** Others are likely to run now, even if this one holds locks. */
  void MayYield()
  {
    if (this->Chance(8))
    {
      std::this_thread::yield();
    }
  }

  /** Gives all back and lets time pass; false if the operation under way has lost too often. */
  bool RollBack()
  {
    this->T.Unlock(this->Worker);
    ++this->Contended;
    ++this->LostInARow;
    if (this->Worker.Help.Sharing)
    {
      unsigned looks = static_cast<unsigned>(this->Random() % 64);
      this->Worker.Help.Sharing->HelpUntil(
        this->Worker.Help.Number, [&looks]() { return looks-- == 0; });
    }
    std::this_thread::yield();
    if (this->Contended % 64 == 0)
    {
      std::this_thread::sleep_for(std::chrono::microseconds(this->Random() % 100));
    }
    if (this->LostInARow > MostLost)
    {
      ADD_FAILURE() << "no progress";
      return false;
    }
    return true;
  }

  /** A vertex that stays for the whole storm. */
  VertexId AnyStaying()
  {
    return this->Staying.empty() || this->Chance(8)
      ? static_cast<VertexId>(this->Random() % (1u << D)) // a corner of the box
      : this->Staying[this->Random() % this->Staying.size()].Id;
  }

  /** A simplex of the star of a vertex that stays. */
  bool Restart(Met& met)
  {
    for (;;)
    {
      const VertexId v = this->AnyStaying();
      if (this->T.TryLock(this->Worker, v))
      {
        met.Id = this->T.GetVertex(v).Incident;
        met.Generation = this->T.State(met.Id).CurrentGeneration();
        this->T.Unlock(this->Worker);
        return true;
      }
      if (!this->RollBack())
      {
        return false;
      }
    }
  }

  void ExpectOwned(SimplexId s)
  {
    EXPECT_TRUE(this->T.IsAlive(s));
    for (const VertexId v : this->T.GetSimplex(s).V)
    {
      EXPECT_TRUE(this->T.GetVertex(v).Alive);
      EXPECT_EQ(this->OwnerOf(v), this->Id);
    }
  }

  WorkerId OwnerOf(VertexId v) const
  {
    // const_cast: atomic_ref to const is not in C++20; only read here
    return std::atomic_ref<WorkerId>(const_cast<WorkerId&>(this->T.GetVertex(v).Owner))
      .load(std::memory_order_relaxed);
  }

  enum class Place
  {
    InConflict, ///< the simplex is locked
    IsVertex,   ///< so is this one
    Nowhere     ///< stuck
  };

  /** Walks towards p, one simplex locked at a time. */
  Place Locate(const Point<D>& p, Met& met)
  {
    if (!this->Restart(met))
    {
      return Place::Nowhere;
    }
    for (;;)
    {
      const LockOutcome outcome = this->T.Lock(this->Worker, met.Id, met.Generation);
      if (outcome == LockOutcome::Locked)
      {
        this->ExpectOwned(met.Id);
        this->MayYield();
        if (this->T.InConflict(this->Worker, met.Id, p))
        {
          return Place::InConflict;
        }
        for (const VertexId v : this->T.GetSimplex(met.Id).V)
        {
          if (this->T.Position(v) == p)
          {
            return Place::IsVertex;
          }
        }
        const SimplexId next = this->NextTowards(met.Id, p);
        if (next == None)
        {
          ADD_FAILURE() << "a simplex contains a point but does not conflict with it";
          return Place::Nowhere;
        }
        met = { next, this->T.State(next).CurrentGeneration() };
        this->T.Unlock(this->Worker);
        continue;
      }
      if (!this->RollBack() || (outcome == LockOutcome::Dead && !this->Restart(met)))
      {
        return Place::Nowhere;
      }
    }
  }

  SimplexId NextTowards(SimplexId s, const Point<D>& p)
  {
    const auto& simplex = this->T.GetSimplex(s);
    std::array<const Point<D>*, D + 1> points;
    for (unsigned i = 0; i <= D; ++i)
    {
      points[i] = &this->T.Position(simplex.V[i]);
    }
    const unsigned first = static_cast<unsigned>(this->Random() % (D + 1));
    for (unsigned k = 0; k <= D; ++k)
    {
      const unsigned i = (first + k) % (D + 1);
      const Point<D>* vertex = points[i];
      points[i] = &p;
      if (simplex.N[i] != None && this->Worker.Predicates.Orientation(points.data()) < 0)
      {
        return simplex.N[i];
      }
      points[i] = vertex;
    }
    return None;
  }

  bool InsertPoint(const Point<D>& p)
  {
    this->LostInARow = 0;
    for (;;)
    {
      Met met;
      const Place place = this->Locate(p, met);
      if (place != Place::InConflict)
      {
        this->Duplicates += place == Place::IsVertex ? 1 : 0;
        this->T.Unlock(this->Worker);
        return false;
      }
      const InsertionOutcome outcome =
        this->T.Insert(this->Worker, p, this->KindOfPoint(p), met.Id);
      this->MayYield();
      if (outcome == InsertionOutcome::Inserted)
      {
        for (const SimplexId s : this->Worker.Created)
        {
          this->ExpectOwned(s);
        }
        this->T.Unlock(this->Worker);
        return true;
      }
      EXPECT_EQ(outcome, InsertionOutcome::Contended);
      if (!this->RollBack())
      {
        return false;
      }
    }
  }

  void RemoveOne()
  {
    this->LostInARow = 0;
    std::swap(this->Doomed[this->Random() % this->Doomed.size()], this->Doomed.back());
    const Inserted doomed = this->Doomed.back();
    this->Doomed.pop_back();
    for (;;)
    {
      if (this->T.TryLock(this->Worker, doomed.Id))
      {
        EXPECT_EQ(this->T.Position(doomed.Id), doomed.Position);
        const RemovalOutcome outcome = this->T.Remove(this->Worker, doomed.Id);
        this->MayYield();
        if (outcome == RemovalOutcome::Removed)
        {
          this->T.Unlock(this->Worker);
          return;
        }
        EXPECT_EQ(outcome, RemovalOutcome::Contended);
      }
      if (!this->RollBack())
      {
        return;
      }
    }
  }

  Kernel& T;
  typename Kernel::Worker Worker;
  const WorkerId Id;
  const double Size;
  const std::vector<Point<D>> ToInsert;
  const OnBox PointsOnBox;
  std::vector<Inserted> Staying;
  std::vector<Inserted> Doomed;
  std::minstd_rand Random;
  /** Counted, not timed: a loaded machine makes a storm slow, but an operation loses no more often. */
  static constexpr std::uint64_t MostLost = 5'000'000;
  std::uint64_t LostInARow = 0; ///< rollbacks of the operation under way
};

/** All points, each for one thread, or each for all if shared. At a sharing threads help each other. */
template <int D>
std::vector<std::unique_ptr<StormThread<D>>> Storm(Triangulation<D>& t,
  const std::vector<Point<D>>& points, double size, unsigned threads, bool shared = false,
  LoopSharing* sharing = nullptr, OnBox onBox = OnBox::Stays)
{
  typename StormThread<D>::Team team;
  std::vector<std::unique_ptr<StormThread<D>>> storm;
  for (unsigned k = 0; k < threads; ++k)
  {
    std::vector<Point<D>> own;
    for (std::size_t i = shared ? 0 : k; i < points.size(); i += shared ? 1 : threads)
    {
      own.push_back(points[i]);
    }
    storm.push_back(std::make_unique<StormThread<D>>(
      t, static_cast<WorkerId>(k + 1), size, std::move(own), onBox));
  }
  for (const auto& thread : storm)
  {
    if (sharing)
    {
      thread->HelpEachOther(*sharing, team);
    }
  }
  std::atomic<unsigned> working{ threads };
  std::latch start(static_cast<std::ptrdiff_t>(threads));
  std::vector<std::jthread> running;
  for (const auto& thread : storm)
  {
    running.emplace_back(
      [&]
      {
        start.arrive_and_wait();
        thread->Run();
        --working;
        thread->HelpOthers(working);
      });
  }
  running.clear();
  return storm;
}

template <int D>
void ExpectTriangulationOf(const Triangulation<D>& t, const std::vector<Point<D>>& points,
  double size, OnBox onBox = OnBox::Stays)
{
  ExpectSoundAndUnlocked(t);
  Triangulation<D> sequential(UnitBox<D>(size));
  typename Triangulation<D>::Worker worker(sequential);
  SimplexId hint = AnyAlive(sequential);
  for (const Point<D>& p : points)
  {
    const SimplexId seed = sequential.FindConflict(worker, p, hint);
    ASSERT_NE(seed, None);
    ASSERT_EQ(
      sequential.Insert(worker, p, KindOf<D>(p, size, onBox), seed), InsertionOutcome::Inserted);
    hint = worker.Created.Back();
  }
  EXPECT_TRUE(Simplices(t) == Simplices(sequential)) << "not the triangulation of what is left";
  EXPECT_EQ(Points(t).size(), points.size() + (1u << D));
}

/** A storm, and all that can be said of its result. @return how often threads met */
template <int D>
std::uint64_t StormAndCheck(const std::vector<Point<D>>& points, double size, unsigned threads,
  bool brute = false, LoopSharing* sharing = nullptr, OnBox onBox = OnBox::Stays)
{
  SCOPED_TRACE(std::to_string(threads) + " threads, " + std::to_string(points.size()) + " points");
  Triangulation<D> t(UnitBox<D>(size));
  std::vector<Point<D>> survivors;
  std::uint64_t contended = 0;
  for (const auto& thread : Storm(t, points, size, threads, false, sharing, onBox))
  {
    const std::vector<Point<D>> own = thread->Survivors();
    survivors.insert(survivors.end(), own.begin(), own.end());
    contended += thread->Contended;
  }
  ExpectTriangulationOf(t, survivors, size, onBox);
  if (brute)
  {
    ExpectDelaunay(t, size);
  }
  return contended;
}

/** Corners of the box are vertices already. */
template <int D>
std::vector<Point<D>> WithoutCorners(std::vector<Point<D>> points, double size)
{
  std::erase_if(points,
    [&](const Point<D>& p)
    { return std::all_of(p.begin(), p.end(), [&](double x) { return x == 0.0 || x == size; }); });
  return points;
}

} // namespace voxplex::checks

#endif
