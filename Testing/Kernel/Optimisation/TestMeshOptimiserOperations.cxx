// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Single operations of mesh optimisation on meshes of a few tetrahedra, and the score that steers them.
#include "BallDomain.h"
#include "ComplexOf.h"
#include "Domain/ImageDomain.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Optimisation/Patch.h"
#include "Optimisation/ShapeScore.h"
#include "Optimisation/Tetrahedra/Flips.h"
#include "Optimisation/Tetrahedra/InterfaceRules.h"
#include "Optimisation/Tetrahedra/MeshOptimiser.h"
#include "Optimisation/Tetrahedra/Smoother.h"
#include "Phantoms.h"
#include "Quality/MeshQuality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <span>

using namespace voxplex;

namespace
{

/** Of one label, its boundary facets included. */
SimplexMesh<3> MeshOf(const std::vector<Point<3>>& points,
  const std::vector<std::array<std::uint32_t, 4>>& tetrahedra,
  const std::vector<std::int64_t>& labels)
{
  SimplexMesh<3> mesh;
  mesh.Points.assign(points.begin(), points.end());
  mesh.Simplices.assign(tetrahedra.begin(), tetrahedra.end());
  mesh.Labels.assign(labels.begin(), labels.end());
  return checks::Written(checks::ComplexOf<3>(mesh));
}

/** n points on the unit circle around the axis from a = 0 to b = 1, and the tetrahedra around ab. */
SimplexMesh<3> Ring(unsigned n, double halfLength, const std::vector<std::int64_t>& labels)
{
  std::vector<Point<3>> points = { { 0.0, 0.0, -halfLength }, { 0.0, 0.0, halfLength } };
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  for (unsigned k = 0; k < n; ++k)
  {
    const double angle = 2.0 * std::numbers::pi * k / n;
    points.push_back({ std::cos(angle), std::sin(angle), 0.0 });
    tetrahedra.push_back({ 0, 1, 2 + k, 2 + (k + 1) % n });
  }
  return MeshOf(points, tetrahedra, labels);
}

OptimisationStatistics Optimise(SimplexMesh<3>& mesh, const OptimisationOptions& options = {})
{
  const checks::BallDomain domain(100.0);
  const OptimisationStatistics statistics = checks::OptimiseMesh(mesh, domain, options);
  checks::ExpectSound(mesh);
  return statistics;
}

/**
 * Below the two triangles abc and abd of a label's boundary, which acd and bcd may replace. The smallest angle is 21
 * degrees in abc, 26 in bcd, and 40 or more in the others.
 */
struct Quadrilateral
{
  bool IsMirrored;
  bool HasJunction; ///< three labels meet at a, so that bcd alone is off junctions

  SimplexMesh<3> Mesh() const
  {
    constexpr std::uint32_t a = 0, b = 1, c = 2, d = 3, e = 4;
    std::vector<Point<3>> points = { { 1.6, -0.5, 0.0 }, { 0.9, 1.3, 0.0 }, { 1.6, 0.9, 0.0 },
      { -0.1, 0.4, 0.0 }, { -0.8, -0.4, -1.2 } };
    std::vector<std::array<std::uint32_t, 4>> tetrahedra = { { a, b, c, e }, { a, b, d, e } };
    std::vector<std::int64_t> labels(tetrahedra.size(), 1);
    if (this->HasJunction)
    {
      points.insert(points.end(), { { 3.6, -2.5, 0.0 }, { 3.6, -0.5, -2.0 }, { 1.6, -2.5, 2.0 } });
      tetrahedra.push_back({ a, 5, 6, 7 });
      labels.push_back(2);
    }
    for (Point<3>& p : points)
    {
      p[0] = this->IsMirrored ? -p[0] : p[0];
    }
    for (auto& v : tetrahedra)
    {
      const std::array x{ &points[v[0]], &points[v[1]], &points[v[2]], &points[v[3]] };
      if (SignedVolume<3>(x.data()) < 0.0)
      {
        std::swap(v[2], v[3]);
      }
    }
    return MeshOf(points, tetrahedra, labels);
  }
};

} // namespace

