// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Volumes of cuts beside those of voxels: of single simplices, and of meshes of a series.
#include "Geometry/SimplexQuality.h"
#include "Quality/FrameVolumes.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

using namespace voxplex;
using namespace voxplex::checks;

TEST(FrameVolumes, DensityOfCuts)
{
  // All volume is at some time, and at a time between one vertex and four it is a power.
  const std::array<double, 5> times = { 0.0, 1.0, 2.5, 3.0, 5.0 };
  double sum = 0.0;
  constexpr int steps = 5000;
  for (int i = 0; i < steps; ++i)
  {
    sum += CutDensity(times, 5.0 * (i + 0.5) / steps, false) * 5.0 / steps;
  }
  EXPECT_NEAR(sum, 1.0, 1e-6);
  EXPECT_NEAR(CutDensity(times, 0.5, false) / CutDensity(times, 0.25, false), 8.0, 1e-12);
  // Flat ends are cut on one side only.
  for (const bool fromAbove : { false, true })
  {
    EXPECT_EQ(CutDensity({ 1.0, 1.0, 1.0, 1.0, 2.0 }, 1.0, fromAbove), fromAbove ? 4.0 : 0.0);
    EXPECT_EQ(CutDensity({ 0.0, 1.0, 1.0, 1.0, 1.0 }, 1.0, fromAbove), fromAbove ? 0.0 : 4.0);
    EXPECT_EQ(CutDensity(times, 6.0, fromAbove), 0.0);
  }
}

TEST(FrameVolumes, TheWorstFrame)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(9, 1.0));
  SimplexMesh<4> mesh = MeshOf(image, SpaceTimeOptions(3.0));
  const FramesOff before = CompareFrames(mesh, image);
  ASSERT_GT(before.Number, 0u); // coarse: the inner ball is too small
  const auto frame = static_cast<double>(before.Frame);
  const bool isEnd = before.Frame == 0 || before.Frame == 8;
  const auto cut = isEnd ? EndVolumes(mesh, frame) : SliceVolumes(mesh, frame);
  const auto scalars = PulsatingBalls(9, 1.0).Scalars();
  const auto first = scalars.begin() + before.Frame * 24 * 24 * 24;
  const auto voxels = std::count(first, first + 24 * 24 * 24, before.Label);
  EXPECT_NEAR(before.Share, cut.at(before.Label) / static_cast<double>(voxels), 1e-9);
  // Elements of label 1 become those of label 2 at first.
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    const auto v = mesh.PointsOf(s);
    const bool isEarly =
      std::all_of(v.begin(), v.end(), [](const Point<4>* p) { return (*p)[3] < 4.0; });
    mesh.Labels[s] = isEarly ? 2 : mesh.Labels[s];
  }
  const FramesOff off = CompareFrames(mesh, image);
  EXPECT_EQ(off.Label, 1);
  EXPECT_EQ(off.Frame, 0);
  EXPECT_LT(off.Share, 0.1);
  EXPECT_GT(off.Number, 2u);
}

// It is cut at the frames that there are.
TEST(FrameVolumes, AnElementBeginsBeforeTheFirstFrame)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(9, 1.0));
  SimplexMesh<4> mesh;
  mesh.Points = { { 0, 0, 0, -2.0 }, { 48, 0, 0, 1.0 }, { 0, 48, 0, 1.0 }, { 0, 0, 48, 1.0 },
    { 0, 0, 0, 12.0 } };
  mesh.Simplices = { { 0, 1, 2, 3, 4 } };
  mesh.Labels = { 2 };
  const double volume = SignedVolume<4>(mesh.PointsOf(0).data());
  const FramesOff off = CompareFrames(mesh, image);
  EXPECT_EQ(off.Label, 2); // by far too large
  const double cut = volume *
    CutDensity({ -2.0, 1.0, 1.0, 1.0, 12.0 }, static_cast<double>(off.Frame), off.Frame == 0);
  const auto scalars = PulsatingBalls(9, 1.0).Scalars();
  const auto first = scalars.begin() + off.Frame * 24 * 24 * 24;
  EXPECT_NEAR(off.Share * static_cast<double>(std::count(first, first + 24 * 24 * 24, 2)),
    std::abs(cut), 1e-6);
}
