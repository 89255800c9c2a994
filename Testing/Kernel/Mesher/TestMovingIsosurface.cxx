// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Grey-value series: a moving ball whose values are signed distances, against the true ball.
#include "Image/Series/FrameInterpolation.h"
#include "Phantoms.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

constexpr double Radius = 8.0;
constexpr int Frames = 9;

/** The ball's centre; it moves by 0.7 voxels a frame. */
Point<3> Centre(double t)
{
  return { 10.0 + 0.6 * t, 12.3 - 0.3 * t, 11.6 + 0.2 * t };
}

/** How deep a point is in the ball. */
double Depth(const Point<4>& p)
{
  return Radius - Distance(Point<3>{ p[0], p[1], p[2] }, Centre(p[3]));
}

GridGeometry<4> Grid()
{
  return GridGeometry<4>::Orthogonal({ 26, 24, 26, Frames }, { 1.0, 1.0, 1.0, 1.0 });
}

std::vector<float> Values()
{
  return phantoms::Sample<float>(Grid(), Depth);
}

double BallVolume(double radius)
{
  return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

/** The ball's mesh; vertices of lateral facets lie on the isosurface only if it is not fitted. */
SimplexMesh<4> MeshOf(const IsosurfaceImage<4>& image, bool fit)
{
  MeshingOptions<4> options = WithDelta<4>(2.0);
  options.Interfaces.Fit = fit;
  MeshingStatistics statistics;
  SimplexMesh<4> mesh = checks::MeshOf(image, options, &statistics);
  ExpectSound(mesh);
  EXPECT_EQ(statistics.FrameSteps, 1u);
  EXPECT_EQ(statistics.FrameComponents.Found, static_cast<std::size_t>(Frames));
  EXPECT_TRUE(statistics.FrameComponents.Lost.empty());
  EXPECT_EQ(TimeSpan(mesh), std::pair(0.0, Frames - 1.0));
  return mesh;
}

/** The largest distance of a vertex of the lateral boundary from the true sphere at its time. */
double LargestDistance(const SimplexMesh<4>& mesh)
{
  double largest = 0.0;
  for (const auto& facet : mesh.Facets)
  {
    const Tetrahedron corners = { facet[0], facet[1], facet[2], facet[3] };
    if (LiesAt(mesh, corners, 0.0) || LiesAt(mesh, corners, Frames - 1.0))
    {
      continue;
    }
    for (const std::uint32_t v : facet)
    {
      largest = std::max(largest, std::abs(Depth(mesh.Points[v])));
    }
  }
  return largest;
}

} // namespace

TEST(MovingIsosurface, VolumesOfTheMovingBall)
{
  const std::vector<float> values = Values();
  const auto image = IsosurfaceImage<4>::FromScalars<float>(values, Grid(), {});
  const SimplexMesh<4> mesh = MeshOf(image, true);
  const double expected = (Frames - 1.0) * BallVolume(Radius);
  EXPECT_NEAR(Volumes(mesh)[1], expected, 0.01 * expected);
  for (const double time : { 0.01, 1.0, 2.5, 4.0, 5.7, 7.99 })
  {
    auto slice = SliceVolumes(mesh, time);
    EXPECT_EQ(slice.size(), 1u);
    EXPECT_NEAR(slice[1], BallVolume(Radius), 0.02 * BallVolume(Radius)) << time;
  }
}

TEST(MovingIsosurface, VerticesLieOnTheTrueSurface)
{
  const std::vector<float> values = Values();
  const auto image = IsosurfaceImage<4>::FromScalars<float>(values, Grid(), {});
  // Interpolation alone is off by up to (0.7^2 + 2) / 8 R, 0.04, in time and two axes of space.
  EXPECT_LT(LargestDistance(MeshOf(image, false)), 0.06);
}

// A threshold of the same image as labels.
TEST(MovingIsosurface, IsBetterThanItsSegmentation)
{
  const std::vector<float> values = Values();
  const auto image = IsosurfaceImage<4>::FromScalars<float>(values, Grid(), {});
  std::vector<std::uint8_t> labels;
  for (const float value : values)
  {
    labels.push_back(value >= 0.0f);
  }
  const SimplexMesh<4> mesh =
    checks::MeshOf(LabelImage<4>::FromScalars<std::uint8_t>(labels, Grid()), SpaceTimeOptions(2.0));
  EXPECT_GT(LargestDistance(mesh), 3.0 * LargestDistance(MeshOf(image, false)));
}

TEST(MovingIsosurface, OtherSideAndLabel)
{
  std::vector<float> values = Values();
  for (float& value : values)
  {
    value = 100.0f - 3.0f * value;
  }
  const auto image = IsosurfaceImage<4>::FromScalars<float>(
    values, Grid(), { 103.0, IsosurfaceSide::Below, 12, 0.0 });
  const SimplexMesh<4> mesh = MeshOf(image, true);
  auto volumes = Volumes(mesh);
  ASSERT_EQ(volumes.size(), 1u);
  const double expected = (Frames - 1.0) * BallVolume(Radius + 1.0);
  EXPECT_NEAR(volumes[12], expected, 0.01 * expected);
}

// Frames 3 and 4 are missing: between frames 2 and 5 values are linear in time.
TEST(MovingIsosurface, ScheduledValues)
{
  const std::vector<float> all = Values();
  const std::size_t frame = all.size() / Frames;
  std::vector<float> some;
  for (const std::size_t kept : { 0u, 1u, 2u, 5u, 6u, 7u, 8u })
  {
    some.insert(some.end(), all.begin() + static_cast<std::ptrdiff_t>(kept * frame),
      all.begin() + static_cast<std::ptrdiff_t>((kept + 1) * frame));
  }
  some[2 * frame + 5] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<double> times = { 0, 1, 2, 5, 6, 7, 8 };
  const auto made = ScheduledValues<float>(some, frame, ScheduleFrames(times), 2);
  ASSERT_EQ(made.size(), all.size());
  for (std::size_t i = 0; i < frame; ++i)
  {
    for (const std::size_t kept : { 0u, 1u, 5u, 8u })
    {
      ASSERT_EQ(made[kept * frame + i], all[kept * frame + i]);
    }
    for (const std::size_t missing : { 3u, 4u })
    {
      const float w = static_cast<float>(missing - 2) / 3.0f;
      const float value = made[missing * frame + i];
      if (i == 5)
      {
        EXPECT_TRUE(std::isnan(value));
        continue;
      }
      ASSERT_NEAR(value, (1.0f - w) * all[2 * frame + i] + w * all[5 * frame + i], 1e-5f);
    }
  }
}
