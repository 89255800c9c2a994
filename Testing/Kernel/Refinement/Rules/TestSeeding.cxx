// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Seeds: none is lost, none crowds another, and shared ones come first.
#include "BallDomain.h"
#include "Refinement/Rules/Rules3D.h"
#include "Refinement/Rules/Rules4D.h"
#include "Refinement/Rules/Seeding.h"
#include "RefinementChecks.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** Seeds on a ball, twice as dense as delta allows. */
template <typename Rules>
void SeedBall(double delta)
{
  constexpr int D = Rules::Dimension;
  const BallDomainOf<D> ball(5.0);
  RefinementContext<D> context(ball, SettingsFor<D>(delta), Around(ball, delta), 1000);
  const std::vector<FeatureSeed<D>> seeds = SampleInterfaces(context, 0.5 * delta, delta, 1);
  RefinementWorker<D> worker(context);
  InsertSeeds<Rules>(context, worker, seeds);

  ExpectSoundAndUnlocked(context.Mesh);
  for (const FeatureSeed<D>& seed : seeds)
  {
    EXPECT_TRUE(context.Features.AnyWithin(seed.Position, seed.Delta * (1.0 + 1e-9)))
      << "a seed is lost";
  }
  std::vector<Point<D>> points;
  for (VertexId v = 0; v < context.Mesh.VertexIdEnd(); ++v)
  {
    if (context.Mesh.GetVertex(v).Alive && context.Mesh.GetVertex(v).Kind == VertexKind::Feature)
    {
      points.push_back(context.Mesh.Position(v));
    }
  }
  EXPECT_EQ(points.size(), context.Features.Size());
  EXPECT_EQ(worker.Statistics.Insertions(), points.size());
  std::size_t near = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    for (std::size_t k = 0; k < i; ++k)
    {
      near += Distance2(points[i], points[k]) < delta * delta * (1.0 - 1e-9) ? 1 : 0;
    }
  }
  EXPECT_EQ(near, 0u) << "vertices are nearer to each other than delta";
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(Seeding, SeedsKeepDeltaFromEachOther)
{
  SeedBall<Rules3D>(0.4);
  SeedBall<Rules4D>(1.6);
}

// Other points that are nearer to them than delta are left out.
TEST(Seeding, SharedPointsComeFirst)
{
  const BallDomainOf<3> ball(5.0);
  RefinementContext<3> context(ball, SettingsFor<3>(0.4), Around(ball, 0.4), 1000);
  std::vector<FeatureSeed<3>> seeds = SampleInterfaces(context, 0.2, 0.4, 1);
  std::mt19937 random(1);
  for (const Point<3>& p : RandomPoints<3>(500, 4.0, random))
  {
    seeds.push_back({ p, 0.4, true, VertexKind::Feature });
  }
  const FeatureSeed<3> beside{ { 5.0, 0.0, 0.1 }, 0.4, true, VertexKind::Feature };
  seeds.push_back(beside);
  RefinementWorker<3> worker(context);
  InsertSeeds<Rules3D>(context, worker, seeds);
  ExpectSoundAndUnlocked(context.Mesh);
  EXPECT_EQ(worker.Statistics.Shared, 501u);
  EXPECT_GT(worker.Statistics.Insertions(), 100u);
  for (const FeatureSeed<3>& seed : seeds)
  {
    const bool isNear = !seed.IsShared && Distance(seed.Position, beside.Position) < 0.4;
    const Point<3>* const found = context.Features.FindWithin(seed.Position, 1e-9);
    EXPECT_FALSE(isNear && found) << "an earlier point is in the way of a shared one";
  }
}

// The pieces that threads start from: all living simplices, once, and near each other.
TEST(Seeding, LivingSimplicesAreOrderedForAnyNumberOfThreads)
{
  const BallDomainOf<3> ball(5.0);
  RefinementContext<3> context(ball, SettingsFor<3>(0.4), Around(ball, 0.4), 1000);
  RefinementWorker<3> worker(context);
  InsertSeeds<Rules3D>(context, worker, SampleInterfaces(context, 0.2, 0.4, 1));
  const std::vector<SimplexId> byOne = LivingAlongCurve(context.Mesh, 1);
  std::vector<SimplexId> sorted = byOne;
  std::sort(sorted.begin(), sorted.end());
  std::vector<SimplexId> living = AliveIn(context.Mesh);
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
