// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Boundaries of labels in space-time are 3-manifolds at all triangles, on any labels, also where the mesh ends flat.
#include "CallableSize.h"
#include "Conformity/ManifoldLabels.h"
#include "MeshChecks.h"
#include "Optimisation/OpenRidges.h"
#include "Phantoms.h"
#include "Refinement/Rules/Rules4D.h"
#include "RefinementChecks.h"
#include "RepairTesting.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <set>
#include <string>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** A ball whose simplices may have any label. */
class AnyLabels final : public BallDomainOf<4>
{
public:
  using BallDomainOf<4>::BallDomainOf;
  std::int64_t LabelValue(LabelId id) const override { return id; }
};

/** The triangles that are not manifold, of all labels. */
std::vector<InterfaceRidge<4>> BadTriangles(const SimplexMesh<4>& mesh)
{
  return FindNonManifoldRidges<4>(mesh.Facets, mesh.FacetLabels, mesh.Points.size());
}

/** A mesh before its triangles are opened, and after. */
struct Opened
{
  Opened(const Triangulation<4>& triangulation, const Domain<4>& domain,
    const SimplexLabels& labels, unsigned threads = 1)
  {
    ExtractMesh<4>(triangulation, domain, labels, this->Before, threads);
    this->Triangles = BadTriangles(this->Before); // points have the numbers of the complex
    UninitialisedVector<std::uint32_t> numbers;
    PentatopeComplex complex(triangulation, labels, {}, numbers, threads);
    this->Left = OpenRidges<4>(complex, domain, this->Triangles);
    complex.Compact(false, threads);
    complex.Write(ValuesOf(domain, labels), this->After, threads);
  }

  void Check() const
  {
    EXPECT_TRUE(this->Left.empty());
    EXPECT_TRUE(BadTriangles(this->After).empty());
    EXPECT_EQ(FindManifoldDefects(this->After).Triangles, 0u); // code of its own
    ExpectSound(this->After);
    const std::set<std::int64_t> labels(this->Before.Labels.begin(), this->Before.Labels.end());
    EXPECT_EQ(std::set<std::int64_t>(this->After.Labels.begin(), this->After.Labels.end()), labels);
    const std::set<Point<4>> points(this->After.Points.begin(), this->After.Points.end());
    EXPECT_EQ(points.size(), this->After.Points.size());
    for (const Point<4>& p : this->Before.Points)
    {
      EXPECT_EQ(points.count(p), 1u);
    }
  }

  std::vector<InterfaceRidge<4>> Triangles;
  std::vector<InterfaceRidge<4>> Left;
  SimplexMesh<4> Before;
  SimplexMesh<4> After;
};

/** A refined triangulation, and the object in it. */
class RefinedObject
{
public:
  RefinedObject(const Domain<4>& domain, double delta)
    : Surfaces(domain)
  {
    Box<4> box = Around(domain, delta);
    for (const unsigned end : { 0u, 1u })
    {
      if (domain.HasTimeBorder(end))
      {
        (end == 0 ? box.Min : box.Max)[3] =
          (end == 0 ? domain.Bounds().Min : domain.Bounds().Max)[3];
      }
    }
    RefinementSettings<4> settings;
    settings.Sizing.Base = { delta };
    settings.SpaceTime.Slivers.Fight = false;
    this->Context = std::make_unique<RefinementContext<4>>(domain, settings, box, 1000);
    EXPECT_TRUE(Refiner<Rules4D>(*this->Context).Run(nullptr));
    this->Object = LabelSimplices<4>(this->Context->Mesh, domain);
  }

  const Triangulation<4>& Mesh() const { return this->Context->Mesh; }
  Triangulation<4>& Mesh() { return this->Context->Mesh; }

  const Domain<4>& Surfaces;
  std::unique_ptr<RefinementContext<4>> Context;
  SimplexLabels Object;
};

