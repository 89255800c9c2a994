// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Insertions with which threads that wait help: the triangulation is the one that nobody helped with.
#include "BallDomain.h"
#include "Delaunay/Triangulation.h"
#include "Parallel/LoopSharing.h"
#include "Refinement/Refiner.h"
#include "Refinement/Rules3D.h"
#include "Refinement/Rules4D.h"
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
  ExpectSound(helped);
  EXPECT_TRUE(LockedVertices(helped).empty());
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
  std::uniform_real_distribution<double> real(0.0, 10.0);
  const auto anywhere = [&]()
  {
    Point<D> p;
    for (double& x : p)
    {
      x = real(random);
    }
    return p;
  };
  // Ties and points on the box, which have facets without neighbours in their cavities.
  std::uniform_int_distribution<int> node(0, cells);
  const auto lattice = [&]()
  {
    Point<D> p;
    for (double& x : p)
    {
      x = node(random) * 10.0 / cells;
    }
    return p;
  };
  for (const auto& [simplices, balls] :
    { std::pair{ std::size_t{ 1 }, Never }, { Never, std::size_t{ 1 } }, { 1, 1 }, { 6, 12 } })
  {
    SCOPED_TRACE("fewest simplices " + std::to_string(simplices));
    InsertUntilHelped<D>(simplices, balls, points / Fraction, anywhere);
    InsertUntilHelped<D>(simplices, balls, points / Fraction, lattice);
  }
}

/** A 4-ball of label 1 around the origin: exact answers. */
class HyperBall final : public Domain<4>
{
public:
  static constexpr double R = 5.0;

  Box<4> Bounds() const override { return { { -R, -R, -R, -R }, { R, R, R, R } }; }
  LabelId Label(const Point<4>& p) const override { return SquaredNorm(p) < R * R ? 1 : 0; }
  std::int64_t LabelValue(LabelId id) const override { return id; }
  double DistanceBound(const Point<4>& p) const override
  {
    return std::abs(std::sqrt(SquaredNorm(p)) - R);
  }
  bool ClosestSurfacePoint(const Point<4>& p, LabelId, Point<4>& z) const override
  {
    const double norm = std::sqrt(SquaredNorm(p));
    z = norm > 0.0 ? p : Point<4>{ R, 0.0, 0.0, 0.0 };
    for (double& x : z)
    {
      x *= R / (norm > 0.0 ? norm : R);
    }
    return true;
  }
  bool NearSurfacePoint(const Point<4>& p, LabelId label, Point<4>& z, double& error) const override
  {
    error = 0.0;
    return this->ClosestSurfacePoint(p, label, z);
  }
  bool FirstCrossing(
    const Point<4>& a, LabelId label, const Point<4>& b, Point<4>& z) const override
  {
    if (this->Label(b) == label)
    {
      return false;
    }
    double inA = 0.0;
    double inB = 1.0;
    for (int bisection = 0; bisection < 60; ++bisection)
    {
      const double middle = 0.5 * (inA + inB);
      for (std::size_t i = 0; i < 4; ++i)
      {
        z[i] = a[i] + middle * (b[i] - a[i]);
      }
      (this->Label(z) == label ? inA : inB) = middle;
    }
    return true;
  }
};

/** A storm at a sharing. */
template <int D>
void HelpedStorm(const std::vector<Point<D>>& points, double size, unsigned threads)
{
  LoopSharing sharing(threads, 400);
  StormAndCheck<D>(points, size, threads, false, &sharing);
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(HelpedInsertion, SameTriangulation3D)
{
  const Watchdog watchdog("helped insertion, 3D");
  InsertAndCompareEverything<3>(600, 9);
}

TEST(HelpedInsertion, SameTriangulation4D)
{
  const Watchdog watchdog("helped insertion, 4D");
  InsertAndCompareEverything<4>(300, 4);
}

TEST(HelpedInsertion, Storm3D)
{
  std::mt19937 random(11);
  for (const unsigned threads : { 2u, 4u, 8u })
  {
    HelpedStorm<3>(RandomPoints<3>(2000 / Fraction, 10.0, random), 10.0, threads);
    HelpedStorm<3>(
      WithoutCorners<3>(LatticePoints<3>(1000 / Fraction, 18, 0.277, random), 18 * 0.277),
      18 * 0.277, threads);
  }
}

TEST(HelpedInsertion, Storm4D)
{
  std::mt19937 random(12);
  for (const unsigned threads : { 2u, 4u, 8u })
  {
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
        RefinementSettings<3> settings;
        settings.Sizing.Base = { delta };
        RefinementContext<3> context(ball, settings, Around(ball, delta), 1000);
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
  const HyperBall ball;
  for (const unsigned threads : { 2u, 4u })
  {
    const Watchdog watchdog("4-ball, " + std::to_string(threads) + " threads");
    RefinementSettings<4> settings;
    settings.Sizing.Base = { 2.5 };
    RefinementContext<4> context(ball, settings, Around(ball, settings.Sizing.Base.Delta), 1000);
    TeamOptions team;
    team.Threads = threads;
    team.FineGrained = true;
    Refiner<Rules4D> refiner(context, team);
    ASSERT_TRUE(refiner.Run(nullptr));
    ExpectSound(context.Mesh);
    EXPECT_TRUE(LockedVertices(context.Mesh).empty());
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
  RefinementSettings<3> settings;
  settings.Sizing.Base = { 0.8 };
  RefinementContext<3> context(ball, settings, Around(ball, 0.8), 1000);
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
    RefinementSettings<3> settings;
    settings.Sizing.Base = { 0.3 };
    RefinementContext<3> context(ball, settings, Around(ball, 0.3), 1000);
    TeamOptions team;
    team.Threads = 6;
    team.FineGrained = true;
    Refiner<Rules3D> refiner(context, team);
    std::atomic<int> calls{ 0 };
    EXPECT_FALSE(refiner.Run([&](std::uint64_t) { return ++calls < most; }));
    ExpectSoundAndUnlocked(context.Mesh);
  }
}
