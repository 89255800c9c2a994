// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Whole space-time meshes of phantoms: invariants, accuracy, flat ends, sizes, options, cancelling.
#include "Base/Error.h"
#include "CallableSize.h"
#include "Geometry/Circumball.h"
#include "Sanitizers.h"
#include "SpaceTimeCases.h"
#include "ThreadTesting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <string>

using namespace voxplex;
using namespace voxplex::checks;
using voxplex::testing::Watchdog;

namespace
{

SimplexMesh<4> Mesh(const LabelImage<4>& image, double delta)
{
  return MeshOf(image, SpaceTimeOptions(delta));
}

/** Volume of a label in every frame, and over all time, against the image; relative. */
void ExpectVolumes(const SimplexMesh<4>& mesh, const LabelImage<4>& image, std::int64_t label,
  double inFrames, double overall)
{
  const double step = image.Grid().IndexToFrame[3][3];
  const std::int64_t frames = image.Grid().Dimensions[3];
  for (std::int64_t frame = 0; frame < frames; ++frame)
  {
    const double last = frame + 1 == frames ? 1e-9 * step : 0.0;
    const double expected = FrameVolumes(image, frame)[label];
    EXPECT_NEAR(SliceVolumes(mesh, static_cast<double>(frame) * step - last)[label], expected,
      inFrames * expected)
      << "label " << label << ", frame " << frame;
  }
  const double expected = Hypervolumes(image)[label];
  EXPECT_NEAR(Volumes(mesh)[label], expected, overall * expected) << "label " << label;
}

} // namespace

// Seen: 4.6 % too small with delta 2, since chords cut the sphere short.
TEST(SpaceTimeMeshing, FourBallHasItsHypervolume)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const double radius = 12.0;
  const LabelImage<4> image = ImageOf(phantoms::FourBall(radius));
  const SimplexMesh<4> mesh = Mesh(image, 2.0);
  ExpectGood(mesh, image);
  EXPECT_FALSE(image.ReachesBorderInTime(0) || image.ReachesBorderInTime(1));
  EXPECT_EQ(NumberOfComponents(mesh, 1), 1u);
  const double volume = 0.5 * std::pow(std::numbers::pi, 2) * std::pow(radius, 4);
  EXPECT_LT(Volumes(mesh)[1], volume);
  EXPECT_NEAR(Volumes(mesh)[1], volume, 0.06 * volume);
  const double c = 0.5 * static_cast<double>(image.Grid().Dimensions[0] - 1);
  double off = 0.0;
  const std::set<std::uint32_t> boundary = VerticesOfInterfaces(mesh);
  for (const std::uint32_t v : boundary)
  {
    const double distance = std::abs(Distance(mesh.Points[v], { c, c, c, c }) - radius);
    EXPECT_LT(distance, 0.6);
    off += distance / static_cast<double>(boundary.size());
  }
  EXPECT_LT(off, 0.1);
}

TEST(SpaceTimeMeshing, BothRuleOrders)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(9, 1.0));
  MeshingOptions<4> options = SpaceTimeOptions(2.0);
  SimplexMesh<4> meshes[2];
  for (const RuleOrder order : { RuleOrder::RadiusEdgeFirst, RuleOrder::SurfaceFirst })
  {
    SCOPED_TRACE(order == RuleOrder::SurfaceFirst ? "surface first" : "radius-edge first");
    options.SpaceTime.Order = order;
    SimplexMesh<4>& mesh = meshes[static_cast<std::size_t>(order)];
    mesh = MeshOf(image, options);
    // Seen: 0 and 4 of some 3,700 facets off, beside a flat end.
    ExpectGood(mesh, image, { 2.0, 0.004, true });
    EXPECT_EQ(NumberOfComponents(mesh, 1), 1u);
    EXPECT_EQ(NumberOfComponents(mesh, 2), 1u);
    ExpectVolumes(mesh, image, 2, 0.16, 0.06);
  }
  EXPECT_FALSE(meshes[0].Points == meshes[1].Points) << "the order makes no difference";
}

