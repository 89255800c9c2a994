// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Where space is cut into tiles, and the lattice that makes circumballs small beside them.
#include "BallDomain.h"
#include "Geometry/Tiles.h"
#include "Refinement/Tiles/CoarseLattice.h"
#include "RefinementChecks.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace voxplex;

namespace
{

template <int D>
std::vector<TileItem<D>> RandomItems(std::size_t number, double size, double reach)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(0.0, size);
  std::vector<TileItem<D>> items(number);
  for (std::size_t i = 0; i < number; ++i)
  {
    for (double& x : items[i].Place)
    {
      x = coordinate(random);
    }
    items[i].Reach = reach;
    items[i].Number = static_cast<std::uint32_t>(3 * i);
  }
  return items;
}

/** The box in which the items are. */
template <int D>
Box<D> Cube()
{
  Box<D> box;
  box.Min.fill(0.0);
  box.Max.fill(100.0);
  return box;
}

/** Every item is in the tile that contains its place, and every point is in the one tile that is found. */
template <int D>
void ExpectPartition(const Tiling<D>& tiling, const std::vector<TileItem<D>>& items)
{
  const std::vector<Tile<D>>& tiles = tiling.Tiles;
  std::vector<int> times(items.size());
  for (const Tile<D>& tile : tiles)
  {
    for (const bool inside : { true, false })
    {
      const std::vector<std::uint32_t>& numbers = inside ? tile.Inside : tile.Across;
      EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
      for (const std::uint32_t i : numbers)
      {
        const TileItem<D>& item = items[i / 3];
        ASSERT_TRUE(tile.Extent.Contains(item.Place));
        ASSERT_EQ(tile.Extent.ContainsBall(item.Place, item.Reach), inside);
        ++times[i / 3];
      }
    }
  }
  EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](int n) { return n == 1; }));
  std::mt19937 random(6);
  std::uniform_real_distribution<double> coordinate(-50.0, 250.0);
  for (int k = 0; k < 1000; ++k)
  {
    const Point<D> p = checks::Drawn<D>([&] { return coordinate(random); });
    EXPECT_EQ(std::count_if(tiles.begin(), tiles.end(),
                [&](const Tile<D>& tile) { return tile.Extent.Contains(p); }),
      1);
    EXPECT_TRUE(tiles.at(tiling.TileAt(p)).Extent.Contains(p));
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(Tiles, CoverSpaceOnce)
{
  const auto items = RandomItems<3>(20000, 100.0, 1.0);
  const auto tiling = TileCutter<3>::Cut(items, Cube<3>());
  EXPECT_GE(tiling.Tiles.size(), 16u);
  ExpectPartition<3>(tiling, items);
  const auto items4 = RandomItems<4>(20000, 100.0, 1.0);
  const auto tiling4 = TileCutter<4>::Cut(items4, Cube<4>());
  EXPECT_GE(tiling4.Tiles.size(), 16u);
  ExpectPartition<4>(tiling4, items4);
}

TEST(Tiles, HaveAboutTheSameWork)
{
  const auto items = RandomItems<3>(20000, 100.0, 1.0);
  std::size_t most = 0;
  const auto tiles = TileCutter<3>::Cut(items, Cube<3>()).Tiles;
  for (const Tile<3>& tile : tiles)
  {
    most = std::max(most, tile.Inside.size() + tile.Across.size());
  }
  EXPECT_LT(most, 3 * items.size() / tiles.size());
}

// With balls as large as this, most would be in the way of any plane.
TEST(Tiles, AreNotCutWhereMostItemsAreInTheWay)
{
  const auto items = RandomItems<3>(20000, 100.0, 30.0);
  EXPECT_EQ(TileCutter<3>::Cut(items, Cube<3>()).Tiles.size(), 1u);
  EXPECT_EQ(TileCutter<3>::Whole(items).Tiles.size(), 1u);
  ExpectPartition<3>(TileCutter<3>::Whole(items), items);
  const double largest = TileCutter<3>::LargestReach(items, Cube<3>());
  EXPECT_GT(largest, 2.0);
  EXPECT_LT(largest, 30.0);
  EXPECT_GE(
    TileCutter<3>::Cut(RandomItems<3>(20000, 100.0, 0.9 * largest), Cube<3>()).Tiles.size(), 2u);
  EXPECT_EQ(TileCutter<3>::Cut(RandomItems<3>(100, 100.0, 0.01), Cube<3>()).Tiles.size(), 1u)
    << "too few";
}

// What was put off lies along the planes of the last tiling. The next planes must be elsewhere.
TEST(Tiles, AreCutElsewhereTheNextTime)
{
  std::vector<TileItem<3>> items = RandomItems<3>(20000, 100.0, 2.0);
  std::size_t passes = 0;
  while (items.size() > 500 && passes < 20)
  {
    const auto tiles = TileCutter<3>::Cut(items, Cube<3>()).Tiles;
    std::vector<TileItem<3>> left;
    for (const Tile<3>& tile : tiles)
    {
      for (const std::uint32_t i : tile.Across)
      {
        left.push_back(items[i / 3]);
      }
    }
    items = left;
    for (std::size_t i = 0; i < items.size(); ++i)
    {
      items[i].Number = static_cast<std::uint32_t>(3 * i);
    }
    ++passes;
  }
  EXPECT_LE(passes, 6u);
}

// The circumcentres of flat simplices on the box.
TEST(Tiles, AreCutWhereTheItemsAreDespiteOutliers)
{
  auto items = RandomItems<3>(20000, 100.0, 1.0);
  items[0].Place = { 1e9, -1e9, 1e17 };
  items[1].Place = { -1e17, 50.0, 50.0 };
  items[0].Reach = items[1].Reach = 1e18;
  const auto tiling = TileCutter<3>::Cut(items, Cube<3>());
  EXPECT_GE(tiling.Tiles.size(), 16u);
  ExpectPartition<3>(tiling, items);
  EXPECT_LT(TileCutter<3>::LargestReach(items, Cube<3>()), 100.0);
}

TEST(Tiles, ItemsInOnePlaceAreNotCut)
{
  std::vector<TileItem<3>> items(5000, TileItem<3>{ { 1.0, 2.0, 3.0 }, 0.0, 0 });
  for (std::size_t i = 0; i < items.size(); ++i)
  {
    items[i].Number = static_cast<std::uint32_t>(3 * i);
  }
  const auto tiles = TileCutter<3>::Cut(items, Cube<3>()).Tiles;
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_EQ(tiles[0].Inside.size(), items.size());
}

//------------------------------------------------------------------------------------------------
TEST(CoarseLattice, LiesInTheBoxAndOnItsFaces)
{
  const checks::BallDomain ball(20.0);
  RefinementContext<3> context(ball, checks::SettingsFor<3>(1.0), checks::Around(ball, 1.0), 1000);
  const Box<3>& box = context.Mesh.GetBox();
  const auto nodes = MakeCoarseLattice(context, 5.0, 1.5, 1);
  std::size_t onFaces = 0;
  for (const LatticeNode<3>& node : nodes)
  {
    ASSERT_TRUE(box.Contains(node.Position));
    ASSERT_GE(ball.DistanceBound(node.Position), 1.5);
    bool isOnFace = false;
    for (std::size_t a = 0; a < 3; ++a)
    {
      isOnFace |= node.Position[a] == box.Min[a] || node.Position[a] == box.Max[a];
    }
    ASSERT_EQ(node.Kind == VertexKind::Box, isOnFace);
    onFaces += isOnFace ? 1 : 0;
  }
  EXPECT_GT(onFaces, 20u);
  EXPECT_GT(nodes.size(), onFaces + 100);

  const auto again = MakeCoarseLattice(context, 5.0, 1.5, 4);
  ASSERT_EQ(again.size(), nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    ASSERT_EQ(again[i].Position, nodes[i].Position);
  }
}

TEST(CoarseLattice, BoundsCircumballsNearInterfaces)
{
  const checks::BallDomain ball(40.0);
  RefinementContext<3> context(ball, checks::SettingsFor<3>(1.0), checks::Around(ball, 1.0), 1000);
  RefinementWorker<3> worker(context);
  const auto nodes = MakeCoarseLattice(context, 5.0, 1.5, 1);
  InsertCoarseLattice(context, worker, nodes);
  checks::ExpectSound(context.Mesh);
  std::size_t near = 0;
  std::size_t farther = 0;
  for (const SimplexId s : checks::AliveIn(context.Mesh))
  {
    const Circumball<3> circumball = context.Mesh.GetCircumball(s);
    const double radius = std::sqrt(circumball.Radius2);
    const double distance = ball.DistanceBound(circumball.Center);
    near += distance < radius ? 1 : 0;
    ASSERT_LT(radius, distance < 5.0 ? 10.0 : 40.0);
    farther += distance > 20.0 && radius > 8.0 ? 1 : 0;
  }
  EXPECT_GT(near, 1000u);
  EXPECT_GT(farther, 10u) << "far from interfaces the lattice is coarser";
}
