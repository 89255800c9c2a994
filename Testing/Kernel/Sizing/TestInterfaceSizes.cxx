// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Sampling distances of single interfaces: the table, how they pass into each other, and meshes.
#include "Base/Error.h"
#include "CallableSize.h"
#include "Domain/ImageDomain.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Mesher/ImageMesher.h"
#include "Phantoms.h"
#include "Refinement/RefinementContext.h"
#include "Refinement/Rules/FeatureGrid.h"
#include "Sizing/InterfaceSizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

using namespace voxplex;

namespace
{

constexpr std::int64_t Any = InterfaceSize::AnyLabel;

constexpr Point<3> Somewhere{ 9.0, 9.0, 9.0 }; ///< where it does not matter

using Interface = std::pair<std::int64_t, std::int64_t>; ///< the larger label first

/** Lengths of the edges of each interface's facets, on average. */
std::map<Interface, double> MeanEdges(const SimplexMesh<3>& mesh)
{
  std::map<Interface, std::pair<double, double>> sums;
  for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
  {
    auto& [sum, count] = sums[{ mesh.FacetLabels[f][0], mesh.FacetLabels[f][1] }];
    for (std::size_t i = 0; i < 3; ++i)
    {
      sum += Distance(mesh.Points[mesh.Facets[f][i]], mesh.Points[mesh.Facets[f][(i + 1) % 3]]);
      count += 1.0;
    }
  }
  std::map<Interface, double> means;
  for (const auto& [labels, sum] : sums)
  {
    means[labels] = sum.first / sum.second;
  }
  return means;
}

SimplexMesh<3> Mesh(const LabelImage<3>& image, double delta, std::vector<InterfaceSize> sizes,
  double gradation = 0.3, unsigned threads = 1)
{
  MeshingOptions<3> options = checks::WithDelta<3>(delta);
  options.Sampling.InterfaceSizes = std::move(sizes);
  options.Sampling.Gradation = gradation;
  options.Team.Threads = threads;
  const SimplexMesh<3> mesh = checks::MeshOf(image, options);
  checks::ExpectSound(mesh);
  return mesh;
}

/** The message of the error that the sizes make. */
std::string ErrorOf(const std::vector<InterfaceSize>& sizes)
{
  try
  {
    InterfaceSizes<3>(phantoms::NestedBalls(9.0), sizes, { 1.0 }, 0.3, 1);
  }
  catch (const InputError& error)
  {
    return error.what();
  }
  return "";
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(InterfaceSizes, PairsOfAnyNumberOfLabelsAreApart)
{
  const InterfaceSizes<3> sizes(phantoms::Blocks(2, 42), { { 2, 1, 0.5 } }, { 1.0 }, 0.0, 2);
  EXPECT_EQ(sizes.Between(Somewhere, 2, 1), 0.5);
  EXPECT_EQ(sizes.Between(Somewhere, 65536 + 2, 1), 1.0);
  EXPECT_EQ(sizes.Between(Somewhere, 65536 + 1, 2), 1.0);
}

TEST(InterfaceSizes, PairsCountBeforeLabels)
{
  const LabelImage<3> image = phantoms::NestedBalls(12.0); // 3 within 7 within 200: ids 1, 2, 3
  const InterfaceSizes<3> sizes(
    image, { { 7, 3, 0.5 }, { 7, Any, 3.0 }, { 0, Any, 4.0 }, { 0, 7, 9.0 } }, { 2.0 }, 0.0, 1);
  EXPECT_EQ(sizes.Between(Somewhere, 1, 2), 0.5);
  EXPECT_EQ(sizes.Between(Somewhere, 2, 1), 0.5);
  EXPECT_EQ(sizes.Between(Somewhere, 2, 3), 3.0); // of label 7
  EXPECT_EQ(sizes.Between(Somewhere, 3, 0), 4.0); // of background
  EXPECT_EQ(sizes.Between(Somewhere, 0, 2), 9.0); // the pair, not the smaller of its labels
  EXPECT_EQ(sizes.Between(Somewhere, 1, 3), 2.0); // delta
  // Over the interfaces there are: 3-7, 7-200 and 200-0.
  EXPECT_EQ(sizes.Smallest(), 0.5);
  EXPECT_EQ(sizes.Largest(), 4.0);
  EXPECT_EQ(sizes.LargestOf(1), 0.5);
  EXPECT_EQ(sizes.LargestOf(2), 3.0);
  EXPECT_EQ(sizes.LargestOf(3), 4.0);
  EXPECT_GT(sizes.Equivalent(), 0.5);
  EXPECT_LT(sizes.Equivalent(), 4.0);
  const InterfaceSizes<3> same(image, { { 7, Any, 2.0 } }, { 2.0 }, 0.0, 1);
  EXPECT_NEAR(same.Equivalent(), 2.0, 1e-12);
  EXPECT_TRUE(std::isinf(same.GradedAt({ 16.0, 16.0, 16.0 })));
  // Of two labels the smaller counts.
  const InterfaceSizes<3> both(image, { { 7, Any, 1.0 }, { 200, Any, 0.7 } }, { 2.0 }, 0.0, 1);
  EXPECT_EQ(both.Between(Somewhere, 2, 3), 0.7);
}

TEST(InterfaceSizes, RefusesWhatMakesNoSense)
{
  EXPECT_NE(ErrorOf({ { 5, Any, 1.0 } }).find("label 5, which does not occur"), std::string::npos);
  EXPECT_NE(ErrorOf({ { 7, 5, 1.0 } }).find("label 5, which does not occur"), std::string::npos);
  EXPECT_NE(ErrorOf({ { 7, 7, 1.0 } }).find("no interface with itself"), std::string::npos);
  EXPECT_NE(ErrorOf({ { 7, 3, 1.0 }, { 3, 7, 2.0 } }).find("given twice"), std::string::npos);
  EXPECT_NE(ErrorOf({ { 7, Any, 1.0 }, { 7, Any, 1.0 } }).find("given twice"), std::string::npos);
  for (const double wrong : { 0.0, -1.0, std::nan(""), HUGE_VAL })
  {
    EXPECT_NE(ErrorOf({ { 7, 3, wrong } }).find("positive and finite"), std::string::npos) << wrong;
  }
  EXPECT_NE(ErrorOf({ { 7, 3, -1e-9 } }).find("it is -1e-09"), std::string::npos);
  EXPECT_EQ(ErrorOf({ { 7, 3, 1.0 }, { 7, Any, 2.0 }, { 7, 0, 3.0 } }), "");
}

//------------------------------------------------------------------------------------------------
// Delta grows from left to right. Interfaces with a size take that, the others follow delta.
TEST(InterfaceSizes, DeltaMayBeGraded)
{
  const LabelImage<3> image = phantoms::TouchingLabels(30);
  GradedDelta<3> delta({ { 0.0, 0.0, 0.0 }, { 40.0, 40.0, 40.0 } }, 1.0);
  delta.Lower({ 3.0, 20.0, 20.0 }, 1.0);
  delta.Grade(0.05, 1, {});
  delta.Cap(2.5);
  const BaseDistance<3> base{ 2.5, &delta, 1.7 };
  const InterfaceSizes<3> stepping(image, { { 1, 2, 0.5 } }, base, 0.0, 1);
  const InterfaceSizes<3> graded(image, { { 1, 2, 4.0 } }, base, 0.3, 1);
  for (double x = 3.0; x < 30.0; x += 0.9)
  {
    const Point<3> p{ x, 3.5, 20.0 };
    EXPECT_EQ(stepping.At(p, 1, 0), delta.At(p));
    EXPECT_EQ(stepping.At(p, 1, 2), 0.5);
    EXPECT_LE(graded.At(p, 1, 0), delta.At(p));
    // A coarse interface becomes finer near those that follow delta, which are around all of it.
    EXPECT_LE(graded.At(p, 1, 2), delta.At(p) + 0.6);
  }
  EXPECT_EQ(stepping.Smallest(), 0.5);
  EXPECT_EQ(stepping.Largest(), 2.5);
  EXPECT_EQ(graded.Smallest(), 1.0);
  EXPECT_EQ(graded.Largest(), 4.0);
  EXPECT_EQ(graded.LargestOf(1), 4.0);
  // Most faces are between a label and background.
  EXPECT_NEAR(graded.Equivalent(), 1.7, 0.3);
  EXPECT_LT(stepping.Equivalent(), 1.7);
}

//------------------------------------------------------------------------------------------------
// Against all faces between 1 and 2, the fine interface x = 18.5 of the box.
TEST(InterfaceSizes, GrowWithTheDistanceFromFinerOnes)
{
  const LabelImage<3> image = phantoms::TouchingLabels(30);
  const InterfaceSizes<3> graded(image, { { 1, 2, 0.5 } }, { 4.0 }, 0.2, 1);
  const InterfaceSizes<3> stepping(image, { { 1, 2, 0.5 } }, { 4.0 }, 0.0, 3);
  for (double x = 18.5; x < 34.0; x += 0.7)
  {
    const Point<3> p{ x, 20.0, 3.5 };
    const double exact = std::hypot(x - 18.5, 0.5);
    EXPECT_NEAR(graded.At(p, 2, 0), std::min(4.0, 0.5 + 0.2 * exact), 0.11) << x;
    EXPECT_EQ(graded.At(p, 2, 1), 0.5);
    EXPECT_EQ(stepping.At(p, 2, 0), 4.0);
    EXPECT_NEAR(graded.GradedAt(p), 0.5 + 0.2 * exact, 0.11);
    EXPECT_NEAR(stepping.GradedAt(p), 0.5 + 0.25 * exact, 0.13);
  }
}

//------------------------------------------------------------------------------------------------
TEST(InterfaceSizes, EachInterfaceHasItsOwn)
{
  const LabelImage<3> image = phantoms::NestedBalls(24.0);
  const auto uniform = MeanEdges(Mesh(image, 2.5, {}));
  for (const unsigned threads : { 1u, 4u })
  {
    const auto edges =
      MeanEdges(Mesh(image, 2.5, { { 3, 7, 1.0 }, { 0, Any, 4.0 } }, 0.3, threads));
    ASSERT_EQ(edges.size(), 3u);
    // Edges are shorter or longer by the same factor as the sampling distances.
    EXPECT_NEAR(edges.at({ 7, 3 }) / uniform.at({ 7, 3 }), 1.0 / 2.5, 0.08);
    EXPECT_NEAR(edges.at({ 200, 7 }) / uniform.at({ 200, 7 }), 1.0, 0.12);
    EXPECT_NEAR(edges.at({ 200, 0 }) / uniform.at({ 200, 0 }), 1.6, 0.25);
  }
}

TEST(InterfaceSizes, DeltaOfNoInterfaceDoesNotMatter)
{
  // All interfaces have a size, so delta has no effect. Nor has the size of a pair that does not touch.
  const LabelImage<3> image = phantoms::NestedBalls(15.0);
  const auto uniform = MeanEdges(Mesh(image, 2.0, {}));
  for (const double delta : { 0.7, 2.0, 6.0 })
  {
    const auto edges = MeanEdges(Mesh(image, delta,
      { { 3, Any, 2.0 }, { 7, Any, 2.0 }, { 200, Any, 2.0 }, { 0, 3, 0.05 }, { 0, 7, 40.0 } }));
    for (const auto& [labels, edge] : edges)
    {
      EXPECT_NEAR(edge / uniform.at(labels), 1.0, 0.12) << delta;
    }
  }
}

// Where the label beyond was not found, as at the rim of a spike, a tiny delta was taken that no interface had.
TEST(InterfaceSizes, TheSameLabelTwiceHasTheSpacingThere)
{
  const LabelImage<3> image = phantoms::NestedBalls(15.0);
  const ImageDomain<3> domain(image, 1.0);
  RefinementSettings<3> settings;
  settings.Sizing.Base = { 0.01 };
  BaseDistance<3> base;
  base.Delta = settings.Sizing.Base.Delta;
  base.Equivalent = settings.Sizing.Base.Delta;
  base.Asked = settings.Sizing.Base.Delta;
  const InterfaceSizes<3> sizes(
    image, { { 3, Any, 2.0 }, { 7, Any, 2.0 }, { 200, Any, 3.0 } }, base, 0.3, 1);
  settings.Sizing.Interfaces = &sizes;
  const RefinementContext<3> context(domain, settings, domain.Bounds(), 1000);
  for (const LabelId label : { 0, 1, 2, 3 })
  {
    const double delta = context.Sizing.SamplingDistance(Somewhere, label, label);
    EXPECT_GE(delta, 2.0);
    EXPECT_LE(delta, 3.0);
    EXPECT_EQ(delta, context.Sizing.Spacing(Somewhere, label));
  }
}

//------------------------------------------------------------------------------------------------
// The rim of the box, where the three interfaces meet: coarse facets become finer towards it.
TEST(InterfaceSizes, PassIntoEachOtherAtJunctions)
{
  const LabelImage<3> image = phantoms::TouchingLabels(36); // the plane is x = 21.5
  const auto longestNear = [&](const SimplexMesh<3>& mesh, double from, double to)
  {
    double longest = 0.0;
    for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
    {
      if (mesh.FacetLabels[f][1] != 0)
      {
        continue;
      }
      for (std::size_t i = 0; i < 3; ++i)
      {
        const Point<3>& a = mesh.Points[mesh.Facets[f][i]];
        const Point<3>& b = mesh.Points[mesh.Facets[f][(i + 1) % 3]];
        const double distance = std::min(std::abs(a[0] - 21.5), std::abs(b[0] - 21.5));
        if (distance >= from && distance < to)
        {
          longest = std::max(longest, Distance(a, b));
        }
      }
    }
    return longest;
  };
  // Points along the rim would make the facets beside it smaller with every gradation.
  const auto meshWith = [&](double gradation)
  {
    MeshingOptions<3> options = checks::WithDelta<3>(5.0);
    options.Sampling.InterfaceSizes = { { 1, 2, 0.8 } };
    options.Sampling.Gradation = gradation;
    options.Interfaces.SampleJunctions = false;
    return checks::MeshOf(image, options);
  };
  const SimplexMesh<3> graded = meshWith(0.2);
  const SimplexMesh<3> stepping = meshWith(0.0);
  // Edges are at most two or three times as long as the sampling distance, 0.8 + 0.2 x.
  EXPECT_LT(longestNear(graded, 1.0, 3.0), 2.7 * (0.8 + 0.2 * 4.0));
  EXPECT_LT(longestNear(graded, 4.0, 7.0), 2.7 * (0.8 + 0.2 * 8.0));
  EXPECT_GT(longestNear(stepping, 1.0, 3.0), 2.7 * (0.8 + 0.2 * 4.0));
  EXPECT_GT(longestNear(stepping, 4.0, 7.0), 2.7 * (0.8 + 0.2 * 8.0));
  EXPECT_GT(graded.Simplices.size(), stepping.Simplices.size());
}

//------------------------------------------------------------------------------------------------
// What is farther from the mesh than its sampling distance is too far. A coarse interface alone is no reason to go on.
TEST(InterfaceSizes, CoarseInterfacesStayCoarseWhenInspected)
{
  const LabelImage<3> image = phantoms::NestedBalls(24.0);
  std::array<std::size_t, 2> elements;
  for (const unsigned rounds : { 0u, 5u })
  {
    MeshingOptions<3> options = checks::WithDelta<3>(1.0);
    options.Sampling.InterfaceSizes = { { 200, 0, 6.0 } };
    options.Sampling.Gradation = 0.0;
    options.Interfaces.Rounds = rounds;
    MeshingStatistics statistics;
    elements[rounds > 0] = checks::MeshOf(image, options, &statistics).Simplices.size();
    EXPECT_EQ(statistics.LargestDelta, 6.0);
    EXPECT_LE(statistics.Interfaces.Seeds, 20u) << rounds;
  }
  EXPECT_NEAR(static_cast<double>(elements[1]) / static_cast<double>(elements[0]), 1.0, 0.01);
}

// Removal at a coarse interface leaves vertices that a finer one beside it needs. Otherwise the two undo each other's work.
TEST(InterfaceSizes, CoarseInterfacesDoNotUndoWhatFinerOnesNeed)
{
  const std::pair<LabelImage<3>, std::vector<InterfaceSize>> cases[] = {
    { phantoms::NestedBalls(24.0), { { 200, 0, 8.0 } } },
    { phantoms::TouchingLabels(30), { { 1, 0, 8.0 }, { 2, 0, 8.0 } } }
  };
  for (const auto& [image, sizes] : cases)
  {
    MeshingOptions<3> options = checks::WithDelta<3>(1.0);
    options.Sampling.InterfaceSizes = sizes;
    options.Sampling.Gradation = 0.0;
    MeshingStatistics statistics;
    const SimplexMesh<3> mesh = checks::MeshOf(image, options, &statistics);
    const RuleStatistics& rules = statistics.Rules;
    EXPECT_GT(rules.Removed, 20u) << "no test";
    EXPECT_LT(
      rules.Removed, mesh.Simplices.size() / 20); // otherwise 40 % of them, or more than there are
    EXPECT_LT(
      rules.Created, 10 * mesh.Simplices.size()); // otherwise 39 and more for each that stays
  }
}

// The finest of the interfaces that meet counts. Each of the three is the finest in turn.
TEST(InterfaceSizes, JunctionsBelongToTheFinestInterface)
{
  const LabelImage<3> image = phantoms::TouchingLabels(30);
  const auto pointsWith = [&](std::vector<InterfaceSize> sizes)
  {
    MeshingOptions<3> options = checks::WithDelta<3>(4.0);
    options.Sampling.InterfaceSizes = std::move(sizes);
    options.Sampling.Gradation = 0.0;
    MeshingStatistics statistics;
    checks::MeshOf(image, options, &statistics);
    return statistics.Interfaces.JunctionSeeds;
  };
  const std::uint64_t fine = pointsWith({ { 1, 2, 1.0 } });
  EXPECT_GT(fine, 3 * pointsWith({}));
  EXPECT_EQ(pointsWith({ { 0, 1, 1.0 } }), fine);
  EXPECT_EQ(pointsWith({ { 0, 2, 1.0 } }), fine);
}

// The graded delta has no effect on a pair that has its own sampling distance.
TEST(InterfaceSizes, GoWithGradingByLocalFeatureSize)
{
  const LabelImage<3> image = phantoms::NestedBalls(24.0);
  std::map<GradingMode, std::map<Interface, double>> edges;
  for (const GradingMode mode : { GradingMode::Uniform, GradingMode::LocalFeatureSize })
  {
    MeshingOptions<3> options = checks::WithDelta<3>(1.5);
    options.Sampling.Grading.Mode = mode;
    options.Sampling.InterfaceSizes = { { 3, 7, 1.5 } };
    const SimplexMesh<3> mesh = checks::MeshOf(image, options);
    checks::ExpectSound(mesh);
    edges[mode] = MeanEdges(mesh);
  }
  auto& uniform = edges[GradingMode::Uniform];
  auto& graded = edges[GradingMode::LocalFeatureSize];
  EXPECT_NEAR(graded.at({ 7, 3 }) / uniform.at({ 7, 3 }), 1.0, 0.1);
  EXPECT_GT(graded.at({ 200, 0 }) / uniform.at({ 200, 0 }), 1.2);
}

//------------------------------------------------------------------------------------------------
TEST(InterfaceSizes, SmallerElementSizesTakeTheirPlace)
{
  const LabelImage<3> image = phantoms::NestedBalls(18.0);
  MeshingOptions<3> options = checks::WithDelta<3>(3.0);
  options.Sampling.InterfaceSizes = { { 200, Any, 6.0 } };
  options.Sampling.Size =
    std::make_shared<CallableSize>([](const Point<3>&, std::int64_t) { return 1.5; });
  SimplexMesh<3> mesh;
  ImageMesher<3> mesher(options);
  mesher.Run(image, mesh);
  EXPECT_TRUE(checks::Complaints(mesh).empty());
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    ASSERT_LT(checks::Circumradius(mesh, t), 1.5 + 1e-9);
  }
  // Creations stay in proportion: nothing inserts what something else removes.
  EXPECT_LT(mesher.Statistics().Rules.Created, 40 * mesh.Simplices.size());
}

TEST(InterfaceSizes, SameInputSameMesh)
{
  const LabelImage<3> image = phantoms::TouchingLabels(16);
  const std::vector<InterfaceSize> sizes{ { 1, 2, 0.8 }, { 2, 0, 3.0 } };
  const SimplexMesh<3> a = Mesh(image, 1.5, sizes);
  const SimplexMesh<3> b = Mesh(image, 1.5, sizes);
  EXPECT_EQ(a.Points, b.Points);
  EXPECT_EQ(a.Simplices, b.Simplices);
}

//------------------------------------------------------------------------------------------------
// Interfaces that are coarser than delta ask the grid of feature vertices for more than its usual distance.
TEST(FeatureGrid, AnswersAnyDistance)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-10.0, 10.0);
  const auto point = [&] {
    return Point<3>{ anywhere(random), anywhere(random), anywhere(random) };
  };
  FeatureGrid<3> grid({ -10.0, -10.0, -10.0 }, 0.7, 100);
  std::vector<Point<3>> points;
  for (int i = 0; i < 60; ++i)
  {
    points.push_back(point());
    grid.Add(points.back());
  }
  int within = 0;
  for (int i = 0; i < 3000; ++i)
  {
    const Point<3> p = point();
    double nearest = HUGE_VAL;
    for (const Point<3>& q : points)
    {
      nearest = std::min(nearest, Distance(p, q));
    }
    for (const double distance : { 0.3, 0.7, 0.71, 1.5, 3.0, 8.0 })
    {
      ASSERT_EQ(grid.AnyWithin(p, distance), nearest < distance);
      within += nearest < distance;
    }
  }
  EXPECT_GT(within, 3000);
  EXPECT_LT(within, 15000);
}
