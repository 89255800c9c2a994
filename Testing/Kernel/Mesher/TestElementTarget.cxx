// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Meshes of a given number of elements.
#include "Base/Error.h"
#include "CallableSize.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Mesher/DeltaSearch.h"
#include "Phantoms.h"
#include "Sanitizers.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

double Deviation(std::size_t elements, std::uint64_t target)
{
  return std::abs(static_cast<double>(elements) / static_cast<double>(target) - 1.0);
}

std::shared_ptr<SizeFunction<3>> Size(std::function<double(const Point<3>&, std::int64_t)> f)
{
  return std::make_shared<CallableSize>(std::move(f));
}

} // namespace

TEST(ElementTarget, IsMetOnPhantoms)
{
  const std::pair<const char*, LabelImage<3>> images[] = { { "ball", phantoms::Ball(20.0) },
    { "nested balls", phantoms::NestedBalls(18.0) }, { "torus", phantoms::Torus(15.0, 6.0) },
    { "touching labels", phantoms::TouchingLabels(24) }, { "sheet", phantoms::Sheet(30) } };
  for (const auto& [name, image] : images)
  {
    for (const std::uint64_t target : { 6000u, 30000u })
    {
      if (Sanitized && target > 6000)
      {
        continue;
      }
      for (const unsigned threads : { 1u, 4u })
      {
        if (Sanitized && threads == 1)
        {
          continue;
        }
        MeshingOptions<3> options;
        options.Sampling.Elements = target;
        options.Team.Threads = threads;
        MeshingStatistics statistics;
        const SimplexMesh<3> mesh = MeshOf(image, options, &statistics);
        EXPECT_LE(Deviation(mesh.Simplices.size(), target), DeltaSearch::Tolerance)
          << name << ' ' << target << ' ' << threads;
        ExpectSound(mesh);

        // The statistics are of the run whose mesh was taken.
        EXPECT_EQ(statistics.ElementsAskedFor, target);
        ASSERT_FALSE(statistics.Runs.empty());
        EXPECT_LE(statistics.Runs.size(), 6u) << name << ' ' << target;
        const auto taken = std::find_if(statistics.Runs.begin(), statistics.Runs.end(),
          [&](const MeshingRun& run) { return run.Delta == statistics.Delta; });
        ASSERT_NE(taken, statistics.Runs.end());
        EXPECT_EQ(taken->Elements, mesh.Simplices.size());
        EXPECT_LT(statistics.Rules.Insertions(), 2 * mesh.Simplices.size());
        if (threads == 1)
        {
          const SimplexMesh<3> same = MeshOf(image, WithDelta<3>(statistics.Delta));
          EXPECT_EQ(same.Points, mesh.Points) << name << ' ' << target;
          EXPECT_EQ(same.Simplices, mesh.Simplices);
        }
      }
    }
  }
}

TEST(ElementTarget, SizesStay)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<3> image = phantoms::NestedBalls(18.0);
  MeshingOptions<3> options;
  options.Sampling.Elements = 40000;
  options.Sampling.Size =
    Size([](const Point<3>&, std::int64_t label) { return label == 7 ? 1.6 : 9.0; });
  options.Sampling.InterfaceSizes = { { 200, 0, 1.2 } };
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = MeshOf(image, options, &statistics);
  EXPECT_LE(Deviation(mesh.Simplices.size(), 40000), DeltaSearch::Tolerance);
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    ASSERT_LT(Circumradius(mesh, t), mesh.Labels[t] == 7 ? 1.6 + 1e-9 : 9.0);
  }
}

TEST(ElementTarget, CountsWhatOptimisationLeaves)
{
  MeshingOptions<3> options;
  options.Sampling.Elements = 20000;
  options.Optimisation.Run = true;
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = MeshOf(phantoms::NestedBalls(18.0), options, &statistics);
  EXPECT_LE(Deviation(mesh.Simplices.size(), 20000), DeltaSearch::Tolerance);
  EXPECT_TRUE(statistics.Optimisation.Ran);
  EXPECT_EQ(statistics.Runs.back().Elements, mesh.Simplices.size());
}

// The first guess knows nothing of the fine interface, so it has too many elements.
TEST(ElementTarget, RunsDoNotTouchEachOther)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<3> image = phantoms::TouchingLabels(30);
  MeshingOptions<3> options;
  options.Sampling.Elements = 20000;
  options.Sampling.InterfaceSizes = { { 1, 2, 0.8 } };
  options.Optimisation.Run = true;
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = MeshOf(image, options, &statistics);
  ASSERT_GT(statistics.Runs.size(), 1u);
  options.Sampling.Elements = 0;
  options.Sampling.Delta = statistics.Delta;
  MeshingStatistics direct;
  EXPECT_EQ(MeshOf(image, options, &direct).Points, mesh.Points);
  EXPECT_EQ(direct.Rules.Insertions(), statistics.Rules.Insertions());
  EXPECT_EQ(direct.Interfaces.JunctionCurves, statistics.Interfaces.JunctionCurves);
  EXPECT_EQ(direct.Interfaces.JunctionSeeds, statistics.Interfaces.JunctionSeeds);
  EXPECT_EQ(direct.Components.Found, statistics.Components.Found);

  // A run that is far off is not optimised.
  options.Sampling.Delta = statistics.Runs.front().Delta;
  options.Optimisation.Run = false;
  options.Shape.Slivers.AngleInside = 1.0; // as with optimisation
  const auto elements = static_cast<double>(MeshOf(image, options).Simplices.size());
  EXPECT_NEAR(static_cast<double>(statistics.Runs.front().Elements), 0.96 * elements, 1.0);
}

