// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Meshes whose sampling distance is graded keep every rule, lose nothing, and have fewer elements.
#include "Base/Error.h"
#include "Image/Components.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Phantoms.h"
#include "Refinement/Refiner.h"
#include "Refinement/Rules/FeatureGrid.h"
#include "Refinement/Rules/Rules3D.h"
#include "RefinementChecks.h"
#include "Sanitizers.h"
#include "Sizing/GradedDelta.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** A small ball beside a large one, and a plate below. */
LabelImage<3> SmallAndLarge()
{
  return phantoms::Make(phantoms::Cube(64),
    [](const Point<3>& p) -> std::int16_t
    {
      if (Distance(p, { 26.0, 32.0, 36.0 }) < 20.0)
      {
        return 4;
      }
      if (Distance(p, { 54.0, 32.0, 36.0 }) < 4.0)
      {
        return 9;
      }
      return p[2] > 5.5 && p[2] < 8.5 && Distance(p, { 32.0, 32.0, 7.0 }) < 25.0 ? 2 : 0;
    });
}

MeshingOptions<3> Graded(double delta, double ratio = 1.0)
{
  MeshingOptions<3> options = WithDelta<3>(delta);
  options.Sampling.Grading.Mode = GradingMode::LocalFeatureSize;
  options.Sampling.Grading.Ratio = ratio;
  return options;
}

/** Interface vertices nearer than a distance to a point. */
std::size_t FeaturesNear(const SimplexMesh<3>& mesh, const Point<3>& p, double distance)
{
  const std::set<std::uint32_t> vertices = VerticesOfInterfaces(mesh);
  return static_cast<std::size_t>(std::count_if(vertices.begin(), vertices.end(),
    [&](std::uint32_t v) { return Distance(mesh.Points[v], p) < distance; }));
}

} // namespace

// Vertices that crowd together are in lists of fine cells, which serve short queries.
TEST(FeatureGrid, FindsVerticesAtAllDistances)
{
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> x(-3.0, 3.0);
  FeatureGrid<4> grid({ -3.1, -3.1, -3.1, -3.1 }, 5.0, 10);
  std::vector<Point<4>> points;
  for (int k = 0; k < 900; ++k)
  {
    const double scale = std::pow(10.0, x(random) - 3.0);
    points.push_back({ 1.0 + scale * x(random), scale * x(random), scale * x(random), 0.5 });
    grid.Add(points.back());
  }
  const auto expectRight = [&]
  {
    for (int k = 0; k < 3000; ++k)
    {
      const double scale = std::pow(10.0, x(random) - 3.0);
      const Point<4> p = { 1.0 + scale * x(random), scale * x(random), scale * x(random), 0.5 };
      const double distance = std::pow(10.0, x(random) - 2.0) * scale;
      const auto isNear = [&](const Point<4>& q) { return Distance(p, q) < distance; };
      const Point<4>* const found = grid.FindWithin(p, distance);
      ASSERT_EQ(found != nullptr, std::any_of(points.begin(), points.end(), isNear)) << distance;
      ASSERT_TRUE(!found || isNear(*found));
    }
  };
  expectRight();
  for (int k = 0; k < 400; ++k)
  {
    EXPECT_TRUE(grid.Remove(points.back()));
    EXPECT_FALSE(grid.Remove(points.back()));
    points.pop_back();
  }
  expectRight();
}

TEST(GradedMeshing, NoRuleAppliesAfterwards)
{
  const BallDomain ball(5.0);
  GradedDelta<3> graded({ { -5.0, -5.0, -5.0 }, { 5.0, 5.0, 5.0 } }, 0.5);
  graded.Lower({ -5.0, 0.0, 0.0 }, 0.4);
  graded.Lower({ 5.0, 0.0, 0.0 }, 2.0);
  graded.Grade(0.25, 1, {});
  for (const unsigned threads : { 1u, 4u })
  {
    RefinementSettings<3> settings = SettingsFor<3>(2.0);
    settings.Sizing.Base.Graded = &graded;
    RefinementContext<3> context(ball, settings, Around(ball, settings.Sizing.Base.Delta), 1000);
    EXPECT_DOUBLE_EQ(context.Sizing.SpacingFloor(), SpacingFloorFraction * 0.4);
    EXPECT_DOUBLE_EQ(context.Sizing.SizeFloor(), SpacingFloorFraction * 0.4);
    TeamOptions team;
    team.Threads = threads;
    Refiner<Rules3D> refiner(context, team);
    ASSERT_TRUE(refiner.Run(nullptr));
    ExpectSound(context.Mesh);
    ExpectNoRuleApplies(context, ball);
    const SimplexMesh<3> mesh = ExtractSphere(context, ball);
    EXPECT_GT(
      FeaturesNear(mesh, { -5.0, 0.0, 0.0 }, 1.5), 3 * FeaturesNear(mesh, { 5.0, 0.0, 0.0 }, 1.5));
  }
}

