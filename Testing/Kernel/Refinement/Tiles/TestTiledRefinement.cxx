// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// TiledRefiner: the same triangulation for any number of threads, with nothing left to refine.
#include "BallDomain.h"
#include "Refinement/Refiner.h"
#include "Refinement/Rules/Rules3D.h"
#include "Refinement/Rules/Rules4D.h"
#include "Refinement/Tiles/TiledRefiner.h"
#include "RefinementChecks.h"
#include "Sanitizers.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** What a refinement leaves, with its numbers. */
template <int D>
struct Result
{
  std::vector<Point<D>> Positions;
  std::vector<std::array<VertexId, D + 1>> Simplices;
  std::uint64_t Evaluated = 0;
};

template <typename Rules, int D = Rules::Dimension>
Result<D> Refine(double radius, double delta, unsigned threads)
{
  const BallDomainOf<D> ball(radius);
  RefinementSettings<D> settings = SettingsFor<D>(delta);
  settings.Shape.Slivers.Angle = 9.0;
  RefinementContext<D> context(ball, settings, Around(ball, delta), 1000);
  TeamOptions team = TeamOptions::Default<D>();
  team.Threads = threads;
  TiledRefiner<Rules> refiner(context, team);
  EXPECT_TRUE(refiner.Run(nullptr));
  EXPECT_EQ(refiner.GetThreadStatistics().size(), threads);
  // In 4D one thread may insert all and the others help in its loops, if they wake up in time.
  EXPECT_TRUE(D == 4 || refiner.GetNumberOfTiles() > 4) << "the threads had nothing to do";

  ExpectSound(context.Mesh);
  Result<D> result;
  for (VertexId v = 0; v < context.Mesh.VertexIdEnd(); ++v)
  {
    if (context.Mesh.GetVertex(v).Alive)
    {
      result.Positions.push_back(context.Mesh.Position(v));
    }
  }
  for (const SimplexId s : AliveIn(context.Mesh))
  {
    result.Simplices.push_back(context.Mesh.GetSimplex(s).V);
  }
  result.Evaluated = refiner.GetRuleStatistics().Evaluated;
  ExpectNothingLeft<Rules>(context);
  return result;
}

template <typename Rules>
void CompareThreads(double radius, double delta, const std::vector<unsigned>& numbers)
{
  const auto one = Refine<Rules>(radius, delta, 1);
  EXPECT_GT(one.Simplices.size(), 5000u);
  for (const unsigned threads : numbers)
  {
    const auto several = Refine<Rules>(radius, delta, threads);
    EXPECT_TRUE(several.Positions == one.Positions) << threads;
    EXPECT_TRUE(several.Simplices == one.Simplices) << threads;
    EXPECT_EQ(several.Evaluated, one.Evaluated) << threads;
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(TiledRefinement, DoesNotDependOnThreads)
{
  CompareThreads<Rules3D>(20.0, 1.0, { 2, 3, 8 });
  CompareThreads<Rules4D>(Sanitized ? 8.0 : 12.0, 2.0, { 2, 5 });
}

// Without tiles side by side ids are not replaced in the end. They come from the first worker, so it must do all.
TEST(TiledRefinement, OneTileIsTheFirstWorkers)
{
  const BallDomainOf<4> ball(3.0);
  const RefinementSettings<4> settings = SettingsFor<4>(2.0);
  TeamOptions team = TeamOptions::Default<4>();
  team.Threads = 8;
  for (int run = 0; run < (Sanitized ? 20 : 200); ++run)
  {
    RefinementContext<4> context(ball, settings, Around(ball, 2.0), 1000);
    TiledRefiner<Rules4D> refiner(context, team);
    ASSERT_TRUE(refiner.Run(nullptr));
    ASSERT_EQ(refiner.GetNumberOfTiles(), 0u);
    const std::vector<ThreadStatistics> threads = refiner.GetThreadStatistics();
    EXPECT_GT(threads[0].Insertions, 0u);
    for (std::size_t t = 1; t < threads.size(); ++t)
    {
      ASSERT_EQ(threads[t].Insertions, 0u) << run;
    }
  }
}

TEST(TiledRefinement, StopsWhenItIsAskedTo)
{
  const BallDomain ball(20.0);
  RefinementContext<3> context(ball, SettingsFor<3>(0.8), Around(ball, 0.8), 1000);
  TeamOptions team;
  team.Threads = 3;
  TiledRefiner<Rules3D> refiner(context, team);
  EXPECT_FALSE(refiner.Run([](std::uint64_t vertices) { return vertices < 4000; }));
  EXPECT_LT(context.Mesh.VertexIdEnd(), 9000u);
}
