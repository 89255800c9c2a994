// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The rules on an analytic domain, where every answer is known: after refinement none is violated.
#include "BallDomain.h"
#include "ComplexOf.h"
#include "Domain/ImageDomain.h"
#include "Geometry/HilbertOrder.h"
#include "MeshChecks.h"
#include "Phantoms.h"
#include "Refinement/Refiner.h"
#include "Refinement/Rules/FeatureGrid.h"
#include "Refinement/Rules/Rules3D.h"
#include "RefinementChecks.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

class HalfSpaceSize : public SizeFunction<3>
{
public:
  double Evaluate(const Point<3>& p, std::int64_t label) const override
  {
    EXPECT_EQ(label, 5);
    return p[2] < 0.0 ? 0.7 : 5.0;
  }
};

} // namespace

TEST(Refinement, NoRuleAppliesAfterwards)
{
  const BallDomain ball(5.0);
  const HalfSpaceSize size;
  for (const double delta : { 2.0, 1.0, 0.5 })
  {
    for (const SizeFunction<3>* sf :
      { static_cast<const SizeFunction<3>*>(nullptr), static_cast<const SizeFunction<3>*>(&size) })
    {
      SCOPED_TRACE("delta " + std::to_string(delta) + (sf ? " with sizes" : ""));
      RefinementSettings<3> settings = SettingsFor<3>(delta);
      settings.Sizing.Size = sf;
      RefinementContext<3> context(ball, settings, Around(ball, delta), 1000);
      Refiner<Rules3D> refiner(context);
      ASSERT_TRUE(refiner.Run(nullptr));
      const RuleStatistics rules = refiner.GetRuleStatistics();
      EXPECT_LE(rules.RefusedTooClose, rules.PicksTried)
        << "only the sliver rule may ask for such points";
      EXPECT_EQ(rules.RemovalsFailed, 0u);
      EXPECT_GT(rules.Fired[0], 0u);
      EXPECT_GT(rules.Fired[1], 0u);
      ExpectSound(context.Mesh);
      ExpectNoRuleApplies(context, ball);
      ExpectNothingLeft<Rules3D>(context);
    }
  }
}

// Afterwards no rule applies anywhere, though only what is near the new bound was looked at.
TEST(Refinement, FollowsBoundsThatWereLowered)
{
  const LabelImage<3> image = phantoms::Ball(25.0);
  const ImageDomain<3> domain(image, 1.0);
  for (const unsigned threads : { 1u, 3u })
  {
    LocalDelta<3> local(image);
    RefinementSettings<3> settings = SettingsFor<3>(2.5);
    settings.Sizing.Local = &local;
    TeamOptions team;
    team.Threads = threads;
    RefinementContext<3> context(
      domain, settings, Around(domain, settings.Sizing.Base.Delta), 1000);
    ASSERT_TRUE(Refiner<Rules3D>(context, team).Run(nullptr));
    const std::uint32_t features = context.Features.Size();
    Refiner<Rules3D> idle(context, team, {}, RefinementStart::AtSeeds);
    ASSERT_TRUE(idle.Run(nullptr));
    EXPECT_EQ(idle.GetRuleStatistics().Evaluated, 0u);

    local.SetBound({ 24, 24, 0 }, 2, 1, 1.0);
    local.Grade();
    Refiner<Rules3D> near(context, team, {}, RefinementStart::AtSeeds);
    ASSERT_TRUE(near.Run(nullptr));
    EXPECT_GT(context.Features.Size(), features + 10);
    Refiner<Rules3D> everywhere(context, team);
    ASSERT_TRUE(everywhere.Run(nullptr));
    EXPECT_LT(near.GetRuleStatistics().Evaluated, everywhere.GetRuleStatistics().Evaluated);
    for (const std::uint64_t fired : everywhere.GetRuleStatistics().Fired)
    {
      EXPECT_EQ(fired, 0u);
    }
  }
}

TEST(Refinement, ExtractedBallIsASphere)
{
  const BallDomain ball(5.0);
  const double delta = 0.8;
  const SimplexMesh<3> mesh = ExtractSphere(*Refined(ball, delta), ball);
  EXPECT_EQ(mesh.Labels.front(), 5);
  // Hilbert order keeps neighbours near: the mean jump is a small part of the object.
  double jump = 0.0;
  for (std::size_t i = 1; i < mesh.Points.size(); ++i)
  {
    jump += Distance(mesh.Points[i], mesh.Points[i - 1]);
  }
  EXPECT_LT(jump / static_cast<double>(mesh.Points.size()), 3.0 * delta);
}

// Removal: circumcentres come before feature points in places, and then have to go. The ball rule inserts centres of
// balls that are empty up to 2 delta. The radius-edge and sliver rules may insert nearer ones and are off, so that what
// removal promises holds of every pair.
TEST(Refinement, FreeVerticesNearFeatureVerticesAreRemoved)
{
  const BallDomain ball(5.0);
  RefinementSettings<3> settings = SettingsFor<3>(1.0);
  settings.Shape.RadiusEdgeRatio = 1e9;
  settings.Shape.Slivers.Angle = 0.0;
  RefinementContext<3> context(ball, settings, Around(ball, settings.Sizing.Base.Delta), 1000);
  Refiner<Rules3D> refiner(context);
  refiner.Run(nullptr);
  EXPECT_GT(refiner.GetRuleStatistics().Removed, 0u);
  EXPECT_EQ(refiner.GetRuleStatistics().RemovalsFailed, 0u);
  std::map<VertexKind, std::vector<Point<3>>> points;
  for (VertexId v = 0; v < context.Mesh.VertexIdEnd(); ++v)
  {
    const Triangulation<3>::Vertex& vertex = context.Mesh.GetVertex(v);
    if (vertex.Alive)
    {
      points[vertex.Kind].push_back(vertex.Position);
    }
  }
  EXPECT_GT(points[VertexKind::Free].size(), 10u);
  EXPECT_GT(points[VertexKind::Feature].size(), 100u);
  for (const Point<3>& free : points[VertexKind::Free])
  {
    for (const Point<3>& feature : points[VertexKind::Feature])
    {
      EXPECT_GE(Distance(free, feature), 2.0 * settings.Sizing.Base.Delta);
    }
  }
}

