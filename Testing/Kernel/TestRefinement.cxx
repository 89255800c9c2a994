// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The rules on an analytic domain, where every answer is known: after refinement none is violated.
#include "Mesh/HilbertOrder.h"
#include "Mesh/MeshExtraction.h"
#include "MeshChecks.h"
#include "Refinement/FeatureGrid.h"
#include "Refinement/Refiner.h"
#include "Refinement/Rules3D.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

using namespace voxplex;

namespace
{

/** A ball of label 5 in background: exact answers, no image. */
class BallDomain final : public Domain<3>
{
public:
  explicit BallDomain(double radius)
    : R(radius)
  {
  }
  Box<3> Bounds() const override
  {
    return { { -this->R, -this->R, -this->R }, { this->R, this->R, this->R } };
  }
  LabelId Label(const Point<3>& p) const override { return Norm(p) < this->R ? 1 : 0; }
  std::int64_t LabelValue(LabelId id) const override { return id == 1 ? 5 : 0; }
  DistanceInterval DistanceBounds(const Point<3>& p) const override
  {
    const double d = std::abs(Norm(p) - this->R);
    return { std::max(0.0, d - this->Slack), d + this->Slack };
  }
  bool ClosestSurfacePoint(const Point<3>& p, LabelId, Point<3>& z) const override
  {
    const double norm = Norm(p);
    if (norm == 0.0)
    {
      z = { this->R, 0.0, 0.0 };
      return true;
    }
    for (std::size_t i = 0; i < 3; ++i)
    {
      z[i] = p[i] * this->R / norm;
    }
    return true;
  }
  bool NearSurfacePoint(const Point<3>& p, LabelId label, Point<3>& z, double& error) const override
  {
    error = 0.0;
    return this->ClosestSurfacePoint(p, label, z);
  }
  bool FirstCrossing(const Point<3>& a, LabelId, const Point<3>& b, Point<3>& z) const override
  {
    const Point<3> d = Subtract(b, a);
    const double qa = Dot(d, d);
    const double qb = Dot(a, d);
    const double qc = Dot(a, a) - this->R * this->R;
    const double root = std::sqrt(std::max(0.0, qb * qb - qa * qc));
    for (const double t : { (-qb - root) / qa, (-qb + root) / qa })
    {
      if (t >= 0.0 && t <= 1.0)
      {
        z = Interpolate(a, b, t);
        return true;
      }
    }
    return false;
  }
  static double Norm(const Point<3>& p) { return std::sqrt(Dot(p, p)); }

  double R;
  double Slack = 0.05;
};

class HalfSpaceSize : public SizeFunction<3>
{
public:
  double Evaluate(const Point<3>& p, std::int64_t label) const override
  {
    EXPECT_EQ(label, 5);
    return p[2] < 0.0 ? 0.7 : 5.0;
  }
};

Box<3> Around(const BallDomain& ball, double delta)
{
  Box<3> box = ball.Bounds();
  for (std::size_t a = 0; a < 3; ++a)
  {
    box.Min[a] -= 2.0 * delta;
    box.Max[a] += 2.0 * delta;
  }
  return box;
}

/** Every rule of the thesis' section 3.1, stated anew, on every tetrahedron. */
void ExpectNoRuleApplies(const RefinementContext<3>& context, const BallDomain& ball)
{
  const Triangulation<3>& mesh = context.Mesh;
  std::vector<Point<3>> features;
  for (VertexId v = 0; v < mesh.VertexIdEnd(); ++v)
  {
    if (mesh.GetVertex(v).Alive && mesh.GetVertex(v).Kind == VertexKind::Feature)
    {
      features.push_back(mesh.Position(v));
      ASSERT_NEAR(BallDomain::Norm(mesh.Position(v)), ball.R, 1e-9) << "feature vertex off dOmega";
    }
  }
  for (std::size_t i = 0; i < features.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      ASSERT_GE(Distance(features[i], features[j]), context.SpacingFloor);
    }
  }
  for (SimplexId s = 0; s < mesh.SimplexIdEnd(); ++s)
  {
    if (!mesh.IsAlive(s))
    {
      continue;
    }
    const Circumball<3> c = mesh.GetCircumball(s);
    const double radius = std::sqrt(c.Radius2);
    const double distance = std::abs(BallDomain::Norm(c.Center) - ball.R);
    const bool inside = ball.Label(c.Center) != 0;
    if (distance < radius * (1.0 - 1e-9))
    {
      Point<3> z;
      ball.ClosestSurfacePoint(c.Center, 0, z);
      const double local = context.Delta(z, 1, 0);
      ASSERT_TRUE(std::any_of(features.begin(), features.end(),
        [&](const Point<3>& f) { return Distance(f, z) < local; }))
        << "R1";
      ASSERT_LT(radius, 2.0 * local) << "R2";
    }
    const auto& v = mesh.GetSimplex(s).V;
    double shortest = 1e300;
    for (unsigned i = 0; i < 4; ++i)
    {
      for (unsigned j = 0; j < i; ++j)
      {
        shortest = std::min(shortest, Distance(mesh.Position(v[i]), mesh.Position(v[j])));
      }
      const SimplexId n = mesh.GetSimplex(s).N[i];
      if (n != None && inside && ball.Label(mesh.GetCircumball(n).Center) == 0)
      {
        SimplexMesh<3> facet;
        for (unsigned j = 0; j < 4; ++j)
        {
          if (j != i)
          {
            ASSERT_EQ(mesh.GetVertex(v[j]).Kind, VertexKind::Feature) << "R3";
            facet.Points.push_back(mesh.Position(v[j]));
          }
        }
        ASSERT_GE(checks::SmallestAngle(facet, { 0, 1, 2 }), 30.0 - 1e-6) << "R3";
      }
    }
    if (inside)
    {
      ASSERT_LT(radius / shortest, context.Settings.RadiusEdgeRatio) << "R4";
      ASSERT_LT(radius, context.Size(c.Center, 1)) << "R5";
    }
  }
}

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
      RefinementSettings<3> settings;
      settings.Delta = delta;
      settings.Size = sf;
      RefinementContext<3> context(ball, settings, Around(ball, delta), 1000);
      Refiner<Rules3D> refiner(context);
      ASSERT_TRUE(refiner.Run(nullptr));
      const RuleStatistics& rules = refiner.GetWorker().Statistics;
      EXPECT_EQ(rules.RefusedTooClose, 0u);
      EXPECT_EQ(rules.RemovalsFailed, 0u);
      EXPECT_GT(rules.Fired[0], 0u);
      EXPECT_GT(rules.Fired[1], 0u);
      Triangulation<3>::Worker worker(context.Mesh);
      const std::vector<std::string> complaints = context.Mesh.Verify(worker);
      ASSERT_TRUE(complaints.empty()) << complaints.front();
      ExpectNoRuleApplies(context, ball);

      // Again: nothing happens.
      Refiner<Rules3D> again(context);
      ASSERT_TRUE(again.Run(nullptr));
      for (const std::uint64_t fired : again.GetWorker().Statistics.Fired)
      {
        EXPECT_EQ(fired, 0u);
      }
    }
  }
}

