// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ComplexOf.h"
#include "Optimisation/Tetrahedra/Rooms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

using namespace voxplex;

namespace
{

constexpr std::uint32_t Length = 20;

/** A strip of tetrahedra along a helix: tetrahedron t has the vertices t to t + 3. */
TetrahedralComplex Strip()
{
  SimplexMesh<3> mesh;
  for (std::uint32_t v = 0; v < Length + 3; ++v)
  {
    const double angle = 2.3 * v;
    mesh.Points.push_back({ std::cos(angle), std::sin(angle), 0.3 * v });
  }
  for (std::uint32_t t = 0; t < Length; ++t)
  {
    mesh.Simplices.push_back({ t, t + 1, t + 2, t + 3 });
    mesh.Labels.push_back(1);
  }
  return checks::ComplexOf<3>(mesh);
}

/** The room of each vertex; the rooms' number stands for none. */
std::vector<std::uint32_t> RoomsOf(const std::vector<std::uint32_t>& cells, unsigned edges)
{
  return RoomsAround(Strip(), cells, edges).OfVertex;
}

TEST(Rooms, HaveTheVerticesThatEdgesLeadTo)
{
  for (unsigned edges = 0; edges < 3; ++edges)
  {
    const std::vector<std::uint32_t> rooms = RoomsOf({ 9 }, edges);
    for (std::uint32_t v = 0; v < rooms.size(); ++v)
    {
      EXPECT_EQ(rooms[v] == 0, v + 3 * edges >= 9 && v <= 12 + 3 * edges) << v << ", " << edges;
    }
  }
}

TEST(Rooms, ThatMeetAreOne)
{
  // Vertices 2 to 5 and 11 to 14; one edge leads three vertices on.
  EXPECT_EQ(RoomsAround(Strip(), std::vector<std::uint32_t>{ 11, 2 }, 0).Number, 2u);
  EXPECT_EQ(RoomsAround(Strip(), std::vector<std::uint32_t>{ 11, 2 }, 1).Number, 1u);
  EXPECT_EQ(RoomsAround(Strip(), std::vector<std::uint32_t>{ 12, 2 }, 1).Number, 2u);
}

TEST(Rooms, AreNumberedByTheirFirstVertices)
{
  const std::vector<std::uint32_t> rooms = RoomsOf({ 16, 0, 8 }, 0);
  EXPECT_EQ(rooms[0], 0u);
  EXPECT_EQ(rooms[8], 1u);
  EXPECT_EQ(rooms[16], 2u);
  EXPECT_EQ(rooms[5], 3u) << "in none";
}

TEST(Rooms, ContainTheTetrahedraThatHaveAllVerticesThere)
{
  const Rooms rooms = RoomsAround(Strip(), std::vector<std::uint32_t>{ 2, 6 }, 0);
  ASSERT_EQ(rooms.Number, 2u);
  EXPECT_TRUE(rooms.Contain({ 2, 3, 4, 5 }));
  EXPECT_TRUE(rooms.Contain({ 6, 7, 8, 9 }));
  EXPECT_FALSE(rooms.Contain({ 3, 4, 5, 6 })) << "in two rooms";
  EXPECT_FALSE(rooms.Contain({ 7, 8, 9, 10 })) << "partly in one";
  EXPECT_FALSE(rooms.Contain({ 12, 13, 14, 15 })) << "in none";
}

} // namespace
