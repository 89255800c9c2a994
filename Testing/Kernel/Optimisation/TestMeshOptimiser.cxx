// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Optimised meshes of phantoms: shapes, and all that must stay as it was.
#include "Base/Error.h"
#include "ComplexOf.h"
#include "Domain/ImageDomain.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Optimisation/Patch.h"
#include "Optimisation/Tetrahedra/MeshOptimiser.h"
#include "Optimisation/Tetrahedra/Smoother.h"
#include "Phantoms.h"
#include "Quality/MeshQuality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <random>
#include <set>
#include <utility>

using namespace voxplex;

namespace
{

constexpr double Sigma = 1.0;

SimplexMesh<3> Mesh(const LabelImage<3>& image, double delta)
{
  MeshingOptions<3> options = checks::WithDelta<3>(delta);
  options.SmoothingSigma = Sigma;
  return checks::MeshOf(image, options);
}

/** Cells of random seeds in a ball: surfaces of many labels, junction curves, and corners. */
LabelImage<3> Foam(double radius, std::int16_t labels)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(0.0, 2 * radius + 8);
  std::vector<Point<3>> seeds;
  for (std::int16_t k = 0; k < labels; ++k)
  {
    seeds.push_back({ coordinate(random), coordinate(random), coordinate(random) });
  }
  const double c = radius + 3.5;
  return phantoms::Make(phantoms::Cube(static_cast<std::int64_t>(2 * radius) + 8),
    [=](const Point<3>& p) -> std::int16_t
    {
      if (Distance(p, { c, c, c }) >= radius)
      {
        return 0;
      }
      const auto nearer = [&p](const Point<3>& a, const Point<3>& b)
      { return Distance(p, a) < Distance(p, b); };
      return static_cast<std::int16_t>(
        1 + (std::min_element(seeds.begin(), seeds.end(), nearer) - seeds.begin()));
    });
}

/** Small pieces of two labels, from one voxel on, in a block of a third. */
LabelImage<3> Islands()
{
  return phantoms::Make(phantoms::Cube(30),
    [](const Point<3>& p) -> std::int16_t
    {
      for (int k = 0; k < 6; ++k)
      {
        const Point<3> centre = { 7.0 + 3.0 * k, 8.0 + 2.0 * (k % 3) * k, 8.0 + 2.0 * k };
        if (Distance(p, centre) < 0.5 + 0.4 * k)
        {
          return static_cast<std::int16_t>(k % 2 == 0 ? 4 : 9);
        }
      }
      const auto within = [](double x) { return x > 3.5 && x < 26.5; };
      return within(p[0]) && within(p[1]) && within(p[2]) ? 2 : 0;
    });
}

struct Phantom
{
  const char* Name;
  LabelImage<3> (*Make)();
  double Delta;
};

std::ostream& operator<<(std::ostream& out, const Phantom& phantom)
{
  return out << phantom.Name;
}

const Phantom Phantoms[] = {
  { "Ball", [] { return phantoms::Ball(9.0); }, 1.0 },
  { "CoarseBall", [] { return phantoms::Ball(9.0); }, 3.0 },
  { "NestedBalls", [] { return phantoms::NestedBalls(15.0); }, 1.2 },
  { "TouchingLabels", [] { return phantoms::TouchingLabels(12); }, 1.2 },
  { "Islands", Islands, 1.0 },
  { "Sheet", [] { return phantoms::Sheet(16); }, 1.0 },
  { "CutBall", [] { return phantoms::CutBall(12); }, 1.5 },
  { "Foam", [] { return Foam(16.0, 25); }, 1.3 },
};

/** Whether labels change within about `distance` of p: at a sample of directions and distances. */
bool IsNearInterface(const Domain<3>& domain, const Point<3>& p, double distance)
{
  const double reach = 1.3 * distance; // no direction is farther than 37 degrees from a sample
  constexpr int Lengths = 16;
  for (int sample = 0; sample < Lengths * 27; ++sample)
  {
    const int i = sample % 3 - 1;
    const int j = sample / 3 % 3 - 1;
    const int k = sample / 9 % 3 - 1;
    const double length =
      reach * (1 + sample / 27) / Lengths / std::sqrt(std::max(1, i * i + j * j + k * k));
    if (domain.Label({ p[0] + length * i, p[1] + length * j, p[2] + length * k }) !=
      domain.Label(p))
    {
      return true;
    }
  }
  return false;
}