TEST(Refinement, ExtractedBallIsASphere)
{
  const BallDomain ball(5.0);
  RefinementSettings<3> settings;
  settings.Delta = 0.8;
  RefinementContext<3> context(ball, settings, Around(ball, settings.Delta), 1000);
  Refiner<Rules3D> refiner(context);
  refiner.Run(nullptr);
  SimplexMesh<3> mesh;
  ExtractMesh<3>(context.Mesh, ball, mesh);
  const std::vector<std::string> complaints = checks::Complaints(mesh);
  ASSERT_TRUE(complaints.empty()) << complaints.front();
  std::set<std::uint32_t> vertices;
  for (const auto& f : mesh.Facets)
  {
    vertices.insert(f.begin(), f.end());
  }
  EXPECT_EQ(2 * vertices.size() - 4, mesh.Facets.size()) << "Euler characteristic of a sphere";
  EXPECT_EQ(mesh.Labels.front(), 5);
  // Hilbert order keeps neighbours near: the mean jump is a small part of the object.
  double jump = 0.0;
  for (std::size_t i = 1; i < mesh.Points.size(); ++i)
  {
    jump += Distance(mesh.Points[i], mesh.Points[i - 1]);
  }
  EXPECT_LT(jump / static_cast<double>(mesh.Points.size()), 3.0 * settings.Delta);
}

// R6: circumcentres come before feature points in places, and then have to go.
TEST(Refinement, FreeVerticesNearFeatureVerticesAreRemoved)
{
  const BallDomain ball(5.0);
  RefinementSettings<3> settings;
  settings.Delta = 1.0;
  RefinementContext<3> context(ball, settings, Around(ball, settings.Delta), 1000);
  Refiner<Rules3D> refiner(context);
  refiner.Run(nullptr);
  EXPECT_GT(refiner.GetWorker().Statistics.Removed, 0u);
  for (VertexId v = 0; v < context.Mesh.VertexIdEnd(); ++v)
  {
    const Triangulation<3>::Vertex& vertex = context.Mesh.GetVertex(v);
    if (vertex.Alive && vertex.Kind == VertexKind::Free)
    {
      EXPECT_GT(std::abs(BallDomain::Norm(vertex.Position) - ball.R), 0.2 * settings.Delta);
    }
  }
}

TEST(Refinement, StopsWhenAsked)
{
  const BallDomain ball(5.0);
  RefinementSettings<3> settings;
  settings.Delta = 0.3;
  RefinementContext<3> context(ball, settings, Around(ball, settings.Delta), 1000);
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
      for (const double distance : { 0.5, 0.2 })
      {
        const bool near = std::any_of(points.begin(), points.end(),
          [&](const Point<3>& q) { return Distance(p, q) < distance; });
        ASSERT_EQ(grid.AnyWithin(p, distance), near);
      }
      grid.Add(p);
      points.push_back(p);
    }
    EXPECT_EQ(grid.Size(), 400u);
  }
}

TEST(HilbertOrder, VisitsNeighbouringCellsOfALattice)
{
  Box<3> box;
  box.Min.fill(0.0);
  box.Max.fill(8.0);
  std::vector<std::pair<std::uint64_t, Point<3>>> cells;
  for (int k = 0; k < 512; ++k)
  {
    const Point<3> p = { (k & 7) + 0.5, ((k >> 3) & 7) + 0.5, (k >> 6) + 0.5 };
    cells.push_back({ HilbertIndex<3>(p, box), p });
  }
  std::sort(cells.begin(), cells.end());
  for (std::size_t i = 1; i < cells.size(); ++i)
  {
    EXPECT_NEAR(Distance(cells[i].second, cells[i - 1].second), 1.0, 1e-12);
  }
}
