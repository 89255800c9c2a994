// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// ImageMesher with several threads: as good a mesh as one thread makes, of every phantom; progress,
// cancelling, errors.
#include "Base/Error.h"
#include "CallableSize.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Phantoms.h"
#include "Sanitizers.h"
#include "ThreadTesting.h"

#include <gtest/gtest.h>

#include <atomic>
#include <ctime>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;
using voxplex::testing::OthersStandStill;
using voxplex::testing::Soon;
using voxplex::testing::Watchdog;

namespace
{

struct Custom : std::runtime_error
{
  Custom()
    : std::runtime_error("custom")
  {
  }
};

struct Case
{
  std::string Name;
  LabelImage<3> Image;
  double Delta;
  double SmallestAngle;   ///< facets where three regions meet may have smaller ones
  double VolumeTolerance; ///< against one thread
};

/** A ball in a grid whose axes are not orthogonal. */
LabelImage<3> TiltedBall(double radius)
{
  GridGeometry<3> grid = phantoms::Cube(static_cast<std::int64_t>(2 * radius) + 12);
  grid.IndexToFrame[0][1] = 0.4;
  grid.IndexToFrame[1][2] = -0.3;
  const double c = 0.5 * static_cast<double>(grid.Dimensions[0] - 1);
  const Point<3> centre = grid.ToFrame({ c, c, c });
  return phantoms::Make(
    grid, [&](const Point<3>& p) -> std::int16_t { return Distance(p, centre) < radius ? 1 : 0; });
}

/** Faces on planes of the lattice: many points are co-spherical and co-planar. */
LabelImage<3> AlignedCube()
{
  return phantoms::Make(phantoms::Cube(16),
    [](const Point<3>& p) -> std::int16_t
    {
      const auto within = [](double x) { return x > 3.5 && x < 11.5; };
      return within(p[0]) && within(p[1]) && within(p[2]) ? 5 : 0;
    });
}

std::vector<Case> Cases()
{
  return {
    { "nested balls", phantoms::NestedBalls(15.0), 1.2, 30.0, 0.03 },
    { "touching labels", phantoms::TouchingLabels(10), 1.2, 0.0, 0.02 },
    { "sheet", phantoms::Sheet(24), 0.8, 30.0, 0.02 },
    { "aligned cube", AlignedCube(), 1.0, 30.0, 0.02 },
    { "cut ball", phantoms::CutBall(11), 0.8, 30.0, 0.02 },
    { "tilted ball", TiltedBall(8.0), 1.4, 30.0, 0.02 },
  };
}

MeshingOptions<3> Options(double delta, unsigned threads)
{
  MeshingOptions<3> options = WithDelta<3>(delta);
  options.Team.Threads = threads;
  return options;
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(ParallelMeshing, AnyNumberOfThreadsMakesAsGoodAMesh)
{
  for (const Case& c : Cases())
  {
    SCOPED_TRACE(c.Name);
    std::map<std::int64_t, double> expected;
    std::size_t simplices = 0;
    for (const unsigned threads : { 1u, 2u, 3u, 4u, 6u, 8u })
    {
      const Watchdog watchdog(c.Name + ", threads: " + std::to_string(threads));
      SCOPED_TRACE(std::to_string(threads) + " threads");
      MeshingStatistics statistics;
      const SimplexMesh<3> mesh = MeshOf(c.Image, Options(c.Delta, threads), &statistics);
      ExpectGood(mesh, c.SmallestAngle);
      const std::map<std::int64_t, double> volumes = Volumes(mesh);
      EXPECT_EQ(statistics.Threads.size(), threads);
      std::uint64_t insertions = 0;
      for (const ThreadStatistics& thread : statistics.Threads)
      {
        insertions += thread.Insertions;
      }
      std::uint64_t fired = 0;
      for (const std::uint64_t f : statistics.Rules.Fired)
      {
        fired += f;
      }
      EXPECT_EQ(
        insertions, fired + statistics.Rules.SliversSplit + statistics.Rules.SliversSampled);
      if (threads == 1)
      {
        expected = volumes;
        simplices = mesh.Simplices.size();
        EXPECT_EQ(volumes.size(), static_cast<std::size_t>(c.Image.NumberOfLabels()));
        EXPECT_EQ(statistics.SeedingSeconds, 0.0);
        continue;
      }
      EXPECT_GT(statistics.SeedingSeconds, 0.0);
      EXPECT_LE(statistics.SeedingSeconds, statistics.Times.Refinement);
      ASSERT_EQ(volumes.size(), expected.size());
      for (const auto& [label, volume] : expected)
      {
        EXPECT_NEAR(volumes.at(label), volume, c.VolumeTolerance * volume) << "label " << label;
      }
      EXPECT_NEAR(static_cast<double>(mesh.Simplices.size()), static_cast<double>(simplices),
        100.0 + 0.15 * static_cast<double>(simplices)); // a sliver can cost a hundred
    }
  }
}

TEST(ParallelMeshing, SizesAreRespected)
{
  const LabelImage<3> image = phantoms::NestedBalls(9.0);
  const double c = 0.5 * static_cast<double>(image.Grid().Dimensions[0] - 1);
  for (const unsigned threads : { 2u, 4u, 8u })
  {
    const Watchdog watchdog("sizes");
    std::atomic<std::int64_t> unknown{ 0 };
    MeshingOptions<3> options = Options(1.6, threads);
    const auto size = [&](const Point<3>& p, std::int64_t label)
    {
      unknown += label == 3 || label == 7 || label == 200 ? 0 : 1;
      return label == 7 ? 1.0 : p[2] < c ? 1.3 : 2.5;
    };
    options.Sampling.Size = std::make_shared<CallableSize>(size);
    const SimplexMesh<3> mesh = MeshOf(image, options);
    ExpectGood(mesh);
    EXPECT_EQ(unknown, 0);
    for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
    {
      ASSERT_LT(Circumradius(mesh, t), mesh.Labels[t] == 7 ? 1.0 + 1e-9 : 2.5 + 1e-9);
    }
  }
}

TEST(ParallelMeshing, OneThreadIsReproducible)
{
  const LabelImage<3> image = phantoms::NestedBalls(8.0);
  for (const bool synchronise : { false, true })
  {
    MeshingOptions<3> options = Options(1.2, 1);
    options.Team.Synchronise = synchronise;
    SimplexMesh<3> first;
    SimplexMesh<3> second;
    ImageMesher<3>(options).Run(image, first);
    ImageMesher<3> mesher(options);
    mesher.Run(image, second);
    mesher.Run(image, second); // an instance may be used again
    EXPECT_FALSE(first.Points.empty());
    ExpectSame(first, second);
  }
}

TEST(ParallelMeshing, AllCoresAndPinnedThreads)
{
  const Watchdog watchdog("pinned threads");
  const LabelImage<3> image = phantoms::NestedBalls(6.0);
  for (const unsigned threads : { 0u, 3u, 8u })
  {
    MeshingOptions<3> options = Options(1.2, threads);
    options.Team.Pin = true;
    ExpectGood(MeshOf(image, options));
  }
}

// Several meshes at once, as filters in one process may be asked for.
TEST(ParallelMeshing, MeshersDoNotDisturbEachOther)
{
  const Watchdog watchdog("three meshers");
  const LabelImage<3> image = phantoms::NestedBalls(6.0);
  std::vector<std::jthread> running;
  for (int k = 0; k < 3; ++k)
  {
    running.emplace_back([&] { ExpectGood(MeshOf(image, Options(1.0, 4))); });
  }
}

//------------------------------------------------------------------------------------------------
TEST(ParallelMeshing, ProgressIsReportedByTheCallerAndNeverFalls)
{
  const Watchdog watchdog("progress");
  const LabelImage<3> image = phantoms::NestedBalls(Sanitized ? 9.0 : 14.0);
  const std::thread::id caller = std::this_thread::get_id();
  for (const unsigned threads : { 1u, 8u })
  {
    ImageMesher<3> mesher(Options(0.6, threads));
    double last = 0.0;
    int calls = 0;
    mesher.Progress = [&](double fraction)
    {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      EXPECT_GE(fraction, last);
      EXPECT_LE(fraction, 1.0);
      last = fraction;
      ++calls;
      return true;
    };
    SimplexMesh<3> mesh;
    ASSERT_EQ(mesher.Run(image, mesh), MeshingOutcome::Done);
    EXPECT_EQ(last, 1.0);
    EXPECT_GT(calls, 3);
    EXPECT_FALSE(mesh.Simplices.empty());
  }
}

TEST(ParallelMeshing, CancelledAtAnyMoment)
{
  const LabelImage<3> image = phantoms::NestedBalls(15.0);
  std::mt19937 random(3);
  for (int k = 0; k < (Sanitized ? 6 : 24); ++k)
  {
    const int most = static_cast<int>(random() % 12);
    const std::string name = "cancelled at call " + std::to_string(most);
    SCOPED_TRACE(name);
    const Watchdog watchdog(name);
    MeshingOptions<3> options = Options(0.3, k % 6 == 5 ? 1 : 8);
    options.Team.Contention = static_cast<ContentionPolicy>(k % 4);
    options.Team.Balance = static_cast<BalancePolicy>(k / 4 % 2);
    ImageMesher<3> mesher(options);
    std::clock_t cancelled = 0; // processor time of all threads: others may keep the machine busy
    int calls = 0;
    mesher.Progress = [&](double)
    {
      if (++calls > most)
      {
        cancelled = std::clock();
        return false;
      }
      return true;
    };
    SimplexMesh<3> mesh;
    mesh.Points.resize(3);
    ASSERT_EQ(mesher.Run(image, mesh), MeshingOutcome::Cancelled);
    const double seconds = static_cast<double>(std::clock() - cancelled) / CLOCKS_PER_SEC;
    EXPECT_LT(seconds, Sanitized ? 20.0 : 2.0);
    EXPECT_EQ(calls, most + 1) << "asked again after it was cancelled";
    EXPECT_TRUE(mesh.Points.empty());
    EXPECT_TRUE(mesh.Labels.empty());
    EXPECT_TRUE(mesh.FacetLabels.empty());
    EXPECT_TRUE(mesh.Simplices.empty());
    EXPECT_TRUE(mesh.Facets.empty());
  }
}

// Not only the result is thrown away: the work that is left is not done.
TEST(ParallelMeshing, ACancelledRefinementIsNotFinished)
{
  const Watchdog watchdog("cancelled refinement");
  const LabelImage<3> image = phantoms::NestedBalls(15.0);
  const auto insertions = [&](double cancelAt, MeshingOutcome outcome)
  {
    ImageMesher<3> mesher(Options(Sanitized ? 0.5 : 0.3, 8));
    mesher.Progress = [&](double fraction) { return fraction < cancelAt; };
    SimplexMesh<3> mesh;
    EXPECT_EQ(mesher.Run(image, mesh), outcome);
    std::uint64_t sum = 0;
    for (const std::uint64_t fired : mesher.Statistics().Rules.Fired)
    {
      sum += fired;
    }
    return sum;
  };
  const std::uint64_t all = insertions(2.0, MeshingOutcome::Done);
  const std::uint64_t some = insertions(0.25, MeshingOutcome::Cancelled);
  EXPECT_GT(some, 0u);
  EXPECT_LT(some, all * 9 / 10);
}

TEST(ParallelMeshing, WhatTheProgressCallbackThrowsLeavesRun)
{
  const Watchdog watchdog("throwing progress");
  const LabelImage<3> image = phantoms::NestedBalls(15.0);
  for (const int most : { 0, 3, 8 })
  {
    ImageMesher<3> mesher(Options(0.3, most == 3 ? 1 : 8));
    int calls = 0;
    mesher.Progress = [&](double)
    {
      if (calls++ == most)
      {
        throw Custom();
      }
      return true;
    };
    SimplexMesh<3> mesh;
    EXPECT_THROW(mesher.Run(image, mesh), Custom);
  }
}

// A thread falls asleep in the midst of an operation. If others lose against it, they do so again and
// again, until the local manager takes over and they wait. Then the thread wakes up.
TEST(ParallelMeshing, TheSwitchToTheLocalManagerIsReported)
{
  const LabelImage<3> image = phantoms::NestedBalls(4.0);
  for (const ContentionPolicy contention :
    { ContentionPolicy::Aggressive, ContentionPolicy::Random })
  {
    bool switched = false;
    for (long sleeping = 400; sleeping < 4000 && !switched; sleeping += 200)
    {
      const Watchdog watchdog("switch, asleep at query " + std::to_string(sleeping));
      std::atomic<long> queries{ 0 };
      MeshingOptions<3> options = Options(1.2, 4);
      options.Team.Contention = contention;
      options.Sampling.Size = std::make_shared<CallableSize>(
        [&](const Point<3>&, std::int64_t)
        {
          if (++queries == sleeping)
          {
            Soon(OthersStandStill);
          }
          return 1.0;
        });
      MeshingStatistics statistics;
      ExpectGood(MeshOf(image, options, &statistics), 0.0);
      switched = statistics.SwitchedToLocal;
    }
    EXPECT_TRUE(switched) << ContentionPolicyNames[static_cast<std::size_t>(contention)];
  }
}

//------------------------------------------------------------------------------------------------
template <typename Exception>
void ExpectSizeErrorsLeaveRun()
{
  const LabelImage<3> image = phantoms::NestedBalls(4.0);
  std::atomic<long> queries{ 0 };
  long failing = -1;
  const auto size = std::make_shared<CallableSize>(
    [&](const Point<3>&, std::int64_t)
    {
      if (++queries == failing)
      {
        throw Exception();
      }
      return 1.0;
    });
  const auto run = [&](unsigned threads, bool withProgress)
  {
    MeshingOptions<3> options = Options(1.2, threads);
    options.Sampling.Size = size;
    ImageMesher<3> mesher(options);
    if (withProgress)
    {
      mesher.Progress = [](double) { return true; };
    }
    SimplexMesh<3> mesh;
    queries = 0;
    mesher.Run(image, mesh);
  };
  run(1, false);
  const long all = queries;
  constexpr long Moments = Sanitized ? 6 : 16;
  for (const unsigned threads : { 1u, 2u, 4u, 8u })
  {
    for (long k = 0; k <= Moments; ++k)
    {
      failing = 1 + all / 2 * k / Moments;
      const std::string name =
        std::to_string(threads) + " threads, failure at query " + std::to_string(failing);
      SCOPED_TRACE(name);
      const Watchdog watchdog(name);
      EXPECT_THROW(run(threads, k % 4 == 0), Exception);
    }
    failing = -1;
    EXPECT_NO_THROW(run(threads, false)) << "afterwards all is well";
  }
}

TEST(ParallelMeshing, BadAllocOfTheSizeFunctionLeavesRun)
{
  ExpectSizeErrorsLeaveRun<std::bad_alloc>();
}

TEST(ParallelMeshing, CustomExceptionsOfTheSizeFunctionLeaveRun)
{
  ExpectSizeErrorsLeaveRun<Custom>();
}
