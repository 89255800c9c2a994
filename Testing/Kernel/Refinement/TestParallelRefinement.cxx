// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Refinement by several threads on an analytic domain: the rules hold as they do after one thread, the
// counts add up, and what goes wrong in a thread comes out of Run().
#include "BallDomain.h"
#include "ComplexOf.h"
#include "MeshChecks.h"
#include "Parallel/CycleClock.h"
#include "Refinement/Refiner.h"
#include "Refinement/Rules/Rules3D.h"
#include "RefinementChecks.h"
#include "Sanitizers.h"
#include "ThreadTesting.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <new>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;
using voxplex::testing::Watchdog;

namespace
{

struct Custom : std::exception
{
};

/** A ball that calls a function before it answers. */
class WatchedBall final : public BallDomain
{
public:
  WatchedBall(double radius, std::function<void()> beforeAnswers)
    : BallDomain(radius)
    , BeforeAnswers(std::move(beforeAnswers))
  {
  }
  LabelId Label(const Point<3>& p) const override
  {
    this->BeforeAnswers();
    return this->BallDomain::Label(p);
  }
  double DistanceBound(const Point<3>& p) const override
  {
    this->BeforeAnswers();
    return this->BallDomain::DistanceBound(p);
  }
  /** NearSurfacePoint() asks here, too. */
  bool ClosestSurfacePoint(const Point<3>& p, LabelId label, Point<3>& z) const override
  {
    this->BeforeAnswers();
    return this->BallDomain::ClosestSurfacePoint(p, label, z);
  }
  bool FirstCrossing(
    const Point<3>& a, LabelId label, const Point<3>& b, Point<3>& z) const override
  {
    this->BeforeAnswers();
    return this->BallDomain::FirstCrossing(a, label, b, z);
  }

private:
  const std::function<void()> BeforeAnswers;
};

/** Often lets other threads run, for a domain that is asked in the midst of an operation: so threads meet. */
void MayYield()
{
  static std::atomic<unsigned> seeds{ 0 };
  thread_local std::minstd_rand random(++seeds);
  if (random() % 128 == 0)
  {
    std::this_thread::yield();
  }
}

TeamOptions Team(unsigned threads, ContentionPolicy contention = ContentionPolicy::Local,
  BalancePolicy balance = BalancePolicy::Hierarchical)
{
  TeamOptions team;
  team.Threads = threads;
  team.Contention = contention;
  team.Balance = balance;
  return team;
}

std::uint64_t CountVertices(const Triangulation<3>& mesh, const std::set<VertexKind>& kinds)
{
  std::uint64_t count = 0;
  for (VertexId v = 0; v < mesh.VertexIdEnd(); ++v)
  {
    count += mesh.GetVertex(v).Alive && kinds.count(mesh.GetVertex(v).Kind) != 0 ? 1 : 0;
  }
  return count;
}

std::uint64_t CountSimplices(const Triangulation<3>& mesh)
{
  return AliveIn(mesh).size();
}

/**
 * What the counts say must be what there is.
 * @param clock made before the run
 */
void ExpectConsistentStatistics(const RefinementContext<3>& context, Refiner<Rules3D>& refiner,
  unsigned threads, const CycleClock& clock)
{
  const double seconds = clock.Seconds();
  const RuleStatistics rules = refiner.GetRuleStatistics();
  const std::vector<ThreadStatistics> each = refiner.GetThreadStatistics();
  ASSERT_EQ(each.size(), threads);
  std::uint64_t insertions = 0;
  std::uint64_t removals = 0;
  for (const ThreadStatistics& thread : each)
  {
    insertions += thread.Insertions;
    removals += thread.Removals;
    EXPECT_LE(thread.Waits, thread.Rollbacks);
    const std::uint64_t gifts =
      std::accumulate(thread.Received.begin(), thread.Received.end(), std::uint64_t{ 0 });
    EXPECT_LE(gifts, thread.ReceivedElements) << "an empty gift was counted";
    EXPECT_EQ(gifts == 0, thread.ReceivedElements == 0);
    // A thread loses time once only, to rollbacks if there were any. At the end one of several begs.
    EXPECT_EQ(thread.RollbackSeconds > 0.0, thread.Rollbacks > 0);
    EXPECT_EQ(thread.ContentionSeconds > 0.0, thread.Rollbacks > 0);
    EXPECT_TRUE(threads == 1 || thread.LoadBalanceSeconds > 0.0);
    EXPECT_LE(
      thread.ContentionSeconds + thread.LoadBalanceSeconds + thread.RollbackSeconds, seconds);
  }
  EXPECT_EQ(insertions,
    std::accumulate(rules.Fired.begin(), rules.Fired.end(), std::uint64_t{ 0 }) +
      rules.SliversSplit + rules.SliversSampled);
  EXPECT_EQ(removals, rules.Removed);
  // The sample spacing and facet rules insert feature points, the sliver rule either kind, the others free ones, or some on the box.
  const std::uint64_t features = CountVertices(context.Mesh, { VertexKind::Feature });
  EXPECT_EQ(features, context.Features.Size());
  EXPECT_EQ(features, rules.Fired[0] + rules.Fired[2] + rules.SliversSampled);
  EXPECT_EQ(CountVertices(context.Mesh, { VertexKind::Free, VertexKind::Box }),
    8 + rules.Fired[1] + rules.Fired[3] + rules.Fired[4] + rules.SliversSplit - rules.Removed);
  EXPECT_EQ(CountVertices(context.Mesh, { VertexKind::Box }), 8 + rules.Projected);
  EXPECT_GE(rules.Created, CountSimplices(context.Mesh) - 6);
  EXPECT_GE(rules.Evaluated, insertions);
  EXPECT_EQ(rules.RemovalsFailed, 0u);
}

using Policies = std::tuple<unsigned, ContentionPolicy, BalancePolicy>;

std::string Name(const Policies& policies)
{
  const auto [threads, contention, balance] = policies;
  return std::to_string(threads) + "_" +
    std::string(ContentionPolicyNames[static_cast<std::size_t>(contention)]) + "_" +
    std::string(BalancePolicyNames[static_cast<std::size_t>(balance)]);
}

class ParallelRefinement : public ::testing::TestWithParam<Policies>
{
};

} // namespace

