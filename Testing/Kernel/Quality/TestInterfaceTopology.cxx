// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** Interfaces of meshes made by hand: found again, their junctions and non-manifold edges counted. */
#include "CubeMeshes.h"
#include "Mesh/FindInterfaces.h"
#include "MeshRuns.h"
#include "Phantoms.h"
#include "Quality/InterfaceTopology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace
{

using namespace voxplex;

/** Facets turned so that the smallest point comes first, with their labels. */
std::map<std::array<std::uint32_t, 3>, std::array<std::int64_t, 2>> FacetMap(
  const SimplexMesh<3>& mesh)
{
  std::map<std::array<std::uint32_t, 3>, std::array<std::int64_t, 2>> facets;
  for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
  {
    auto facet = mesh.Facets[f];
    std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
    facets[facet] = mesh.FacetLabels[f];
  }
  EXPECT_EQ(facets.size(), mesh.Facets.size());
  return facets;
}

InterfaceTopology TopologyOf(CubeMesh& cubes)
{
  EXPECT_EQ(FindInterfaces(cubes.Mesh, 1), 0U);
  return MeasureTopology(cubes.Mesh, 1);
}

const Point<3> Origin{ 0, 0, 0 };

} // namespace

//------------------------------------------------------------------------------
TEST(FindInterfaces, AgreesWithExtraction)
{
  for (const bool three : { true, false })
  {
    SimplexMesh<3> mesh = checks::MeshOf(
      three ? phantoms::NestedBalls(12) : phantoms::TouchingLabels(12), checks::WithDelta<3>(3.0));
    ASSERT_GT(mesh.Facets.size(), 100U);
    const auto expected = FacetMap(mesh);
    EXPECT_EQ(FindInterfaces(mesh, 1), 0U);
    EXPECT_EQ(FacetMap(mesh), expected); // labels and normals, too
    const auto facets = mesh.Facets;
    EXPECT_EQ(FindInterfaces(mesh, 3), 0U);
    EXPECT_EQ(mesh.Facets, facets);
  }
}

TEST(FindInterfaces, CountsFacesThatThreeShare)
{
  CubeMesh cubes;
  for (const double x : { 1.0, 2.0, -1.0 })
  {
    cubes.AddTetrahedron({ Origin, { 0, 1, 0 }, { 0, 0, 1 }, { x, 0, 0 } }, 1);
  }
  EXPECT_EQ(FindInterfaces(cubes.Mesh, 1), 1U);
  EXPECT_EQ(cubes.Mesh.Facets.size(), 9U);
}

TEST(FindInterfaces, EmptyMesh)
{
  SimplexMesh<3> mesh;
  EXPECT_EQ(FindInterfaces(mesh, 1), 0U);
  EXPECT_TRUE(mesh.Facets.empty());
  EXPECT_EQ(MeasureTopology(mesh, 1).InterfaceEdges, 0U);
}

//------------------------------------------------------------------------------
// A cube has 12 triangles and 18 edges.
TEST(InterfaceTopology, Cube)
{
  CubeMesh cubes;
  cubes.AddBox(Origin, { 1, 1, 1 }, 4);
  const InterfaceTopology topology = TopologyOf(cubes);
  EXPECT_EQ(cubes.Mesh.Facets.size(), 12U);
  EXPECT_EQ(topology.InterfaceEdges, 18U);
  EXPECT_EQ(topology.BoundaryEdges, 18U);
  EXPECT_EQ(topology.JunctionEdges, 0U);
  EXPECT_EQ(topology.JunctionPoints, 0U);
  EXPECT_EQ(topology.Corners, 0U);
  EXPECT_EQ(topology.NonManifoldEdges, 0U);
  ASSERT_EQ(topology.Labels.size(), 1U);
  EXPECT_EQ(topology.Labels[0].Label, 4);
}

