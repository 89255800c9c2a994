// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Flips and smoothing raise the worst pentatopes; interfaces, ends, volumes and bounds stay.
#include "Base/Error.h"
#include "Geometry/SimplexQuality.h"
#include "MeshChecks.h"
#include "Optimisation/Pentatopes/PentatopeFlips.h"
#include "Optimisation/Pentatopes/PentatopeOptimiser.h"
#include "Optimisation/Pentatopes/PentatopeStar.h"
#include "PentatopeCases.h"
#include "Sanitizers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

std::vector<double> Qualities(const SimplexMesh<4>& mesh)
{
  std::vector<double> qualities;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    qualities.push_back(NormalizedVolume<4>(mesh.PointsOf(s).data()));
  }
  std::sort(qualities.begin(), qualities.end());
  return qualities;
}

double Mean(const std::vector<double>& qualities)
{
  return std::accumulate(qualities.begin(), qualities.end(), 0.0) /
    static_cast<double>(qualities.size());
}

std::size_t Poor(const std::vector<double>& sorted)
{
  return static_cast<std::size_t>(
    std::lower_bound(sorted.begin(), sorted.end(), OptimisedNormalizedVolume) - sorted.begin());
}

/** Interfaces keep their facets. Their vertices move by half a voxel at most, and on ends not in time. */
void ExpectSameInterfaces(
  const SimplexMesh<4>& before, const SimplexMesh<4>& after, const LabelImage<4>& image)
{
  ASSERT_EQ(InterfacesOf(before), InterfacesOf(after));
  ASSERT_LE(before.Points.size(), after.Points.size()); // new vertices are inside and come last
  const auto [first, last] = TimeSpan(before);
  std::size_t moved = 0;
  for (const std::uint32_t v : VerticesOfInterfaces(before))
  {
    const Point<4>& p = before.Points[v];
    const Point<4>& q = after.Points[v];
    moved += p != q;
    const Point<4> voxels = Subtract(image.Grid().ToIndex(q), image.Grid().ToIndex(p));
    for (const double x : voxels)
    {
      ASSERT_LE(std::abs(x), 0.5 + 1e-9);
    }
    if (image.ReachesBorderInTime(0) && (p[3] == first || p[3] == last))
    {
      ASSERT_EQ(p[3], q[3]);
    }
  }
  EXPECT_GT(moved, 100u);
}

/** The two ways to fill the hull of six points, where both have two pentatopes or more. */
std::array<SimplexMesh<4>, 2> BothFillings(const std::vector<Point<4>>& points)
{
  std::array<SimplexMesh<4>, 2> both;
  for (std::uint32_t left = 0; left < 6; ++left)
  {
    std::array<const Point<4>*, 5> corners;
    for (std::uint32_t k = 0, m = 0; k < 6; ++k)
    {
      if (k != left)
      {
        corners[m++] = &points[k];
      }
    }
    const bool sign = SignedVolume<4>(corners.data()) > 0.0;
    auto& mesh = both[(left % 2 == 0) == sign ? 0 : 1];
    mesh.Simplices.push_back(Without(points, left));
    mesh.Labels.push_back(1);
  }
  for (auto& mesh : both)
  {
    for (const Point<4>& p : points)
    {
      mesh.Points.push_back(p);
    }
  }
  return both;
}

std::set<std::set<std::uint32_t>> SetsOf(const SimplexMesh<4>& mesh)
{
  std::set<std::set<std::uint32_t>> sets;
  for (const auto& v : mesh.Simplices)
  {
    sets.insert({ v.begin(), v.end() });
  }
  return sets;
}

} // namespace

