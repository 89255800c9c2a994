// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ComplexOf.h"
#include "Optimisation/Tetrahedra/Rooms.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

using namespace voxplex;

namespace
{

constexpr std::uint32_t Length = 20;

/** The room of each vertex; the rooms' number stands for none. */
std::vector<std::uint32_t> RoomsOf(const std::vector<std::uint32_t>& cells, unsigned edges)
{
  return RoomsAround(checks::Strip(Length), cells, edges).OfVertex;
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
  EXPECT_EQ(RoomsAround(checks::Strip(Length), std::vector<std::uint32_t>{ 11, 2 }, 0).Number, 2u);
  EXPECT_EQ(RoomsAround(checks::Strip(Length), std::vector<std::uint32_t>{ 11, 2 }, 1).Number, 1u);
  EXPECT_EQ(RoomsAround(checks::Strip(Length), std::vector<std::uint32_t>{ 12, 2 }, 1).Number, 2u);
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
  const Rooms rooms = RoomsAround(checks::Strip(Length), std::vector<std::uint32_t>{ 2, 6 }, 0);
  ASSERT_EQ(rooms.Number, 2u);
  EXPECT_TRUE(rooms.Contain({ 2, 3, 4, 5 }));
  EXPECT_TRUE(rooms.Contain({ 6, 7, 8, 9 }));
  EXPECT_FALSE(rooms.Contain({ 3, 4, 5, 6 })) << "in two rooms";
  EXPECT_FALSE(rooms.Contain({ 7, 8, 9, 10 })) << "partly in one";
  EXPECT_FALSE(rooms.Contain({ 12, 13, 14, 15 })) << "in none";
}

} // namespace