TEST(ShapeScore, OfTwoTetrahedraIsThatOfEach)
{
  const ShapeScore score(15.0, 155.0, 2.0);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int inverted = 0;
  for (int i = 0; i < 2000; ++i)
  {
    std::array<Point<3>, 7> p;
    for (Point<3>& q : p)
    {
      q = { uniform(random), uniform(random), uniform(random) };
    }
    if (i % 10 == 0)
    {
      p[3] = Interpolate(p[1], p[2], 0.5); // flat
    }
    const std::array<double, 2> two = score.OfTwo(p[0], &p[1], &p[4]);
    ASSERT_EQ(two[0], score(p[0], p[1], p[2], p[3]));
    ASSERT_EQ(two[1], score(p[0], p[4], p[5], p[6]));
    inverted += two[1] == ShapeScore::Inverted ? 1 : 0;
  }
  EXPECT_GT(inverted, 500);
  EXPECT_LT(inverted, 1500);
}

//------------------------------------------------------------------------------------------------
TEST(ShapeScore, IsOneAtEachBound)
{
  // Tetrahedra of a known dihedral angle at ab, all others being well within.
  const auto wedge = [](double degrees, double half)
  {
    const double angle = degrees / DegreesPerRadian;
    return std::array<Point<3>, 4>{ Point<3>{ 0, 0, -half }, Point<3>{ 0, 0, half },
      Point<3>{ 1, 0, 0 }, Point<3>{ std::cos(angle), std::sin(angle), 0 } };
  };
  const auto small = wedge(20.0, 1.0);
  EXPECT_NEAR(ShapeScore(20.0, 179.0, 50.0)(small[0], small[1], small[2], small[3]), 1.0, 1e-9);
  EXPECT_LT(ShapeScore(20.1, 179.0, 50.0)(small[0], small[1], small[2], small[3]), 1.0);
  const auto large = wedge(140.0, 0.5);
  EXPECT_NEAR(ShapeScore(1.0, 140.0, 50.0)(large[0], large[1], large[2], large[3]), 1.0, 1e-9);
  EXPECT_LT(ShapeScore(1.0, 139.9, 50.0)(large[0], large[1], large[2], large[3]), 1.0);
  const Point<3>* const v[4] = { &small[0], &small[1], &small[2], &small[3] };
  const double ratio = RadiusEdgeRatio<3>(v);
  EXPECT_GE(ShapeScore(1.0, 179.0, 1.000001 * ratio)(small[0], small[1], small[2], small[3]), 1.0);
  EXPECT_LT(ShapeScore(1.0, 179.0, 0.999999 * ratio)(small[0], small[1], small[2], small[3]), 0.01);
  EXPECT_EQ(
    ShapeScore(1.0, 179.0, 2.0)(small[1], small[0], small[2], small[3]), ShapeScore::Inverted);
  EXPECT_EQ(
    ShapeScore(1.0, 179.0, 2.0)(small[0], small[1], small[2], small[2]), ShapeScore::Inverted);
}

TEST(ShapeScore, AgreesWithTheMeasuresOfQuality)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  for (int i = 0; i < 2000; ++i)
  {
    std::array<Point<3>, 4> p;
    for (Point<3>& x : p)
    {
      x = { coordinate(random), coordinate(random), coordinate(random) };
    }
    if (SignedVolume<3>(std::array{ &p[0], &p[1], &p[2], &p[3] }.data()) < 0.0)
    {
      std::swap(p[0], p[1]);
    }
    const Point<3>* const v[4] = { &p[0], &p[1], &p[2], &p[3] };
    const auto angles = DihedralAngles(v);
    const double smallest = *std::min_element(angles.begin(), angles.end());
    const double largest = *std::max_element(angles.begin(), angles.end());
    const bool within = smallest >= 15.0 && largest <= 155.0 && RadiusEdgeRatio<3>(v) <= 2.5;
    EXPECT_EQ(ShapeScore(15.0, 155.0, 2.5)(p[0], p[1], p[2], p[3]) >= 1.0, within);
  }
}