// Space-time images that a mesh must end flat for, or must not.
TEST(SpaceTimeMeshing, CutOnOneSideOnly)
{
  const LabelImage<4> image =
    ImageOf({ GridGeometry<4>::Orthogonal({ 22, 22, 22, 13 }, { 1.0, 1.0, 1.0, 1.0 }),
      [](const Point<4>& p) -> std::uint8_t {
        return Distance(p, { 10.5, 10.5, 10.5, 0.0 }) < 8.5;
      } });
  ASSERT_TRUE(image.ReachesBorderInTime(0));
  ASSERT_FALSE(image.ReachesBorderInTime(1));
  const SimplexMesh<4> mesh = Mesh(image, 2.0);
  ExpectGood(mesh, image);
  ExpectVolumes(mesh, image, 1, 1.0, 0.1);
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(8.5, 3);
  EXPECT_NEAR(EndVolumes(mesh, 0.0)[1], volume, 0.08 * volume);
}

// Before and after the two are apart; meanwhile they touch in an interface of their own.
TEST(SpaceTimeMeshing, ObjectsMergeAndPart)
{
  const phantoms::SpaceTimePhantom phantom =
    phantoms::WithTimeScale(phantoms::MergingBalls(9), 2.0);
  const LabelImage<4> image = ImageOf(phantom);
  const SimplexMesh<4> mesh = Mesh(image, 2.5);
  ExpectGood(mesh, image);
  for (const std::int64_t label : { 1, 2 })
  {
    EXPECT_EQ(NumberOfComponents(mesh, label), 1u);
    ExpectVolumes(mesh, image, label, 0.15, 0.12);
  }
  double from = 1e300;
  double to = -1e300;
  std::size_t shared = 0;
  for (std::size_t k = 0; k < mesh.Facets.size(); ++k)
  {
    if (mesh.FacetLabels[k] == std::array<std::int64_t, 2>{ 2, 1 })
    {
      ++shared;
      for (const std::uint32_t v : mesh.Facets[k])
      {
        from = std::min(from, mesh.Points[v][3]);
        to = std::max(to, mesh.Points[v][3]);
      }
    }
  }
  EXPECT_GT(shared, 20u);
  EXPECT_GT(from, 2.0);
  EXPECT_LT(to, 14.0);
}

TEST(SpaceTimeMeshing, BeatingVentricle)
{
  const LabelImage<4> image = ImageOf(phantoms::WithTimeScale(phantoms::BeatingVentricle(4), 5.0));
  const SimplexMesh<4> mesh = Mesh(image, Sanitized ? 12.0 : 9.0);
  Tolerances tolerances;
  tolerances.VertexLinks = false;        // the wall is as thin as two voxels
  tolerances.FacetsOffInterface = 0.005; // around a triangle that was opened, by a tenth of a voxel
  ExpectGood(mesh, image, tolerances);
  ExpectVolumes(mesh, image, 1, 0.18, 0.12);
}

TEST(SpaceTimeMeshing, AnisotropicSpacingAndTiltedAxes)
{
  GridGeometry<4> tilted = GridGeometry<4>::Orthogonal({ 26, 26, 26, 7 }, { 1.0, 1.0, 1.0, 1.5 });
  tilted.IndexToFrame[0][1] = 0.3;
  tilted.IndexToFrame[1][2] = -0.3;
  for (const auto& grid :
    { GridGeometry<4>::Orthogonal({ 30, 24, 12, 7 }, { 0.8, 1.0, 2.0, 1.5 }), tilted })
  {
    const LabelImage<4> image = ImageOf(PulsatingBalls(grid, 1.0));
    const SimplexMesh<4> mesh = Mesh(image, 2.5);
    ExpectGood(mesh, image);
    ExpectVolumes(mesh, image, 2, 0.2, 0.07);
  }
}

