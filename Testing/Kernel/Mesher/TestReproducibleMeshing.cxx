// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Reproducible meshes: with any number of threads the same, bit for bit, with everything on.
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Phantoms.h"
#include "Sanitizers.h"
#include "SpaceTimeCases.h"
#include "ThreadTesting.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

using namespace voxplex;
using voxplex::testing::Watchdog;

namespace
{

template <int D>
void ExpectSameForAnyNumberOfThreads(
  const std::string& name, const LabelImage<D>& image, MeshingOptions<D> options)
{
  SCOPED_TRACE(name);
  options.Team.Reproducible = true;
  options.Limits.Force = true;
  SimplexMesh<D> expected;
  RuleStatistics rules;
  const std::vector<unsigned> numbers =
    Sanitized ? std::vector<unsigned>{ 1, 5 } : std::vector<unsigned>{ 1, 3, 16 };
  for (const unsigned threads : numbers)
  {
    const Watchdog watchdog(name + ", threads: " + std::to_string(threads));
    SCOPED_TRACE(std::to_string(threads) + " threads");
    options.Team.Threads = threads;
    ImageMesher<D> mesher(options);
    SimplexMesh<D> mesh;
    ASSERT_EQ(mesher.Run(image, mesh), MeshingOutcome::Done);
    EXPECT_EQ(mesher.Statistics().Threads.size(), threads);
    if (threads == 1)
    {
      checks::ExpectSound(mesh);
      ASSERT_GT(mesh.Simplices.size(), 100u);
      expected = std::move(mesh);
      rules = mesher.Statistics().Rules;
      continue;
    }
    checks::ExpectSame(mesh, expected);
    EXPECT_EQ(mesher.Statistics().Rules.Evaluated, rules.Evaluated);
    EXPECT_EQ(mesher.Statistics().Rules.Insertions(), rules.Insertions());
    EXPECT_EQ(mesher.Statistics().Rules.Removed, rules.Removed);
  }
}

/** Everything that the program does by default. */
MeshingOptions<3> Default(double delta)
{
  MeshingOptions<3> options = checks::WithDelta<3>(Sanitized ? 1.5 * delta : delta);
  options.Components.Smallest = 8;
  options.Optimisation.Run = true;
  return options;
}

GridGeometry<3> Tilted(std::int64_t n)
{
  GridGeometry<3> grid = phantoms::Cube(n);
  grid.IndexToFrame[0][1] = 0.4;
  grid.IndexToFrame[1][2] = -0.3;
  return grid;
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(ReproducibleMeshing, Balls)
{
  ExpectSameForAnyNumberOfThreads<3>("nested balls", phantoms::NestedBalls(14.0), Default(1.0));
  ExpectSameForAnyNumberOfThreads<3>("ball", phantoms::Ball(20.0), Default(1.0));
  ExpectSameForAnyNumberOfThreads<3>("cut ball", phantoms::CutBall(14), Default(1.0));
}

TEST(ReproducibleMeshing, LabelsThatMeet)
{
  ExpectSameForAnyNumberOfThreads<3>("labels", phantoms::TouchingLabels(16), Default(1.2));
  ExpectSameForAnyNumberOfThreads<3>("cells", phantoms::CutCells(3, 20, 6, 1), Default(1.5));
}

TEST(ReproducibleMeshing, ThinAndFlatThings)
{
  ExpectSameForAnyNumberOfThreads<3>("sheet", phantoms::Sheet(28), Default(1.2));
  ExpectSameForAnyNumberOfThreads<3>("torus", phantoms::Torus(14.0, 3.0), Default(1.0));
  ExpectSameForAnyNumberOfThreads<3>("block", phantoms::Block(phantoms::Cube(24)), Default(1.5));
  ExpectSameForAnyNumberOfThreads<3>("tilted block", phantoms::Block(Tilted(20)), Default(1.5));
}

TEST(ReproducibleMeshing, Sizes)
{
  MeshingOptions<3> options = Default(2.0);
  options.Sampling.InterfaceSizes = { { 7, InterfaceSize::AnyLabel, 0.8 } };
  ExpectSameForAnyNumberOfThreads<3>("interface sizes", phantoms::NestedBalls(14.0), options);
  options = Default(0.8);
  options.Sampling.Grading.Mode = GradingMode::LocalFeatureSize;
  ExpectSameForAnyNumberOfThreads<3>("graded", phantoms::Torus(14.0, 3.0), options);
  options = Default(0.0);
  options.Sampling.Delta = 0.0;
  options.Sampling.Elements = Sanitized ? 5000 : 20000;
  ExpectSameForAnyNumberOfThreads<3>("20,000 elements", phantoms::Ball(12.0), options);
}

// Everything on that users get.
TEST(ReproducibleMeshing, TimePlanesAndPeriods)
{
  for (const bool isPeriodic : { false, true })
  {
    MeshingOptions<4> options = checks::WithDelta<4>(Sanitized ? 3.5 : 2.0);
    options.Optimisation.Run = true;
    options.Components.Smallest = 8;
    options.Planes.Times = isPeriodic ? std::vector<double>() : std::vector<double>{ 5.0, 11.0 };
    options.Planes.Periodic = isPeriodic;
    ExpectSameForAnyNumberOfThreads<4>(isPeriodic ? "a period" : "planes",
      checks::ImageOf(checks::PulsatingBalls(17, 1.0, 2.5)), options);
  }
}

TEST(ReproducibleMeshing, SpaceTime)
{
  const double delta = Sanitized ? 3.5 : 2.5;
  for (const bool fight : { true, false })
  {
    MeshingOptions<4> options = checks::SpaceTimeOptions(delta);
    options.SpaceTime.Slivers.Fight = fight;
    const std::string name = fight ? "balls with picking" : "balls";
    ExpectSameForAnyNumberOfThreads<4>(
      name, checks::ImageOf(checks::PulsatingBalls(12, 2.0)), options);
  }
  ExpectSameForAnyNumberOfThreads<4>("strong motion",
    checks::ImageOf(checks::PulsatingBalls(10, 2.0, 3.0)), checks::SpaceTimeOptions(delta));
}