//------------------------------------------------------------------------------------------------
TEST(Patch, FindsRingsAndStars)
{
  for (const unsigned n : { 3u, 4u, 7u })
  {
    const SimplexMesh<3> mesh = Ring(n, 0.5, std::vector<std::int64_t>(n, 1));
    TetrahedralComplex complex = checks::ComplexOf(mesh, ShapeScore(15.0, 155.0, 2.5));
    const std::vector<std::uint32_t> blocks(complex.Points.size(), 0);
    Patch patch(complex, blocks, 0);
    EdgeRing ring;
    ASSERT_TRUE(GatherRing(patch, 0, complex.IndexOf(0, 0), complex.IndexOf(0, 1), 10, ring));
    EXPECT_TRUE(ring.Closed);
    EXPECT_EQ(ring.Cells.size(), n);
    EXPECT_EQ(ring.Link.size(), n);
    for (std::size_t k = 0; k < n; ++k)
    {
      EXPECT_GT(complex.Score({ ring.A, ring.B, ring.Link[k], ring.Link[(k + 1) % n] }), 0.0);
    }
    EXPECT_FALSE(GatherRing(patch, 0, complex.IndexOf(0, 0), complex.IndexOf(0, 1), n - 1, ring));
    // From a to a point of the circle: two tetrahedra, open.
    ASSERT_TRUE(GatherRing(patch, 0, complex.IndexOf(0, 0), complex.IndexOf(0, 3), 10, ring));
    EXPECT_FALSE(ring.Closed);
    EXPECT_EQ(ring.Cells.size(), 2u);
    EXPECT_EQ(ring.Link.size(), 3u);
    for (std::size_t k = 0; k < 2; ++k)
    {
      EXPECT_GT(complex.Score({ ring.A, ring.B, ring.Link[k], ring.Link[k + 1] }), 0.0);
    }
    VertexStar<3> star;
    ASSERT_TRUE(patch.GatherStar(0, star));
    EXPECT_EQ(star.Cells.size(), n);
    ASSERT_TRUE(patch.GatherStar(2, star));
    EXPECT_EQ(star.Cells.size(), 2u);
    for (const auto& corners : star.Corners)
    {
      EXPECT_EQ(corners[0], 2u);
      EXPECT_GT(complex.Score(corners), 0.0);
    }
  }
}

TEST(Patch, LeavesOtherBlocksAlone)
{
  const SimplexMesh<3> mesh = Ring(4, 0.5, { 1, 1, 1, 1 });
  TetrahedralComplex complex = checks::ComplexOf(mesh, ShapeScore(15.0, 155.0, 2.5));
  std::vector<std::uint32_t> blocks(complex.Points.size(), 0);
  blocks[4] = 1;
  Patch patch(complex, blocks, 0);
  EdgeRing ring;
  VertexStar<3> star;
  EXPECT_FALSE(GatherRing(patch, 0, complex.IndexOf(0, 0), complex.IndexOf(0, 1), 10, ring));
  EXPECT_FALSE(patch.GatherStar(0, star));
}

TEST(Patch, FindsStarsThatShareNoFacet)
{
  // Two tetrahedra with a common vertex only.
  const SimplexMesh<3> mesh = MeshOf({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
                                       { -1, 0, 0 }, { 0, -1, 0 }, { 0, 0, -1 } },
    { { 0, 1, 2, 3 }, { 0, 5, 4, 6 } }, { 1, 1 });
  TetrahedralComplex complex = checks::ComplexOf(mesh, ShapeScore(15.0, 155.0, 2.5));
  const std::vector<std::uint32_t> blocks(complex.Points.size(), 0);
  Patch patch(complex, blocks, 0);
  VertexStar<3> star;
  EXPECT_FALSE(patch.GatherStar(0, star));
  const std::uint32_t wanted[] = { 0 };
  patch.FindStars(wanted);
  EXPECT_TRUE(patch.GatherStar(0, star));
  EXPECT_EQ(star.Cells.size(), 2u);
}