/**
 * Vertices of interfaces that are farther than `tolerance` from them, and also from all points that the mesh
 * had before.
 */
std::size_t VerticesOffInterfaces(const SimplexMesh<3>& mesh, const SimplexMesh<3>& before,
  const Domain<3>& domain, double tolerance)
{
  const std::set<std::uint32_t> vertices = checks::VerticesOfInterfaces(mesh);
  return static_cast<std::size_t>(std::count_if(vertices.begin(), vertices.end(),
    [&](std::uint32_t v)
    {
      const Point<3>& p = mesh.Points[v];
      return !IsNearInterface(domain, p, tolerance + 0.02) &&
        std::none_of(before.Points.begin(), before.Points.end(),
          [&](const Point<3>& q) { return Distance(p, q) <= tolerance + 1e-9; });
    }));
}

/** Edges that more than two interface facets of one label have. */
std::size_t NonManifoldEdges(const SimplexMesh<3>& mesh)
{
  std::size_t edges = 0;
  for (const auto& [label, counts] : checks::RidgesOfBoundaries(mesh))
  {
    for (const auto& [ridge, count] : counts)
    {
      edges += count > 2 ? 1 : 0;
    }
  }
  return edges;
}

/** Pieces of each label, joined by facets, of two tetrahedra or more. */
std::map<std::int64_t, int> Pieces(const SimplexMesh<3>& mesh)
{
  std::map<std::array<std::uint32_t, 3>, std::size_t> facets;
  std::vector<std::size_t> parents(mesh.Simplices.size());
  std::iota(parents.begin(), parents.end(), std::size_t{ 0 });
  const auto root = [&](std::size_t t)
  {
    while (parents[t] != t)
    {
      t = parents[t] = parents[parents[t]];
    }
    return t;
  };
  for (std::size_t t = 0; t < parents.size(); ++t)
  {
    for (unsigned i = 0; i < 4; ++i)
    {
      const auto& v = mesh.Simplices[t];
      std::array<std::uint32_t, 3> f = { v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4] };
      std::sort(f.begin(), f.end());
      const auto [other, isNew] = facets.emplace(f, t);
      if (!isNew && mesh.Labels[other->second] == mesh.Labels[t])
      {
        parents[root(t)] = root(other->second);
      }
    }
  }
  std::map<std::size_t, int> sizes;
  for (std::size_t t = 0; t < parents.size(); ++t)
  {
    ++sizes[root(t)];
  }
  std::map<std::int64_t, int> pieces;
  for (const auto& [t, size] : sizes)
  {
    pieces[mesh.Labels[t]] += size > 1 ? 1 : 0;
  }
  return pieces;
}

double SmallestFacetAngle(const SimplexMesh<3>& mesh)
{
  double smallest = 180.0;
  for (const auto& f : mesh.Facets)
  {
    smallest = std::min(smallest, checks::SmallestAngle(mesh, f));
  }
  return smallest;
}

class OptimisedPhantom : public testing::TestWithParam<Phantom>
{
protected:
  OptimisedPhantom()
    : Image(GetParam().Make())
    , Domain(this->Image, Sigma)
    , Before(Mesh(this->Image, GetParam().Delta))
    , After(this->Before)
  {
    this->Options.InterfaceTolerance = 0.1;
    this->Statistics = checks::OptimiseMesh(this->After, this->Domain, this->Options);
  }

  LabelImage<3> Image;
  ImageDomain<3> Domain;
  SimplexMesh<3> Before;
  SimplexMesh<3> After;
  OptimisationOptions Options;
  OptimisationStatistics Statistics;
};

} // namespace