LabelImage<4> Noise(
  unsigned seed, std::int64_t side, std::int64_t frames, unsigned labels, double spacing = 1.0)
{
  return phantoms::Noise(GridGeometry<4>::Orthogonal(
                           { side, side, side, frames }, { spacing, spacing, spacing, spacing }),
    seed, labels);
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(SpaceTimeRidges, OpenAllTrianglesOfShuffledLabels)
{
  const AnyLabels ball(3.0);
  const RefinedObject refined(ball, 1.4);
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    SCOPED_TRACE(seed);
    const bool withBackground = seed % 2 == 0;
    const SimplexLabels labels =
      Shuffled(refined.Object, seed, (withBackground ? 1 : 2) + seed / 3, withBackground);
    const Opened opened(refined.Mesh(), ball, labels);
    opened.Check();
    EXPECT_GT(opened.Triangles.size(), 20u);
    EXPECT_EQ(
      opened.Triangles.empty(), opened.After.Simplices.size() == opened.Before.Simplices.size());
    if (!withBackground)
    {
      EXPECT_NEAR(TotalVolume(opened.After), TotalVolume(opened.Before), 1e-9);
    }
  }
}

// Around triangles on the flat ends, pentatopes form no circle.
TEST(SpaceTimeRidges, KeepFlatEnds)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(5, 3.0, 0.0));
  const ImageDomain<4> domain(image, 1.0);
  const RefinedObject refined(domain, 4.0);
  const auto [first, last] = std::pair(0.0, 12.0);
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    SCOPED_TRACE(seed);
    const bool withBackground = seed % 2 == 0;
    const Opened opened(refined.Mesh(), domain,
      Shuffled(refined.Object, seed, withBackground ? 1 : 2, withBackground));
    opened.Check();
    std::size_t onEnds = 0;
    for (const InterfaceRidge<4>& triangle : opened.Triangles)
    {
      onEnds += std::all_of(triangle.Vertices.begin(), triangle.Vertices.end(),
        [&, end = last](std::uint32_t v) { return opened.Before.Points[v][3] == end; });
    }
    EXPECT_GT(onEnds, 0u);
    for (const double end : { first, last })
    {
      const auto total = [&](const SimplexMesh<4>& mesh)
      {
        double volume = 0.0;
        for (const auto& [label, part] : EndVolumes(mesh, end))
        {
          volume += part;
        }
        return volume;
      };
      EXPECT_GT(total(opened.Before), 0.0);
      if (withBackground)
      {
        EXPECT_GE(total(opened.After), total(opened.Before) - 1e-9) << "a dent";
      }
      else
      {
        EXPECT_NEAR(total(opened.After), total(opened.Before), 1e-9);
      }
    }
  }
}

TEST(SpaceTimeRidges, DoNotDependOnThreads)
{
  const AnyLabels ball(3.0);
  const RefinedObject refined(ball, 1.4);
  const SimplexLabels labels = Shuffled(refined.Object, 7, 2, true);
  const Opened one(refined.Mesh(), ball, labels, 1);
  const Opened three(refined.Mesh(), ball, labels, 3);
  EXPECT_EQ(one.After.Points, three.After.Points);
  EXPECT_EQ(one.After.Simplices, three.After.Simplices);
  EXPECT_EQ(one.After.Labels, three.After.Labels);
  EXPECT_EQ(one.After.Facets, three.After.Facets);
}

