// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Slices as tetrahedra: single cells with all orders of their points, slices of meshes.
#include "Geometry/SimplexQuality.h"
#include "Mesh/FindInterfaces.h"
#include "Mesh/SliceTetrahedra.h"
#include "Quality/SpaceTimeTopology.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

double SmallestVolume(const SimplexMesh<3>& mesh)
{
  double smallest = 1e300;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    smallest = std::min(smallest, SignedVolume<3>(mesh.PointsOf(s).data()));
  }
  return smallest;
}

double TotalVolume(const SimplexMesh<3>& mesh)
{
  double sum = 0.0;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    sum += SignedVolume<3>(mesh.PointsOf(s).data());
  }
  return sum;
}

/** One cell, whose i-th corner is the point number order[i] of the slice. */
TimeSlice OneCell(
  SliceCellType type, const std::vector<Point<3>>& corners, const std::vector<std::size_t>& order)
{
  TimeSlice slice;
  slice.Points.resize(corners.size());
  slice.Types = { type };
  slice.Offsets = { 0, static_cast<long long>(corners.size()) };
  slice.Sources = { 0 };
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    slice.Points[order[i]] = corners[i];
    slice.Connectivity.push_back(static_cast<long long>(order[i]));
  }
  return slice;
}

/** All orders of the points give tetrahedra of positive volume that fill the cell. */
void ExpectFilled(
  SliceCellType type, const std::vector<Point<3>>& corners, std::size_t tetrahedra, double volume)
{
  std::vector<std::size_t> order(corners.size());
  std::iota(order.begin(), order.end(), 0u);
  const std::vector<std::int64_t> labels = { 7 };
  do
  {
    SimplexMesh<3> mesh = SplitIntoTetrahedra(OneCell(type, corners, order), labels);
    ASSERT_EQ(mesh.Simplices.size(), tetrahedra);
    EXPECT_EQ(mesh.Labels.front(), 7);
    EXPECT_GT(SmallestVolume(mesh), 0.0);
    EXPECT_NEAR(TotalVolume(mesh), volume, 1e-12);
    EXPECT_EQ(FindInterfaces(mesh, 1), 0u);
    // The surface of a wedge is 8 triangles, that of a pyramid 6.
    EXPECT_EQ(mesh.Facets.size(), type == SliceCellType::Wedge ? 8u : 6u);
  } while (std::next_permutation(order.begin(), order.end()));
}

} // namespace

TEST(SliceTetrahedra, WedgesAndPyramids)
{
  // VTK's orders: the wedge's first triangle looks away from the second, the base at the apex.
  ExpectFilled(SliceCellType::Wedge,
    { { 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, { 0, 1, 1 }, { 1, 0, 1 } }, 3, 0.5);
  ExpectFilled(SliceCellType::Pyramid,
    { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0.3, 0.4, 1 } }, 2, 1.0 / 3.0);
}

TEST(SliceTetrahedra, SlicesOfAMesh)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(9, 1.0));
  const SimplexMesh<4> mesh = MeshOf(image, SpaceTimeOptions(3.0));
  std::vector<double> points;
  std::vector<double> times;
  std::vector<long long> offsets = { 0 };
  std::vector<long long> connectivity;
  for (const Point<4>& p : mesh.Points)
  {
    points.insert(points.end(), p.begin(), p.begin() + 3);
    times.push_back(p[3]);
  }
  for (const auto& simplex : mesh.Simplices)
  {
    connectivity.insert(connectivity.end(), simplex.begin(), simplex.end());
    offsets.push_back(static_cast<long long>(connectivity.size()));
  }
  const TimeSlicer slicer({ points, times, offsets, connectivity });
  for (const double time : { 0.0, 0.7, 3.0, 5.33, 8.0 })
  {
    SCOPED_TRACE(time);
    SimplexMesh<3> slice = SplitIntoTetrahedra(slicer.Slice(time), mesh.Labels);
    EXPECT_GT(SmallestVolume(slice), -1e-12);
    const auto expected =
      time == 0.0 || time == 8.0 ? EndVolumes(mesh, time) : SliceVolumes(mesh, time);
    double total = 0.0;
    for (const auto& [label, volume] : expected)
    {
      total += volume;
    }
    EXPECT_NEAR(TotalVolume(slice), total, 1e-9 * total);
    EXPECT_EQ(FindInterfaces(slice, 2), 0u);
    // Label 1 is inside of label 2: where two cells were split along different diagonals it would
    // have facets to the background.
    std::size_t split = 0;
    std::size_t interfaces = 0;
    for (const auto& labels : slice.FacetLabels)
    {
      split += labels == std::array<std::int64_t, 2>{ 1, 0 };
      interfaces += labels == std::array<std::int64_t, 2>{ 2, 1 };
    }
    EXPECT_EQ(split, 0u);
    EXPECT_GT(interfaces, 10u);
  }
}

TEST(SpaceTimeTopology, PentatopesThatMeet)
{
  // Two in a facet, one in a triangle with them, one apart; the second has another label at first.
  SimplexMesh<4> mesh;
  mesh.Points.resize(14);
  mesh.Simplices = { { 0, 1, 2, 3, 4 }, { 5, 3, 2, 1, 0 }, { 0, 1, 2, 6, 7 },
    { 9, 10, 11, 12, 13 } };
  mesh.Labels = { 1, 2, 1, 1 };
  SpaceTimeTopology topology = MeasureTopology(mesh);
  EXPECT_EQ(topology.InterfaceFacets, 19u); // 4 x 5, one of them shared
  EXPECT_EQ(topology.FacetsOfThreeElements, 0u);
  EXPECT_EQ(topology.Components, (std::map<std::int64_t, std::uint64_t>{ { 1, 3 }, { 2, 1 } }));
  mesh.Labels[1] = 1;
  topology = MeasureTopology(mesh);
  EXPECT_EQ(topology.InterfaceFacets, 18u);
  EXPECT_EQ(topology.Components.at(1), 3u);
  mesh.Simplices[3] = { 8, 0, 3, 1, 2 };
  EXPECT_EQ(MeasureTopology(mesh).FacetsOfThreeElements, 1u);
}

// Two balls merge and part: one component in space-time. Counted from the mesh and from the mesher.
TEST(SpaceTimeTopology, Meshes)
{
  const LabelImage<4> image = ImageOf(phantoms::MergingBalls(9));
  const SimplexMesh<4> mesh = MeshOf(image, SpaceTimeOptions(3.0));
  const SpaceTimeTopology topology = MeasureTopology(mesh);
  EXPECT_EQ(topology.InterfaceFacets, mesh.Facets.size());
  EXPECT_EQ(topology.FacetsOfThreeElements, 0u);
  for (const auto& [label, components] : topology.Components)
  {
    EXPECT_EQ(components, NumberOfComponents(mesh, label)) << label;
  }
}
