// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Insertions with which threads that wait help: the triangulation is the one that nobody helped with.
#include "BallDomain.h"
#include "Delaunay/Triangulation.h"
#include "Parallel/LoopSharing.h"
#include "Refinement/Refiner.h"
#include "Refinement/Rules/Rules3D.h"
#include "Refinement/Rules/Rules4D.h"
#include "RefinementChecks.h"
#include "Sanitizers.h"
#include "ThreadTesting.h"
#include "TriangulationChecks.h"
#include "TriangulationStorm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;
using voxplex::testing::Watchdog;

namespace
{

constexpr int Fraction = Sanitized ? 8 : 1;
constexpr std::size_t Never = std::numeric_limits<std::size_t>::max();

/** Same ids, vertices, neighbours and balls, to the last bit. */
template <int D>
void ExpectIdentical(const Triangulation<D>& a, const Triangulation<D>& b)
{
  ASSERT_EQ(a.SimplexIdEnd(), b.SimplexIdEnd());
  for (SimplexId s = 0; s < a.SimplexIdEnd(); ++s)
  {
    ASSERT_EQ(a.IsAlive(s), b.IsAlive(s)) << s;
    if (a.IsAlive(s))
    {
      ASSERT_EQ(a.GetSimplex(s).V, b.GetSimplex(s).V) << s;
      ASSERT_EQ(a.GetSimplex(s).N, b.GetSimplex(s).N) << s;
      // As bytes: the radius may be NaN.
      ASSERT_EQ(std::memcmp(&a.GetSimplex(s).Ball, &b.GetSimplex(s).Ball, sizeof(Circumball<D>)), 0)
        << s;
    }
  }
}

/** A worker with two threads that do nothing but help it. */
template <int D>
class HelpedWorker
{
public:
  using Kernel = Triangulation<D>;

  HelpedWorker(const Kernel& t, std::size_t fewestSimplices, std::size_t fewestBalls)
    : Worker(t, 1)
    , First(t, 2)
    , Second(t, 3)
    , Team({ &this->Worker, &this->First, &this->Second })
  {
    this->Worker.Help.Sharing = &this->Sharing;
    this->Worker.Help.Number = 0;
    this->Worker.Help.Team = &this->Team;
    this->Worker.Help.FewestSimplices = fewestSimplices;
    this->Worker.Help.FewestBalls = fewestBalls;
    this->Worker.Help.Grain = 2;
    for (const unsigned number : { 1u, 2u })
    {
      this->Threads.emplace_back([this, number]()
        { this->Sharing.HelpUntil(number, [this]() { return this->Over.load(); }); });
    }
  }
  ~HelpedWorker() { this->DismissHelpers(); }
  HelpedWorker(const HelpedWorker&) = delete;
  HelpedWorker& operator=(const HelpedWorker&) = delete;

  void DismissHelpers()
  {
    this->Over = true;
    this->Threads.clear();
  }

  /** True once a helper has done something. */
  bool WasHelped() const { return this->Sharing.GetCounts(0).Iterations > 0; }

  PredicateStatistics Predicates() const
  {
    PredicateStatistics sum = this->Worker.GetPredicateStatistics();
    sum += this->First.GetPredicateStatistics();
    sum += this->Second.GetPredicateStatistics();
    return sum;
  }