TEST(Patch, RefusesWhatItHasNoRoomFor)
{
  const SimplexMesh<3> mesh = Ring(3, 0.5, { 1, 1, 1 });
  TetrahedralComplex complex = checks::ComplexOf(mesh, ShapeScore(15.0, 155.0, 2.5));
  const std::vector<std::uint32_t> blocks(complex.Points.size(), 0);
  Patch patch(complex, blocks, 0);
  const std::uint32_t old[] = { 0 };
  const NewCell<3> one = { complex.Cells[0].V, 1 };
  const NewCell<3> two[] = { one, one };
  EXPECT_FALSE(patch.Replace(old, two));
  EXPECT_TRUE(patch.Replace(old, std::span(two).first(1)));
  checks::ExpectSound(checks::Written(complex));
}

TEST(TetrahedralComplex, TellsKindsOfVertices)
{
  const auto kinds = [](const std::vector<std::int64_t>& labels)
  { return checks::ComplexOf(Ring(4, 0.5, labels), ShapeScore(15.0, 155.0, 2.5)).Kinds; };
  for (const VertexRole kind : kinds({ 1, 1, 1, 1 }))
  {
    EXPECT_EQ(kind, VertexRole::Surface);
  }
  const auto two = kinds({ 1, 1, 2, 2 }); // and background
  EXPECT_EQ(std::count(two.begin(), two.end(), VertexRole::Fixed), 4);
  EXPECT_EQ(two[0], VertexRole::Fixed);
  EXPECT_EQ(std::count(two.begin(), two.end(), VertexRole::Free), 0);
}

// They are not looked up again after flips: a vertex may turn out freer than it was, which costs quality only, but
// never less free, which would let it leave a junction or the edge of a face where the image cuts the object.
TEST(TetrahedralComplex, KindsHoldAfterFlips)
{
  const LabelImage<3> image = phantoms::CutCells(7, 300, 4, 0); // of three labels and of background
  const ImageDomain<3> domain(image, 1.0);
  MeshingOptions<3> options = checks::WithDelta<3>(1.2);
  options.Shape.Slivers.Angle = 0.0; // leaves many to flips
  const SimplexMesh<3> mesh = checks::MeshOf(image, options);
  const ShapeScore score(30.0, 130.0, 2.0); // most can be better
  TetrahedralComplex complex = checks::ComplexOf(mesh, score);
  complex.FindBorderFaces(domain);
  const std::size_t cells = complex.Cells.size();
  complex.AddCells(cells);
  std::vector<std::uint32_t> slots(cells);
  std::iota(slots.begin(), slots.end(), static_cast<std::uint32_t>(cells));
  const std::vector<std::uint32_t> blocks(complex.Points.size(), 0);
  Patch patch(complex, blocks, 0);
  patch.SetSlots(slots);
  Flips flips(patch, InterfaceRules(2.0, 2.0, 100.0)); // rules that forbid little
  for (int pass = 0; pass < 3; ++pass)
  {
    for (std::uint32_t t = 0; t < complex.Cells.size(); ++t)
    {
      if (complex.IsAlive(t))
      {
        flips.Improve(t);
      }
    }
  }
  EXPECT_GT(flips.Counts().InterfaceFlips, 100u);
  EXPECT_GT(flips.Counts().Dropped, 100u);

  SimplexMesh<3> after;
  after = checks::Written(complex);
  checks::ExpectSound(after);
  TetrahedralComplex fresh = checks::ComplexOf(after, score);
  fresh.FindBorderFaces(domain);
  std::vector<bool> isUsed(complex.Points.size());
  for (const auto& cell : complex.Cells)
  {
    for (unsigned i = 0; i < 4 && cell.V[0] != TetrahedralComplex::None; ++i)
    {
      isUsed[cell.V[i]] = true;
    }
  }
  std::uint32_t number = 0; // among those used
  for (std::uint32_t v = 0; v < isUsed.size(); ++v)
  {
    if (isUsed[v])
    {
      EXPECT_LE(fresh.Kinds[number], complex.Kinds[v]) << v;
      ++number;
    }
  }
}

