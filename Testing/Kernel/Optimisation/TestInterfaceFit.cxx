// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Vertices of interfaces are moved so that volumes are right; shapes, ends and topology stay.
#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "CallableSize.h"
#include "Domain/ImageDomain.h"
#include "Geometry/Circumball.h"
#include "Geometry/SimplexQuality.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Optimisation/Fit/InterfaceFit.h"
#include "Optimisation/Fit/InterfaceOffsets.h"
#include "Phantoms.h"
#include "Sanitizers.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <stop_token>
#include <string>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

SimplexMesh<4> Mesh(const LabelImage<4>& image, MeshingOptions<4> options, bool fit)
{
  options.Interfaces.Fit = fit;
  options.SpaceTime.Slivers.Fight = true;
  return MeshOf(image, options);
}

/** Points, vertices of interfaces that have moved, and the largest distance, in shortest edges. */
struct Moves
{
  std::size_t Inside = 0;
  std::size_t OnInterfaces = 0;
  std::size_t OnEndsInTime = 0;
};

Moves Compare(const SimplexMesh<4>& before, const SimplexMesh<4>& after)
{
  std::set<std::uint32_t> corners;
  for (const auto& facet : before.Facets)
  {
    corners.insert(facet.begin(), facet.end());
  }
  const auto [first, last] = TimeSpan(before);
  Moves moves;
  for (std::uint32_t v = 0; v < before.Points.size(); ++v)
  {
    const Point<4>& p = before.Points[v];
    const Point<4>& q = after.Points[v];
    if (p == q)
    {
      continue;
    }
    ++(corners.count(v) != 0 ? moves.OnInterfaces : moves.Inside);
    moves.OnEndsInTime += (p[3] == first || p[3] == last) && p[3] != q[3];
  }
  return moves;
}

double SmallestShape(const SimplexMesh<4>& mesh)
{
  double smallest = 1.0;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    smallest = std::min(smallest, NormalizedVolume<4>(mesh.PointsOf(s).data()));
  }
  return smallest;
}

} // namespace

// Seen: -3.3, -3.8, and -2.2 and -1.6 % without; below 0.5 % with it.
TEST(InterfaceFit, MakesVolumesRight)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const std::map<std::string, phantoms::SpaceTimePhantom> phantoms = {
    { "four-ball", phantoms::FourBall(12.0) },
    { "merging balls", phantoms::WithTimeScale(phantoms::MergingBalls(), 2.0) },
    { "pulsating balls", PulsatingBalls(11, 2.0, 1.0) },
  };
  for (const auto& [name, phantom] : phantoms)
  {
    if (Sanitized && name == "merging balls")
    {
      continue;
    }
    SCOPED_TRACE(name);
    const LabelImage<4> image = ImageOf(phantom);
    const SimplexMesh<4> before = Mesh(image, SpaceTimeOptions(2.0), false);
    const SimplexMesh<4> after = Mesh(image, SpaceTimeOptions(2.0), true);
    for (const auto& [label, expected] : Hypervolumes(image))
    {
      SCOPED_TRACE(label);
      // The inner one of the pulsating balls is only two delta across: seen -7 instead of -16 %.
      const bool isSmall = image.NumberOfLabels() == 2 && expected < 10000.0;
      EXPECT_NEAR(Volumes(after)[label], expected, (isSmall ? 0.09 : 0.01) * expected);
      EXPECT_LT(Volumes(before)[label], 0.99 * expected) << "there is nothing to do";
    }

    ASSERT_EQ(before.Simplices, after.Simplices);
    ASSERT_EQ(before.Labels, after.Labels);
    ASSERT_EQ(before.Facets, after.Facets);
    const Moves moves = Compare(before, after);
    EXPECT_EQ(moves.Inside, 0u);
    EXPECT_EQ(image.ReachesBorderInTime(0) ? moves.OnEndsInTime : 0, 0u);
    EXPECT_GT(moves.OnInterfaces, 500u);
    EXPECT_TRUE(Complaints(after).empty());
    EXPECT_GE(SmallestShape(after), SliverOptions().VolumeBound);
    for (std::size_t s = 0; s < after.Simplices.size(); ++s)
    {
      ASSERT_LE(RadiusEdge(after, s), std::max(2.0, RadiusEdge(before, s)) + 1e-9);
    }
  }
}