//------------------------------------------------------------------------------------------------
TEST_P(ParallelRefinement, NoRuleAppliesAfterwards)
{
  const auto [threads, contention, balance] = GetParam();
  const Watchdog watchdog(Name(GetParam()));
  const BallDomain smooth(5.0);
  const WatchedBall jittery(5.0, MayYield);
  std::uint64_t rollbacks = 0;
  unsigned run = 0;
  for (const double delta : { 1.7, 1.0, Sanitized ? 0.9 : 0.6 })
  {
    for (const BallDomain* ball : { &smooth, static_cast<const BallDomain*>(&jittery) })
    {
      SCOPED_TRACE("delta " + std::to_string(delta));
      RefinementContext<3> context(*ball, SettingsFor<3>(delta), Around(*ball, delta), 1000);
      TeamOptions team = Team(threads, contention, balance);
      team.SeedsPerThread = run % 3 == 1 ? 128 : 0;
      ++run;
      Refiner<Rules3D> refiner(context, team);
      const CycleClock clock;
      ASSERT_TRUE(refiner.Run(nullptr));
      ExpectSoundAndUnlocked(context.Mesh);
      ExpectNoRuleApplies(context, smooth);
      ExpectConsistentStatistics(context, refiner, threads, clock);
      ExtractSphere(context, smooth);
      EXPECT_GT(refiner.GetSecondsToSeed(), 0.0);
      EXPECT_LT(refiner.GetSecondsToSeed(), clock.Seconds());
      for (const ThreadStatistics& thread : refiner.GetThreadStatistics())
      {
        rollbacks += thread.Rollbacks;
      }
      ExpectNothingLeft<Rules3D>(context);
    }
  }
  EXPECT_GT(rollbacks, 0u) << "the threads never met: the test tests nothing";
}

