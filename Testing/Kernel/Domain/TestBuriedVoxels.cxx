// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Tips that smoothing would take away: which voxels they are, and what the label field makes of them.
#include "Domain/BuriedVoxels.h"
#include "Domain/LabelField.h"
#include "Phantoms.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace voxplex;

namespace
{

constexpr double Sigma = 1.0;
constexpr std::int64_t Cells = 30;

/** A rod along x, an L of three voxels across, whose ends are one voxel. A slot of the AAL atlas is like this. */
bool IsInRod(const Point<3>& p, double begin, double end)
{
  const bool isMiddle = p[1] == 14 && p[2] == 14;
  const bool isL = isMiddle || (p[1] == 14 && p[2] == 15) || (p[1] == 15 && p[2] == 14);
  return (isMiddle && p[0] >= begin && p[0] <= end) ||
    (isL && p[0] >= begin + 1 && p[0] <= end - 1);
}

/** A slab of label 1 with a rod that sticks out; or that much of it, empty, in a slab. */
LabelImage<3> Image(bool isSlot, std::int64_t cells = Cells)
{
  return phantoms::Make(phantoms::Cube(cells),
    [isSlot](const Point<3>& p) -> std::int16_t
    {
      const bool isInSlab = p[0] >= 4 && p[0] <= (isSlot ? 24 : 14);
      const bool isInRod = isSlot ? IsInRod(p, 19, 24) : IsInRod(p, 15, 20);
      return isInSlab != isInRod ? 1 : 0;
    });
}

/** How far a label reaches from p along each axis, in both directions, at least. */
double ReachOf(const LabelField<3>& field, const Point<3>& p, LabelId label)
{
  double least = 1.0;
  for (std::size_t a = 0; a < 3; ++a)
  {
    for (const double sign : { -1.0, 1.0 })
    {
      double reach = 0.0;
      Point<3> q = p;
      while (reach < 1.0 && field.Label(q) == label)
      {
        reach += 0.01;
        q[a] = p[a] + sign * reach;
      }
      least = std::min(least, reach);
    }
  }
  return least;
}

} // namespace

TEST(BuriedVoxels, TipsOfProcessesReachTheirEnds)
{
  for (const bool isSlot : { false, true })
  {
    const LabelField<3> field(Image(isSlot), Sigma);
    const double tip = isSlot ? 19.0 : 20.0;
    for (const double x : { tip, isSlot ? 20.0 : 19.0 })
    {
      EXPECT_GT(ReachOf(field, { x, 14.0, 14.0 }, isSlot ? 0 : 1), 0.25) << isSlot << ' ' << x;
    }
  }
}

// The place of tiles and the border of the crop make no difference.
TEST(BuriedVoxels, DoNotDependOnTiles)
{
  for (std::int64_t shift = 0; shift < 8; ++shift)
  {
    const LabelField<3> field(phantoms::Make(phantoms::Cube(40),
                                [shift](const Point<3>& p) -> std::int16_t
                                {
                                  const double x = p[0] - static_cast<double>(shift);
                                  const double y = p[1] - static_cast<double>(shift);
                                  const bool isInSlab = x >= 4 && x <= 14 && p[2] > 2 && y < 25;
                                  return isInSlab || IsInRod({ x, y, p[2] }, 15, 20) ? 1 : 0;
                                }),
      Sigma);
    const auto s = static_cast<double>(shift);
    EXPECT_GT(ReachOf(field, { 20.0 + s, 14.0 + s, 14.0 }, 1), 0.25) << shift;
  }
}

TEST(BuriedVoxels, BumpsAndFlatFacesAreSmoothed)
{
  const auto image = phantoms::Make(phantoms::Cube(Cells),
    [](const Point<3>& p) -> std::int16_t
    {
      const bool isBump = p[0] == 15 && p[1] == 14 && p[2] == 14;
      return (p[0] >= 4 && p[0] <= 14) || isBump ? 1 : 0;
    });
  const LabelField<3> field(image, Sigma);
  EXPECT_LT(ReachOf(field, { 15.0, 14.0, 14.0 }, 1), 0.1);

  const LabelImage<3> ball = phantoms::Ball(9.0);
  std::vector<WeakVoxel> weak = { { 5, true }, { 7, false } };
  EXPECT_TRUE(FindBuriedVoxels(ball, {}, 1, {}).empty());
  // Two lost voxels of background in a corner have neighbours that are not weak.
  EXPECT_TRUE(FindBuriedVoxels(ball, weak, 1, {}).empty());
}

TEST(BuriedVoxels, AreThoseWithoutASolidNeighbour)
{
  const LabelImage<3> image = Image(false);
  const auto n = image.CropDimensions();
  const auto sampleOf = [&](std::int64_t x, std::int64_t y, std::int64_t z)
  {
    const auto lattice = [&](std::int64_t i, std::size_t a)
    { return static_cast<std::uint64_t>(i - image.CropOrigin()[a] + 1); };
    return lattice(x, 0) +
      static_cast<std::uint64_t>(n[0] + 2) *
      (lattice(y, 1) + static_cast<std::uint64_t>(n[1] + 2) * lattice(z, 2));
  };
  std::vector<WeakVoxel> weak;
  for (std::int64_t x = 18; x <= 19; ++x)
  {
    weak.push_back({ sampleOf(x, 14, 15), true });
    weak.push_back({ sampleOf(x, 15, 14), true });
    weak.push_back({ sampleOf(x, 14, 14), false });
  }
  weak.push_back({ sampleOf(20, 14, 14), true });
  weak.push_back(weak.front());
  // At x = 18 the rod goes on with solid voxels. So those at 19 and 20 are buried, and the ones at 18 lie around them.
  for (const unsigned threads : { 1u, 4u })
  {
    const auto buried = FindBuriedVoxels(image, weak, threads, {});
    ASSERT_EQ(buried.size(), 7u);
    EXPECT_TRUE(std::is_sorted(buried.begin(), buried.end()));
    EXPECT_EQ(buried.front()[0], 18 - image.CropOrigin()[0] + 1);
  }
  std::erase_if(weak, [&](const WeakVoxel& voxel) { return voxel.Sample == sampleOf(20, 14, 14); });
  // The end of the rod is solid now, and nothing is two voxels away from a solid one.
  EXPECT_TRUE(FindBuriedVoxels(image, weak, 1, {}).empty());
}