//------------------------------------------------------------------------------------------------
TEST_P(OptimisedPhantom, IsValid)
{
  ASSERT_GT(this->Statistics.Before.Poor, 0u) << "nothing to test";
  checks::ExpectSound(this->After);
}

TEST_P(OptimisedPhantom, HasGoodShapes)
{
  const MeshQuality quality = MeasureQuality<3>(this->After, 2.5, 30.0, 1);
  EXPECT_EQ(quality.InvertedSimplices, 0u);
  EXPECT_GE(quality.MinimumDihedralAngle, 12.0);
  EXPECT_LE(quality.MaximumDihedralAngle, 160.0);
  EXPECT_LE(quality.MaximumRadiusEdgeRatio, 2.5 + 1e-6);
}

TEST_P(OptimisedPhantom, ReachesAllBounds)
{
  OptimisationOptions options;
  options.InterfaceTolerance = 0.25; // as the mesher has it
  SimplexMesh<3> mesh = this->Before;
  const OptimisationStatistics statistics = checks::OptimiseMesh(mesh, this->Domain, options);
  EXPECT_EQ(statistics.After.Poor, 0u)
    << statistics.After.SmallestDihedralAngle << " to " << statistics.After.LargestDihedralAngle;
  EXPECT_EQ(
    VerticesOffInterfaces(mesh, this->Before, this->Domain, options.InterfaceTolerance), 0u);
}

TEST_P(OptimisedPhantom, StatisticsAreThoseOfTheMesh)
{
  const auto compare = [](const ShapeStatistics& survey, const SimplexMesh<3>& mesh)
  {
    const MeshQuality quality = MeasureQuality<3>(mesh, 2.5, 30.0, 1);
    EXPECT_NEAR(survey.SmallestDihedralAngle, quality.MinimumDihedralAngle, 1e-4);
    EXPECT_NEAR(survey.LargestDihedralAngle, quality.MaximumDihedralAngle, 1e-4);
    EXPECT_NEAR(survey.LargestRadiusEdgeRatio, quality.MaximumRadiusEdgeRatio, 1e-6);
  };
  compare(this->Statistics.Before, this->Before);
  compare(this->Statistics.After, this->After);
  EXPECT_LT(this->Statistics.After.Poor, this->Statistics.Before.Poor);
}

TEST_P(OptimisedPhantom, KeepsLabelsAndTheirVolumes)
{
  const auto before = checks::Volumes(this->Before);
  const auto after = checks::Volumes(this->After);
  ASSERT_EQ(before.size(), after.size());
  for (const auto& [label, volume] : before)
  {
    ASSERT_TRUE(after.contains(label));
    // Interfaces move by a small part of a voxel: at most a hundredth on average.
    double area = 0.0;
    for (std::size_t k = 0; k < this->Before.Facets.size(); ++k)
    {
      const auto& labels = this->Before.FacetLabels[k];
      area += labels[0] == label || labels[1] == label
        ? checks::AreaOf(this->Before, this->Before.Facets[k])
        : 0.0;
    }
    EXPECT_NEAR(after.at(label), volume, 0.01 * area) << "label " << label;
  }
}

TEST_P(OptimisedPhantom, KeepsPiecesAndManifolds)
{
  EXPECT_EQ(Pieces(this->After), Pieces(this->Before));
  EXPECT_LE(NonManifoldEdges(this->After), NonManifoldEdges(this->Before));
}

TEST_P(OptimisedPhantom, KeepsFacetAngles)
{
  const MeshQuality before = MeasureQuality<3>(this->Before, 2.0, 30.0 - 1e-6, 1);
  const MeshQuality after = MeasureQuality<3>(this->After, 2.0, 30.0 - 1e-6, 1);
  EXPECT_LE(after.FacetAngleViolations - after.FacetAngleViolationsAtJunctions,
    before.FacetAngleViolations - before.FacetAngleViolationsAtJunctions);
  EXPECT_GE(after.MinimumFacetAngleOffJunctions,
    std::min(30.0, before.MinimumFacetAngleOffJunctions) - 1e-6);
  EXPECT_GE(
    SmallestFacetAngle(this->After), std::min(20.0, SmallestFacetAngle(this->Before)) - 1e-6);
}