// The removal rule with removals that are put off: free vertices crowd around the interface before refinement, and
// all must have made way for feature vertices, as they do with one thread.
TEST_P(ParallelRefinement, FreeVerticesNearFeatureVerticesAreRemoved)
{
  const auto [threads, contention, balance] = GetParam();
  const Watchdog watchdog(Name(GetParam()));
  const WatchedBall ball(5.0, MayYield);
  const double delta = 1.0;
  for (const unsigned number : { 1u, threads })
  {
    RefinementContext<3> context(ball, SettingsFor<3>(delta), Around(ball, delta), 1000);
    std::set<Point<3>> crowd;
    {
      Triangulation<3>::Worker worker(context.Mesh);
      std::mt19937 random(threads);
      SimplexId hint = AnyAlive(context.Mesh);
      for (Point<3> p : RandomPoints<3>(2000, 11.0, random))
      {
        p = Subtract(p, { 5.5, 5.5, 5.5 });
        if (std::abs(BallDomain::Norm(p) - ball.R) < 0.5 * delta)
        {
          const SimplexId seed = context.Mesh.FindConflict(worker, p, hint);
          ASSERT_EQ(
            context.Mesh.Insert(worker, p, VertexKind::Free, seed), InsertionOutcome::Inserted);
          hint = worker.Created.Back();
          crowd.insert(p);
        }
      }
    }
    Refiner<Rules3D> refiner(context, Team(number, contention, balance));
    ASSERT_TRUE(refiner.Run(nullptr));
    EXPECT_GE(refiner.GetRuleStatistics().Removed, crowd.size());
    std::size_t left = 0;
    for (VertexId v = 0; v < context.Mesh.VertexIdEnd(); ++v)
    {
      const Triangulation<3>::Vertex& vertex = context.Mesh.GetVertex(v);
      if (vertex.Alive && vertex.Kind == VertexKind::Free)
      {
        left += crowd.count(vertex.Position);
        EXPECT_GT(std::abs(BallDomain::Norm(vertex.Position) - ball.R), 0.2 * delta);
      }
    }
    EXPECT_EQ(left, 0u) << "with " << number << " threads, of " << crowd.size();
    ExpectNoRuleApplies(context, ball);
    ExpectSoundAndUnlocked(context.Mesh);
  }
}

INSTANTIATE_TEST_SUITE_P(Policies, ParallelRefinement,
  ::testing::Combine(::testing::Values(2u, 4u, 8u),
    ::testing::ValuesIn(voxplex::testing::AllPolicies),
    ::testing::Values(BalancePolicy::Random, BalancePolicy::Hierarchical)),
  [](const auto& policies) { return Name(policies.param); });

//------------------------------------------------------------------------------------------------
TEST(ParallelRefinementOfOne, SynchronisedThread)
{
  const BallDomain ball(5.0);
  RefinementContext<3> context(ball, SettingsFor<3>(0.8), Around(ball, 0.8), 1000);
  TeamOptions team = Team(1);
  team.Synchronise = true;
  Refiner<Rules3D> refiner(context, team);
  const CycleClock clock;
  ASSERT_TRUE(refiner.Run(nullptr));
  ExpectSoundAndUnlocked(context.Mesh);
  ExpectNoRuleApplies(context, ball);
  ExpectConsistentStatistics(context, refiner, 1, clock);
  ExtractSphere(context, ball);
  EXPECT_EQ(refiner.GetThreadStatistics()[0].Rollbacks, 0u);
  EXPECT_EQ(refiner.GetThreadStatistics()[0].Waits, 0u);
  EXPECT_FALSE(refiner.SwitchedToLocal());
}

TEST(ParallelRefinementOfOne, StatisticsOfOneThread)
{
  const BallDomain ball(5.0);
  RefinementContext<3> context(ball, SettingsFor<3>(1.0), Around(ball, 1.0), 1000);
  Refiner<Rules3D> refiner(context);
  const CycleClock clock;
  ASSERT_TRUE(refiner.Run(nullptr));
  ExpectConsistentStatistics(context, refiner, 1, clock);
  EXPECT_FALSE(refiner.SwitchedToLocal());
}