TEST(GradedMeshing, IsFineWhereTheShapeIs)
{
  const LabelImage<3> image = SmallAndLarge();
  const SimplexMesh<3> plain = MeshOf(image, WithDelta<3>(1.5));
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = MeshOf(image, Graded(1.5, 0.5), &statistics);
  ExpectGood(mesh);
  EXPECT_EQ(statistics.Delta, 1.5);
  EXPECT_GT(statistics.LargestDelta, 4.0);
  EXPECT_LE(statistics.LargestDelta, 6.0 + 1e-6) << "ratio x lambda";
  EXPECT_GT(statistics.GradingSamples, 1000u);
  EXPECT_GT(statistics.GradingPoles, 100u);
  EXPECT_GT(statistics.Times.Grading, 0.0);
  EXPECT_LT(mesh.Simplices.size(), plain.Simplices.size() / 2);
  // The plate and the small ball are as fine as without grading, the large ball is not.
  const Point<3> plate = { 32.0, 32.0, 7.0 };
  const Point<3> small = { 54.0, 32.0, 36.0 };
  const Point<3> large = { 26.0, 32.0, 56.0 };
  EXPECT_GT(FeaturesNear(mesh, plate, 8.0), FeaturesNear(plain, plate, 8.0) * 4 / 5);
  EXPECT_GT(FeaturesNear(mesh, small, 6.0), FeaturesNear(plain, small, 6.0) / 2);
  EXPECT_LT(FeaturesNear(mesh, large, 8.0), FeaturesNear(plain, large, 8.0) / 3);
}

// A start that is too coarse costs more elements in the end than a finer one. There must be none.
TEST(GradedMeshing, LargeRatiosAndFeaturesDoNotTakeMoreElements)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  for (const LabelImage<3>& image : { phantoms::Ball(16.0), phantoms::Torus(22.0, 10.0) })
  {
    MeshingStatistics statistics;
    const std::size_t plain = MeshOf(image, Graded(2.0, 0.6)).Simplices.size();
    MeshingOptions<3> coarse = Graded(2.0, 2.0);
    const std::size_t ratio = MeshOf(image, coarse, &statistics).Simplices.size();
    coarse.Sampling.Grading.Lambda = 100.0;
    const std::size_t lambda = MeshOf(image, coarse).Simplices.size();
    EXPECT_LT(statistics.Interfaces.Seeds, 100u);
    EXPECT_LT(ratio, plain + plain / 5);
    EXPECT_LT(lambda, plain + plain / 5);
  }
}

// Removal spares free vertices that serve finer interfaces; otherwise the ball rule puts them back again and again.
TEST(GradedMeshing, RulesDoNotUndoEachOther)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const auto created = [](const MeshingOptions<3>& options)
  {
    MeshingStatistics statistics;
    const SimplexMesh<3> mesh = MeshOf(SmallAndLarge(), options, &statistics);
    return static_cast<double>(statistics.Rules.Created) /
      static_cast<double>(mesh.Simplices.size());
  };
  EXPECT_LT(created(Graded(0.8, 1.0)), 2.5 * created(WithDelta<3>(0.8)));
}

TEST(GradedMeshing, EstimateFollows)
{
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = MeshOf(SmallAndLarge(), Graded(1.0), &statistics);
  const double ratio =
    static_cast<double>(statistics.EstimatedElements) / static_cast<double>(mesh.Simplices.size());
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 2.0);
}

TEST(GradedMeshing, LosesNoLabelAndNoComponent)
{
  // Specks of 2 x 2 x 2 voxels, far from everything and within a ball where Delta is large.
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(56),
    [](const Point<3>& p) -> std::int16_t
    {
      const auto isSpeck = [&](double x, double y, double z) {
        return p[0] >= x && p[0] < x + 2 && p[1] >= y && p[1] < y + 2 && p[2] >= z && p[2] < z + 2;
      };
      if (isSpeck(3, 3, 3) || isSpeck(28, 28, 28) || isSpeck(28, 20, 33))
      {
        return 7;
      }
      return Distance(p, { 28.0, 28.0, 28.0 }) < 22.0 ? 1 : 0;
    });
  for (const unsigned threads : { 1u, 3u })
  {
    MeshingOptions<3> options = Graded(2.0, 2.0);
    options.Team.Threads = threads;
    MeshingStatistics statistics;
    const SimplexMesh<3> mesh = MeshOf(image, options, &statistics);
    EXPECT_TRUE(statistics.Components.Lost.empty());
    EXPECT_EQ(statistics.Components.Found, 4u);
    const Components<3> components(image);
    std::set<std::uint32_t> found;
    for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
    {
      Point<3> centroid{};
      for (const std::uint32_t v : mesh.Simplices[t])
      {
        for (std::size_t a = 0; a < 3; ++a)
        {
          centroid[a] += 0.25 * mesh.Points[v][a];
        }
      }
      GridGeometry<3>::Index voxel;
      for (std::size_t a = 0; a < 3; ++a)
      {
        voxel[a] = std::llround(centroid[a]) - image.CropOrigin()[a];
      }
      const std::uint32_t c = components.At(voxel);
      if (c != Components<3>::None && image.Values()[components.All()[c].Label] == mesh.Labels[t])
      {
        found.insert(c);
      }
    }
    EXPECT_EQ(found.size(), 4u);
  }
}

