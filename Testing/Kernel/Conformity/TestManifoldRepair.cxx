// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Edges of interfaces that are not manifold: found, and mended.
#include "Base/Error.h"
#include "Conformity/ManifoldRepair.h"
#include "Domain/ImageDomain.h"
#include "InterfaceChecks.h"
#include "RefinementChecks.h"
#include "RepairTesting.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** A refined triangulation of blobs, with labels that may be repaired. */
struct RefinedBlobs
{
  explicit RefinedBlobs(unsigned seed)
    : Image(Blobs(seed))
    , Surfaces(this->Image, 1.0)
    , Context(Refined(this->Surfaces, 3.0))
    , Labels(LabelSimplices<3>(this->Context->Mesh, this->Surfaces))
  {
  }
  Repaired<3> Repair(
    const ManifoldRepairOptions<3>& options, unsigned threads = 1, const std::stop_token& stop = {})
  {
    return RepairAll<3>(this->Context->Mesh, this->Labels, options, threads, stop);
  }
  SimplexMesh<3> Extract() const
  {
    SimplexMesh<3> mesh;
    ExtractMesh<3>(this->Context->Mesh, this->Surfaces, this->Labels, mesh);
    return mesh;
  }
  const Point<3>& Position(VertexId v) const { return this->Context->Mesh.Position(v); }

  const LabelImage<3> Image;
  const ImageDomain<3> Surfaces;
  const std::unique_ptr<RefinementContext<3>> Context;
  SimplexLabels Labels;
};

/** The facets off junctions that have an angle below a bound, by the positions of their vertices. */
std::set<std::set<Point<3>>> SharpFacetsOffJunctions(const SimplexMesh<3>& mesh, double bound)
{
  std::map<std::uint32_t, std::set<std::int64_t>> labels;
  for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
  {
    for (const std::uint32_t v : mesh.Facets[f])
    {
      labels[v].insert(mesh.FacetLabels[f].begin(), mesh.FacetLabels[f].end());
    }
  }
  std::set<std::set<Point<3>>> sharp;
  for (const auto& facet : mesh.Facets)
  {
    if (checks::SmallestAngle(mesh, facet) < bound &&
      std::none_of(
        facet.begin(), facet.end(), [&](std::uint32_t v) { return labels[v].size() > 2; }))
    {
      sharp.insert({ mesh.Points[facet[0]], mesh.Points[facet[1]], mesh.Points[facet[2]] });
    }
  }
  return sharp;
}

} // namespace

TEST(InterfaceEdges, AreFoundByTheirLabels)
{
  EXPECT_TRUE(NonManifoldEdges(Ring({ 1, 1, 2, 2 })).empty());
  const auto alternating = NonManifoldEdges(Ring({ 1, 2, 1, 2 }));
  ASSERT_EQ(alternating.size(), 1u);
  EXPECT_EQ(alternating[0].Vertices, (std::array<std::uint32_t, 2>{ 0, 1 }));
  EXPECT_FALSE(alternating[0].IsJunction);
  const auto junction = NonManifoldEdges(Ring({ 1, 2, 1, 3 }));
  ASSERT_EQ(junction.size(), 1u);
  EXPECT_TRUE(junction[0].IsJunction);
  // Background may be there in as many pieces as it likes, if no label is.
  EXPECT_TRUE(NonManifoldEdges(Ring({ 1, 0, 2, 0 })).empty());
  EXPECT_EQ(NonManifoldEdges(Ring({ 1, 0, 1, 0 })).size(), 1u);
}

TEST(InterfaceEdges, AgreeWithCountingByLabel)
{
  const SimplexMesh<3> mesh = Mesh(Blobs(1), 3.0, 0);
  std::set<std::array<std::uint32_t, 2>> found;
  for (const InterfaceEdge& edge : NonManifoldEdges(mesh))
  {
    found.insert(edge.Vertices);
  }
  EXPECT_GT(found.size(), 3u);
  EXPECT_EQ(found, BadEdges(mesh));
}

//------------------------------------------------------------------------------------------------
TEST(ManifoldRepair, GivesATetrahedronToItsNeighbour)
{
  Triangulated ring(Ring({ 1, 2, 1, 2 }));
  const SimplexLabels before = ring.Labels;
  ASSERT_TRUE(checks::Complaints(ring.Extract()).empty());
  const Repaired<3> result = RepairAll<3>(*ring.Source, ring.Labels);
  EXPECT_EQ(result.Before, 1u);
  EXPECT_TRUE(result.Left.empty());
  ASSERT_EQ(result.Relabelled.size(), 1u);
  const SimplexMesh<3> mesh = ring.Extract();
  EXPECT_TRUE(BadEdges(mesh).empty());
  EXPECT_TRUE(checks::Complaints(mesh).empty());
  EXPECT_EQ(mesh.Simplices.size(), 4u);
  for (SimplexId s = 0; s < before.size(); ++s)
  {
    EXPECT_EQ(ring.Labels[s] != before[s], s == result.Relabelled[0]);
  }
}