//------------------------------------------------------------------------------------------------
TEST(SpaceTimeManifoldLabels, GiveFewerBadTriangles)
{
  for (unsigned seed = 1; seed <= 2; ++seed)
  {
    SCOPED_TRACE(seed);
    const LabelImage<4> image = Noise(seed, 4, 4, 2, 3.0); // voxels are larger than pentatopes
    const ImageDomain<4> domain(image, 1.0);
    RefinedObject refined(domain, 1.7);
    ManifoldRepairOptions<4> options;
    options.Surfaces = &domain;
    InterfaceStatistics figures;
    ManifoldLabeller<4> labeller(refined.Mesh(), options, 1, {});
    labeller.Take();
    const SimplexLabels plain = labeller.GetLabels();
    const auto repaired = checks::LabelsOf(labeller, figures);
    EXPECT_EQ(plain, refined.Object);
    EXPECT_NE(repaired.Labels, plain);

    const auto countBad = [&](const SimplexLabels& labels)
    {
      SimplexMesh<4> mesh;
      ExtractMesh<4>(refined.Mesh(), domain, labels, mesh);
      EXPECT_TRUE(Complaints(mesh).empty());
      return BadTriangles(mesh).size();
    };
    EXPECT_EQ(countBad(repaired.Labels), repaired.NonManifold.size());
    EXPECT_EQ(figures.NonManifoldLeft, repaired.NonManifold.size());
    EXPECT_EQ(figures.NonManifoldRepaired + figures.NonManifoldLeft, countBad(plain));
    EXPECT_GT(figures.NonManifoldRepaired, figures.NonManifoldLeft);

    // No vertex comes onto an interface. Those inside of a flat end are on none.
    const auto onInterfaces = [&](const SimplexLabels& labels)
    {
      std::set<VertexId> vertices;
      for (SimplexId s = 0; s < labels.size(); ++s)
      {
        const auto& simplex = refined.Mesh().GetSimplex(s);
        for (unsigned i = 0; i < 5 && labels[s] != 0; ++i)
        {
          if (simplex.N[i] != None && labels[simplex.N[i]] != labels[s])
          {
            for (unsigned k = 1; k < 5; ++k)
            {
              vertices.insert(simplex.V[(i + k) % 5]);
            }
          }
        }
      }
      return vertices;
    };
    const std::set<VertexId> before = onInterfaces(plain);
    const std::set<VertexId> after = onInterfaces(repaired.Labels);
    EXPECT_TRUE(std::includes(before.begin(), before.end(), after.begin(), after.end()));

    // No pentatope of an end in time is dropped.
    for (SimplexId s = 0; s < plain.size(); ++s)
    {
      const auto& beside = refined.Mesh().GetSimplex(s).N;
      const bool isAtEnd = plain[s] != 0 &&
        std::any_of(beside.begin(), beside.end(), [](SimplexId n) { return n == None; });
      EXPECT_TRUE(!isAtEnd || repaired.Labels[s] != 0);
    }

    // It keeps them, and several threads give the same.
    InterfaceStatistics again;
    EXPECT_EQ(checks::LabelsOf(labeller, again).Labels, repaired.Labels);
    RefinedObject other(domain, 1.7);
    ManifoldLabeller<4> others(other.Mesh(), options, 4, {});
    EXPECT_EQ(checks::LabelsOf(others, again).Labels, repaired.Labels);
  }
}

//------------------------------------------------------------------------------------------------
TEST(SpaceTimeManifolds, HaveNoBadTrianglesOnAnyImage)
{
  std::uint64_t opened = 0;
  for (unsigned seed = 1; seed <= 16; ++seed)
  {
    MeshingOptions<4> options;
    options.Sampling.Delta = 1.2 + 0.4 * (seed % 5);
    options.Interfaces.Rounds = seed % 4 == 0 ? 0 : seed % 3;
    options.Interfaces.Fit = seed % 3 != 0;
    options.Components.Smallest = seed % 3 == 0 ? 0 : 8;
    options.SmoothingSigma = seed % 2 == 0 ? 0.0 : 1.0;
    options.Optimisation.Run = seed % 4 < 2;
    options.SpaceTime.Slivers.Fight = seed % 5 != 0;
    options.FrameSteps = 1;
    options.Team.Threads = seed % 6 == 0 ? 3 : 1;
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", delta " << options.Sampling.Delta);
    SimplexMesh<4> mesh;
    opened += ExpectRidgesOpened(Noise(seed, 5, 7, 1 + seed % 3), options, mesh);
    EXPECT_EQ(FindManifoldDefects(mesh).Triangles, 0u);
  }
  EXPECT_GT(opened, 10u);
}

TEST(SpaceTimeManifolds, AreLeftAsTheyComeOnRequest)
{
  MeshingOptions<4> options;
  options.Sampling.Delta = 1.6;
  options.SmoothingSigma = 0.0;
  options.FrameSteps = 1;
  options.Interfaces.Manifold = false;
  MeshingStatistics statistics;
  const SimplexMesh<4> mesh = MeshOf(Noise(1, 5, 7, 2), options, &statistics);
  EXPECT_GT(FindManifoldDefects(mesh).Triangles, 0u);
  EXPECT_EQ(statistics.Interfaces.NonManifoldRepaired, 0u);
}
