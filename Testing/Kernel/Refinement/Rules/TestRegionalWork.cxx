// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Phantoms.h"
#include "Refinement/Rules/RegionalWork.h"
#include "Refinement/Rules/Rules3D.h"
#include "Refinement/Rules/Rules4D.h"
#include "Sanitizers.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <thread>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** Points of the sample spacing rule keep Delta(z) from all others: a region has room for no more than this number of them. */
constexpr std::uint64_t MostSampled = 1000;

template <int D>
auto Region(const Point<D>& place, double spacing)
{
  return RegionalWork<D>::RegionOf(place, spacing);
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(RegionalWork, CountsTheInsertionsOfEachRegion)
{
  RegionalWork<3> work(1000);
  const Point<3> here{ 0.5, 0.5, 0.5 };
  const Point<3> beside{ 2.9, 0.1, 2.0 }; // in the same cell of side 3
  const Point<3> behind{ 3.1, 0.5, 0.5 };
  EXPECT_EQ(work.At(Region<3>(here, 1.0)), 0u);
  for (std::uint32_t n = 0; n < 10; ++n)
  {
    EXPECT_EQ(work.Add(Region<3>(n % 2 == 0 ? here : beside, 1.0 + 0.018 * n)), n);
  }
  EXPECT_EQ(work.At(Region<3>(beside, 1.18)), 10u);
  EXPECT_EQ(work.At(Region<3>(behind, 1.18)), 0u);
  EXPECT_EQ(work.At(Region<3>(here, 0.99)), 0u) << "finer regions have counts of their own";
  EXPECT_EQ(work.At(Region<3>(here, 1.2)), 0u);
  EXPECT_EQ(work.At(Region<3>({ -0.5, 0.5, 0.5 }, 1.0)), 0u);
}

// More regions than the table was made for: all are counted, few too often.
TEST(RegionalWork, NeverCountsTooFew)
{
  RegionalWork<3> work(1000);
  const auto place = [](int i) { return Point<3>{ 4.0 * i + 0.5, 4.0 * (i % 7) + 0.5, 0.5 }; };
  constexpr int regions = 4000;
  for (int i = 0; i < regions; ++i)
  {
    for (int n = 0; n <= i % 3; ++n)
    {
      work.Add(Region<3>(place(i), 1.0));
    }
  }
  int tooOften = 0;
  for (int i = 0; i < regions; ++i)
  {
    const auto counted = static_cast<int>(work.At(Region<3>(place(i), 1.0)));
    ASSERT_GE(counted, i % 3 + 1);
    ASSERT_LE(counted, 20);
    tooOften += counted > 3 ? 1 : 0;
  }
  EXPECT_LT(tooOften, regions / 5);
}

TEST(RegionalWork, CountsWhatThreadsInsertAtOnce)
{
  RegionalWork<4> work(1000);
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t)
  {
    threads.emplace_back(
      [&]
      {
        for (int n = 0; n < 10000; ++n)
        {
          work.Add(Region<4>({ 0.5, 0.5, 0.5, 0.5 }, 1.0));
        }
      });
  }
  threads.clear();
  EXPECT_EQ(work.At(Region<4>({ 0.5, 0.5, 0.5, 0.5 }, 1.0)), 40000u);
}

TEST(RegionalWork, RulesGiveWayStepByStep)
{
  EXPECT_EQ(RelaxationAfter(0, 100), Relaxation::Nothing);
  EXPECT_EQ(RelaxationAfter(99, 100), Relaxation::Nothing);
  EXPECT_EQ(RelaxationAfter(100, 100), Relaxation::Slivers);
  EXPECT_EQ(RelaxationAfter(200, 100), Relaxation::Spacing);
  EXPECT_EQ(RelaxationAfter(399, 100), Relaxation::Spacing);
  EXPECT_EQ(RelaxationAfter(400, 100), Relaxation::All);
}

//------------------------------------------------------------------------------------------------
/** Bounds that no mesh can keep: without a limit refinement goes on until there is no room for points any more. */
template <int D, typename Rules>
void ExpectEnd(const LabelImage<D>& image, MeshingOptions<D> options, unsigned several)
{
  options.Limits.Force = true;
  for (const unsigned threads : { 1u, several })
  {
    if (Sanitized && threads == 1)
    {
      continue;
    }
    options.Team.Threads = threads;
    MeshingStatistics statistics;
    ExpectSound(MeshOf(image, options, &statistics));
    EXPECT_GE(statistics.Rules.LargestRegionalWork, Rules::WorkLimit);
    EXPECT_LE(statistics.Rules.LargestRegionalWork, 4 * Rules::WorkLimit + MostSampled);
    ASSERT_FALSE(statistics.RelaxedRegions.empty());
    EXPECT_EQ(statistics.RelaxedRegions.front().Voxel.size(), static_cast<std::size_t>(D));
    EXPECT_TRUE(D == 4 ||
      std::any_of(statistics.RelaxedRegions.begin(), statistics.RelaxedRegions.end(),
        [](const RelaxationReport& region) { return region.Step == 1; }));
  }
}

TEST(RegionalWork, EndsWhereSliverBoundsCannotBeKept)
{
  MeshingOptions<3> options = WithDelta<3>(2.0);
  options.Shape.Slivers.Angle = 40.0;
  ExpectEnd<3, Rules3D>(phantoms::Ball(8.0), options, 4);
}

TEST(RegionalWork, IsModestOnPhantoms)
{
  MeshingStatistics statistics;
  MeshOf(phantoms::NestedBalls(9.0), WithDelta<3>(1.5), &statistics);
  EXPECT_GT(statistics.Rules.LargestRegionalWork, 0u);
  EXPECT_LT(statistics.Rules.LargestRegionalWork, Rules3D::WorkLimit / 2);
  EXPECT_TRUE(statistics.RelaxedRegions.empty());
}

/** Two frames so near to each other that all circumcentres lie far beyond them. */
TEST(RegionalWork, IsCountedWherePointsAreMovedTo)
{
  const double space = 0.6510869561479895;
  LabelImage<4> image = LabelImage<4>::FromScalars<std::uint8_t>(
    std::vector<std::uint8_t>{ 0, 0, 1, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1 },
    GridGeometry<4>::Orthogonal({ 2, 2, 2, 2 }, { space, space, space, 0.20051644901783508 }));
  MeshingOptions<4> options = SpaceTimeOptions(0.72);
  options.SmoothingSigma = 2.5803734861743171;
  MeshingStatistics statistics;
  ExpectSound(MeshOf(image, options, &statistics));
  EXPECT_LT(statistics.Rules.Insertions(), 10000u);
}

TEST(RegionalWork, EndsWhereVolumeBoundsCannotBeKept)
{
  MeshingOptions<4> options = WithDelta<4>(2.0);
  options.SpaceTime.Slivers.VolumeBound = 0.3;
  ExpectEnd<4, Rules4D>(ImageOf(phantoms::FourBall(4.0)), options, 3);
}