// Two cubes share a square: its rim is a junction of both labels and background.
TEST(InterfaceTopology, TwoLabelsMeetInASquare)
{
  CubeMesh cubes;
  cubes.AddBox(Origin, { 1, 1, 1 }, 1);
  cubes.AddBox({ 0, 0, 1 }, { 1, 1, 2 }, 2);
  const InterfaceTopology topology = TopologyOf(cubes);
  EXPECT_EQ(cubes.Mesh.Facets.size(), 22U);
  EXPECT_EQ(topology.InterfaceEdges, 2U * 18U - 5U);
  EXPECT_EQ(topology.BoundaryEdges, 2U * 18U);
  EXPECT_EQ(topology.JunctionEdges, 4U);
  EXPECT_EQ(topology.JunctionPoints, 4U);
  EXPECT_EQ(topology.IrregularJunctionPoints, 0U);
  EXPECT_EQ(topology.Corners, 0U);
  EXPECT_EQ(topology.NonManifoldEdges, 0U);
}

// Four columns around an axis, of labels 1, 2, 3 and 1: four junctions meet at both ends of the axis.
TEST(InterfaceTopology, FourColumns)
{
  CubeMesh cubes;
  cubes.AddBox({ -1, -1, 0 }, { 0, 0, 1 }, 1);
  cubes.AddBox({ 0, -1, 0 }, { 1, 0, 1 }, 2);
  cubes.AddBox({ -1, 0, 0 }, { 0, 1, 1 }, 3);
  cubes.AddBox(Origin, { 1, 1, 1 }, 1);
  const InterfaceTopology topology = TopologyOf(cubes);
  EXPECT_EQ(topology.Corners, 2U);
  // The axis, and of each of the four squares between columns the three outer edges.
  EXPECT_EQ(topology.JunctionEdges, 1U + 4U * 3U);
  EXPECT_EQ(topology.JunctionPoints, 2U + 4U * 2U);
  EXPECT_EQ(topology.IrregularJunctionPoints, 0U);
  // Label 1 has two columns, so the axis has four of its facets.
  EXPECT_EQ(topology.NonManifoldEdges, 1U);
  EXPECT_EQ(topology.NonManifoldEdgesAtJunctions, 1U);
  ASSERT_EQ(topology.Labels.size(), 3U);
  EXPECT_EQ(topology.Labels[0].NonManifoldEdges, 1U);
  EXPECT_EQ(topology.Labels[0].NonManifoldEdgesAtJunctions, 1U);
  EXPECT_EQ(topology.Labels[0].BoundaryEdges, 2U * 18U - 1U);
  EXPECT_EQ(topology.Labels[1].NonManifoldEdges, 0U);
}

// Two cubes that touch in an edge: four facets of one label, or two of each.
TEST(InterfaceTopology, CubesThatTouchInAnEdge)
{
  for (const std::int64_t other : { 1, 2 })
  {
    CubeMesh cubes;
    cubes.AddBox({ -1, -1, 0 }, { 0, 0, 1 }, 1);
    cubes.AddBox(Origin, { 1, 1, 1 }, other);
    const InterfaceTopology topology = TopologyOf(cubes);
    EXPECT_EQ(topology.InterfaceEdges, 2U * 18U - 1U);
    EXPECT_EQ(topology.NonManifoldEdges, other == 1 ? 1U : 0U);
    EXPECT_EQ(topology.NonManifoldEdgesAtJunctions, 0U);
    EXPECT_EQ(topology.JunctionEdges, other == 1 ? 0U : 1U);
    EXPECT_EQ(topology.IrregularJunctionPoints, other == 1 ? 0U : 2U); // a junction with two ends
  }
}

TEST(InterfaceTopology, DoesNotDependOnThreads)
{
  const SimplexMesh<3> mesh =
    checks::MeshOf(phantoms::TouchingLabels(20), checks::WithDelta<3>(1.5));
  const InterfaceTopology one = MeasureTopology(mesh, 1);
  const InterfaceTopology three = MeasureTopology(mesh, 3);
  EXPECT_GT(one.JunctionEdges, 20U);
  EXPECT_EQ(one.JunctionEdges, three.JunctionEdges);
  EXPECT_EQ(one.InterfaceEdges, three.InterfaceEdges);
  EXPECT_EQ(one.BoundaryEdges, three.BoundaryEdges);
  EXPECT_EQ(one.NonManifoldEdges, three.NonManifoldEdges);
}