// Without insertions one to six pentatopes stay poor.
TEST(PentatopeOptimiser, RaisesTheWorst)
{
  const std::map<std::string, phantoms::SpaceTimePhantom> phantoms = {
    { "four-ball", phantoms::FourBall(12.0) },
    { "merging balls", phantoms::WithTimeScale(phantoms::MergingBalls(), 2.0) },
    { "pulsating balls", PulsatingBalls(11, 2.0, 1.0) },
  };
  for (const auto& [name, phantom] : phantoms)
  {
    if (Sanitized && name != "four-ball")
    {
      continue;
    }
    SCOPED_TRACE(name);
    const LabelImage<4> image = ImageOf(phantom);
    const Result before = Mesh(image, UsualOptions(2.0), false);
    const Result after = Mesh(image, UsualOptions(2.0), true);
    const std::vector<double> worst = Qualities(before.Mesh);
    const std::vector<double> better = Qualities(after.Mesh);
    EXPECT_GT(Poor(worst), 500u);
    EXPECT_EQ(Poor(better), 0u);
    EXPECT_GT(Mean(better), Mean(worst) + 0.014);

    ExpectSound(after.Mesh);
    ExpectSameInterfaces(before.Mesh, after.Mesh, image);
    for (const auto& [label, volume] : Volumes(before.Mesh))
    {
      EXPECT_NEAR(Volumes(after.Mesh)[label], volume, 0.002 * volume) << label;
    }
    for (std::size_t s = 0; s < after.Mesh.Simplices.size(); ++s)
    {
      ASSERT_LE(RadiusEdge(after.Mesh, s), 2.0 + 1e-9);
    }
    const OptimisationSummary& said = after.Statistics.Optimisation;
    EXPECT_TRUE(said.Ran);
    EXPECT_FALSE(before.Statistics.Optimisation.Ran);
    EXPECT_EQ(said.PoorBefore, Poor(worst));
    EXPECT_EQ(said.PoorAfter, Poor(better));
    EXPECT_EQ(said.SmallestVolumeBefore, worst.front());
    EXPECT_NEAR(said.SmallestVolumeAfter, better.front(), 1e-12);
  }
}

// One to three pentatopes of these stay poor unless what is around them gives them room.
TEST(PentatopeOptimiser, MakesRoomForTheLast)
{
  struct Case
  {
    double TimeScale;
    double Delta;
  };
  for (const auto& [scale, delta] : { Case{ 3.0, 1.74 }, Case{ 2.0, 2.16 }, Case{ 2.0, 2.37 } })
  {
    if (Sanitized && delta < 2.3)
    {
      continue;
    }
    SCOPED_TRACE(testing::Message() << "time scale " << scale << ", delta " << delta);
    const LabelImage<4> image = ImageOf(phantoms::WithTimeScale(phantoms::OpeningTube(9), scale));
    const Result result = Mesh(image, UsualOptions(delta), true);
    EXPECT_GT(result.Statistics.Optimisation.PoorBefore, 500u);
    EXPECT_EQ(result.Statistics.Optimisation.PoorAfter, 0u);
    EXPECT_EQ(Poor(Qualities(result.Mesh)), 0u);
    ExpectSound(result.Mesh);
  }
}

// What a star says of a vertex at another place, against the measures of a pentatope that is there.
TEST(PentatopeOptimiser, StarsMeasureMovedPentatopes)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(9, 2.0));
  const ImageDomain<4> domain(image, 1.0);
  const SimplexMesh<4> mesh = Mesh(image, UsualOptions(2.5), false).Mesh;
  PentatopeComplex complex = checks::ScoredComplexOf(mesh);
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  PentatopeStar star;
  std::size_t positive = 0;
  for (std::uint32_t v = 0; v < mesh.Points.size(); v += 7)
  {
    ASSERT_TRUE(star.Gather(Patch(complex, {}, 0), v));
    ASSERT_EQ(star.Inside().size(), complex.Degrees[v]);
    Point<4> p = mesh.Points[v];
    for (double& x : p)
    {
      x += 0.2 * star.ShortestEdge() * number(generator);
    }
    for (MovedPentatope& one : star.Inside())
    {
      std::array<const Point<4>*, 5> corners = complex.PointsOf(complex.Cells[one.Id].V);
      one.Measured();
      *std::find(corners.begin(), corners.end(), &complex.Points[v]) = &p;
      const PentatopeShape shape = ShapeOf(corners);
      const PentatopeShape moved = one.ShapeAt(p);
      EXPECT_NEAR(one.VolumeAt(p), SignedVolume<4>(corners.data()), 1e-9);
      EXPECT_NEAR(moved.Quality, shape.Quality, 1e-9);
      if (shape.Quality < 1e-3)
      {
        continue;
      }
      ++positive;
      EXPECT_NEAR(moved.Ratio, shape.Ratio, 1e-6 * shape.Ratio);
      EXPECT_LT(Distance(moved.Ball.Center, shape.Ball.Center), 1e-6);
      const Point<4> gradient = one.GradientAt(p);
      for (std::size_t a = 0; a < 4; ++a)
      {
        Point<4> beside = p;
        beside[a] += 1e-6;
        ASSERT_NEAR(gradient[a], (one.ShapeAt(beside).Quality - moved.Quality) / 1e-6, 1e-4);
      }
    }
  }
  EXPECT_GT(positive, 1000u);
}

