// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Edges of interfaces that are not manifold: found, and mended.
#include "Image/ImageDomain.h"
#include "InterfaceChecks.h"
#include "Mesh/InterfaceEdges.h"
#include "Mesh/ManifoldRepair.h"

#include <algorithm>
#include <map>

using namespace voxplex;
using namespace voxplex::checks;

TEST(InterfaceEdges, AreFoundByTheirLabels)
{
  EXPECT_TRUE(FindNonManifoldEdges(Ring({ 1, 1, 2, 2 })).empty());
  const auto alternating = FindNonManifoldEdges(Ring({ 1, 2, 1, 2 }));
  ASSERT_EQ(alternating.size(), 1u);
  EXPECT_EQ(alternating[0].Ends, (std::array<std::uint32_t, 2>{ 0, 1 }));
  EXPECT_FALSE(alternating[0].IsJunction);
  const auto junction = FindNonManifoldEdges(Ring({ 1, 2, 1, 3 }));
  ASSERT_EQ(junction.size(), 1u);
  EXPECT_TRUE(junction[0].IsJunction);
  // Background may be there in as many pieces as it likes, if no label is.
  EXPECT_TRUE(FindNonManifoldEdges(Ring({ 1, 0, 2, 0 })).empty());
  EXPECT_EQ(FindNonManifoldEdges(Ring({ 1, 0, 1, 0 })).size(), 1u);
}

TEST(InterfaceEdges, AgreeWithCountingByLabel)
{
  const SimplexMesh<3> mesh = Mesh(Blobs(1), 3.0, 0);
  std::set<std::array<std::uint32_t, 2>> found;
  for (const InterfaceEdge& edge : FindNonManifoldEdges(mesh))
  {
    found.insert(edge.Ends);
  }
  EXPECT_GT(found.size(), 3u);
  EXPECT_EQ(found, BadEdges(mesh));
}

//------------------------------------------------------------------------------------------------
TEST(ManifoldRepair, GivesATetrahedronToItsNeighbour)
{
  SimplexMesh<3> mesh = Ring({ 1, 2, 1, 2 });
  ASSERT_TRUE(checks::Complaints(mesh).empty());
  const ManifoldRepairCounts counts = RepairManifold(mesh);
  EXPECT_EQ(counts.Before, 1u);
  EXPECT_EQ(counts.After, 0u);
  EXPECT_TRUE(counts.Left.empty());
  EXPECT_TRUE(BadEdges(mesh).empty());
  EXPECT_TRUE(checks::Complaints(mesh).empty());
  EXPECT_EQ(mesh.Simplices.size(), 4u);
  EXPECT_EQ(std::count(mesh.Labels.begin(), mesh.Labels.end(), 1) % 2, 1); // one has changed
}

// A tetrahedron that hangs on an edge only goes, and its points with it.
TEST(ManifoldRepair, DropsWhatHangsOnAnEdge)
{
  SimplexMesh<3> mesh = Ring({ 1, 1, 0, 1, 0 });
  ASSERT_EQ(FindNonManifoldEdges(mesh).size(), 1u);
  EXPECT_EQ(RepairManifold(mesh).After, 0u);
  EXPECT_EQ(mesh.Simplices.size(), 2u);
  EXPECT_EQ(mesh.Points.size(), 5u);
  EXPECT_TRUE(checks::Complaints(mesh).empty());
}

// Whoever changes sides here leaves a triangle between itself and its cap, with an angle of 25 degrees in the narrow
// tetrahedra and of 12 in the wide ones.
TEST(ManifoldRepair, MakesNoSharpFacets)
{
  const SimplexMesh<3> ring = SharpRing();
  ASSERT_TRUE(checks::Complaints(ring).empty());
  SimplexMesh<3> mesh = ring;
  ManifoldRepairOptions options;
  options.FacetAngle = 26.0;
  options.JunctionFacetAngle = 26.0;
  const ManifoldRepairCounts counts = RepairManifold(mesh, options);
  EXPECT_EQ(counts.After, 1u);
  ASSERT_EQ(counts.Left.size(), 1u);
  EXPECT_EQ(counts.Left[0].Ends, FindNonManifoldEdges(mesh)[0].Ends);
  EXPECT_EQ(mesh.Labels, ring.Labels);
  options.FacetAngle = 20.0;
  options.JunctionFacetAngle = 20.0;
  EXPECT_EQ(RepairManifold(mesh, options).After, 0u);
  EXPECT_EQ(mesh.Labels[2], 2); // a wide one stays
  EXPECT_TRUE(checks::Complaints(mesh).empty());
}

