// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// TiledRefiner: the same triangulation for any number of threads, with nothing left to refine.
#include "BallDomain.h"
#include "Refinement/Refiner.h"
#include "Refinement/Rules3D.h"
#include "Refinement/Rules4D.h"
#include "Refinement/Tiles/TiledRefiner.h"
#include "RefinementChecks.h"
#include "Sanitizers.h"
#include "TriangulationVerifier.h"

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
  RefinementSettings<D> settings;
  settings.Sizing.Base = { delta };
  settings.Shape.Slivers.Angle = 9.0;
  RefinementContext<D> context(ball, settings, Around(ball, delta), 1000);
  TeamOptions team = TeamOptions::Default<D>();
  team.Threads = threads;
  TiledRefiner<Rules> refiner(context, team);
  EXPECT_TRUE(refiner.Run(nullptr));
  EXPECT_EQ(refiner.GetThreadStatistics().size(), threads);
  // In 4D one thread may insert all and the others help in its loops, if they wake up in time.
  EXPECT_TRUE(D == 4 || refiner.GetNumberOfTiles() > 4) << "the threads had nothing to do";

  const std::vector<std::string> complaints = checks::Verify(context.Mesh);
  EXPECT_TRUE(complaints.empty()) << complaints.front();
  Result<D> result;
  for (VertexId v = 0; v < context.Mesh.VertexIdEnd(); ++v)
  {
    if (context.Mesh.GetVertex(v).Alive)
    {
      result.Positions.push_back(context.Mesh.Position(v));
    }
  }
  for (SimplexId s = 0; s < context.Mesh.SimplexIdEnd(); ++s)
  {
    if (context.Mesh.IsAlive(s))
    {
      result.Simplices.push_back(context.Mesh.GetSimplex(s).V);
    }
  }
  result.Evaluated = refiner.GetRuleStatistics().Evaluated;

  Refiner<Rules> again(context);
  EXPECT_TRUE(again.Run(nullptr));
  for (const std::uint64_t fired : again.GetRuleStatistics().Fired)
  {
    EXPECT_EQ(fired, 0u);
  }
  return result;
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(TiledRefinement, DoesNotDependOnThreads3D)
{
  const Result<3> one = Refine<Rules3D>(20.0, 1.0, 1);
  EXPECT_GT(one.Simplices.size(), 20000u);
  for (const unsigned threads : { 2u, 3u, 8u })
  {
    const Result<3> several = Refine<Rules3D>(20.0, 1.0, threads);
    EXPECT_TRUE(several.Positions == one.Positions) << threads;
    EXPECT_TRUE(several.Simplices == one.Simplices) << threads;
    EXPECT_EQ(several.Evaluated, one.Evaluated) << threads;
  }
}

TEST(TiledRefinement, DoesNotDependOnThreads4D)
{
  const double radius = Sanitized ? 8.0 : 12.0;
  const Result<4> one = Refine<Rules4D>(radius, 2.0, 1);
  EXPECT_GT(one.Simplices.size(), 5000u);
  for (const unsigned threads : { 2u, 5u })
  {
    const Result<4> several = Refine<Rules4D>(radius, 2.0, threads);
    EXPECT_TRUE(several.Positions == one.Positions) << threads;
    EXPECT_TRUE(several.Simplices == one.Simplices) << threads;
    EXPECT_EQ(several.Evaluated, one.Evaluated) << threads;
  }
}

// Without tiles side by side ids are not replaced in the end. They come from the first worker, so it must do all.
TEST(TiledRefinement, OneTileIsTheFirstWorkers)
{
  const BallDomainOf<4> ball(3.0);
  RefinementSettings<4> settings;
  settings.Sizing.Base = { 2.0 };
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
  RefinementSettings<3> settings;
  settings.Sizing.Base = { 0.8 };
  RefinementContext<3> context(ball, settings, Around(ball, 0.8), 1000);
  TeamOptions team;
  team.Threads = 3;
  TiledRefiner<Rules3D> refiner(context, team);
  EXPECT_FALSE(refiner.Run([](std::uint64_t vertices) { return vertices < 4000; }));
  EXPECT_LT(context.Mesh.VertexIdEnd(), 9000u);
}
