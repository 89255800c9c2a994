// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Space-time: components of the image and of frames, and interfaces far from the mesh.
#include "Conformity/DistanceCheck.h"
#include "Image/Components.h"
#include "Phantoms.h"
#include "Quality/LostComponents.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

using Index = GridGeometry<4>::Index;

GridGeometry<4> Voxels(std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t frames)
{
  return GridGeometry<4>::Orthogonal({ x, y, z, frames }, { 1.0, 1.0, 1.0, 1.0 });
}

/** Small balls that last for a few frames and move, each with a label of its own. */
LabelImage<4> Specks()
{
  struct Speck
  {
    std::array<double, 3> Start;
    std::array<double, 3> Step;
    double Radius;
    std::int64_t First;
    std::int64_t Last;
  };
  const std::vector<Speck> specks = { { { 6, 6, 6 }, { 0.5, 0.0, 0.3 }, 1.5, 0, 4 },
    { { 18, 6, 6 }, { 0.0, 0.7, 0.0 }, 2.0, 3, 3 }, { { 6, 18, 6 }, { 0.0, 0.0, 0.0 }, 1.5, 7, 9 },
    { { 18, 18, 6 }, { -0.6, 0.0, 0.4 }, 1.7, 2, 8 },
    { { 12, 12, 18 }, { 0.9, -0.9, 0.0 }, 1.5, 1, 5 } };
  return phantoms::OfVoxels(Voxels(24, 24, 24, 10),
    [&](const Index& v)
    {
      for (std::size_t s = 0; s < specks.size(); ++s)
      {
        const Speck& speck = specks[s];
        double distance2 = 0.0;
        for (std::size_t a = 0; a < 3; ++a)
        {
          const double centre =
            speck.Start[a] + speck.Step[a] * static_cast<double>(v[3] - speck.First);
          distance2 += (static_cast<double>(v[a]) - centre) * (static_cast<double>(v[a]) - centre);
        }
        if (v[3] >= speck.First && v[3] <= speck.Last && distance2 <= speck.Radius * speck.Radius)
        {
          return static_cast<std::uint8_t>(s + 1);
        }
      }
      return std::uint8_t{ 0 };
    });
}

MeshingStatistics MeshWith(
  const LabelImage<4>& image, const MeshingOptions<4>& options, SimplexMesh<4>& mesh)
{
  ImageMesher<4> mesher(options);
  EXPECT_EQ(mesher.Run(image, mesh), MeshingOutcome::Done);
  return mesher.Statistics();
}

/** Labels and frames that have voxels in the image, but no volume in the mesh. */
std::size_t CountMissing(const LabelImage<4>& image, const SimplexMesh<4>& mesh)
{
  std::size_t missing = 0;
  const std::int64_t frames = image.Grid().Dimensions[3];
  for (std::int64_t frame = 0; frame < frames; ++frame)
  {
    std::map<std::int64_t, double> there =
      SliceVolumes(mesh, static_cast<double>(frame) - (frame + 1 == frames ? 1e-9 : 0.0));
    for (const auto& [label, volume] : FrameVolumes(image, frame))
    {
      missing += label != 0 && volume >= 8.0 && !(there[label] > 0.0) ? 1 : 0;
    }
  }
  return missing;
}