// Off junctions new facets have larger angles than at them.
TEST(ManifoldRepair, MakesSharpFacetsAtJunctionsOnly)
{
  ManifoldRepairOptions options;
  options.FacetAngle = 45.0;
  options.JunctionFacetAngle = 20.0;
  std::size_t sharp = 0;
  std::size_t other = 0;
  for (unsigned seed = 1; seed < 9; ++seed)
  {
    SimplexMesh<3> mesh = Mesh(Blobs(seed), 3.0, 0);
    std::set<std::set<Point<3>>> before;
    const auto cornersOf = [&](const auto& facet) {
      return std::set{ mesh.Points[facet[0]], mesh.Points[facet[1]], mesh.Points[facet[2]] };
    };
    for (const auto& facet : mesh.Facets)
    {
      before.insert(cornersOf(facet));
    }
    RepairManifold(mesh, options);
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
      const bool isAtJunction = std::any_of(
        facet.begin(), facet.end(), [&](std::uint32_t v) { return labels[v].size() > 2; });
      if (!before.contains(cornersOf(facet)))
      {
        const double angle = SmallestAngle(mesh, facet);
        EXPECT_GE(angle, isAtJunction ? 20.0 : 45.0) << seed;
        sharp += isAtJunction && angle < 45.0 ? 1 : 0;
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
  SimplexMesh<3> mesh = Ring({ 1, 2, 1, 3 }, shape);
  ManifoldRepairOptions options; // no angle stands in the way
  options.FacetAngle = 0.0;
  options.JunctionFacetAngle = 0.0;
  EXPECT_EQ(RepairManifold(mesh, options).After, 0u);
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
  ManifoldRepairOptions options; // no angle stands in the way
  options.FacetAngle = 0.0;
  options.JunctionFacetAngle = 0.0;
  for (const bool enclosed : { false, true })
  {
    shape.Inner = enclosed ? 1 : 0;
    SimplexMesh<3> mesh = Ring({ 1, 1, 2, 1, 2 }, shape);
    ASSERT_TRUE(checks::Complaints(mesh).empty());
    EXPECT_EQ(RepairManifold(mesh, options).After, 0u);
    EXPECT_TRUE(checks::Complaints(mesh).empty());
    EXPECT_EQ(mesh.Labels[0], enclosed ? 1 : 2);
    EXPECT_EQ(mesh.Labels[1], enclosed ? 1 : 2);
  }
}

TEST(ManifoldRepair, LeavesAGoodMeshAlone)
{
  SimplexMesh<3> mesh = Ring({ 1, 1, 2, 3 });
  const SimplexMesh<3> before = mesh;
  EXPECT_EQ(RepairManifold(mesh).Before, 0u);
  EXPECT_EQ(mesh.Labels, before.Labels);
  EXPECT_EQ(mesh.Facets, before.Facets);
}

// A face where the image cuts the object lies in the plane of the edge and of the outer facets of the first and the
// last tetrahedron. One of these may be dropped or go over to the label between them.
TEST(ManifoldRepair, LeavesNoDentsWhereTheImageCuts)
{
  const LabelImage<3> image = phantoms::CutBall(12);
  const ImageDomain<3> domain(image, 1.0);
  RingShape shape;
  shape.Degrees = { 60.0, 60.0, 60.0, 180.0 };
  ManifoldRepairOptions options;
  for (const bool cut : { false, true })
  {
    options.Cut = cut ? &domain : nullptr;
    for (const std::vector<std::int64_t>& labels :
      { std::vector<std::int64_t>{ 1, 2, 1, 0 }, { 1, 0, 1, 0 } })
    {
      SimplexMesh<3> mesh = Ring(labels, shape);
      for (Point<3>& p : mesh.Points)
      {
        p = { p[2] + 14.0, p[0] + 14.0, p[1] - 0.5 }; // the image's lower face along z is at -0.5
      }
      ASSERT_TRUE(checks::Complaints(mesh).empty());
      const std::size_t tetrahedra = mesh.Simplices.size();
      const ManifoldRepairCounts counts = RepairManifold(mesh, options);
      EXPECT_EQ(counts.Before, 1u);
      EXPECT_EQ(counts.After, 0u);
      EXPECT_TRUE(checks::Complaints(mesh).empty());
      EXPECT_EQ(mesh.Simplices.size(), tetrahedra - (cut && labels[1] == 2 ? 0 : 1));
    }
  }
}

TEST(ManifoldRepair, MendsRealMeshes)
{
  for (const unsigned seed : { 1u, 2u })
  {
    SimplexMesh<3> mesh = Mesh(Blobs(seed), 3.0, 0);
    const std::map<std::int64_t, double> volumes = checks::Volumes(mesh);
    const std::size_t before = BadEdges(mesh).size();
    double smallest = 180.0;
    const ManifoldRepairCounts counts = RepairManifold(mesh);
    EXPECT_EQ(counts.Before, before);
    EXPECT_EQ(counts.After, BadEdges(mesh).size());
    EXPECT_LT(counts.After, before / 3 + 1);
    const std::vector<std::string> complaints = checks::Complaints(mesh);
    EXPECT_TRUE(complaints.empty()) << complaints.front();
    for (const auto& facet : mesh.Facets)
    {
      smallest = std::min(smallest, checks::SmallestAngle(mesh, facet));
    }
    EXPECT_GE(smallest, 20.0);
    EXPECT_EQ(checks::Volumes(mesh).size(), volumes.size()); // no label is lost
  }
}

void ExpectTellsWhatIsLeft(const SimplexMesh<3>& mesh, const ManifoldRepairCounts& counts)
{
  const std::vector<InterfaceEdge> expected = FindNonManifoldEdges(mesh);
  EXPECT_EQ(counts.After, expected.size());
  ASSERT_EQ(counts.Left.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
  {
    EXPECT_EQ(counts.Left[k].Ends, expected[k].Ends) << k;
    EXPECT_EQ(counts.Left[k].IsJunction, expected[k].IsJunction) << k;
  }
}

TEST(ManifoldRepair, TellsWhatIsLeft)
{
  std::size_t left = 0;
  for (const unsigned seed : { 1u, 2u, 3u, 4u })
  {
    for (const double angle : { 20.0, 38.0, 55.0 })
    {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", angle " << angle);
      SimplexMesh<3> mesh = Mesh(Blobs(seed), 3.0, 0);
      const ManifoldRepairCounts counts = RepairManifold(mesh, { angle, angle });
      ExpectTellsWhatIsLeft(mesh, counts);
      left += counts.Before > counts.After ? counts.After : 0;
    }
  }
  EXPECT_GT(left, 5u); // where some were mended, but not all

  // By the numbers that points have when others have gone with their tetrahedron.
  SimplexMesh<3> mesh = Ring({ 1, 1, 0, 1, 0 });
  Append(SharpRing(), 10.0, mesh);
  const ManifoldRepairCounts counts = RepairManifold(mesh, { 26.0, 26.0 });
  ExpectTellsWhatIsLeft(mesh, counts);
  EXPECT_EQ(counts.Before, 2u);
  ASSERT_EQ(counts.Left.size(), 1u);
  EXPECT_EQ(counts.Left[0].Ends, (std::array<std::uint32_t, 2>{ 5, 6 })); // two points have gone
}