TEST_P(OptimisedPhantom, KeepsInterfaceVerticesOnInterfaces)
{
  const double tolerance = this->Options.InterfaceTolerance;
  EXPECT_EQ(VerticesOffInterfaces(this->After, this->Before, this->Domain, tolerance), 0u);

  OptimisationOptions strict = this->Options;
  strict.InterfaceTolerance = 0.0;
  SimplexMesh<3> mesh = this->Before;
  const OptimisationStatistics statistics = checks::OptimiseMesh(mesh, this->Domain, strict);
  EXPECT_EQ(statistics.Smoothing.MovesOffInterfaces, 0u);
  EXPECT_EQ(VerticesOffInterfaces(mesh, this->Before, this->Domain, 0.0), 0u);
}

TEST_P(OptimisedPhantom, DoesNotChangeWhatHasNothingPoor)
{
  // Bounds that the mesh just keeps, so that nothing is poor.
  const ShapeStatistics& shapes = this->Statistics.After;
  OptimisationOptions kept = this->Options;
  kept.SmallestDihedralAngle = shapes.SmallestDihedralAngle - 0.01;
  kept.LargestDihedralAngle = shapes.LargestDihedralAngle + 0.01;
  kept.Shape.RadiusEdgeRatio = shapes.LargestRadiusEdgeRatio + 0.01;
  SimplexMesh<3> again = this->After;
  const OptimisationStatistics statistics = checks::OptimiseMesh(again, this->Domain, kept);
  checks::ExpectSame(again, this->After);
  EXPECT_EQ(statistics.Before.Poor, 0u);
  EXPECT_EQ(statistics.Passes, 0u);

  // And one that it just breaks.
  kept.SmallestDihedralAngle = shapes.SmallestDihedralAngle + 0.01;
  const OptimisationStatistics more = checks::OptimiseMesh(again, this->Domain, kept);
  EXPECT_GT(more.Before.Poor, 0u);
  EXPECT_GT(more.Passes, 0u);
}

TEST_P(OptimisedPhantom, WorstShapeNeverGetsWorse)
{
  // Bounds that cannot be reached: every operation has much to try.
  OptimisationOptions options;
  options.SmallestDihedralAngle = 35.0;
  options.LargestDihedralAngle = 130.0;
  options.InterfaceTolerance = 0.05;
  const auto worst = [&](const ShapeStatistics& survey)
  {
    const auto square = [](double x) { return x * x; };
    return std::min({ square(std::sin(survey.SmallestDihedralAngle / DegreesPerRadian) /
                        std::sin(options.SmallestDihedralAngle / DegreesPerRadian)),
      square(std::sin(survey.LargestDihedralAngle / DegreesPerRadian) /
        std::sin(options.LargestDihedralAngle / DegreesPerRadian)),
      square(options.Shape.RadiusEdgeRatio / survey.LargestRadiusEdgeRatio) });
  };
  SimplexMesh<3> mesh = this->Before;
  const OptimisationStatistics statistics = checks::OptimiseMesh(mesh, this->Domain, options);
  EXPECT_GT(worst(statistics.After), worst(statistics.Before));
  EXPECT_LT(statistics.After.Poor, statistics.Before.Poor);
  checks::ExpectSound(mesh);
  EXPECT_EQ(Pieces(mesh), Pieces(this->Before));
  EXPECT_LE(NonManifoldEdges(mesh), NonManifoldEdges(this->Before));
  EXPECT_EQ(
    VerticesOffInterfaces(mesh, this->Before, this->Domain, options.InterfaceTolerance), 0u);
  EXPECT_GE(SmallestFacetAngle(mesh), std::min(20.0, SmallestFacetAngle(this->Before)) - 1e-6);
}