//------------------------------------------------------------------------------------------------
// More threads than there are simplices to begin with, and than the processors of most machines.
TEST(ParallelRefinementOfMany, ThirtyTwoThreadsOnAnObjectSmallerThanDelta)
{
  const Watchdog watchdog("32 threads");
  const BallDomain ball(1.0);
  for (const double delta : { 4.0, 0.5 })
  {
    RefinementContext<3> context(ball, SettingsFor<3>(delta), Around(ball, delta), 1000);
    Refiner<Rules3D> refiner(context, Team(32));
    const CycleClock clock;
    ASSERT_TRUE(refiner.Run(nullptr));
    ExpectSoundAndUnlocked(context.Mesh);
    ExpectNoRuleApplies(context, ball);
    ExpectConsistentStatistics(context, refiner, 32, clock);
  }
}

TEST(ParallelRefinementStop, StopsWhenAsked)
{
  const Watchdog watchdog("stop when asked");
  const BallDomain ball(5.0);
  for (const int most : { 1, 5, 20 })
  {
    for (const ContentionPolicy contention : voxplex::testing::AllPolicies)
    {
      RefinementContext<3> context(ball, SettingsFor<3>(0.3), Around(ball, 0.3), 1000);
      Refiner<Rules3D> refiner(context, Team(8, contention));
      std::atomic<int> calls{ 0 };
      EXPECT_FALSE(refiner.Run([&](std::uint64_t) { return ++calls < most; }));
      EXPECT_LT(calls.load(), most + 8) << "a thread went on after the stop";
      ExpectSoundAndUnlocked(context.Mesh);
    }
  }
}

TEST(ParallelRefinementErrors, WhatTheMonitorThrowsLeavesRun)
{
  const Watchdog watchdog("monitor");
  const BallDomain ball(5.0);
  for (const unsigned threads : { 1u, 2u, 8u })
  {
    RefinementContext<3> context(ball, SettingsFor<3>(0.4), Around(ball, 0.4), 1000);
    Refiner<Rules3D> refiner(context, Team(threads));
    std::atomic<int> calls{ 0 };
    EXPECT_THROW(refiner.Run(
                   [&](std::uint64_t)
                   {
                     if (++calls == 3)
                     {
                       throw Custom();
                     }
                     return true;
                   }),
      Custom);
  }
}

template <typename Exception>
void ExpectDomainErrorsLeaveRun()
{
  const double delta = 1.0;
  std::atomic<long> queries{ 0 }; // of all threads
  long failing = -1;
  const WatchedBall ball(5.0,
    [&]
    {
      if (++queries == failing)
      {
        throw Exception();
      }
    });
  {
    RefinementContext<3> context(ball, SettingsFor<3>(delta), Around(ball, delta), 1000);
    Refiner<Rules3D>(context).Run(nullptr);
  }
  const long all = queries;
  constexpr long Moments = Sanitized ? 10 : 40;
  for (const unsigned threads : { 1u, 2u, 3u, 4u, 8u })
  {
    for (long k = 0; k <= Moments; ++k)
    {
      // Up to where each run surely comes; the first few queries are made before threads start.
      failing = k < 4 ? k + 1 : all / 2 * k / Moments;
      queries = 0;
      const std::string name =
        std::to_string(threads) + " threads, failure at query " + std::to_string(failing);
      SCOPED_TRACE(name);
      const Watchdog watchdog(name);
      RefinementContext<3> context(ball, SettingsFor<3>(delta), Around(ball, delta), 1000);
      TeamOptions team =
        Team(threads, static_cast<ContentionPolicy>(k % 4), static_cast<BalancePolicy>(k / 4 % 2));
      team.Synchronise = k % 3 == 0;
      Refiner<Rules3D> refiner(context, team);
      EXPECT_THROW(refiner.Run(nullptr), Exception);
      EXPECT_GE(queries, failing);
    }
  }
}

TEST(ParallelRefinementErrors, BadAllocOfTheDomainLeavesRun)
{
  ExpectDomainErrorsLeaveRun<std::bad_alloc>();
}

TEST(ParallelRefinementErrors, CustomExceptionsOfTheDomainLeaveRun)
{
  ExpectDomainErrorsLeaveRun<Custom>();
}