/** The smallest quality of pentatopes with a vertex at a time. */
double WorstAt(const SimplexMesh<4>& mesh, double time)
{
  double worst = 1.0;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    const std::array<const Point<4>*, 5> points = mesh.PointsOf(s);
    if (std::any_of(
          points.begin(), points.end(), [time](const Point<4>* p) { return (*p)[3] == time; }))
    {
      worst = std::min(worst, NormalizedVolume<4>(points.data()));
    }
  }
  return worst;
}

// Refinement leaves pentatopes that are positively oriented, but so flat that rounding may put a vertex on the wrong side.
TEST(PentatopeOptimiser, FlatPentatopesGrowToTheRightSide)
{
  const LabelImage<4> image = ImageOf(phantoms::FourBall(4.0));
  const ImageDomain<4> domain(image, 1.0);
  const std::vector<Point<4>> regular = { { 1.0, 0.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0, 0.0 },
    { 0.0, 0.0, 1.0, 0.0 }, { 0.0, 0.0, 0.0, 1.0 }, { 1.0, 1.0, 1.0, 1.0 } };
  std::array<std::uint32_t, 5> corners = { 0, 1, 2, 3, 4 };
  for (unsigned turn = 0; turn < 5; ++turn)
  {
    SimplexMesh<4> mesh;
    mesh.Points.assign(regular.begin(), regular.end());
    mesh.Simplices = { corners };
    if (Volume(mesh, 0) < 0.0)
    {
      std::swap(mesh.Simplices[0][0], mesh.Simplices[0][1]);
    }
    mesh.Labels = { 1 };
    mesh.Points[4] = { 0.25, 0.25, 0.25, 0.25 - 1e-9 }; // behind the facet of the others
    PentatopeComplex complex = checks::ScoredComplexOf(mesh);
    PentatopeStar star;
    star.Gather(Patch(complex, {}, 0), 4);
    ASSERT_EQ(star.Inside().size(), 1u);
    EXPECT_NEAR(star.Inside()[0].Measured().VolumeAt(regular[4]), 3.0 / 24.0, 1e-12);
    EXPECT_GT(Dot(star.Inside()[0].Measured().GradientAt(mesh.Points[4]), regular[4]), 0.0);
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  }
}

// Both ends of a period: each vertex moves with its twin.
TEST(PentatopeOptimiser, MovesTwinsTogether)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(17, 1.0, 2.5));
  MeshingOptions<4> options = UsualOptions(2.0);
  options.Planes.Periodic = true;
  const SimplexMesh<4> before = Mesh(image, options, false).Mesh;
  const SimplexMesh<4> after = Mesh(image, options, true).Mesh;
  ASSERT_EQ(before.Twins, after.Twins);
  ASSERT_GT(after.Twins.size(), 100u);
  std::size_t moved = 0;
  for (const auto& [first, last] : after.Twins)
  {
    const Point<4>& p = after.Points[first];
    const Point<4>& q = after.Points[last];
    ASSERT_EQ(p, (Point<4>{ q[0], q[1], q[2], 0.0 }));
    ASSERT_EQ(q[3], 16.0);
    moved += p != before.Points[first] ? 1 : 0;
  }
  EXPECT_GT(moved, after.Twins.size() / 2);
  for (const double time : { 0.0, 16.0 })
  {
    EXPECT_GT(WorstAt(after, time), 1.5 * WorstAt(before, time));
    EXPECT_GT(WorstAt(after, time), 0.03);
  }
  ExpectSound(after);
  ExpectSameInterfaces(before, after, image);
  for (const auto& [label, volume] : Volumes(before))
  {
    EXPECT_NEAR(Volumes(after).at(label), volume, 0.002 * volume) << label;
  }
}