TEST_P(OptimisedPhantom, SmoothingNeverLowersTheWorstOfAStar)
{
  TetrahedralComplex complex =
    checks::ComplexOf(this->Before, ShapeScore(40.0, 120.0, 2.5), &this->Domain);
  const std::vector<std::uint32_t> blocks(complex.Points.size(), 0);
  Patch patch(complex, blocks, 0);
  AnchorMap anchors;
  Smoother smoother(patch, this->Domain, InterfaceRules(30.0, 20.0, 30.0), 0.05, anchors);
  VertexStar<3> star;
  const auto worst = [&]
  {
    float score = 2.0f;
    for (const std::uint32_t t : star.Cells)
    {
      EXPECT_NEAR(complex.Scores[t], complex.Score(complex.Cells[t].V), 1e-5);
      score = std::min(score, complex.Scores[t]);
    }
    return score;
  };
  for (std::uint32_t v = 0; v < complex.Points.size(); ++v)
  {
    if (patch.GatherStar(v, star))
    {
      const float before = worst();
      const bool moved = smoother.Improve(v) || smoother.MoveOffInterface(v);
      EXPECT_TRUE(moved ? worst() > before : worst() == before);
    }
  }
  EXPECT_GT(smoother.Counts().SurfaceMoves, 0u);
  EXPECT_GT(smoother.Counts().MovesOffInterfaces, 0u);
}

INSTANTIATE_TEST_SUITE_P(MeshOptimiser, OptimisedPhantom, testing::ValuesIn(Phantoms),
  [](const auto& info) { return std::string(info.param.Name); });

//------------------------------------------------------------------------------------------------
TEST(MeshOptimiser, ResultDoesNotDependOnThreads)
{
  const LabelImage<3> image = Foam(22.0, 30);
  const ImageDomain<3> domain(image, Sigma);
  const SimplexMesh<3> before = Mesh(image, 0.75);
  ASSERT_GT(before.Points.size(), 16000u) << "fewer than four blocks";
  OptimisationOptions options;
  options.InterfaceTolerance = 0.05;
  SimplexMesh<3> one = before;
  SimplexMesh<3> four = before;
  const OptimisationStatistics statistics = checks::OptimiseMesh(one, domain, options, 1);
  checks::OptimiseMesh(four, domain, options, 4);
  checks::ExpectSame(one, four);
  // Each kind of operation had work.
  EXPECT_GT(statistics.Flips.EdgeRemovals, 0u);
  EXPECT_GT(statistics.Flips.InterfaceFlips, 0u);
  EXPECT_GT(statistics.Flips.Dropped, 0u);
  EXPECT_GT(statistics.Smoothing.FreeMoves, 0u);
  EXPECT_GT(statistics.Smoothing.SurfaceMoves, 0u);
  EXPECT_GT(statistics.Smoothing.Insertions, 0u);
  EXPECT_GE(statistics.After.SmallestDihedralAngle, 12.0);
  EXPECT_LE(statistics.After.LargestDihedralAngle, 160.0);
  checks::ExpectSound(four);
}

TEST(MeshOptimiser, GivesUpWhenAskedTo)
{
  const LabelImage<3> image = phantoms::Ball(8.0);
  const ImageDomain<3> domain(image, Sigma);
  const SimplexMesh<3> before = Mesh(image, 1.0);
  SimplexMesh<3> mesh = before;
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(checks::OptimiseMesh(mesh, domain, {}, 1, stop.get_token()), Cancelled);
  checks::ExpectSame(mesh, before);
}