/** Meshes `frames` frames, `timeScale` apart, with delta 3. */
void ExpectGoodDuration(std::int64_t frames, double timeScale, double radiusEdge)
{
  const std::string name =
    std::to_string(frames) + " frames, " + std::to_string(timeScale) + " apart";
  SCOPED_TRACE(name);
  const Watchdog watchdog(name);
  const double swing = frames == 2 ? 0.0 : std::min(1.0, 2.0 * timeScale);
  const LabelImage<4> image = ImageOf(PulsatingBalls(frames, timeScale, swing));
  const SimplexMesh<4> mesh = Mesh(image, 3.0);
  ExpectGood(mesh, image, { radiusEdge, 0.01, true });
  ExpectVolumes(mesh, image, 2, 0.2, 0.1);
  EXPECT_EQ(NumberOfComponents(mesh, 2), 1u);
  EXPECT_LT(mesh.Simplices.size(), 40000u);
}

TEST(SpaceTimeMeshing, LongDurations)
{
  ExpectGoodDuration(9, 8.0, 2.0);
  ExpectGoodDuration(2, 10.0, 2.0);
}

// Between the ends there is room for one element, or for less than one: those keep their bad ratio.
TEST(SpaceTimeMeshing, DurationsShorterThanDelta)
{
  ExpectGoodDuration(9, 0.2, 2.0);
  ExpectGoodDuration(2, 3.0, 2.0);
  ExpectGoodDuration(2, 1.0, 3.0);
}

TEST(SpaceTimeMeshing, NothingIsLeftIfDeltaIsTooLargeAndNothingIsChecked)
{
  const LabelImage<4> image = ImageOf(phantoms::FourBall(3.0));
  EXPECT_FALSE(Mesh(image, 60.0).Simplices.empty()) << "components stay";
  MeshingOptions<4> options = SpaceTimeOptions(60.0);
  options.Components.Smallest = 0;
  options.Interfaces.Rounds = 0;
  const SimplexMesh<4> mesh = MeshOf(image, options);
  EXPECT_TRUE(mesh.Simplices.empty());
  EXPECT_TRUE(mesh.Points.empty());
  EXPECT_TRUE(mesh.Facets.empty());
}

//------------------------------------------------------------------------------------------------
// Behind interfaces there are points, so that pentatopes are better than the bound of the ratio asks for.
TEST(SpaceTimeMeshing, LargePentatopesHaveTheirPreferredRatio)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<4> image = ImageOf(phantoms::FourBall(12.0));
  const ImageDomain<4> domain(image, 1.0);
  const double delta = 2.0;
  const SimplexMesh<4> mesh = Mesh(image, delta);
  double ratios = 0.0;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    Circumball<4> ball;
    ASSERT_TRUE(ComputeCircumball<4>(mesh.PointsOf(s).data(), ball));
    ratios += RadiusEdge(mesh, s);
    if (domain.Label(ball.Center) != 0 && ball.Radius2 > 1.21 * 1.21 * delta * delta)
    {
      ASSERT_LT(RadiusEdge(mesh, s), 1.45 + 1e-9);
    }
  }
  EXPECT_LT(ratios / static_cast<double>(mesh.Simplices.size()), 1.12);
}

TEST(SpaceTimeMeshing, SizesBoundCircumradii)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<4> image = ImageOf(PulsatingBalls(9, 1.0));
  // Where sizes below delta meet a flat end, points that the rules ask for are refused: they would crowd
  // those of the end. Seen: a ratio of 2.3, and 6 % of the facets with a vertex off.
  // Parts may touch at a vertex of such an end.
  const Tolerances nearEnds = { 2.4, 0.08, false };
  const std::size_t without = Mesh(image, 3.0).Simplices.size();
  MeshingOptions<4> options = SpaceTimeOptions(3.0);
  options.Sampling.Gradation = 0.0; // sizes that step; the tolerances are for them
  const auto size = [](double (*f)(const Point<4>&, std::int64_t))
  { return std::make_shared<CallableSizeOf<4>>(f); };
  options.Sampling.Size =
    size([](const Point<4>& p, std::int64_t) { return p[3] < 4.0 ? 2.0 : 6.0; });
  SimplexMesh<4> mesh = MeshOf(image, options);
  ExpectGood(mesh, image, nearEnds);
  EXPECT_GT(mesh.Simplices.size(), without * 3 / 2);
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    double latest = 0.0;
    for (const std::uint32_t v : mesh.Simplices[s])
    {
      latest = std::max(latest, mesh.Points[v][3]);
    }
    ASSERT_LT(Circumradius(mesh, s), latest < 2.0 ? 2.0 + 1e-9 : 6.0 + 1e-9);
  }

  options.Sampling.Size = size([](const Point<4>&, std::int64_t label)
    { return label == 1 ? 1.6 : std::numeric_limits<double>::quiet_NaN(); });
  mesh = MeshOf(image, options);
  ExpectGood(mesh, image, nearEnds);
  double largestOther = 0.0;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    const double radius = Circumradius(mesh, s);
    if (mesh.Labels[s] == 1)
    {
      ASSERT_LT(radius, 1.6 + 1e-9);
    }
    largestOther = std::max(largestOther, radius);
  }
  EXPECT_GT(largestOther, 2.0);
}