// Moves must not make the mesh overlap itself where a gap is thin: the pentatopes outside stay positive.
TEST(PentatopeOptimiser, LeavesWhatIsOutsidePositive)
{
  const LabelImage<4> image = ImageOf(phantoms::WithTimeScale(phantoms::MergingBalls(), 2.0));
  const ImageDomain<4> domain(image, 1.0);
  const Result before = Mesh(image, SpaceTimeOptions(2.0), false);
  // A pentatope outside, on a facet of the boundary. Its fifth point nearly lies in the facet.
  SimplexMesh<4> mesh = before.Mesh;
  for (std::size_t f = 0; f < mesh.Facets.size(); f += 3)
  {
    if (mesh.FacetLabels[f][1] != 0)
    {
      continue;
    }
    std::array<const Point<4>*, 4> p;
    Point<4> centre{};
    for (std::size_t k = 0; k < 4; ++k)
    {
      p[k] = &mesh.Points[mesh.Facets[f][k]];
      for (std::size_t a = 0; a < 4; ++a)
      {
        centre[a] += 0.25 * (*p[k])[a];
      }
    }
    const Point<4> normal =
      Cross(Subtract(*p[1], *p[0]), Subtract(*p[2], *p[0]), Subtract(*p[3], *p[0]));
    const double length = std::sqrt(Dot(normal, normal));
    std::array<std::uint32_t, 5> simplex{ mesh.Facets[f][0], mesh.Facets[f][1], mesh.Facets[f][2],
      mesh.Facets[f][3], static_cast<std::uint32_t>(mesh.Points.size()) };
    for (const double sign : { 1.0, -1.0 })
    {
      Point<4> apex = centre;
      for (std::size_t a = 0; a < 4; ++a)
      {
        apex[a] += sign * 0.02 * normal[a] / length;
      }
      const std::array<const Point<4>*, 5> corners{ p[0], p[1], p[2], p[3], &apex };
      // Whichever side is positive will do: only its volume is looked at.
      if (SignedVolume<4>(corners.data()) > 0.0)
      {
        mesh.Points.push_back(apex);
        mesh.Simplices.push_back(simplex);
        mesh.Labels.push_back(0);
      }
    }
  }
  PentatopeComplex complex = ComplexOf<4>(mesh, &domain);
  voxplex::OptimisePentatopes(complex, domain, image, {});
  std::size_t outside = 0;
  for (const std::uint32_t t : AliveIn(complex))
  {
    if (complex.Labels[t] == 0)
    {
      ASSERT_GT(SignedVolume<4>(complex.PointsOf(complex.Cells[t].V).data()), 0.0);
      ++outside;
    }
  }
  EXPECT_GT(outside, 500u);
  EXPECT_NE(Written(complex).Points, before.Mesh.Points);
}

TEST(PentatopeOptimiser, Stops)
{
  const LabelImage<4> image = ImageOf(phantoms::FourBall(8.0));
  const ImageDomain<4> domain(image, 1.0);
  SimplexMesh<4> mesh = Mesh(image, SpaceTimeOptions(2.0), false).Mesh;
  const SimplexMesh<4> before = mesh;
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW(
    checks::OptimisePentatopes(mesh, domain, image, {}, 1, source.get_token()), Cancelled);
  ExpectSame(mesh, before);
}

//------------------------------------------------------------------------------------------------
TEST(PentatopeFlips, ExchangeTheFillingsOfSixPoints)
{
  const LabelImage<4> image = ImageOf(phantoms::FourBall(4.0));
  const ImageDomain<4> domain(image, 1.0);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(2.0, 12.0);
  std::map<std::size_t, std::size_t> flips;
  PentatopeBounds bounds;
  bounds.RadiusEdgeRatio = 1e9;
  for (unsigned trial = 0; trial < 1500; ++trial)
  {
    std::vector<Point<4>> points(6);
    for (Point<4>& p : points)
    {
      p = { uniform(random), uniform(random), uniform(random), uniform(random) };
    }
    std::array<SimplexMesh<4>, 2> fillings = BothFillings(points);
    if (fillings[0].Simplices.size() < 2 || fillings[1].Simplices.size() < 2)
    {
      continue; // a point in the hull of the others
    }
    if (Qualities(fillings[0]).front() > Qualities(fillings[1]).front())
    {
      std::swap(fillings[0], fillings[1]);
    }
    if (Qualities(fillings[1]).front() < 1e-6)
    {
      continue; // flat to rounding
    }
    SimplexMesh<4>& mesh = fillings[0];
    ASSERT_NEAR(WholeVolume(mesh), WholeVolume(fillings[1]), 1e-9 * WholeVolume(mesh));
    PentatopeComplex complex = checks::ScoredComplexOf(mesh);
    const PentatopeRules rules(domain, bounds);
    for (std::uint32_t s = 0; s < mesh.Simplices.size(); ++s)
    {
      const PentatopeFlip flip = FindFlip(complex, rules, s);
      ASSERT_EQ(flip.NumberOfOld, mesh.Simplices.size());
      ASSERT_EQ(flip.NumberOfNew, fillings[1].Simplices.size());
      EXPECT_NEAR(flip.Before, Qualities(mesh).front(), 1e-9);
      EXPECT_NEAR(flip.After, Qualities(fillings[1]).front(), 1e-9);
    }
    const PentatopeComplex good = checks::ScoredComplexOf(fillings[1]);
    EXPECT_EQ(FindFlip(good, rules, 0).NumberOfOld, 0u) << "it would lower the worst";
    PentatopeBounds strict;
    strict.RadiusEdgeRatio = 0.1;
    const bool getsRounder = FindFlip(complex, PentatopeRules(domain, strict), 0).NumberOfOld != 0;

    ++flips[mesh.Simplices.size()];
    const PentatopeFlip flip = FindFlip(complex, rules, 0);
    Patch patch(complex, {}, 0);
    ASSERT_TRUE(Replace(complex, patch, { flip.Old.data(), flip.NumberOfOld },
      { flip.New.data(), flip.NumberOfNew }));
    double largestBefore = 0.0;
    for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
    {
      largestBefore = std::max(largestBefore, RadiusEdge(mesh, s));
    }
    mesh = Written(complex);
    double largestAfter = 0.0;
    for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
    {
      largestAfter = std::max(largestAfter, RadiusEdge(mesh, s));
    }
    EXPECT_EQ(getsRounder, largestAfter <= largestBefore);
    EXPECT_EQ(SetsOf(mesh), SetsOf(fillings[1]));
    for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
    {
      EXPECT_GT(SignedVolume<4>(mesh.PointsOf(s).data()), 0.0);
    }
  }
  EXPECT_GT(flips[2], 20u);
  EXPECT_GT(flips[3], 20u);
  EXPECT_GT(flips[4], 20u);
}