// A tetrahedron that hangs on an edge only goes, and its points with it.
TEST(ManifoldRepair, DropsWhatHangsOnAnEdge)
{
  Triangulated ring(Ring({ 1, 1, 0, 1, 0 }));
  const Repaired<3> result = RepairAll<3>(*ring.Source, ring.Labels);
  EXPECT_EQ(result.Before, 1u);
  EXPECT_TRUE(result.Left.empty());
  const SimplexMesh<3> mesh = ring.Extract();
  EXPECT_EQ(mesh.Simplices.size(), 2u);
  EXPECT_EQ(mesh.Points.size(), 5u);
  EXPECT_TRUE(checks::Complaints(mesh).empty());
}

// A tetrahedron that changes its label here leaves a triangle between itself and its cap. This has an angle of
// 25 degrees at the narrow tetrahedra and of 12 at the wide ones.
TEST(ManifoldRepair, MakesNoSharpFacets)
{
  Triangulated ring(SharpRing());
  ASSERT_TRUE(checks::Complaints(ring.Extract()).empty());
  const SimplexLabels before = ring.Labels;
  ManifoldRepairOptions<3> options;
  options.Shape.FacetAngle = 26.0;
  options.Shape.JunctionFacetAngle = 26.0;
  const Repaired<3> result = RepairAll<3>(*ring.Source, ring.Labels, options);
  EXPECT_EQ(result.Left.size(), 1u);
  EXPECT_TRUE(result.Relabelled.empty());
  EXPECT_EQ(ring.Labels, before);
  options.Shape.FacetAngle = 20.0;
  options.Shape.JunctionFacetAngle = 20.0;
  const Repaired<3> other = RepairAll<3>(*ring.Source, ring.Labels, options);
  EXPECT_TRUE(other.Left.empty());
  ASSERT_EQ(other.Relabelled.size(), 1u);
  EXPECT_EQ(before[other.Relabelled[0]], 1); // a wide one stays
  EXPECT_TRUE(checks::Complaints(ring.Extract()).empty());
}

// Off junctions new facets have larger angles than at them.
TEST(ManifoldRepair, MakesSharpFacetsAtJunctionsOnly)
{
  ManifoldRepairOptions<3> options;
  options.Shape.FacetAngle = 45.0;
  options.Shape.JunctionFacetAngle = 20.0;
  std::size_t sharp = 0;
  std::size_t other = 0;
  for (unsigned seed = 1; seed < 9; ++seed)
  {
    RefinedBlobs blobs(seed);
    std::set<std::set<Point<3>>> before;
    const auto cornersOf = [](const SimplexMesh<3>& mesh, const auto& facet) {
      return std::set{ mesh.Points[facet[0]], mesh.Points[facet[1]], mesh.Points[facet[2]] };
    };
    const SimplexMesh<3> first = blobs.Extract();
    for (const auto& facet : first.Facets)
    {
      before.insert(cornersOf(first, facet));
    }
    blobs.Repair(options);
    const SimplexMesh<3> mesh = blobs.Extract();
    std::vector<std::set<std::int64_t>> labels(mesh.Points.size());
    for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
    {
      for (const std::uint32_t v : mesh.Facets[f])
      {
        labels[v].insert(mesh.FacetLabels[f].begin(), mesh.FacetLabels[f].end());
      }
    }
    for (const auto& facet : mesh.Facets)
    {
      std::size_t most = 0;
      for (const std::uint32_t v : facet)
      {
        most = std::max(most, labels[v].size());
      }
      const bool isAtJunction = most > 2;
      if (!before.contains(cornersOf(mesh, facet)))
      {
        const double angle = SmallestAngle(mesh, facet);
        EXPECT_GE(angle, isAtJunction ? 20.0 : 45.0) << seed;
        sharp += most == 3 && angle < 45.0 ? 1 : 0;
        other += isAtJunction ? 0 : 1;
      }
    }
  }
  EXPECT_GT(sharp, 0u);
  EXPECT_GT(other, 0u);
}

