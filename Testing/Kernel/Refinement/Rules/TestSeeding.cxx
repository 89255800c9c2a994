// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Seeds that several workers insert side by side: none is lost, none crowds another, and all workers
// take part.
#include "BallDomain.h"
#include "Refinement/Rules/Rules3D.h"
#include "Refinement/Rules/Rules4D.h"
#include "Refinement/Rules/Seeding.h"
#include "RefinementChecks.h"
#include "ThreadTesting.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;
using voxplex::testing::Watchdog;

namespace
{

/** Lets other threads run while its own holds what it has locked, so that threads meet. */
template <typename Base>
class SlowRules : public Base
{
public:
  using Base::Base;

  RuleOutcome InsertSeedBesideOthers(const FeatureSeed<Base::Dimension>& seed, VertexId& near)
  {
    const RuleOutcome outcome = this->Base::InsertSeedBesideOthers(seed, near);
    Contended += outcome == RuleOutcome::Contended ? 1 : 0;
    std::this_thread::yield();
    return outcome;
  }

  static inline std::atomic<unsigned> Contended{ 0 };
};

template <int D>
using Workers = std::vector<std::unique_ptr<RefinementWorker<D>>>;

template <int D>
Workers<D> MakeWorkers(RefinementContext<D>& context, unsigned number)
{
  Workers<D> workers;
  for (unsigned w = 0; w < number; ++w)
  {
    workers.push_back(std::make_unique<RefinementWorker<D>>(
      context, static_cast<WorkerId>(number > 1 ? w + 1 : 0)));
  }
  return workers;
}

template <int D>
std::vector<Point<D>> FeaturePoints(const Triangulation<D>& mesh)
{
  std::vector<Point<D>> points;
  for (VertexId v = 0; v < mesh.VertexIdEnd(); ++v)
  {
    if (mesh.GetVertex(v).Alive && mesh.GetVertex(v).Kind == VertexKind::Feature)
    {
      points.push_back(mesh.Position(v));
    }
  }
  return points;
}

/**
 * Seeds on a ball, twice as dense as delta allows. @param delta of the seeds and of the mesh
 * @return the number of times that threads met
 */
template <typename Rules>
unsigned SeedBall(double delta, unsigned threads, std::size_t& inserted)
{
  constexpr int D = Rules::Dimension;
  const BallDomainOf<D> ball(5.0);
  RefinementContext<D> context(ball, SettingsFor<D>(delta), Around(ball, delta), 1000);
  const std::vector<FeatureSeed<D>> seeds = SampleInterfaces(context, 0.5 * delta, delta, 1);
  const Workers<D> workers = MakeWorkers(context, threads);
  SlowRules<Rules>::Contended = 0;
  InsertSeeds<SlowRules<Rules>>(context, workers, seeds);

  ExpectSoundAndUnlocked(context.Mesh);
  for (const FeatureSeed<D>& seed : seeds)
  {
    EXPECT_TRUE(context.Features.AnyWithin(seed.Position, seed.Delta * (1.0 + 1e-9)))
      << "a seed is lost";
  }
  const std::vector<Point<D>> points = FeaturePoints(context.Mesh);
  inserted = points.size();
  EXPECT_EQ(points.size(), context.Features.Size());
  std::uint64_t counted = 0;
  for (const auto& worker : workers)
  {
    EXPECT_GT(worker->Statistics.Insertions(), 0u) << "a worker does nothing";
    counted += worker->Statistics.Insertions();
  }
  EXPECT_EQ(counted, points.size());
  std::size_t near = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    for (std::size_t k = 0; k < i; ++k)
    {
      near += Distance2(points[i], points[k]) < delta * delta * (1.0 - 1e-9) ? 1 : 0;
    }
  }
  EXPECT_EQ(near, 0u) << "vertices are nearer to each other than delta";
  return SlowRules<Rules>::Contended;
}

template <typename Rules>
void SeedBalls(double delta)
{
  std::size_t byOne = 0;
  SeedBall<Rules>(delta, 1, byOne);
  unsigned contended = 0;
  for (const unsigned threads : { 2u, 4u, 8u })
  {
    SCOPED_TRACE(std::to_string(threads) + " threads");
    std::size_t bySeveral = 0;
    contended += SeedBall<Rules>(delta, threads, bySeveral);
    EXPECT_GT(10 * bySeveral, 9 * byOne);
    EXPECT_LT(10 * bySeveral, 11 * byOne);
  }
  EXPECT_GT(contended, 0u) << "the threads never met: the test tests nothing";
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(Seeding, WorkersInsertSideBySide)
{
  const Watchdog watchdog("side by side");
  SeedBalls<Rules3D>(0.4);
  SeedBalls<Rules4D>(1.6);
}

// One worker inserts shared points, before the others. There may be nothing else.
TEST(Seeding, SharedPointsComeFirst)
{
  const BallDomainOf<3> ball(5.0);
  for (const bool onlyShared : { true, false })
  {
    RefinementContext<3> context(ball, SettingsFor<3>(0.4), Around(ball, 0.4), 1000);
    std::vector<FeatureSeed<3>> seeds =
      onlyShared ? std::vector<FeatureSeed<3>>() : SampleInterfaces(context, 0.2, 0.4, 1);
    const std::size_t others = seeds.size();
    std::mt19937 random(1);
    for (const Point<3>& p : RandomPoints<3>(500, 4.0, random))
    {
      seeds.push_back({ p, 0.4, true, VertexKind::Shared });
    }
    const Workers<3> workers = MakeWorkers(context, 4);
    InsertSeeds<Rules3D>(context, workers, seeds);
    ExpectSoundAndUnlocked(context.Mesh);
    EXPECT_EQ(workers[0]->Statistics.Shared, 500u);
    EXPECT_EQ(others > 0, context.Features.Size() > 0);
    EXPECT_EQ(others > 0, workers[3]->Statistics.Insertions() > 0);
  }
}

// The pieces that threads start from: all living simplices, once, and near each other.
TEST(Seeding, LivingSimplicesAreOrderedForAnyNumberOfThreads)
{
  const BallDomainOf<3> ball(5.0);
  RefinementContext<3> context(ball, SettingsFor<3>(0.4), Around(ball, 0.4), 1000);
  InsertSeeds<Rules3D>(context, MakeWorkers(context, 1), SampleInterfaces(context, 0.2, 0.4, 1));
  const std::vector<SimplexId> byOne = LivingAlongCurve(context.Mesh, 1);
  std::vector<SimplexId> sorted = byOne;
  std::sort(sorted.begin(), sorted.end());
  std::vector<SimplexId> living;
  for (SimplexId s = 0; s < context.Mesh.SimplexIdEnd(); ++s)
  {
    if (context.Mesh.IsAlive(s))
    {
      living.push_back(s);
    }
  }
  EXPECT_EQ(sorted, living);
  for (const unsigned threads : { 2u, 8u })
  {
    EXPECT_EQ(LivingAlongCurve(context.Mesh, threads), byOne);
  }
  const auto sumOfSteps = [&](const std::vector<SimplexId>& simplices)
  {
    double sum = 0.0;
    for (std::size_t i = 1; i < simplices.size(); ++i)
    {
      sum += std::sqrt(Distance2(context.Mesh.Position(context.Mesh.GetSimplex(simplices[i]).V[0]),
        context.Mesh.Position(context.Mesh.GetSimplex(simplices[i - 1]).V[0])));
    }
    return sum;
  };
  EXPECT_LT(sumOfSteps(byOne), 0.5 * sumOfSteps(living));
}