TEST(MeshOptimiser, IsCancelledWhileItWorks)
{
  /** Requests a stop when it is asked for the hundredth label. */
  class Stopping : public Domain<3>
  {
  public:
    explicit Stopping(const Domain<3>& inner)
      : Inner(inner)
    {
    }
    Box<3> Bounds() const override { return this->Inner.Bounds(); }
    LabelId Label(const Point<3>& p) const override
    {
      if (++this->Calls == 100)
      {
        this->Stop.request_stop();
      }
      return this->Inner.Label(p);
    }
    std::int64_t LabelValue(LabelId id) const override { return this->Inner.LabelValue(id); }
    double DistanceBound(const Point<3>& p) const override { return this->Inner.DistanceBound(p); }
    bool NearSurfacePoint(const Point<3>& p, LabelId l, Point<3>& z, double& e) const override
    {
      return this->Inner.NearSurfacePoint(p, l, z, e);
    }
    bool ClosestSurfacePoint(const Point<3>& p, LabelId l, Point<3>& z) const override
    {
      return this->Inner.ClosestSurfacePoint(p, l, z);
    }
    bool FirstCrossing(const Point<3>& a, LabelId l, const Point<3>& b, Point<3>& z) const override
    {
      return this->Inner.FirstCrossing(a, l, b, z);
    }
    const Domain<3>& Inner;
    mutable std::stop_source Stop;
    mutable int Calls = 0;
  };
  const LabelImage<3> image = phantoms::Ball(10.0);
  const ImageDomain<3> domain(image, Sigma);
  const Stopping stopping(domain);
  const SimplexMesh<3> before = Mesh(image, 0.8);
  SimplexMesh<3> mesh = before;
  OptimisationOptions options;
  options.SmallestDihedralAngle = 40.0;
  checks::OptimiseMesh(mesh, stopping, options);
  const int calls = std::exchange(stopping.Calls, 0);
  stopping.Stop = std::stop_source();
  mesh = before;
  EXPECT_THROW(
    checks::OptimiseMesh(mesh, stopping, options, 1, stopping.Stop.get_token()), Cancelled);
  EXPECT_GE(stopping.Calls, 100);
  EXPECT_LT(stopping.Calls, calls / 2);
  checks::ExpectSame(mesh, before);
}

TEST(MeshOptimiser, KeepsToTheTimeLimit)
{
  const LabelImage<3> image = phantoms::Ball(10.0);
  const ImageDomain<3> domain(image, Sigma);
  SimplexMesh<3> mesh = Mesh(image, 0.8);
  OptimisationOptions options;
  options.Seconds = 1e-9; // over before work begins
  const OptimisationStatistics statistics = checks::OptimiseMesh(mesh, domain, options);
  EXPECT_TRUE(statistics.OutOfTime);
  EXPECT_EQ(statistics.Flips.EdgeRemovals, 0u);
  EXPECT_EQ(statistics.After.Poor, statistics.Before.Poor);
  checks::ExpectSound(mesh);
  options.Seconds = 1e6;
  const OptimisationStatistics more = checks::OptimiseMesh(mesh, domain, options);
  EXPECT_FALSE(more.OutOfTime);
  EXPECT_LT(more.After.Poor, more.Before.Poor);
}

TEST(MeshOptimiser, RefusesBadOptions)
{
  const LabelImage<3> image = phantoms::Ball(4.0);
  const ImageDomain<3> domain(image, Sigma);
  SimplexMesh<3> mesh;
  const auto refused = [&](double OptimisationOptions::*option, double value)
  {
    OptimisationOptions options;
    options.*option = value;
    EXPECT_THROW(checks::OptimiseMesh(mesh, domain, options), InputError) << value;
  };
  const auto refusedShape = [&](double ShapeBounds::*bound, double value)
  {
    OptimisationOptions options;
    options.Shape.*bound = value;
    EXPECT_THROW(checks::OptimiseMesh(mesh, domain, options), InputError) << value;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using O = OptimisationOptions;
  for (const double value : { 0.0, 60.0, nan })
  {
    refused(&O::SmallestDihedralAngle, value);
  }
  for (const double value : { 90.0, 180.0, nan })
  {
    refused(&O::LargestDihedralAngle, value);
  }
  for (const double value : { 0.9, std::numeric_limits<double>::infinity(), nan })
  {
    refusedShape(&ShapeBounds::RadiusEdgeRatio, value);
  }
  for (const double value : { -1.0, 91.0, nan })
  {
    refusedShape(&ShapeBounds::FacetAngle, value);
    refusedShape(&ShapeBounds::JunctionFacetAngle, value);
    refused(&O::CreaseAngle, value);
  }
  refused(&O::InterfaceTolerance, -1.0);
  refused(&O::Seconds, -1.0);
}