/** The largest distance from a face between voxels of different labels to a vertex of a facet. */
double LargestDistance(const LabelImage<4>& image, const SimplexMesh<4>& mesh)
{
  std::vector<char> isUsed(mesh.Points.size(), 0);
  for (const auto& facet : mesh.Facets)
  {
    for (const std::uint32_t v : facet)
    {
      isUsed[v] = 1;
    }
  }
  double largest2 = 0.0;
  const Index& n = image.CropDimensions();
  Index v{};
  for (v[3] = 0; v[3] < n[3]; ++v[3])
  {
    for (v[2] = -1; v[2] < n[2]; ++v[2])
    {
      for (v[1] = -1; v[1] < n[1]; ++v[1])
      {
        for (v[0] = -1; v[0] < n[0]; ++v[0])
        {
          for (std::size_t a = 0; a < 4; ++a)
          {
            Index next = v;
            ++next[a];
            if (image.At(v) == image.At(next) || next[3] == n[3])
            {
              continue;
            }
            const Point<4> face = Interpolate(image.CentreOf(v), image.CentreOf(next), 0.5);
            double nearest2 = std::numeric_limits<double>::infinity();
            for (std::size_t p = 0; p < mesh.Points.size(); ++p)
            {
              nearest2 = isUsed[p] ? std::min(nearest2, Distance2(face, mesh.Points[p])) : nearest2;
            }
            largest2 = std::max(largest2, nearest2);
          }
        }
      }
    }
  }
  return std::sqrt(largest2);
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(SpaceTimeComponents, OfFramesAreJoinedInSpaceOnly)
{
  std::mt19937 random(3);
  const LabelImage<4> image = phantoms::OfVoxels(
    Voxels(9, 8, 7, 5), [&](const Index&) { return static_cast<std::uint8_t>(random() % 3 / 2); });
  const Components<4> whole(image);
  const Components<4> ofFrames(image, 2, {}, 3);
  EXPECT_EQ(whole.Extent(), 4u);
  EXPECT_EQ(ofFrames.Extent(), 3u);
  EXPECT_GT(ofFrames.All().size(), whole.All().size());
  const Index& n = image.CropDimensions();
  std::map<std::uint32_t, std::int64_t> frameOf;
  for (std::size_t k = 0; k < CountCells(n); ++k)
  {
    const Index v = IndexAt(k, n);
    const std::uint32_t own = ofFrames.At(v);
    if (own == Components<4>::None)
    {
      continue;
    }
    EXPECT_EQ(frameOf.emplace(own, v[3]).first->second, v[3]);
    for (std::size_t a = 0; a < 3; ++a)
    {
      Index next = v;
      ++next[a];
      EXPECT_TRUE(image.At(next) != image.At(v) || ofFrames.At(next) == own);
    }
  }
}

TEST(SpaceTimeComponents, OfFramesAreLookedForInTheCut)
{
  // Four components of one voxel: two in frame 2, one in frame 0 and one in frame 5.
  const LabelImage<4> image = phantoms::OfVoxels(Voxels(12, 12, 12, 6),
    [](const Index& v)
    {
      return static_cast<std::uint8_t>(v == Index{ 3, 3, 3, 2 } || v == Index{ 9, 9, 9, 2 } ||
        v == Index{ 3, 3, 3, 0 } || v == Index{ 3, 3, 3, 5 });
    });
  const Components<4> ofFrames(image, 1, {}, 3);
  ASSERT_EQ(ofFrames.All().size(), 4u); // in the order of frames
  SimplexMesh<4> mesh;
  mesh.Points = { { 2.5, 3.0, 3.0, 1.0 }, { 3.5, 3.0, 3.0, 3.0 }, { 3.0, 3.8, 3.0, 3.0 },
    { 3.0, 3.0, 3.8, 3.0 }, { 2.6, 2.6, 2.6, 3.0 } };
  mesh.Simplices = { { 0, 1, 2, 3, 4 } };
  mesh.Labels = { 1 };
  const std::vector<bool> all(4, true);
  EXPECT_EQ(
    FindLostComponents(ofFrames, image, mesh, all, 1), (std::vector<std::uint32_t>{ 0, 2, 3 }));
  mesh.Points[0][3] = -1e-12; // in the first frame it is a point
  EXPECT_EQ(
    FindLostComponents(ofFrames, image, mesh, all, 1), (std::vector<std::uint32_t>{ 0, 2, 3 }));
  mesh.Points[0][3] = -0.5; // in the first frame it is a tetrahedron
  EXPECT_EQ(
    FindLostComponents(ofFrames, image, mesh, all, 1), (std::vector<std::uint32_t>{ 2, 3 }));
  for (Point<4>& p : mesh.Points)
  {
    p[0] += 1.2; // beside the voxels, but no more than a voxel away
  }
  EXPECT_EQ(
    FindLostComponents(ofFrames, image, mesh, all, 1), (std::vector<std::uint32_t>{ 2, 3 }));
  mesh.Labels = { 2 };
  EXPECT_EQ(FindLostComponents(ofFrames, image, mesh, all, 1).size(), 4u);
}

//------------------------------------------------------------------------------------------------
TEST(SpaceTimeChecks, EveryComponentHasElementsInEveryFrame)
{
  const LabelImage<4> image = Specks();
  for (const double delta : { 2.0, 4.0, 6.0 })
  {
    SCOPED_TRACE(delta);
    MeshingOptions<4> options = SpaceTimeOptions(delta);
    SimplexMesh<4> mesh;
    const MeshingStatistics statistics = MeshWith(image, options, mesh);
    EXPECT_EQ(statistics.Components.Found, 5u);
    EXPECT_EQ(statistics.FrameComponents.Found, 21u);
    EXPECT_TRUE(statistics.Components.Lost.empty());
    EXPECT_TRUE(statistics.FrameComponents.Lost.empty());
    EXPECT_EQ(CountMissing(image, mesh), 0u);
    ExpectGood(mesh, image, { .FacetsOffInterface = 0.05, .VertexLinks = false });

    options.Components.Smallest = 0;
    options.Interfaces.Rounds = 0;
    options.Interfaces.Manifold = false; // takes a component's last pentatope at delta 2
    MeshWith(image, options, mesh);
    EXPECT_EQ(CountMissing(image, mesh) > 0, delta > 2.0) << "the check has nothing to do";
  }
}

TEST(SpaceTimeChecks, InterfacesAreNearThoseOfTheImage)
{
  // A fast ball, and a disc that turns.
  for (const bool isBall : { false, true })
  {
    SCOPED_TRACE(isBall);
    const LabelImage<4> image = phantoms::OfVoxels(Voxels(30, 30, 24, 16),
      [&](const Index& v)
      {
        const auto t = static_cast<double>(v[3]);
        const double x = static_cast<double>(v[0]) - (isBall ? 3.5 + 1.4 * t : 14.5);
        const double y =
          static_cast<double>(v[1]) - (isBall ? 15.0 + 8.0 * std::sin(t / 1.5) : 14.5);
        const double z = static_cast<double>(v[2]) - 11.5;
        const double off = std::abs(x * std::cos(0.2 * t) + y * std::sin(0.2 * t));
        return static_cast<std::uint8_t>(
          x * x + y * y + z * z <= (isBall ? 12.0 : 121.0) && (isBall || off <= 1.0));
      });
    MeshingOptions<4> options = SpaceTimeOptions(5.0);
    SimplexMesh<4> mesh;
    const MeshingStatistics statistics = MeshWith(image, options, mesh);
    const double limit = DistanceCheck<4>::LargestDistance * options.Sampling.Delta;
    EXPECT_GT(statistics.Interfaces.Rounds, 0u);
    EXPECT_LT(LargestDistance(image, mesh), limit);
    // Seeds of components, and vertices where triangles were opened, are off interfaces. Pieces of opened ones have
    // larger ratios.
    ExpectGood(mesh, image,
      { .RadiusEdge = statistics.Interfaces.NonManifoldOpened > 0 ? 2.5 : 2.0,
        .FacetsOffInterface = 0.09,
        .VertexLinks = false });

    options.Interfaces.Rounds = 0;
    options.Components.Smallest = 0;
    EXPECT_EQ(MeshWith(image, options, mesh).Interfaces.Rounds, 0u);
    EXPECT_GT(LargestDistance(image, mesh), limit) << "the check has nothing to do";
  }
}
