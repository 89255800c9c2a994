// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Components and facets of pentatope meshes.
#include "Quality/SpaceTimeTopology.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <map>

using namespace voxplex;
using namespace voxplex::checks;

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