// A slab that stands still has no chords, but for its edges: there is nothing to gain.
TEST(InterfaceFit, LeavesPlanesAlone)
{
  const LabelImage<4> image =
    ImageOf({ GridGeometry<4>::Orthogonal({ 20, 26, 26, 10 }, { 1.0, 1.0, 1.0, 1.0 }),
      [](const Point<4>& p) -> std::uint8_t { return p[0] > 4.0 && p[0] < 14.0; } });
  const SimplexMesh<4> before = Mesh(image, SpaceTimeOptions(2.0), false);
  const SimplexMesh<4> after = Mesh(image, SpaceTimeOptions(2.0), true);
  ASSERT_EQ(before.Points.size(), after.Points.size());
  const auto isOnSide = [](const Point<4>& p)
  {
    return p[1] > 8.0 && p[1] < 17.0 && p[2] > 8.0 && p[2] < 17.0 &&
      (std::abs(p[0] - 4.5) < 0.1 || std::abs(p[0] - 13.5) < 0.1);
  };
  std::size_t sides = 0;
  for (std::size_t v = 0; v < before.Points.size(); ++v)
  {
    if (isOnSide(before.Points[v]))
    {
      ++sides;
      EXPECT_LT(Distance(before.Points[v], after.Points[v]), 0.05);
    }
  }
  EXPECT_GT(sides, 50u);
}

// The size falls along the first axis, so an element may become too large although it does not grow.
TEST(InterfaceFit, KeepsElementSizes)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<4> image = ImageOf(PulsatingBalls(5, 2.0, 1.0));
  const auto sizeAt = [](const Point<4>& p) { return 2.0 + 0.5 * std::abs(p[0] - 11.5); };
  MeshingOptions<4> options = SpaceTimeOptions(3.0);
  options.Sampling.Size =
    std::make_shared<CallableSizeOf<4>>([&](const Point<4>& p, std::int64_t) { return sizeAt(p); });
  options.Sampling.Gradation = 0.0;
  options.Optimisation.Run = false;
  options.Interfaces.Manifold = false; // so that both meshes have the same elements
  const SimplexMesh<4> before = Mesh(image, options, false);
  const SimplexMesh<4> after = Mesh(image, options, true);
  ASSERT_EQ(before.Simplices, after.Simplices);
  const auto share = [&](const SimplexMesh<4>& mesh, std::size_t s)
  {
    Circumball<4> ball;
    ComputeCircumballExactly<4>(mesh.PointsOf(s).data(), ball);
    return std::sqrt(ball.Radius2) / sizeAt(ball.Center);
  };
  std::size_t changed = 0;
  for (std::size_t s = 0; s < after.Simplices.size(); ++s)
  {
    changed += share(after, s) != share(before, s) ? 1 : 0;
    EXPECT_LE(share(after, s), std::max(1.0, share(before, s)) + 1e-9);
  }
  EXPECT_GT(changed, 1000u);
}

TEST(InterfaceFit, DoesNotDependOnThreads)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(9, 2.0));
  const ImageDomain<4> domain(image, 1.0);
  const MeshingOptions<4> options = SpaceTimeOptions(2.5);
  MeshingOptions<4> reproducible = options;
  reproducible.Team.Reproducible = true;
  SimplexMesh<4> first;
  for (const unsigned threads : { 1u, 3u, 8u })
  {
    reproducible.Team.Threads = threads;
    const SimplexMesh<4> mesh = Mesh(image, reproducible, true);
    if (first.Points.empty())
    {
      first = mesh;
    }
    ExpectSame(mesh, first);
  }
}

namespace
{

/** The largest relative error of a label's volume. */
double WorstVolume(const LabelImage<3>& image, const SimplexMesh<3>& mesh)
{
  const std::map<std::int64_t, double> volumes = Volumes(mesh);
  double worst = 0.0;
  for (std::size_t label = 1; label < image.Values().size(); ++label)
  {
    const double wanted = static_cast<double>(image.Counts()[label]) * image.Grid().VoxelVolume();
    worst = std::max(worst, std::abs(volumes.at(image.Values()[label]) / wanted - 1.0));
  }
  return worst;
}

MeshingOptions<3> Optimised(double delta, bool fit)
{
  MeshingOptions<3> options = WithDelta<3>(delta);
  options.Optimisation.Run = true;
  options.Interfaces.Fit = fit;
  return options;
}

/** A ball in three parts that meet along curves. */
LabelImage<3> BallOfThree()
{
  return phantoms::Make(phantoms::Cube(28),
    [](const Point<3>& p) -> std::int16_t
    {
      const bool isInside = Distance(p, Point<3>{ 13.3, 13.6, 13.4 }) < 9.0;
      return !isInside ? 0 : p[0] > 14.0 ? 1 : p[2] > 14.0 ? 2 : 3;
    });
}

} // namespace

// Seen: 1.8, 5.6, 10 and 17 % of the ball are lost without.
TEST(InterfaceFit, GivesLabelsTheVolumesOfTheirVoxels)
{
  const std::map<std::string, LabelImage<3>> images = { { "ball", phantoms::Ball(9.0) },
    { "ball of three", BallOfThree() }, { "ball that is cut", phantoms::CutBall(9) },
    { "nested balls", phantoms::NestedBalls(15.0) }, { "small voxels", phantoms::Ball(4.5, 0.5) } };
  for (const auto& [name, image] : images)
  {
    const double unit = image.Grid().SmallestSpacing();
    for (const double delta : { 1.0, 2.0, 3.0 })
    {
      SCOPED_TRACE(name + ", " + std::to_string(delta));
      const SimplexMesh<3> mesh = MeshOf(image, Optimised(delta * unit, true));
      ExpectSound(mesh);
      // Parts of a ball have some twenty vertices then, and lack 20 % without.
      const bool isCoarse = image.NumberOfLabels() > 1 && delta > 2.0;
      EXPECT_LT(WorstVolume(image, mesh), isCoarse ? 0.04 : 0.005);
      EXPECT_GT(WorstVolume(image, MeshOf(image, Optimised(delta * unit, false))), 0.01);
    }
  }
}

