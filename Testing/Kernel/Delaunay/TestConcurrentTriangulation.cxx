// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Triangulation<D> under several workers: storms of insertions and removals whose result must be what one
// worker makes of the surviving points.
#include "Delaunay/ChunkedArray.h"
#include "Delaunay/Triangulation.h"
#include "Sanitizers.h"
#include "TriangulationChecks.h"
#include "TriangulationStorm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <latch>
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

constexpr int Fraction = Sanitized ? 4 : 1;

} // namespace

//------------------------------------------------------------------------------------------------
TEST(TriangulationStorm, RandomPoints)
{
  std::mt19937 random(1);
  std::uint64_t contended = 0;
  for (const unsigned threads : { 2u, 4u, 8u })
  {
    contended += StormAndCheck<3>(RandomPoints<3>(20000 / Fraction, 10.0, random), 10.0, threads);
    StormAndCheck<4>(RandomPoints<4>(1000 / Fraction, 10.0, random), 10.0, threads);
  }
  EXPECT_GT(contended, 0u) << "the threads never met: the test tests nothing";
}

TEST(TriangulationStorm, LatticePoints)
{
  std::mt19937 random(2);
  std::uint64_t contended = 0;
  for (const unsigned threads : { 2u, 4u, 8u })
  {
    contended += StormAndCheck<3>(
      WithoutCorners<3>(LatticePoints<3>(6000 / Fraction, 18, 0.277, random), 18 * 0.277),
      18 * 0.277, threads);
    StormAndCheck<4>(
      WithoutCorners<4>(LatticePoints<4>(800 / Fraction, 5, 1.0, random), 5.0), 5.0, threads);
  }
  EXPECT_GT(contended, 0u);
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
    ExpectSoundAndUnlocked(t);
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
  // Five seconds are enough, but not if there was nothing to test in them.
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (!over && died < 4000u / Fraction && (died == 0 || std::chrono::steady_clock::now() < end))
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
  for (int round = 0; round < (Sanitized ? 5 : 200); ++round)
  {
    // The smaller the chunks, the larger the table of them, which the thread sanitizer clears.
    ChunkedArray<std::uint32_t, 6> array(7u);
    std::latch start(Threads);
    std::vector<std::jthread> running;
    for (unsigned k = 0; k < Threads; ++k)
    {
      running.emplace_back(
        [&, k]
        {
          start.arrive_and_wait();
          for (std::uint32_t i = k; i < 16000; i += Threads)
          {
            array.Grow(i + 1);
            EXPECT_EQ(array[i], 7u);
            array[i] = i;
          }
        });
    }
    running.clear();
    for (std::uint32_t i = 0; i < 16000; ++i)
    {
      ASSERT_EQ(array[i], i);
    }
  }
}