// A small angle at a junction is no excuse for one off it.
TEST(FacetBounds, GoByWhatIsReplaced)
{
  const InterfaceRules rules(30.0, 20.0, 30.0);
  const auto cosine = [](double degrees) { return std::cos(degrees / DegreesPerRadian); };
  FacetBounds bounds(rules);
  EXPECT_TRUE(bounds.Allow(cosine(30.1), false));
  EXPECT_FALSE(bounds.Allow(cosine(29.9), false));
  EXPECT_TRUE(bounds.Allow(cosine(20.1), true));
  EXPECT_FALSE(bounds.Allow(cosine(19.9), true));
  bounds.Replace(cosine(15.0), true);
  bounds.Replace(cosine(25.0), false);
  bounds.Replace(cosine(40.0), false);
  EXPECT_TRUE(bounds.Allow(cosine(25.1), false));
  EXPECT_FALSE(bounds.Allow(cosine(24.9), false));
  EXPECT_TRUE(bounds.Allow(cosine(15.1), true));
  EXPECT_FALSE(bounds.Allow(cosine(14.9), true));
}

//------------------------------------------------------------------------------------------------
TEST(Flips, RemoveAnEdge)
{
  // Three tetrahedra with angles of 120 degrees at their common edge; two without it have 104.
  SimplexMesh<3> three = Ring(3, 0.5, { 1, 1, 1 });
  const double volume = checks::WholeVolume(three);
  OptimisationOptions options;
  options.SmallestDihedralAngle = 25.0;
  options.LargestDihedralAngle = 115.0;
  OptimisationStatistics statistics = Optimise(three, options);
  EXPECT_EQ(statistics.Flips.EdgeRemovals, 1u);
  EXPECT_EQ(three.Simplices.size(), 2u);
  EXPECT_NEAR(checks::WholeVolume(three), volume, 1e-12);
}

TEST(Flips, FillNoBackground)
{
  // The boundary is concave at ab, and would be better shaped were it filled there.
  const auto at = [](double degrees) -> Point<3> {
    return { std::cos(degrees / DegreesPerRadian), std::sin(degrees / DegreesPerRadian), 0.0 };
  };
  SimplexMesh<3> mesh = MeshOf({ { 0, 0, -2 }, { 0, 0, 2 }, at(0), at(100), at(200) },
    { { 0, 1, 2, 3 }, { 0, 1, 3, 4 } }, { 1, 1 });
  const double volume = checks::WholeVolume(mesh);
  OptimisationOptions options;
  options.LargestDihedralAngle = 110.0;
  const OptimisationStatistics statistics = Optimise(mesh, options);
  EXPECT_GT(statistics.Before.Poor, 0u);
  EXPECT_EQ(statistics.Flips.InterfaceFlips, 0u);
  EXPECT_NEAR(checks::WholeVolume(mesh), volume, 0.01 * volume);
}

// Two labels touch in a quadrilateral, which each of them cuts along another diagonal. Were one of them flipped, both
// labels would have the same triangles, and be neighbours.
TEST(Flips, JoinNoPartsThatTouch)
{
  for (const bool touched : { false, true })
  {
    constexpr std::uint32_t a = 0, b = 1, c = 2, d = 3, e = 4, f = 5;
    std::vector<Point<3>> points = { { 1.5, 0, 0 }, { -1.5, 0, 0 }, { 0, 0.8, 0 }, { 0, -0.8, 0 },
      { 0, 0, -1 } };
    std::vector<std::array<std::uint32_t, 4>> tetrahedra = { { a, b, c, e }, { b, a, d, e } };
    std::vector<std::int64_t> labels = { 1, 1 };
    if (touched)
    {
      points.push_back({ 0, 0, 1 });
      tetrahedra.insert(tetrahedra.end(), { { c, d, f, a }, { d, c, f, b } });
      labels.insert(labels.end(), { 2, 2 });
    }
    for (auto& v : tetrahedra)
    {
      const std::array x{ &points[v[0]], &points[v[1]], &points[v[2]], &points[v[3]] };
      if (SignedVolume<3>(x.data()) < 0.0)
      {
        std::swap(v[2], v[3]);
      }
    }
    const SimplexMesh<3> mesh = MeshOf(points, tetrahedra, labels);
    TetrahedralComplex complex = checks::ComplexOf(mesh, ShapeScore(50.0, 95.0, 1.0));
    const std::vector<std::uint32_t> blocks(complex.Points.size(), 0);
    Patch patch(complex, blocks, 0);
    const std::uint32_t vertices[] = { a, b, c, d };
    patch.FindStars(vertices);
    Flips flips(patch, InterfaceRules(10.0, 10.0, 30.0));
    flips.Improve(0);
    EXPECT_EQ(flips.Counts().InterfaceFlips, touched ? 0u : 1u);
  }
}