// Many small balls: the count goes up and down with delta, so the last run need not be the one that is nearest.
TEST(ElementTarget, KeepsTheNearestRunNotTheLast)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(44),
    [](const Point<3>& p) -> std::int16_t
    {
      double distance2 = 0.0;
      for (const double x : p)
      {
        const double d = std::fmod(x, 11.0) - 5.0;
        distance2 += d * d;
      }
      return distance2 <= 1.6 * 1.6 ? 1 : 0;
    });
  int earlier = 0;
  for (std::uint64_t target = 2000; target < 3300; target += 97)
  {
    MeshingOptions<3> options;
    options.Sampling.Elements = target;
    options.Components.Exact = true;
    ImageMesher<3> mesher(options);
    SimplexMesh<3> mesh;
    if (MessageOf([&] { EXPECT_EQ(mesher.Run(image, mesh), MeshingOutcome::Done); }) != "")
    {
      continue; // no delta makes this number
    }
    const std::vector<MeshingRun>& runs = mesher.Statistics().Runs;
    const auto nearest = std::min_element(runs.begin(), runs.end(),
      [&](const MeshingRun& a, const MeshingRun& b)
      { return Deviation(a.Elements, target) < Deviation(b.Elements, target); });
    EXPECT_EQ(mesher.Statistics().Delta, nearest->Delta) << target;
    EXPECT_EQ(mesh.Simplices.size(), nearest->Elements) << target;
    earlier += nearest + 1 != runs.end() ? 1 : 0;
  }
  EXPECT_GT(earlier, 0) << "no test";
}

TEST(ElementTarget, GoesWithGradingByLocalFeatureSize)
{
  const LabelImage<3> image = phantoms::NestedBalls(24.0);
  MeshingOptions<3> options;
  options.Sampling.Elements = 7000;
  options.Sampling.Grading.Mode = GradingMode::LocalFeatureSize;
  options.Sampling.Grading.Ratio = 0.5;
  options.Sampling.InterfaceSizes = { { 7, 3, 1.5 } };
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = MeshOf(image, options, &statistics);
  EXPECT_LE(Deviation(mesh.Simplices.size(), 7000), DeltaSearch::Tolerance);
  EXPECT_GT(statistics.GradingPoles, 0u);
  options.Sampling.Elements = 0;
  options.Sampling.Delta = statistics.Delta;
  MeshingStatistics direct;
  const SimplexMesh<3> same = MeshOf(image, options, &direct);
  EXPECT_EQ(same.Points, mesh.Points);
  EXPECT_EQ(same.Simplices, mesh.Simplices);
  EXPECT_EQ(direct.GradingSamples, statistics.GradingSamples);
  EXPECT_EQ(direct.Interfaces.Rounds, statistics.Interfaces.Rounds);
  EXPECT_EQ(direct.Interfaces.JunctionSeeds, statistics.Interfaces.JunctionSeeds);
}

TEST(ElementTarget, EndsWhereGradingAllowsNoMore)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  // The local feature size of a ball is its radius: small deltas change nothing.
  MeshingOptions<3> options;
  options.Sampling.Elements = 100000;
  options.Sampling.Grading.Mode = GradingMode::LocalFeatureSize;
  SimplexMesh<3> mesh;
  const std::string text =
    MessageOf([&] { ImageMesher<3>(options).Run(phantoms::Ball(12.0), mesh); });
  EXPECT_NE(text.find("keeps interfaces coarse with every delta"), std::string::npos) << text;
}

TEST(ElementTarget, WorksInSpaceTime)
{
  MeshingOptions<4> options = SpaceTimeOptions(0.0);
  options.Sampling.Elements = 9000;
  const SimplexMesh<4> mesh = MeshOf(ImageOf(PulsatingBalls(7, 1.0)), options);
  EXPECT_LE(Deviation(mesh.Simplices.size(), 9000), DeltaSearch::Tolerance);
}

TEST(ElementTarget, SaysWhatIsNearestIfThereIsNone)
{
  MeshingOptions<3> options;
  options.Sampling.Elements = 2000;
  options.Sampling.Size = Size([](const Point<3>&, std::int64_t) { return 1.0; });
  SimplexMesh<3> mesh;
  const std::string text =
    MessageOf([&] { ImageMesher<3>(options).Run(phantoms::Ball(10.0), mesh); });
  EXPECT_EQ(text.find("no delta makes a mesh of 2000 elements within 10 %: the nearest of "), 0u)
    << text;
  EXPECT_NE(text.find(" has "), std::string::npos) << text;
}

TEST(ElementTarget, GoesWithoutDelta)
{
  MeshingOptions<3> options;
  options.Sampling.Elements = 2000;
  options.Sampling.Delta = 1.0;
  SimplexMesh<3> mesh;
  EXPECT_THROW(ImageMesher<3>(options).Run(phantoms::Ball(10.0), mesh), InputError);
}

TEST(ElementTarget, ProgressNeverFallsAndAnyRunCanBeCancelled)
{
  const LabelImage<3> image = phantoms::NestedBalls(24.0);
  MeshingOptions<3> options;
  options.Sampling.Elements = Sanitized ? 6000 : 60000;
  ImageMesher<3> mesher(options);
  double last = 0.0;
  bool falls = false;
  mesher.Progress = [&](double fraction)
  {
    falls |= fraction < last;
    last = fraction;
    return true;
  };
  SimplexMesh<3> mesh;
  EXPECT_EQ(mesher.Run(image, mesh), MeshingOutcome::Done);
  EXPECT_FALSE(falls);
  EXPECT_EQ(last, 1.0);
  for (const double until : { 0.01, 0.3, 0.6 })
  {
    mesher.Progress = [&](double fraction) { return fraction < until; };
    EXPECT_EQ(mesher.Run(image, mesh), MeshingOutcome::Cancelled) << until;
    EXPECT_TRUE(mesh.Simplices.empty());
  }
}
