// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What must hold of a triangulation after refinement.
#ifndef voxplex_RefinementChecks_h
#define voxplex_RefinementChecks_h

#include "BallDomain.h"
#include "ComplexOf.h"
#include "MeshChecks.h"
#include "Refinement/RefinementContext.h"
#include "Refinement/Refiner.h"
#include "Refinement/Rules/Rules3D.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace voxplex::checks
{

/** The box in which the mesher would refine a domain. */
template <int D>
Box<D> Around(const Domain<D>& domain, double delta)
{
  Box<D> box = domain.Bounds();
  for (std::size_t a = 0; a < D; ++a)
  {
    box.Min[a] -= 2.0 * delta;
    box.Max[a] += 2.0 * delta;
  }
  return box;
}

template <int D>
RefinementSettings<D> SettingsFor(double delta)
{
  RefinementSettings<D> settings;
  settings.Sizing.Base = { delta };
  return settings;
}

/** A refined triangulation of a domain. */
inline std::unique_ptr<RefinementContext<3>> Refined(const Domain<3>& domain, double delta)
{
  auto context = std::make_unique<RefinementContext<3>>(
    domain, SettingsFor<3>(delta), Around(domain, delta), 1000);
  Refiner<Rules3D> refiner(*context);
  EXPECT_TRUE(refiner.Run(nullptr));
  return context;
}

/** The mesh of the ball is sound, and its interface is a sphere. */
inline SimplexMesh<3> ExtractSphere(const RefinementContext<3>& context, const BallDomain& ball)
{
  SimplexMesh<3> mesh;
  ExtractMesh<3>(context.Mesh, ball, mesh);
  ExpectSound(mesh);
  EXPECT_EQ(2 * VerticesOfInterfaces(mesh).size() - 4, mesh.Facets.size())
    << "Euler characteristic of a sphere";
  return mesh;
}

/** To refine once more inserts nothing. */
template <typename Rules, int D = Rules::Dimension>
void ExpectNothingLeft(RefinementContext<D>& context)
{
  Refiner<Rules> again(context);
  ASSERT_TRUE(again.Run(nullptr));
  for (const std::uint64_t fired : again.GetRuleStatistics().Fired)
  {
    EXPECT_EQ(fired, 0u);
  }
}

/** Checks every rule of the thesis' section 3.1 (3D) or 4.2 (4D, without slivers), stated anew, on
 * every simplex. */
template <int D>
void ExpectNoRuleApplies(const RefinementContext<D>& context, const BallDomainOf<D>& ball)
{
  using Ball = BallDomainOf<D>;
  const Triangulation<D>& mesh = context.Mesh;
  std::vector<Point<D>> features;
  for (VertexId v = 0; v < mesh.VertexIdEnd(); ++v)
  {
    if (mesh.GetVertex(v).Alive && mesh.GetVertex(v).Kind == VertexKind::Feature)
    {
      features.push_back(mesh.Position(v));
      ASSERT_NEAR(Ball::Norm(mesh.Position(v)), ball.R, 1e-9) << "feature vertex off dOmega";
    }
  }
  for (std::size_t i = 0; i < features.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      ASSERT_GE(Distance(features[i], features[j]), context.Sizing.SpacingFloor());
    }
  }
  for (const SimplexId s : AliveIn(mesh))
  {
    const Circumball<D> c = mesh.GetCircumball(s);
    const double radius = std::sqrt(c.Radius2);
    const double distance = std::abs(Ball::Norm(c.Center) - ball.R);
    const bool inside = ball.Label(c.Center) != 0;
    if (distance < radius * (1.0 - 1e-9))
    {
      Point<D> z;
      ball.ClosestSurfacePoint(c.Center, 0, z);
      const double local = context.Sizing.SamplingDistance(z, 1, 0);
      ASSERT_TRUE(std::any_of(features.begin(), features.end(),
        [&](const Point<D>& f) { return Distance(f, z) < local; }))
        << "sample spacing";
      ASSERT_LT(radius, 2.0 * local) << "ball";
    }
    const auto& v = mesh.GetSimplex(s).V;
    double shortest = 1e300;
    for (unsigned i = 0; i < v.size(); ++i)
    {
      for (unsigned j = 0; j < i; ++j)
      {
        shortest = std::min(shortest, Distance(mesh.Position(v[i]), mesh.Position(v[j])));
      }
      const SimplexId n = mesh.GetSimplex(s).N[i];
      if (n != None && inside && ball.Label(mesh.GetCircumball(n).Center) == 0)
      {
        SimplexMesh<D> facet;
        for (unsigned j = 0; j < v.size(); ++j)
        {
          if (j != i)
          {
            ASSERT_EQ(mesh.GetVertex(v[j]).Kind, VertexKind::Feature) << "facets";
            facet.Points.push_back(mesh.Position(v[j]));
          }
        }
        if constexpr (D == 3)
        {
          ASSERT_GE(SmallestAngle(facet, { 0, 1, 2 }), 30.0 - 1e-6) << "facet angles";
        }
      }
    }
    if (inside)
    {
      ASSERT_LT(radius / shortest, context.Settings.Shape.RadiusEdgeRatio) << "radius-edge ratio";
      ASSERT_LT(radius, context.Sizing.ElementSize(c.Center, 1)) << "sizes";
    }
  }
}

} // namespace voxplex::checks

#endif