TEST(Flips, KeepTheLastTetrahedronOfALabel)
{
  for (const std::int64_t label : { 2, 1 })
  {
    // A flat tetrahedron abcd over two good ones, acde and bcde. They become two, unless it is all of its label.
    SimplexMesh<3> mesh =
      MeshOf({ { 1, 0, 0.12 }, { -1, 0, 0.12 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, -1 } },
        { { 0, 1, 2, 3 }, { 0, 3, 2, 4 }, { 1, 2, 3, 4 } }, { label, 2, 2 });
    const OptimisationStatistics statistics = Optimise(mesh);
    EXPECT_GT(statistics.Before.Poor, 0u);
    EXPECT_EQ(mesh.Simplices.size(), label == 2 ? 2u : 3u);
  }
}

TEST(Flips, DropNothingThatIsNotFlat)
{
  for (const double height : { 0.12, 0.8 })
  {
    // A poor tetrahedron abcd lies on two others, acde and bcde. The high one cannot be flipped at cd.
    const SimplexMesh<3> mesh =
      MeshOf({ { 1, 0, height }, { -1, 0, height }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 3, -1 } },
        { { 0, 1, 2, 3 }, { 0, 3, 2, 4 }, { 1, 2, 3, 4 } }, { 2, 2, 2 });
    TetrahedralComplex complex = checks::ComplexOf(mesh, ShapeScore(15.0, 100.0, 2.5));
    EXPECT_LT(complex.Scores[0], 1.0);
    const std::vector<std::uint32_t> blocks(complex.Points.size(), 0);
    Patch patch(complex, blocks, 0);
    Flips flips(patch, InterfaceRules(30.0, 20.0, 30.0));
    flips.Improve(0);
    EXPECT_EQ(flips.Counts().Dropped, height < 0.5 ? 1u : 0u);
    EXPECT_EQ(flips.Counts().InterfaceFlips, flips.Counts().Dropped);
  }
}

TEST(Flips, LeaveJunctionsAlone)
{
  // Three labels meet at the edge that a flip would remove.
  SimplexMesh<3> mesh = Ring(3, 0.1, { 1, 2, 3 });
  const SimplexMesh<3> before = mesh;
  const OptimisationStatistics statistics = Optimise(mesh);
  EXPECT_GT(statistics.Before.Poor, 0u);
  EXPECT_EQ(mesh.Simplices.size(), 3u);
  EXPECT_EQ(checks::Volumes(mesh), checks::Volumes(before));
}

// What was at a junction may have small angles, and is no excuse for small ones off it.
TEST(Flips, MakeNoSmallAnglesOffJunctions)
{
  for (const bool isMirrored : { false, true })
  {
    for (const bool hasJunction : { false, true })
    {
      SCOPED_TRACE(testing::Message() << isMirrored << hasJunction);
      const SimplexMesh<3> mesh = Quadrilateral{ isMirrored, hasJunction }.Mesh();
      TetrahedralComplex complex = checks::ComplexOf(mesh, ShapeScore(15.0, 155.0, 2.5));
      EXPECT_EQ(complex.Kinds[0] == VertexRole::Fixed, hasJunction);
      EXPECT_EQ(complex.Kinds[1], VertexRole::Surface);
      const std::vector<std::uint32_t> blocks(complex.Points.size(), 0);
      Patch patch(complex, blocks, 0);
      const std::uint32_t vertices[] = { 0, 1, 2, 3 };
      patch.FindStars(vertices);
      Flips flips(patch, InterfaceRules(30.0, 20.0, 30.0));
      flips.Improve(0);
      EXPECT_EQ(flips.Counts().InterfaceFlips, hasJunction ? 0u : 1u);
    }
  }
}

