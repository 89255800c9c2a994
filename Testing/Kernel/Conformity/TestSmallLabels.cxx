// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Labels of a voxel or a few are in the mesh, however large delta is.
#include "Image/Components.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Mesher/ImageMesher.h"
#include "Phantoms.h"
#include "Quality/LostComponents.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

using namespace voxplex;

namespace
{

using Index = GridGeometry<3>::Index;

/** A shape of `voxels` voxels that are connected through faces. */
std::set<Index> Shape(std::size_t voxels, std::mt19937& random)
{
  std::set<Index> shape{ { 0, 0, 0 } };
  while (shape.size() < voxels)
  {
    auto member = shape.begin();
    std::advance(member, static_cast<std::ptrdiff_t>(random() % shape.size()));
    Index next = *member;
    next[random() % 3] += random() % 2 == 0 ? 1 : -1;
    shape.insert(next);
  }
  return shape;
}

/**
 * 27 labels from 10 on, of 1 to 7 voxels.
 * @param around the label of all other voxels; 0: background
 */
LabelImage<3> Specks(unsigned seed, std::int16_t around, const Point<3>& spacing)
{
  constexpr std::int64_t Apart = 9;
  std::mt19937 random(seed);
  std::map<Index, std::int16_t> specks;
  for (std::int64_t k = 0; k < 27; ++k)
  {
    for (const Index& voxel : Shape(1 + static_cast<std::size_t>(k) % 7, random))
    {
      specks[{ Apart * (k % 3) + 6 + voxel[0], Apart * (k / 3 % 3) + 6 + voxel[1],
        Apart * (k / 9) + 6 + voxel[2] }] = static_cast<std::int16_t>(10 + k);
    }
  }
  std::vector<std::int16_t> scalars;
  constexpr std::int64_t N = 3 * Apart + 4;
  for (std::int64_t at = 0; at < N * N * N; ++at)
  {
    const auto found = specks.find({ at % N, at / N % N, at / N / N });
    scalars.push_back(found == specks.end() ? around : found->second);
  }
  return LabelImage<3>::FromScalars<std::int16_t>(
    scalars, GridGeometry<3>::Orthogonal({ N, N, N }, spacing));
}

/** Of all labels of the image none is missing, and the statistics say so. */
void ExpectAllLabels(
  const LabelImage<3>& image, const MeshingOptions<3>& options, const std::string& name)
{
  SCOPED_TRACE(name);
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = checks::MeshOf(image, options, &statistics);
  checks::ExpectSound(mesh);
  const std::set<std::int64_t> labels(mesh.Labels.begin(), mesh.Labels.end());
  EXPECT_EQ(labels.size(), static_cast<std::size_t>(image.NumberOfLabels()));
  EXPECT_TRUE(statistics.Components.Lost.empty());
  const Components<3> components(image);
  EXPECT_TRUE(FindLostComponents(components, image, mesh, components.FindWanted(1000), 1).empty());
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(SmallLabels, TheLargestComponentOfEachIsWanted)
{
  // Label 1: 3 and 2 voxels; label 2: 1, 1 and 1; label 5: 4.
  std::vector<std::uint8_t> scalars(10 * 4 * 4, 0);
  const auto set = [&](std::size_t x, std::size_t y, std::size_t length, std::uint8_t label)
  { std::fill_n(scalars.begin() + static_cast<std::ptrdiff_t>((y * 4) * 10 + x), length, label); };
  set(0, 0, 2, 1);
  set(4, 0, 1, 2);
  set(6, 0, 3, 1);
  set(0, 1, 1, 2);
  set(8, 2, 1, 2);
  set(2, 3, 4, 5);
  const auto image = LabelImage<3>::FromScalars<std::uint8_t>(
    scalars, GridGeometry<3>::Orthogonal({ 10, 4, 4 }, { 1.0, 1.0, 1.0 }));
  const Components<3> components(image);
  const auto voxelsOf = [&](std::int64_t fewest)
  {
    const std::vector<bool> wanted = components.FindWanted(fewest);
    std::vector<std::array<std::int64_t, 2>> found;
    for (std::size_t c = 0; c < wanted.size(); ++c)
    {
      if (wanted[c])
      {
        const Component<3>& component = components.All()[c];
        found.push_back({ image.Values()[component.Label], component.First[0] });
      }
    }
    return found;
  };
  using List = std::vector<std::array<std::int64_t, 2>>;
  EXPECT_EQ(voxelsOf(8), (List{ { 2, 4 }, { 1, 6 }, { 5, 2 } })) << "the first of several";
  EXPECT_EQ(voxelsOf(2), (List{ { 1, 0 }, { 2, 4 }, { 1, 6 }, { 5, 2 } }));
  EXPECT_EQ(voxelsOf(1).size(), components.All().size());
}

//------------------------------------------------------------------------------------------------
TEST(SmallLabels, AreInTheMesh)
{
  unsigned seed = 1;
  for (const std::int16_t around : { 0, 1 })
  {
    for (const double delta : { 0.8, 2.0, 5.0, 60.0 })
    {
      const Point<3> spacing =
        seed % 2 == 0 ? Point<3>{ 1.0, 1.0, 1.0 } : Point<3>{ 0.5, 1.0, 1.7 };
      const LabelImage<3> image = Specks(seed++, around, spacing);
      MeshingOptions<3> options = checks::WithDelta<3>(delta);
      const std::string name = std::to_string(delta) + " in " + std::to_string(around);
      ExpectAllLabels(image, options, name);
      options.Optimisation.Run = true;
      ExpectAllLabels(image, options, name + ", optimised");
      options.Sampling.Grading.Mode = GradingMode::LocalFeatureSize;
      ExpectAllLabels(image, options, name + ", graded");
    }
  }
}

// Voxels with one neighbour of their label along each axis are in no block: what they join is thin.
TEST(SmallLabels, OfAThreeLeggedShapeIsInTheMesh)
{
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(12),
    [](const Point<3>& p) -> std::int16_t
    {
      const Point<3> d = Subtract(p, { 5.0, 5.0, 5.0 });
      return Dot(d, d) < 1.5 && d[0] >= 0.0 && d[1] >= 0.0 && d[2] >= 0.0 ? 3 : 0;
    });
  EXPECT_EQ(image.Counts()[1], 4);
  for (const double delta : { 0.5, 1.5, 4.0 })
  {
    MeshingOptions<3> options = checks::WithDelta<3>(delta);
    ExpectAllLabels(image, options, std::to_string(delta));
  }
}

// Without the guarantee, a label of one voxel has no element in a coarse mesh.
TEST(SmallLabels, AreLeftToChanceOnRequest)
{
  const LabelImage<3> image = Specks(9, 1, { 1.0, 1.0, 1.0 });
  MeshingOptions<3> options = checks::WithDelta<3>(12.0);
  options.Components.Smallest = 0;
  options.Interfaces.Rounds = 0;
  options.Interfaces.SampleJunctions = false;
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = checks::MeshOf(image, options, &statistics);
  EXPECT_LT(std::set<std::int64_t>(mesh.Labels.begin(), mesh.Labels.end()).size(), 20u);
  EXPECT_EQ(statistics.Components.Found, 0u);
}