TEST(PentatopeFlips, LeaveInterfacesAlone)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(9, 2.0));
  const ImageDomain<4> domain(image, 1.0);
  const SimplexMesh<4> mesh = Mesh(image, SpaceTimeOptions(2.5), false).Mesh;
  const PentatopeComplex complex = checks::ScoredComplexOf(mesh);
  const PentatopeBounds bounds;
  const PentatopeRules rules(domain, bounds);
  std::size_t found = 0;
  for (std::uint32_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    const PentatopeFlip flip = FindFlip(complex, rules, s);
    found += flip.NumberOfOld != 0;
    for (std::size_t k = 0; k < flip.NumberOfOld; ++k)
    {
      ASSERT_EQ(mesh.Labels[flip.Old[k]], mesh.Labels[s]);
    }
  }
  EXPECT_GT(found, 100u);
}

// Two pentatopes with a common facet on a plane stay two, although four would have better shapes.
TEST(PentatopeFlips, LeaveFacetsOnTimePlanesAlone)
{
  const LabelImage<4> image = ImageOf(phantoms::FourBall(4.0));
  const ImageDomain<4> domain(image, 1.0);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(2.0, 12.0);
  PentatopeBounds bounds;
  bounds.RadiusEdgeRatio = 1e9;
  PentatopeBounds withPlane = bounds;
  withPlane.Planes.Times = { 1.0, 7.0 };
  std::size_t found = 0;
  for (unsigned trial = 0; trial < 1000; ++trial)
  {
    std::vector<Point<4>> points(6);
    Point<4> centre{};
    for (std::size_t k = 0; k < 4; ++k)
    {
      points[k] = { uniform(random), uniform(random), uniform(random), 7.0 };
      for (std::size_t a = 0; a < 4; ++a)
      {
        centre[a] += 0.25 * points[k][a];
      }
    }
    points[4] = points[5] = centre; // above and below the middle of the common facet
    points[4][3] += 0.1 * uniform(random);
    points[5][3] -= 0.1 * uniform(random);
    SimplexMesh<4> mesh;
    mesh.Points.resize(6);
    std::copy(points.begin(), points.end(), mesh.Points.begin());
    for (const std::uint32_t left : { 4u, 5u })
    {
      mesh.Simplices.push_back(Without(points, left));
      mesh.Labels.push_back(1);
    }
    const PentatopeComplex complex = checks::ScoredComplexOf(mesh);
    found += FindFlip(complex, PentatopeRules(domain, bounds), 0).NumberOfOld == 2 ? 1 : 0;
    ASSERT_EQ(FindFlip(complex, PentatopeRules(domain, withPlane), 0).NumberOfOld, 0u);
  }
  EXPECT_GT(found, 20u);
}