// Where the border cuts nearly all of an object its interfaces have one sample or none.
TEST(GradedMeshing, OfImagesWithHardlyAnyInterface)
{
  for (const int free : { 0, 1 }) // voxels of background
  {
    const LabelImage<3> image = phantoms::Make(phantoms::Cube(2),
      [free](const Point<3>& p) -> std::int16_t
      { return free == 1 && p[0] + p[1] + p[2] == 0.0 ? 0 : 1; });
    const SimplexMesh<3> mesh = MeshOf(image, Graded(4.6));
    ExpectSound(mesh);
    EXPECT_FALSE(mesh.Simplices.empty());
  }
}

TEST(GradedMeshing, UniformIsAsBefore)
{
  const LabelImage<3> image = SmallAndLarge();
  MeshingOptions<3> options = WithDelta<3>(2.0);
  MeshingStatistics statistics;
  const SimplexMesh<3> plain = MeshOf(image, options, &statistics);
  EXPECT_EQ(statistics.LargestDelta, 2.0);
  EXPECT_EQ(statistics.GradingSamples, 0u);
  options.Sampling.Grading.Ratio = 3.0;
  options.Sampling.Grading.Lambda = 1.0;
  EXPECT_EQ(MeshOf(image, options).Points, plain.Points);
  // If lambda allows nothing above delta, grading changes nothing.
  options = Graded(2.0, 1.0);
  options.Sampling.Grading.Lambda = 1.0;
  EXPECT_EQ(MeshOf(image, options).Points, plain.Points);
}

TEST(GradedMeshing, RefusesWrongOptions)
{
  const LabelImage<3> image = phantoms::Ball(6.0);
  for (const double wrong : { 0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
         std::numeric_limits<double>::infinity() })
  {
    SimplexMesh<3> mesh;
    MeshingOptions<3> options = Graded(2.0, wrong);
    EXPECT_THROW(ImageMesher<3>(options).Run(image, mesh), InputError) << wrong;
    options = Graded(2.0);
    options.Sampling.Grading.Lambda = wrong;
    EXPECT_THROW(ImageMesher<3>(options).Run(image, mesh), InputError) << wrong;
  }
}

// Only one or two points of the interfaces are left to measure local feature sizes by.
TEST(GradedMeshing, OfImagesThatAreSmallBesideDelta)
{
  const std::array<std::function<std::int16_t(const Point<3>&)>, 3> labels = {
    [](const Point<3>& p) -> std::int16_t {
      return Distance(p, { 2, 2, 2 }) < 0.5 ? 1 : 0;
    },
    [](const Point<3>& p) -> std::int16_t { return p[2] == 2 ? 1 : 0; },
    [](const Point<3>& p) -> std::int16_t { return p[2] < 3 ? 1 : 2; },
  };
  for (const auto& label : labels)
  {
    const LabelImage<3> image =
      phantoms::Make(GridGeometry<3>::Orthogonal({ 5, 6, 7 }, { 1.0, 1.0, 1.0 }), label);
    for (const double delta : { 4.0, 26.0, 500.0 })
    {
      MeshingStatistics statistics;
      const SimplexMesh<3> mesh = MeshOf(image, Graded(delta), &statistics);
      ExpectSound(mesh);
      EXPECT_LE(statistics.GradingSamples, 12u);
    }
  }
}

TEST(GradedMeshing, CanBeCancelled)
{
  const LabelImage<3> image = SmallAndLarge();
  for (const int calls : { 1, 3 })
  {
    ImageMesher<3> mesher(Graded(0.4));
    int count = 0;
    mesher.Progress = [&](double) { return ++count < calls; };
    SimplexMesh<3> mesh;
    EXPECT_EQ(mesher.Run(image, mesh), MeshingOutcome::Cancelled);
    EXPECT_TRUE(mesh.Points.empty());
  }
}
