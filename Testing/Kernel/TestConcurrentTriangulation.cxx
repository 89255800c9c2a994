// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Triangulation<D> under several workers: storms of insertions and removals whose result must be what one
// worker makes of the surviving points.
#include "Delaunay/ChunkedArray.h"
#include "Delaunay/Triangulation.h"
#include "Sanitizers.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <latch>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#include <signal.h>
#endif

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

//------------------------------------------------------------------------------------------------
/** One thread's part of a storm. */
template <int D>
class StormThread
{
public:
  using Kernel = Triangulation<D>;

  StormThread(Kernel& t, WorkerId id, double size, std::vector<Point<D>> points)
    : T(t)
    , Worker(t, id)
    , Id(id)
    , Size(size)
    , ToInsert(std::move(points))
    , Random(id)
    , Deadline(std::chrono::steady_clock::now() + std::chrono::seconds(120))
  {
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
      const bool stays = KindOf<D>(p, this->Size) == VertexKind::Box || this->Chance(2);
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

  bool Chance(unsigned oneIn) { return this->Random() % oneIn == 0; }

  /** Others are likely to run now, whatever this one holds. */
  void MayYield()
  {
    if (this->Chance(8))
    {
      std::this_thread::yield();
    }
  }

  /** Gives all back and lets time pass; false if the storm has been stuck for long. */
  bool RollBack()
  {
    this->T.Unlock(this->Worker);
    ++this->Contended;
    std::this_thread::yield();
    if (this->Contended % 64 == 0)
    {
      std::this_thread::sleep_for(std::chrono::microseconds(this->Random() % 100));
    }
    if (std::chrono::steady_clock::now() > this->Deadline)
    {
      ADD_FAILURE() << "no progress";
      return false;
    }
    return true;
  }

  /** A simplex of the star of a vertex that stays for the whole storm. */
  bool Restart(Met& met)
  {
    for (;;)
    {
      VertexId v = static_cast<VertexId>(this->Random() % (1u << D)); // a corner of the box
      if (!this->Staying.empty() && !this->Chance(8))
      {
        v = this->Staying[this->Random() % this->Staying.size()].Id;
      }
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
        this->T.Insert(this->Worker, p, KindOf<D>(p, this->Size), met.Id);
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
  std::vector<Inserted> Staying;
  std::vector<Inserted> Doomed;
  std::minstd_rand Random;
  const std::chrono::steady_clock::time_point Deadline;
};

/** All points, each for one thread, or each for all if shared. */
template <int D>
std::vector<std::unique_ptr<StormThread<D>>> Storm(Triangulation<D>& t,
  const std::vector<Point<D>>& points, double size, unsigned threads, bool shared = false)
{
  std::vector<std::unique_ptr<StormThread<D>>> storm;
  for (unsigned k = 0; k < threads; ++k)
  {
    std::vector<Point<D>> own;
    for (std::size_t i = shared ? 0 : k; i < points.size(); i += shared ? 1 : threads)
    {
      own.push_back(points[i]);
    }
    storm.push_back(
      std::make_unique<StormThread<D>>(t, static_cast<WorkerId>(k + 1), size, std::move(own)));
  }
  std::latch start(static_cast<std::ptrdiff_t>(threads));
  std::vector<std::jthread> running;
  for (const auto& thread : storm)
  {
    running.emplace_back(
      [&]
      {
        start.arrive_and_wait();
        thread->Run();
      });
  }
  running.clear();
  return storm;
}

template <int D>
void ExpectTriangulationOf(
  const Triangulation<D>& t, const std::vector<Point<D>>& points, double size)
{
  ExpectSound(t);
  EXPECT_TRUE(LockedVertices(t).empty());
  Triangulation<D> sequential(UnitBox<D>(size));
  typename Triangulation<D>::Worker worker(sequential);
  SimplexId hint = AnyAlive(sequential);
  for (const Point<D>& p : points)
  {
    const SimplexId seed = sequential.FindConflict(worker, p, hint);
    ASSERT_NE(seed, None);
    ASSERT_EQ(sequential.Insert(worker, p, KindOf<D>(p, size), seed), InsertionOutcome::Inserted);
    hint = worker.Created.Back();
  }
  EXPECT_TRUE(Simplices(t) == Simplices(sequential)) << "not the triangulation of what is left";
  EXPECT_EQ(Points(t).size(), points.size() + (1u << D));
}

/** A storm, and all that can be said of its result. @return how often threads met */
template <int D>
std::uint64_t StormAndCheck(
  const std::vector<Point<D>>& points, double size, unsigned threads, bool brute = false)
{
  SCOPED_TRACE(std::to_string(threads) + " threads, " + std::to_string(points.size()) + " points");
  Triangulation<D> t(UnitBox<D>(size));
  std::vector<Point<D>> survivors;
  std::uint64_t contended = 0;
  for (const auto& thread : Storm(t, points, size, threads))
  {
    const std::vector<Point<D>> own = thread->Survivors();
    survivors.insert(survivors.end(), own.begin(), own.end());
    contended += thread->Contended;
  }
  ExpectTriangulationOf(t, survivors, size);
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

constexpr int Fraction = Sanitized ? 4 : 1;

} // namespace

//------------------------------------------------------------------------------------------------
TEST(TriangulationStorm, RandomPoints3D)
{
  std::mt19937 random(1);
  std::uint64_t contended = 0;
  for (const unsigned threads : { 2u, 4u, 8u })
  {
    contended += StormAndCheck<3>(RandomPoints<3>(20000 / Fraction, 10.0, random), 10.0, threads);
  }
  EXPECT_GT(contended, 0u) << "the threads never met: the test tests nothing";
}

TEST(TriangulationStorm, LatticePoints3D)
{
  std::mt19937 random(2);
  std::uint64_t contended = 0;
  for (const unsigned threads : { 2u, 4u, 8u })
  {
    contended += StormAndCheck<3>(
      WithoutCorners<3>(LatticePoints<3>(6000 / Fraction, 18, 0.277, random), 18 * 0.277),
      18 * 0.277, threads);
  }
  EXPECT_GT(contended, 0u);
}

TEST(TriangulationStorm, RandomPoints4D)
{
  std::mt19937 random(3);
  for (const unsigned threads : { 2u, 4u, 8u })
  {
    StormAndCheck<4>(RandomPoints<4>(1000 / Fraction, 10.0, random), 10.0, threads);
  }
}

TEST(TriangulationStorm, LatticePoints4D)
{
  std::mt19937 random(4);
  for (const unsigned threads : { 2u, 4u, 8u })
  {
    StormAndCheck<4>(
      WithoutCorners<4>(LatticePoints<4>(800 / Fraction, 5, 1.0, random), 5.0), 5.0, threads);
  }
}

// So few points that the threads are always in each other's way, against brute force.
TEST(TriangulationStorm, CrowdsOfThreads)
{
  for (unsigned seed = 0; seed < 60u / Fraction; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const unsigned threads = 2u << (seed % 3);
    StormAndCheck<3>(
      WithoutCorners<3>(LatticePoints<3>(60, 3, 1.0, random), 3.0), 3.0, threads, true);
    StormAndCheck<3>(RandomPoints<3>(60, 3.0, random), 3.0, threads, true);
    StormAndCheck<4>(
      WithoutCorners<4>(LatticePoints<4>(40, 2, 1.0, random), 2.0), 2.0, threads, true);
    StormAndCheck<4>(RandomPoints<4>(20, 2.0, random), 2.0, threads, true);
    if (HasFailure())
    {
      return;
    }
  }
}

// All threads want the same points on the box, which stay: each gets in once.
TEST(TriangulationStorm, EveryPointIsInsertedOnce)
{
  std::mt19937 random(6);
  const double size = 9.0;
  std::vector<Point<3>> points =
    WithoutCorners<3>(LatticePoints<3>(900 / Fraction, 9, 1.0, random), size);
  std::erase_if(points, [&](const Point<3>& p) { return KindOf<3>(p, size) != VertexKind::Box; });
  for (const unsigned threads : { 2u, 4u, 8u })
  {
    Triangulation<3> t(UnitBox<3>(size));
    std::size_t inserted = 0;
    std::size_t duplicates = 0;
    for (const auto& thread : Storm(t, points, size, threads, true))
    {
      inserted += thread->Survivors().size();
      duplicates += thread->Duplicates;
    }
    EXPECT_EQ(inserted, points.size());
    EXPECT_EQ(duplicates, (threads - 1) * points.size());
    ExpectTriangulationOf(t, points, size);
  }
}

// Removals only: first all points in one thread, then all threads tear at them.
TEST(TriangulationStorm, NothingIsLeftWhenAllRemove)
{
  std::mt19937 random(7);
  for (const unsigned threads : { 2u, 8u })
  {
    Triangulation<3> t(UnitBox<3>(10.0));
    const SimplexSet<3> empty = Simplices(t);
    Triangulation<3>::Worker alone(t);
    std::vector<VertexId> vertices;
    for (const Point<3>& p : RandomPoints<3>(4000 / Fraction, 10.0, random))
    {
      ASSERT_EQ(Insert(t, alone, p), InsertionOutcome::Inserted);
      vertices.push_back(alone.NewVertex);
    }
    std::vector<std::jthread> running;
    for (unsigned k = 0; k < threads; ++k)
    {
      running.emplace_back(
        [&, k]
        {
          Triangulation<3>::Worker worker(t, static_cast<WorkerId>(k + 1));
          std::vector<VertexId> mine;
          for (std::size_t i = k; i < vertices.size(); i += threads)
          {
            mine.push_back(vertices[i]);
          }
          // Whom it could not remove comes last.
          for (std::size_t i = 0; i < mine.size(); ++i)
          {
            if (!t.TryLock(worker, mine[i]) ||
              t.Remove(worker, mine[i]) == RemovalOutcome::Contended)
            {
              mine.push_back(mine[i]);
              std::this_thread::yield();
            }
            t.Unlock(worker);
          }
        });
    }
    running.clear();
    ExpectSound(t);
    EXPECT_TRUE(LockedVertices(t).empty());
    EXPECT_TRUE(Simplices(t) == empty);
  }
}

#if defined(__unix__) || defined(__APPLE__)
namespace
{

std::atomic<unsigned> Turns{ 0 };

/** Keeps a thread wherever it is until the other has had its turn, or cannot have it. */
void Interrupt(int)
{
  const unsigned turn = Turns;
  for (int spin = 0; spin < 20000 && Turns == turn; ++spin)
  {
  }
}

/** Meets simplices and locks them, over and over. */
void LockAllTheTime(
  Triangulation<3>& t, WorkerId id, std::atomic<bool>& over, std::atomic<std::uint64_t>& died)
{
  Triangulation<3>::Worker worker(t, id);
  SimplexId s = None;
  std::uint32_t generation = 0;
  for (unsigned turn = 0; !over; ++turn)
  {
    const VertexId corner = turn % 8;
    if (s == None && t.TryLock(worker, corner))
    {
      s = t.GetVertex(corner).Incident;
      generation = t.State(s).CurrentGeneration();
    }
    t.Unlock(worker);
    if (s == None)
    {
      continue;
    }
    const LockOutcome outcome = t.Lock(worker, s, generation);
    if (outcome == LockOutcome::Locked && t.State(s).CurrentGeneration() != generation)
    {
      ADD_FAILURE() << "locked a dead simplex";
      over = true;
    }
    if (outcome == LockOutcome::Dead)
    {
      s = None;
      ++died;
    }
    t.Unlock(worker);
  }
}

} // namespace

// The generation is read before the vertices are taken, and a simplex may die in between. The six
// simplices of the box come and go in one thread; two others lock them and are interrupted by it
// somewhere on the way.
TEST(TriangulationStorm, ALockedSimplexIsTheOneThatWasMet)
{
  const auto previous = std::signal(SIGUSR1, Interrupt);
  Triangulation<3> t(UnitBox<3>(1.0));
  std::atomic<bool> over{ false };
  std::atomic<std::uint64_t> died{ 0 };
  std::vector<std::jthread> others;
  for (const WorkerId id : { WorkerId{ 2 }, WorkerId{ 3 } })
  {
    others.emplace_back([&, id] { LockAllTheTime(t, id, over, died); });
  }
  Triangulation<3>::Worker worker(t, 1);
  std::mt19937 random(8);
  const std::vector<Point<3>> points = RandomPoints<3>(100, 1.0, random);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (!over && died < 4000u / Fraction && std::chrono::steady_clock::now() < end)
  {
    pthread_kill(others[Turns % 2].native_handle(), SIGUSR1);
    // The others give back what they own whenever they meet this one, which waits.
    for (VertexId corner = 0; corner < 8;)
    {
      corner += t.TryLock(worker, corner) ? 1 : 0;
    }
    // It owns everything, so it may search and needs no second try.
    const Point<3>& p = points[Turns % points.size()];
    const SimplexId seed = t.FindConflict(worker, p, t.GetVertex(0).Incident);
    EXPECT_EQ(t.Insert(worker, p, VertexKind::Free, seed), InsertionOutcome::Inserted);
    EXPECT_EQ(t.Remove(worker, worker.NewVertex), RemovalOutcome::Removed);
    t.Unlock(worker);
    ++Turns;
  }
  over = true;
  others.clear();
  std::signal(SIGUSR1, previous);
  EXPECT_GT(died, 0u) << "the test tests nothing";
  ExpectTriangulationOf<3>(t, {}, 1.0);
}
#endif

// Threads that need the same chunk at the same time: one chunk wins, and nothing is written to the other.
TEST(ChunkedArray, ThreadsGrowItTogether)
{
  constexpr unsigned Threads = 8;
  for (int round = 0; round < (Sanitized ? 20 : 200); ++round)
  {
    ChunkedArray<std::uint32_t, 4> array(7u);
    std::latch start(Threads);
    std::vector<std::jthread> running;
    for (unsigned k = 0; k < Threads; ++k)
    {
      running.emplace_back(
        [&, k]
        {
          start.arrive_and_wait();
          for (std::uint32_t i = k; i < 4000; i += Threads)
          {
            array.Grow(i + 1);
            EXPECT_EQ(array[i], 7u);
            array[i] = i;
          }
        });
    }
    running.clear();
    for (std::uint32_t i = 0; i < 4000; ++i)
    {
      ASSERT_EQ(array[i], i);
    }
  }
}