// The label in the narrow gap would be the cheapest to give up, but it has nothing else.
TEST(ManifoldRepair, LosesNoLabel)
{
  RingShape shape;
  shape.Degrees = { 110.0, 30.0, 110.0, 110.0 };
  Triangulated ring(Ring({ 1, 2, 1, 3 }, shape));
  ManifoldRepairOptions<3> options; // no angle stands in the way
  options.Shape.FacetAngle = 0.0;
  options.Shape.JunctionFacetAngle = 0.0;
  EXPECT_TRUE(RepairAll<3>(*ring.Source, ring.Labels, options).Left.empty());
  const SimplexMesh<3> mesh = ring.Extract();
  EXPECT_TRUE(checks::Complaints(mesh).empty());
  const std::set<std::int64_t> labels(mesh.Labels.begin(), mesh.Labels.end());
  EXPECT_EQ(labels, (std::set<std::int64_t>{ 1, 2, 3 }));
}

// The first two tetrahedra are the smallest, but the vertex between them is inside of their label: the image has no
// interface there, so none may come to it.
TEST(ManifoldRepair, BringsNoInterfaceToInnerVertices)
{
  RingShape shape;
  shape.Degrees = { 15.0, 15.0, 110.0, 110.0, 110.0 };
  ManifoldRepairOptions<3> options; // no angle stands in the way
  options.Shape.FacetAngle = 0.0;
  options.Shape.JunctionFacetAngle = 0.0;
  for (const bool enclosed : { false, true })
  {
    shape.Inner = enclosed ? 1 : 0;
    Triangulated ring(Ring({ 1, 1, 2, 1, 2 }, shape));
    ASSERT_TRUE(checks::Complaints(ring.Extract()).empty());
    const Repaired<3> result = RepairAll<3>(*ring.Source, ring.Labels, options);
    EXPECT_TRUE(result.Left.empty());
    EXPECT_TRUE(checks::Complaints(ring.Extract()).empty());
    EXPECT_EQ(result.Relabelled.size(), enclosed ? 1u : 2u);
    for (const SimplexId s : result.Relabelled)
    {
      const auto& v = ring.Source->GetSimplex(s).V;
      EXPECT_EQ(std::any_of(v.begin(), v.end(),
                  [&](VertexId p)
                  { return ring.Source->Position(p)[0] == std::cos(std::numbers::pi / 12.0); }),
        !enclosed);
    }
  }
}

TEST(ManifoldRepair, LeavesAGoodMeshAlone)
{
  Triangulated ring(Ring({ 1, 1, 2, 3 }));
  const SimplexLabels before = ring.Labels;
  const Repaired<3> result = RepairAll<3>(*ring.Source, ring.Labels);
  EXPECT_EQ(result.Before, 0u);
  EXPECT_TRUE(result.Relabelled.empty());
  EXPECT_EQ(ring.Labels, before);
}

// A face where the image cuts the object lies in the plane of the edge and of the outer facets of the first and the
// last tetrahedron. One of these may be dropped or go over to the label between them.
TEST(ManifoldRepair, LeavesNoDentsWhereTheImageCuts)
{
  const LabelImage<3> image = phantoms::CutBall(12);
  const ImageDomain<3> domain(image, 1.0);
  RingShape shape;
  shape.Degrees = { 60.0, 60.0, 60.0, 180.0 };
  ManifoldRepairOptions<3> options;
  for (const bool cut : { false, true })
  {
    options.Surfaces = cut ? &domain : nullptr;
    for (const std::vector<std::int64_t>& labels :
      { std::vector<std::int64_t>{ 1, 2, 1, 0 }, { 1, 0, 1, 0 } })
    {
      SimplexMesh<3> mesh = Ring(labels, shape);
      for (Point<3>& p : mesh.Points)
      {
        p = { p[2] + 14.0, p[0] + 14.0, p[1] - 0.5 }; // the image's lower face along z is at -0.5
      }
      const std::size_t tetrahedra = mesh.Simplices.size();
      Triangulated ring(mesh);
      ASSERT_TRUE(checks::Complaints(ring.Extract()).empty());
      const Repaired<3> result = RepairAll<3>(*ring.Source, ring.Labels, options);
      EXPECT_EQ(result.Before, 1u);
      EXPECT_TRUE(result.Left.empty());
      mesh = ring.Extract();
      EXPECT_TRUE(checks::Complaints(mesh).empty());
      EXPECT_EQ(mesh.Simplices.size(), tetrahedra - (cut && labels[1] == 2 ? 0 : 1));
    }
  }
}

/** Elements of label 1 may be larger than those of label 2. */
class SizeOfLabelTwo final : public SizeFunction<3>
{
public:
  explicit SizeOfLabelTwo(double size)
    : Size(size)
  {
  }
  double Evaluate(const Point<3>&, std::int64_t label) const override
  {
    return label == 2 ? this->Size : 100.0;
  }

private:
  const double Size;
};