TEST(Refinement, StopsWhenAsked)
{
  const BallDomain ball(5.0);
  RefinementContext<3> context(ball, SettingsFor<3>(0.3), Around(ball, 0.3), 1000);
  Refiner<Rules3D> refiner(context);
  int calls = 0;
  EXPECT_FALSE(refiner.Run([&](std::uint64_t) { return ++calls < 3; }));
  EXPECT_EQ(calls, 3);
}

TEST(FeatureGrid, AgreesWithBruteForce)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-4.0, 4.0);
  for (const std::uint64_t expected : { 1ull, 100000ull })
  {
    FeatureGrid<3> grid({ -4.0, -4.0, -4.0 }, 0.5, expected);
    std::vector<Point<3>> points;
    for (int i = 0; i < 400; ++i)
    {
      const Point<3> p = { uniform(random), uniform(random), uniform(random) };
      for (const double distance : { 0.2, 0.5, 1.8 })
      {
        const bool near = std::any_of(points.begin(), points.end(),
          [&](const Point<3>& q) { return Distance(p, q) < distance; });
        ASSERT_EQ(grid.AnyWithin(p, distance), near);
      }
      grid.Add(p);
      points.push_back(p);
    }
    EXPECT_EQ(grid.Size(), 400u);
    // Every third is taken out, and points that were never there.
    std::vector<Point<3>> left;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      if (i % 3 == 0)
      {
        EXPECT_TRUE(grid.Remove(points[i]));
        EXPECT_FALSE(grid.Remove({ points[i][0], points[i][1], points[i][2] + 1e-9 }));
        EXPECT_FALSE(grid.Remove(points[i]));
      }
      else
      {
        left.push_back(points[i]);
      }
    }
    for (const Point<3>& p : points)
    {
      const bool near = std::any_of(
        left.begin(), left.end(), [&](const Point<3>& q) { return Distance(p, q) < 0.5; });
      EXPECT_EQ(grid.AnyWithin(p, 0.5), near);
    }
  }
}

template <int D>
void ExpectHilbertOrderVisitsNeighbours(int levels)
{
  const int side = 1 << levels;
  Box<D> box;
  box.Min.fill(0.0);
  box.Max.fill(side);
  std::vector<std::pair<std::uint64_t, Point<D>>> cells;
  for (int k = 0; k < 1 << (levels * D); ++k)
  {
    Point<D> p;
    for (int a = 0; a < D; ++a)
    {
      p[static_cast<std::size_t>(a)] = ((k >> (levels * a)) & (side - 1)) + 0.5;
    }
    cells.push_back({ HilbertIndex<D>(p, box), p });
  }
  std::sort(cells.begin(), cells.end());
  for (std::size_t i = 1; i < cells.size(); ++i)
  {
    ASSERT_NEAR(Distance(cells[i].second, cells[i - 1].second), 1.0, 1e-12) << D << " " << i;
  }
}

TEST(HilbertOrder, VisitsNeighbouringCellsOfALattice)
{
  ExpectHilbertOrderVisitsNeighbours<3>(3);
  ExpectHilbertOrderVisitsNeighbours<3>(5);
  ExpectHilbertOrderVisitsNeighbours<4>(2);
  ExpectHilbertOrderVisitsNeighbours<4>(4);
}

// The automaton is a table of Skilling's algorithm.
TEST(HilbertOrder, IsTheCurveOfSkilling)
{
  const auto expect = []<int D>(std::integral_constant<int, D>)
  {
    constexpr auto axes = static_cast<std::size_t>(D);
    constexpr unsigned bits = 63 / D;
    constexpr double side = static_cast<double>((1u << bits) - 1);
    Box<D> box;
    box.Min.fill(0.0);
    box.Max.fill(side);
    std::mt19937 random(7);
    for (int k = 0; k < 2000; ++k)
    {
      std::array<std::uint32_t, axes> x;
      Point<D> p;
      for (std::size_t a = 0; a < axes; ++a)
      {
        x[a] = static_cast<std::uint32_t>(random()) >> (32 - bits);
        p[a] = x[a];
      }
      for (unsigned b = bits - 1; b > 0; --b)
      {
        const std::uint32_t lower = (1u << b) - 1;
        for (std::size_t a = 0; a < axes; ++a)
        {
          const std::uint32_t exchange = (x[a] >> b) & 1u ? 0u : (x[0] ^ x[a]) & lower;
          x[0] ^= (x[a] >> b) & 1u ? lower : exchange;
          x[a] ^= exchange;
        }
      }
      for (std::size_t a = 1; a < axes; ++a)
      {
        x[a] ^= x[a - 1];
      }
      std::uint32_t parity = 0;
      std::uint64_t index = 0;
      for (unsigned b = bits; b-- > 0;)
      {
        for (std::size_t a = 0; a < axes; ++a)
        {
          index = index << 1 | (((x[a] >> b) & 1u) ^ parity);
        }
        parity ^= (x[axes - 1] >> b) & 1u;
      }
      ASSERT_EQ(HilbertIndex<D>(p, box), index) << D;
    }
  };
  expect(std::integral_constant<int, 3>());
  expect(std::integral_constant<int, 4>());
}