//------------------------------------------------------------------------------------------------
namespace
{

/** Inserts a vertex inside tetrahedron 0. False if it is refused. */
bool InsertInside(SimplexMesh<3>& mesh, const OptimisationOptions& options)
{
  TetrahedralComplex complex = checks::ComplexOf(mesh,
    ShapeScore(
      options.SmallestDihedralAngle, options.LargestDihedralAngle, options.Shape.RadiusEdgeRatio));
  const auto vertices = static_cast<std::uint32_t>(complex.Points.size());
  const auto cells = static_cast<std::uint32_t>(complex.Cells.size());
  complex.AddVertices(1);
  complex.AddCells(32);
  const std::vector<std::uint32_t> blocks(vertices + 1, 0);
  Patch patch(complex, blocks, 0);
  std::vector<std::uint32_t> slots(32);
  std::iota(slots.begin(), slots.end(), cells);
  patch.SetSlots(slots);
  patch.SetSpareVertices(vertices, vertices + 1);
  const checks::BallDomain domain(100.0);
  AnchorMap anchors;
  Smoother smoother(patch, domain, InterfaceRules(30.0, 20.0, 30.0), 0.0, anchors);
  const bool isInserted = smoother.InsertInside(0);
  EXPECT_EQ(smoother.Counts().Insertions, isInserted ? 1u : 0u);
  mesh = checks::Written(complex);
  checks::ExpectSound(mesh);
  return isInserted;
}

} // namespace

TEST(Smoother, InsertsAVertexInACavityThatGrows)
{
  // Around a long edge, circumradii are too large beside the edges of the hexagon. The cavity grows to the whole ring.
  SimplexMesh<3> ring = Ring(6, 3.0, { 1, 1, 1, 1, 1, 1 });
  const double volume = checks::WholeVolume(ring);
  const OptimisationOptions options;
  const double ratio = MeasureQuality<3>(ring, 2.5, 30.0, 1).MaximumRadiusEdgeRatio;
  ASSERT_GT(ratio, options.Shape.RadiusEdgeRatio);
  EXPECT_TRUE(InsertInside(ring, options));
  EXPECT_EQ(ring.Simplices.size(), 12u);
  EXPECT_NEAR(checks::WholeVolume(ring), volume, 1e-12);
  EXPECT_LT(MeasureQuality<3>(ring, 2.5, 30.0, 1).MaximumRadiusEdgeRatio, ratio);
}

TEST(Smoother, InsertsNoVertexAcrossLabels)
{
  SimplexMesh<3> ring = Ring(6, 3.0, { 1, 1, 1, 2, 2, 2 });
  const auto volumes = checks::Volumes(ring);
  InsertInside(ring, {});
  for (const auto& [label, volume] : checks::Volumes(ring))
  {
    EXPECT_NEAR(volume, volumes.at(label), 1e-12) << "label " << label;
  }
  EXPECT_EQ(std::count(ring.Labels.begin(), ring.Labels.end(), 2), 3);
}

TEST(Smoother, InsertsNoVertexThatDoesNotHelp)
{
  SimplexMesh<3> ring = Ring(5, 0.6, { 1, 1, 1, 1, 1 });
  EXPECT_FALSE(InsertInside(ring, {}));
  EXPECT_EQ(ring.Simplices.size(), 5u);
}

TEST(MeshOptimiser, TakesDegenerateMeshes)
{
  SimplexMesh<3> empty;
  OptimisationStatistics statistics = Optimise(empty);
  EXPECT_EQ(statistics.Before.Poor, 0u);
  EXPECT_TRUE(empty.Points.empty());

  SimplexMesh<3> one = MeshOf(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.4, 0.4, 0.01 } }, { { 0, 1, 2, 3 } }, { 6 });
  statistics = Optimise(one);
  EXPECT_EQ(statistics.Before.Poor, 1u);
  ASSERT_EQ(one.Simplices.size(), 1u) << "the last tetrahedron of a label must stay";
  EXPECT_EQ(one.Labels[0], 6);
}