  LoopSharing Sharing{ 3, std::numeric_limits<unsigned>::max() };
  typename Kernel::Worker Worker;

private:
  typename Kernel::Worker First;
  typename Kernel::Worker Second;
  std::vector<typename Kernel::Worker*> Team;
  std::atomic<bool> Over{ false };
  std::vector<std::jthread> Threads; // last: they use the others
};

/** Of the last insertion: facets of the cavity's boundary, less the simplices outside beyond them. */
template <int D>
std::uint64_t RepeatedTests(
  const Triangulation<D>& t, const typename Triangulation<D>::Worker& worker)
{
  std::uint64_t facets = 0;
  std::set<SimplexId> outside;
  for (const SimplexId s : worker.Created)
  {
    const auto& simplex = t.GetSimplex(s);
    const auto apex = std::find(simplex.V.begin(), simplex.V.end(), worker.NewVertex);
    const SimplexId n = simplex.N[static_cast<std::size_t>(apex - simplex.V.begin())];
    if (n != None)
    {
      ++facets;
      outside.insert(n);
    }
  }
  return facets - outside.size();
}

/** Inserts points with and without help. @return whether helpers did something */
template <int D, typename MakePoint>
bool InsertAndCompare(
  std::size_t fewestSimplices, std::size_t fewestBalls, int points, double size, MakePoint& make)
{
  Triangulation<D> helped(UnitBox<D>(size));
  Triangulation<D> alone(UnitBox<D>(size));
  HelpedWorker<D> team(helped, fewestSimplices, fewestBalls);
  typename Triangulation<D>::Worker sequential(alone, 1);
  SimplexId hint = AnyAlive(helped);
  for (int k = 0; k < points; ++k)
  {
    const Point<D> p = make();
    const SimplexId seed = helped.FindConflict(team.Worker, p, hint);
    EXPECT_EQ(alone.FindConflict(sequential, p, hint), seed);
    if (seed == None)
    {
      continue; // a vertex already
    }
    const VertexKind kind = KindOf<D>(p, size);
    EXPECT_EQ(helped.Lock(team.Worker, seed, helped.State(seed).Generation), LockOutcome::Locked);
    EXPECT_EQ(alone.Lock(sequential, seed, alone.State(seed).Generation), LockOutcome::Locked);
    const std::uint64_t helpedBefore = team.Predicates().Calls;
    const std::uint64_t aloneBefore = sequential.GetPredicateStatistics().Calls;
    EXPECT_EQ(helped.Insert(team.Worker, p, kind, seed), InsertionOutcome::Inserted);
    EXPECT_EQ(alone.Insert(sequential, p, kind, seed), InsertionOutcome::Inserted);
    const std::uint64_t helpedTests = team.Predicates().Calls - helpedBefore;
    const std::uint64_t aloneTests = sequential.GetPredicateStatistics().Calls - aloneBefore;
    // Without help, a simplex outside is tested from each of its neighbours in the cavity.
    EXPECT_TRUE(
      helpedTests == aloneTests || helpedTests == aloneTests - RepeatedTests(alone, sequential))
      << "each test was made once: " << helpedTests << ", " << aloneTests;
    EXPECT_EQ(team.Worker.Deleted.Size(), sequential.Deleted.Size());
    EXPECT_EQ(team.Worker.NumberOfCreated, sequential.NumberOfCreated);
    EXPECT_EQ(team.Worker.NumberOfOwned(), sequential.NumberOfOwned());
    helped.Unlock(team.Worker);
    alone.Unlock(sequential);
    hint = sequential.Created.Back();
    if (k % 8 == 0)
    {
      std::this_thread::yield(); // to the helpers
    }
  }
  team.DismissHelpers();
  ExpectIdentical(helped, alone);
  ExpectSoundAndUnlocked(helped);
  const PredicateStatistics expected = sequential.GetPredicateStatistics();
  const PredicateStatistics actual = team.Predicates();
  EXPECT_EQ(actual.StaticFailures, expected.StaticFailures) << "each of these tests was made once";
  EXPECT_EQ(actual.ExactCalls, expected.ExactCalls);
  EXPECT_EQ(actual.Perturbed, expected.Perturbed);
  return team.WasHelped();
}

/** Over and over until helpers did something: it is for the system to say when they run. */
template <int D, typename MakePoint>
void InsertUntilHelped(
  std::size_t fewestSimplices, std::size_t fewestBalls, int points, MakePoint& make)
{
  while (!InsertAndCompare<D>(fewestSimplices, fewestBalls, points, 10.0, make) &&
    !::testing::Test::HasFailure())
  {
  }
}

template <int D>
void InsertAndCompareEverything(int points, int cells)
{
  std::mt19937 random(D);
  const auto anywhere = [&]() { return RandomPoints<D>(1, 10.0, random).front(); };
  // Ties and points on the box, which have facets without neighbours in their cavities.
  std::uniform_int_distribution<int> node(0, cells);
  const auto lattice = [&]() { return Drawn<D>([&] { return node(random) * 10.0 / cells; }); };
  for (const auto& [simplices, balls] :
    { std::pair{ std::size_t{ 1 }, Never }, { Never, std::size_t{ 1 } }, { 1, 1 }, { 6, 12 } })
  {
    SCOPED_TRACE("fewest simplices " + std::to_string(simplices));
    InsertUntilHelped<D>(simplices, balls, points / Fraction, anywhere);
    InsertUntilHelped<D>(simplices, balls, points / Fraction, lattice);
  }
}

/** A storm at a sharing. */
template <int D>
void HelpedStorm(const std::vector<Point<D>>& points, double size, unsigned threads)
{
  LoopSharing sharing(threads, 400);
  StormAndCheck<D>(points, size, threads, false, &sharing);
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(HelpedInsertion, SameTriangulation)
{
  const Watchdog watchdog("helped insertion");
  InsertAndCompareEverything<3>(600, 9);
  InsertAndCompareEverything<4>(300, 4);
}

TEST(HelpedInsertion, Storms)
{
  std::mt19937 random(11);
  for (const unsigned threads : { 2u, 4u, 8u })
  {
    HelpedStorm<3>(RandomPoints<3>(2000 / Fraction, 10.0, random), 10.0, threads);
    HelpedStorm<3>(
      WithoutCorners<3>(LatticePoints<3>(1000 / Fraction, 18, 0.277, random), 18 * 0.277),
      18 * 0.277, threads);
    HelpedStorm<4>(RandomPoints<4>(600 / Fraction, 10.0, random), 10.0, threads);
    HelpedStorm<4>(
      WithoutCorners<4>(LatticePoints<4>(600 / Fraction, 5, 1.0, random), 5.0), 5.0, threads);
  }
}

// So few points that the threads are always in each other's way.
TEST(HelpedInsertion, CrowdsOfThreads)
{
  for (unsigned seed = 0; seed < 24u / Fraction && !HasFailure(); ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const unsigned threads = 2u << (seed % 3);
    HelpedStorm<3>(WithoutCorners<3>(LatticePoints<3>(60, 3, 1.0, random), 3.0), 3.0, threads);
    HelpedStorm<4>(RandomPoints<4>(20, 2.0, random), 2.0, threads);
  }
}

//------------------------------------------------------------------------------------------------
TEST(FineGrainedRefinement, NoRuleAppliesAfterwards)
{
  const BallDomain ball(5.0);
  for (const unsigned threads : { 2u, 3u, 8u })
  {
    for (const ContentionPolicy contention : voxplex::testing::AllPolicies)
    {
      for (const double delta : { 1.7, Sanitized ? 1.1 : 0.6 })
      {
        const std::string name = std::to_string(threads) + " threads, " +
          voxplex::testing::NameOf(contention) + ", delta " + std::to_string(delta);
        SCOPED_TRACE(name);
        const Watchdog watchdog(name);
        RefinementContext<3> context(ball, SettingsFor<3>(delta), Around(ball, delta), 1000);
        TeamOptions team;
        team.Threads = threads;
        team.Contention = contention;
        team.FineGrained = true;
        Refiner<Rules3D> refiner(context, team);
        ASSERT_TRUE(refiner.Run(nullptr));
        ExpectSoundAndUnlocked(context.Mesh);
        ExpectNoRuleApplies(context, ball);
        for (const ThreadStatistics& thread : refiner.GetThreadStatistics())
        {
          EXPECT_LE(thread.HelpedLoops, thread.HelpedIterations);
        }
      }
    }
  }
}

TEST(FineGrainedRefinement, FourBall)
{
  const BallDomainOf<4> ball(5.0);
  for (const unsigned threads : { 2u, 4u })
  {
    const Watchdog watchdog("4-ball, " + std::to_string(threads) + " threads");
    RefinementContext<4> context(ball, SettingsFor<4>(2.5), Around(ball, 2.5), 1000);
    TeamOptions team;
    team.Threads = threads;
    team.FineGrained = true;
    Refiner<Rules4D> refiner(context, team);
    ASSERT_TRUE(refiner.Run(nullptr));
    ExpectSoundAndUnlocked(context.Mesh);
    EXPECT_GT(refiner.GetRuleStatistics().Created, 1000u);
    std::uint64_t helped = 0;
    double helping = 0.0;
    for (const ThreadStatistics& thread : refiner.GetThreadStatistics())
    {
      helped += thread.HelpedLoops;
      helping += thread.HelpingSeconds;
      EXPECT_GE(thread.ContentionSeconds, 0.0);
      EXPECT_GE(thread.LoadBalanceSeconds, 0.0);
    }
    EXPECT_TRUE(helped == 0 || helping > 0.0);
    RecordProperty("HelpedLoops" + std::to_string(threads), static_cast<int>(helped));
  }
}

TEST(FineGrainedRefinement, NobodyHelpsUnlessAsked)
{
  const BallDomain ball(5.0);
  RefinementContext<3> context(ball, SettingsFor<3>(0.8), Around(ball, 0.8), 1000);
  TeamOptions team;
  team.Threads = 4;
  Refiner<Rules3D> refiner(context, team);
  ASSERT_TRUE(refiner.Run(nullptr));
  for (const ThreadStatistics& thread : refiner.GetThreadStatistics())
  {
    EXPECT_EQ(thread.HelpedLoops, 0u);
    EXPECT_EQ(thread.HelpedIterations, 0u);
    EXPECT_EQ(thread.HelpingSeconds, 0.0);
  }
}

TEST(FineGrainedRefinement, StopsWhenAsked)
{
  const Watchdog watchdog("stop, fine-grained");
  const BallDomain ball(5.0);
  for (int most = 1; most < 20; most += 3)
  {
    RefinementContext<3> context(ball, SettingsFor<3>(0.3), Around(ball, 0.3), 1000);
    TeamOptions team;
    team.Threads = 6;
    team.FineGrained = true;
    Refiner<Rules3D> refiner(context, team);
    std::atomic<int> calls{ 0 };
    EXPECT_FALSE(refiner.Run([&](std::uint64_t) { return ++calls < most; }));
    ExpectSoundAndUnlocked(context.Mesh);
  }
}