TEST(ManifoldRepair, MakesNoElementLargerThanItsNewLabelAllows)
{
  const LabelImage<3> image =
    phantoms::Make(GridGeometry<3>::Orthogonal({ 6, 6, 6 }, { 1.0, 1.0, 1.0 }),
      [](const Point<3>& p) -> std::int16_t { return p[0] < 2.5 ? 1 : 2; });
  const ImageDomain<3> domain(image, 1.0);
  for (const double size : { 100.0, 0.01 })
  {
    const SizeOfLabelTwo sizes(size);
    const SizingField<3> sizing(domain, { .Base = { 0.1 }, .Size = &sizes });
    Triangulated ring(Ring({ 1, 2, 1, 2 }));
    ManifoldRepairOptions<3> options;
    options.Surfaces = &domain;
    options.Sizing = &sizing;
    const Repaired<3> result = RepairAll<3>(*ring.Source, ring.Labels, options);
    EXPECT_TRUE(result.Left.empty());
    ASSERT_EQ(result.Relabelled.size(), 1u);
    EXPECT_EQ(ring.Labels[result.Relabelled[0]], size < 1.0 ? 1 : 2);
  }
}

// A facet beside a tetrahedron that gets another label stays, but its vertex may be at a junction no more.
TEST(ManifoldRepair, TakesNoJunctionFromASharpFacet)
{
  constexpr double bound = 38.0;
  std::size_t repaired = 0;
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    RefinedBlobs blobs(seed);
    const auto before = SharpFacetsOffJunctions(blobs.Extract(), bound);
    const Repaired<3> result =
      blobs.Repair({ .Shape = { .FacetAngle = bound, .JunctionFacetAngle = 10.0 } });
    repaired += result.Relabelled.size();
    for (const auto& facet : SharpFacetsOffJunctions(blobs.Extract(), bound))
    {
      EXPECT_TRUE(before.contains(facet)) << seed;
    }
  }
  EXPECT_GT(repaired, 20u);
}

TEST(ManifoldRepair, MendsRealMeshes)
{
  for (const unsigned seed : { 1u, 2u })
  {
    RefinedBlobs blobs(seed);
    const SimplexMesh<3> first = blobs.Extract();
    const std::map<std::int64_t, double> volumes = checks::Volumes(first);
    const std::size_t before = BadEdges(first).size();
    double smallest = 180.0;
    const Repaired<3> result = blobs.Repair({});
    const SimplexMesh<3> mesh = blobs.Extract();
    EXPECT_EQ(result.Before, before);
    EXPECT_EQ(result.Left.size(), BadEdges(mesh).size());
    EXPECT_LT(result.Left.size(), before / 3 + 1);
    checks::ExpectSound(mesh);
    for (const auto& facet : mesh.Facets)
    {
      smallest = std::min(smallest, checks::SmallestAngle(mesh, facet));
    }
    EXPECT_GE(smallest, 20.0);
    EXPECT_EQ(checks::Volumes(mesh).size(), volumes.size()); // no label is lost
  }
}

TEST(ManifoldRepair, TellsWhatIsLeft)
{
  using Ends = std::set<Point<3>>;
  std::size_t left = 0;
  for (const unsigned seed : { 1u, 2u, 3u, 4u })
  {
    for (const double angle : { 20.0, 38.0, 55.0 })
    {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", angle " << angle);
      RefinedBlobs blobs(seed);
      const Repaired<3> result =
        blobs.Repair({ .Shape = { .FacetAngle = angle, .JunctionFacetAngle = angle } });
      std::map<Ends, bool> found;
      for (const InterfaceEdge& edge : result.Left)
      {
        found[{ blobs.Position(edge.Vertices[0]), blobs.Position(edge.Vertices[1]) }] =
          edge.IsJunction;
      }
      EXPECT_EQ(found.size(), result.Left.size());
      const SimplexMesh<3> mesh = blobs.Extract();
      std::map<Ends, bool> expected;
      for (const InterfaceEdge& edge : NonManifoldEdges(mesh))
      {
        expected[{ mesh.Points[edge.Vertices[0]], mesh.Points[edge.Vertices[1]] }] =
          edge.IsJunction;
      }
      EXPECT_EQ(found, expected);
      left += result.Before > result.Left.size() ? result.Left.size() : 0;
    }
  }
  EXPECT_GT(left, 5u); // where some were mended, but not all
}

TEST(ManifoldRepair, CanBeCancelled)
{
  RefinedBlobs blobs(1);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(blobs.Repair({}, 1, stop.get_token()), Cancelled);
}