// The interface is known exactly. With vertices on it, the ball is 1.1 % too small.
TEST(InterfaceFit, GivesIsosurfacesTheirVolume)
{
  const auto grid = GridGeometry<3>::Orthogonal({ 36, 36, 36 }, { 1.0, 1.0, 1.0 });
  std::vector<float> depths;
  for (std::size_t i = 0; i < CountCells(grid.Dimensions); ++i)
  {
    const auto x = IndexAt(i, grid.Dimensions);
    const Point<3> p = { static_cast<double>(x[0]), static_cast<double>(x[1]),
      static_cast<double>(x[2]) };
    depths.push_back(static_cast<float>(12.0 - Distance(p, Point<3>{ 17.5, 17.5, 17.5 })));
  }
  const auto image = IsosurfaceImage<3>::FromScalars<float>(depths, grid, Isosurface{});
  const double volume = 4.0 / 3.0 * std::numbers::pi * 12.0 * 12.0 * 12.0;
  EXPECT_NEAR(WholeVolume(MeshOf(image, Optimised(1.5, true))), volume, 0.005 * volume);
  EXPECT_LT(WholeVolume(MeshOf(image, Optimised(1.5, false))), 0.99 * volume);
}

TEST(InterfaceFit, DoesNotDependOnThreadsInSpace)
{
  MeshingOptions<3> options = Optimised(1.5, true);
  options.Team.Reproducible = true;
  const SimplexMesh<3> first = MeshOf(BallOfThree(), options);
  for (const unsigned threads : { 3u, 8u })
  {
    options.Team.Threads = threads;
    ExpectSame(MeshOf(BallOfThree(), options), first);
  }
}

// Labels 1 and 2 touch each other and background; label 1 is to gain 3, label 2 is to lose 1.
TEST(InterfaceOffsets, GiveEachLabelWhatItIsMissing)
{
  InterfaceOffsets offsets;
  const std::uint32_t outside1 = offsets.Add(1, 0, 10.0, 100.0);
  const std::uint32_t outside2 = offsets.Add(2, 0, 20.0, 100.0);
  const std::uint32_t between = offsets.Add(2, 1, 5.0, 100.0);
  EXPECT_EQ(offsets.Add(1, 0, 10.0, 100.0), outside1);
  ASSERT_EQ(offsets.NumberOfLabels(), 3u);
  offsets.Share({ 0.0, 3.0, -1.0 });
  EXPECT_NEAR(20.0 * offsets[outside1] - 5.0 * offsets[between], 3.0, 1e-6);
  EXPECT_NEAR(20.0 * offsets[outside2] + 5.0 * offsets[between], -1.0, 1e-6);
  offsets.Share({ 0.0, 1e6, 0.0 }); // a tenth of the facets' edges at most
  EXPECT_DOUBLE_EQ(offsets[outside1], 10.0);
}

// The outer vertices of a face where the image cuts the object move within it, the others along it.
TEST(InterfaceFit, KeepsFacesWhereTheImageCutsFlat)
{
  const LabelImage<3> image = phantoms::CutBall(9);
  const ImageDomain<3> domain(image, 1.0);
  const auto flatArea = [&](const SimplexMesh<3>& mesh)
  {
    double area = 0.0;
    for (const auto& facet : mesh.Facets)
    {
      unsigned faces = ~0u;
      std::array<Point<3>, 3> p;
      for (std::size_t k = 0; k < 3; ++k)
      {
        p[k] = mesh.Points[facet[k]];
        faces &= domain.Border()->FacesAt(p[k]);
      }
      const Point<3> normal = FacetNormal(p);
      area += faces != 0 ? 0.5 * std::sqrt(Dot(normal, normal)) : 0.0;
    }
    return area;
  };
  for (const double delta : { 1.0, 2.0 })
  {
    const double wanted = flatArea(MeshOf(image, Optimised(delta, false)));
    EXPECT_GT(wanted, 50.0);
    EXPECT_GE(flatArea(MeshOf(image, Optimised(delta, true))), wanted) << delta;
  }
}

// Smoothing moves some of the vertices along interfaces, and not back onto them.
TEST(InterfaceFit, StaysInOptimisation)
{
  EXPECT_LT(WorstVolume(BallOfThree(), MeshOf(BallOfThree(), Optimised(2.0, true))), 0.002);
}
