// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// FindLostLabels(), FindShrunkLabels(): volumes of a mesh made by hand against the voxels of an image.
#include "Quality/ShrunkLabels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

using namespace voxplex;

namespace
{

/** Layers of 10 x 10 voxels of 2 x 1 x 0.5, each with a label of its own. */
LabelImage<3> Layers(const std::vector<std::int32_t>& labels)
{
  const auto grid = GridGeometry<3>::Orthogonal(
    { 10, 10, static_cast<std::int64_t>(labels.size()) }, { 2.0, 1.0, 0.5 });
  std::vector<std::int32_t> voxels;
  for (const std::int32_t label : labels)
  {
    voxels.insert(voxels.end(), 100, label);
  }
  return LabelImage<3>::FromScalars<std::int32_t>(voxels, grid);
}

/** Adds `count` tetrahedra of the volume 10. */
void Add(SimplexMesh<3>& mesh, std::int64_t label, std::size_t count)
{
  const auto first = static_cast<std::uint32_t>(mesh.Points.size());
  for (const Point<3>& p : { Point<3>{ 0, 0, 0 }, { 6, 0, 0 }, { 0, 5, 0 }, { 0, 0, 2 } })
  {
    mesh.Points.push_back(p);
  }
  for (std::size_t k = 0; k < count; ++k)
  {
    mesh.Simplices.push_back({ first, first + 1, first + 2, first + 3 });
    mesh.Labels.push_back(label);
  }
}

TEST(ShrunkLabels, AreThoseThatLackATenthOfTheirVolume)
{
  const LabelImage<3> image = Layers({ 7, 2, 5, 40, 2, 9, 9 }); // volumes 100, 200, 100, 100, 200
  SimplexMesh<3> mesh;
  Add(mesh, 2, 18); // 0.9
  Add(mesh, 40, 1);
  Add(mesh, 7, 10);
  Add(mesh, 9, 19); // 0.95: not shrunk
  Add(mesh, 40, 2); // 0.3, the worst; 5 is lost
  for (const unsigned threads : { 1u, 3u })
  {
    const VolumeShares shares = FindShrunkLabels(mesh, image, ShrunkFraction, threads);
    ASSERT_EQ(shares.Shrunk.size(), 2u);
    EXPECT_EQ(shares.Shrunk[0].Label, 40);
    EXPECT_DOUBLE_EQ(shares.Shrunk[0].Fraction, 0.3);
    EXPECT_EQ(shares.Shrunk[1].Label, 2);
    EXPECT_DOUBLE_EQ(shares.Shrunk[1].Fraction, 0.9);
    EXPECT_DOUBLE_EQ(shares.All, 500.0 / 700.0);
  }
}

TEST(LostLabels, AreThoseWithVoxelsButWithoutElements)
{
  LabelImage<3> image = Layers({ 7, 2, 5, 40, 2 });
  SimplexMesh<3> mesh;
  Add(mesh, 2, 3);
  Add(mesh, 40, 1);
  Add(mesh, 2, 1);
  EXPECT_EQ(FindLostLabels(mesh, image), (std::vector<std::int64_t>{ 5, 7 }));
  for (std::int64_t y = 0; y < 10; ++y)
  {
    image.Relabel({ 0, y, 0 }, 10, 1); // the layer of 7 becomes one of 2
  }
  EXPECT_EQ(FindLostLabels(mesh, image), (std::vector<std::int64_t>{ 5 }));
}

TEST(ShrunkLabels, SpecksAreNotAmongThem)
{
  const auto grid = GridGeometry<3>::Orthogonal({ 4, 2, 2 }, { 10.0, 10.0, 10.0 });
  std::vector<std::int32_t> voxels(16, 1);
  voxels[5] = 0;
  std::fill(voxels.begin() + 8, voxels.end(), 2); // 7 voxels of 1, and 8 of 2
  const LabelImage<3> image = LabelImage<3>::FromScalars<std::int32_t>(voxels, grid);
  SimplexMesh<3> mesh;
  Add(mesh, 1, 1);
  Add(mesh, 2, 1);
  const std::vector<ShrunkLabel> shrunk = FindShrunkLabels(mesh, image).Shrunk;
  ASSERT_EQ(shrunk.size(), 1u);
  EXPECT_EQ(shrunk[0].Label, 2);
}

TEST(ShrunkLabels, ManyElementsInBlocks)
{
  const LabelImage<3> image = Layers({ 1, 3 });
  SimplexMesh<3> mesh;
  Add(mesh, 1, 100000);
  Add(mesh, 3, 4);
  Add(mesh, 1, 100000);
  const std::vector<ShrunkLabel> shrunk = FindShrunkLabels(mesh, image, ShrunkFraction, 2).Shrunk;
  ASSERT_EQ(shrunk.size(), 1u);
  EXPECT_EQ(shrunk[0].Label, 3);
  EXPECT_DOUBLE_EQ(shrunk[0].Fraction, 0.4);
}

} // namespace