//------------------------------------------------------------------------------------------------
TEST(SpaceTimeMeshing, ThreadsManagersAndBalancersMakeGoodMeshes)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(7, 1.5));
  const double delta = Sanitized ? 3.5 : 2.5;
  const std::map<std::int64_t, double> expected = Volumes(Mesh(image, delta));
  for (const ContentionPolicy contention : voxplex::testing::AllPolicies)
  {
    for (const BalancePolicy balance : { BalancePolicy::Hierarchical, BalancePolicy::Random })
    {
      for (const unsigned threads : { 2u, 8u })
      {
        if (Sanitized && threads == 2)
        {
          continue;
        }
        const std::string name = voxplex::testing::NameOf(contention) + ", " +
          std::string(BalancePolicyNames[static_cast<std::size_t>(balance)]) + ", " +
          std::to_string(threads) + " threads";
        SCOPED_TRACE(name);
        const Watchdog watchdog(name);
        MeshingOptions<4> options = SpaceTimeOptions(delta, threads);
        options.Team.Contention = contention;
        options.Team.Balance = balance;
        const SimplexMesh<4> mesh = MeshOf(image, options);
        ExpectGood(mesh, image, { 2.0, 0.005, true });
        const auto volumes = Volumes(mesh);
        for (const auto& [label, volume] : expected)
        {
          EXPECT_NEAR(volumes.at(label), volume, (label == 1 ? 0.15 : 0.03) * volume) << label;
        }
      }
    }
  }
}

TEST(SpaceTimeMeshing, CancellingGivesAnEmptyMesh)
{
  const LabelImage<4> image = ImageOf(phantoms::FourBall(8.0));
  for (const unsigned threads : { 1u, 4u })
  {
    ImageMesher<4> mesher(SpaceTimeOptions(0.5, threads)); // far more work than the test waits for
    int calls = 0;
    mesher.Progress = [&](double) { return ++calls < 8; };
    SimplexMesh<4> mesh;
    mesh.Points.resize(3);
    EXPECT_EQ(mesher.Run(image, mesh), MeshingOutcome::Cancelled);
    EXPECT_TRUE(mesh.Points.empty());
    EXPECT_TRUE(mesh.Simplices.empty());
    EXPECT_TRUE(mesh.Facets.empty());
  }
}

TEST(SpaceTimeMeshing, MeshesThatDoNotFitAreRefused)
{
  const LabelImage<4> image = ImageOf(phantoms::FourBall(5.0));
  MeshingOptions<4> options = SpaceTimeOptions(2.0);
  options.Limits.Memory = 1000;
  SimplexMesh<4> mesh;
  EXPECT_THROW(ImageMesher<4>(options).Run(image, mesh), TooLargeError);
  options.Limits.Force = true;
  EXPECT_EQ(ImageMesher<4>(options).Run(image, mesh), MeshingOutcome::Done);
  options = SpaceTimeOptions(1e-3);
  EXPECT_THROW(ImageMesher<4>(options).Run(image, mesh), TooLargeError);
  EXPECT_TRUE(mesh.Simplices.empty());
}
