// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Pieces of components are joined or get the label beside them, and thin components hold together if they are to be exact.
#include "Base/DisjointSets.h"
#include "Base/Error.h"
#include "ComplexOf.h"
#include "Conformity/InterfaceVertices.h"
#include "Conformity/NonManifoldRidges.h"
#include "Conformity/PieceJoints.h"
#include "Domain/ImageDomain.h"
#include "Geometry/SimplexQuality.h"
#include "Image/Components.h"
#include "InterfaceChecks.h"
#include "MeshRuns.h"
#include "Mesher/ImageMesher.h"
#include "Optimisation/OpenRidges.h"
#include "Phantoms.h"
#include "Quality/ComponentPieces.h"
#include "RefinementChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

//------------------------------------------------------------------------------------------------
/** A refined triangulation with the labels at circumcentres. */
struct LabelledMesh
{
  LabelledMesh(const LabelImage<3>& image, double delta)
    : Image(image)
    , Surfaces(this->Image, 1.0)
    , Context(Refined(this->Surfaces, delta))
    , Labels(LabelSimplices<3>(this->Context->Mesh, this->Surfaces))
  {
    MarkInterfaceVertices<3>(this->Context->Mesh, this->Labels, 1, {});
  }

  const Triangulation<3>& Mesh() const { return this->Context->Mesh; }
  const auto& NeighboursOf(SimplexId s) const { return this->Mesh().GetSimplex(s).N; }

  JoinedPieces<3> Join(
    GapOptions gaps, const std::stop_token& stop = {}, bool mayRelabel = true, bool wants = true)
  {
    const Components<3> components(this->Image);
    ManifoldRepairOptions<3> options;
    options.Surfaces = &this->Surfaces;
    options.Kept.emplace(KeptComponents<3>{ components, this->Image,
      wants ? components.FindWanted(8) : std::vector<bool>(components.All().size()) });
    options.Keeps = [mayRelabel](SimplexId) { return !mayRelabel; };
    return JoinPieces<3>(this->Mesh(), this->Labels, options, gaps, 2, stop);
  }

  /** The number of pieces beside the first of each component. */
  std::size_t LoosePieces() const
  {
    const Components<3> components(this->Image);
    const LabelledTriangulation<3> elements(this->Mesh(), this->Labels);
    const ComponentPieces<3> pieces(elements, components, this->Image);
    std::set<std::uint32_t> held;
    for (const auto& piece : pieces.All())
    {
      held.insert(piece.Component);
    }
    return pieces.All().size() - held.size();
  }

  LabelImage<3> Image;
  const ImageDomain<3> Surfaces;
  const std::unique_ptr<RefinementContext<3>> Context;
  SimplexLabels Labels;
};

//------------------------------------------------------------------------------------------------
/** A block with four wavy rods, less than three voxels thick: much thinner than the block. */
LabelImage<3> BlockWithRods()
{
  const std::pair<double, double> rods[] = { { 12.0, 12.0 }, { 30.0, 14.0 }, { 14.0, 32.0 },
    { 34.0, 34.0 } };
  return phantoms::Make(phantoms::Cube(48),
    [&](const Point<3>& p) -> std::int16_t
    {
      const auto [x, y, z] = p;
      bool inside = x > 4 && x < 28 && y > 4 && y < 44 && z > 4 && z < 44;
      for (const auto& [cy, cz] : rods)
      {
        const double dy = y - cy - 3.0 * std::sin(x / 4.0);
        const double dz = z - cz - 3.0 * std::cos(x / 5.0);
        inside = inside || (x >= 28 && x < 46 && dy * dy + dz * dz < 1.3 * 1.3);
      }
      return inside ? 1 : 0;
    });
}

/** The number of fragments of a mesh of one label. */
std::size_t NumberOfFragments(const SimplexMesh<3>& mesh)
{
  DisjointSets sets(mesh.Simplices.size());
  std::map<std::set<std::uint32_t>, std::uint32_t> beside;
  for (std::uint32_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      std::set<std::uint32_t> face(mesh.Simplices[s].begin(), mesh.Simplices[s].end());
      face.erase(mesh.Simplices[s][i]);
      const auto [other, isNew] = beside.emplace(face, s);
      if (!isNew)
      {
        sets.Join(s, other->second);
      }
    }
  }
  std::set<std::uint32_t> names;
  for (std::uint32_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    names.insert(sets.Find(s));
  }
  return names.size();
}

std::size_t FragmentsOfBlockWithRods(bool exact)
{
  MeshingOptions<3> options = WithDelta<3>(6.0);
  options.Components.Exact = exact;
  const SimplexMesh<3> mesh = MeshOf(BlockWithRods(), options);
  const std::size_t number = NumberOfFragments(mesh);
  EXPECT_EQ(CountFragments(mesh), (std::map<std::int64_t, std::uint64_t>{ { 1, number } }));
  return number;
}

using Voxels = std::set<GridGeometry<3>::Index>;

/** A straight row of 40 voxels along an axis. */
Voxels Row(std::size_t axis)
{
  Voxels voxels;
  for (std::int64_t i = 0; i < 40; ++i)
  {
    GridGeometry<3>::Index voxel = { 4, 4, 4 };
    voxel[axis] += i;
    voxels.insert(voxel);
  }
  return voxels;
}

/** Steps of one voxel along some axes in turn. */
Voxels Stairs(const std::vector<std::size_t>& axes)
{
  Voxels voxels;
  GridGeometry<3>::Index voxel = { 4, 4, 4 };
  for (std::size_t i = 0; i < 40; ++i)
  {
    voxels.insert(voxel);
    ++voxel[axes[i % axes.size()]];
  }
  return voxels;
}

/** A closed ring of voxels that are connected through faces. */
Voxels Ring()
{
  Voxels voxels;
  GridGeometry<3>::Index last = { 22, 13, 5 };
  for (int i = 0; i <= 2000; ++i)
  {
    const double angle = 0.001 * std::numbers::pi * i;
    const GridGeometry<3>::Index next = { std::llround(13.0 + 9.0 * std::cos(angle)),
      std::llround(13.0 + 9.0 * std::sin(angle)), 5 };
    voxels.insert({ next[0], last[1], 5 });
    voxels.insert(next);
    last = next;
  }
  return voxels;
}

/** A ball with a row of voxels that ends in it. */
Voxels BallWithRow()
{
  Voxels voxels;
  for (std::int64_t k = 0; k < 21 * 21 * 21; ++k)
  {
    const GridGeometry<3>::Index voxel = { k % 21, k / 21 % 21, k / 441 };
    const auto square = [](std::int64_t x) { return (2 * x - 21) * (2 * x - 21); };
    if (square(voxel[0]) + square(voxel[1]) + square(voxel[2]) < 4 * 64)
    {
      voxels.insert(voxel);
    }
  }
  for (std::int64_t x = 10; x < 45; ++x)
  {
    voxels.insert({ x, 10, 10 });
  }
  return voxels;
}

/** Label 1 at these voxels, in background or in a block of label 2. */
LabelImage<3> ImageOf(const Voxels& voxels, std::uint8_t around, const Point<3>& spacing)
{
  GridGeometry<3>::Index n = { 0, 0, 0 };
  for (const auto& voxel : voxels)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      n[a] = std::max(n[a], voxel[a] + 5);
    }
  }
  return phantoms::OfVoxels(GridGeometry<3>::Orthogonal(n, spacing),
    [&](const auto& voxel) { return voxels.contains(voxel) ? 1 : around; });
}

/** Meshes an image. Each component must be in the mesh, and broken ones must be listed. */
SimplexMesh<3> MeshListed(const LabelImage<3>& image, const MeshingOptions<3>& options,
  std::vector<BrokenComponent>& broken)
{
  MeshingStatistics statistics;
  SimplexMesh<3> mesh = MeshOf(image, options, &statistics);
  EXPECT_TRUE(statistics.Components.Lost.empty());
  broken = statistics.Components.Broken;
  return mesh;
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(PieceJoints, JoinOrGiveAwayWhatIsLoose)
{
  std::size_t found = 0;
  std::size_t loose = 0;
  std::size_t left = 0; // some must keep angles good
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    LabelledMesh blobs(Blobs(seed), 5.0);
    const SimplexLabels before = blobs.Labels;
    loose += blobs.LoosePieces();
    const std::vector<SimplexId> changed = blobs.Join({ 1e9 }).Relabelled;
    left += blobs.LoosePieces();
    found += changed.size();
    for (SimplexId s = 0; s < before.size(); ++s)
    {
      const bool isChanged = std::binary_search(changed.begin(), changed.end(), s);
      EXPECT_EQ(blobs.Labels[s] != before[s], isChanged);
      const auto& n = blobs.NeighboursOf(s);
      EXPECT_TRUE(!isChanged ||
        std::any_of(n.begin(), n.end(),
          [&](SimplexId t) { return t != None && blobs.Labels[t] == blobs.Labels[s]; }));
    }
  }
  EXPECT_GT(found, 10u);
  EXPECT_LE(4 * left, loose);
}

// Pieces of components that nobody wants are not joined.
TEST(PieceJoints, GiveAwayWhatIsSmall)
{
  std::size_t loose = 0;
  std::size_t left = 0;
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    LabelledMesh blobs(Blobs(seed), 5.0);
    loose += blobs.LoosePieces();
    EXPECT_TRUE(blobs.Join({}, {}, true, false).Gaps.empty());
    left += blobs.LoosePieces();
  }
  EXPECT_LT(2 * left, loose);
}

TEST(PieceJoints, TellGapsOfLargePieces)
{
  LabelledMesh blobs(Blobs(6), 5.0);
  EXPECT_TRUE(blobs.Join({ 1e9 }, {}, false).Gaps.empty());
  EXPECT_GE(blobs.Join({}, {}, false).Gaps.size(), blobs.LoosePieces());
  EXPECT_GT(blobs.LoosePieces(), 0u);
}

TEST(PieceJoints, CanBeStopped)
{
  LabelledMesh blobs(Blobs(1), 5.0);
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW(blobs.Join({}, source.get_token()), Cancelled);
}

//------------------------------------------------------------------------------------------------
TEST(CountFragments, OfEachLabel)
{
  // Two tetrahedra with a common face, one that shares an edge with them, and one of another label
  // with a common face.
  SimplexMesh<3> mesh;
  mesh.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 1, 1 }, { -1, 0, 0 },
    { 0, -1, 0 } };
  mesh.Simplices = { { 0, 1, 2, 3 }, { 4, 2, 1, 3 }, { 0, 3, 5, 6 }, { 0, 2, 5, 3 } };
  mesh.Labels = { 7, 7, 7, 2 };
  using Numbers = std::map<std::int64_t, std::uint64_t>;
  EXPECT_EQ(CountFragments(mesh), (Numbers{ { 2, 1 }, { 7, 2 } }));
  mesh.Labels[3] = 7;
  EXPECT_EQ(CountFragments(mesh), (Numbers{ { 7, 1 } }));
  EXPECT_TRUE(CountFragments(SimplexMesh<3>()).empty());
}

//------------------------------------------------------------------------------------------------
TEST(Pieces, ThinPartsHoldTogether)
{
  const LabelImage<3> image = BlockWithRods();
  ASSERT_EQ(Components<3>(image).All().size(), 1u);
  EXPECT_EQ(FragmentsOfBlockWithRods(false), 1u);
  EXPECT_EQ(FragmentsOfBlockWithRods(true), 1u);
}

//------------------------------------------------------------------------------------------------
// What is one voxel thick, with sampling distances below and above.
TEST(Pieces, VesselsOfAVoxelHoldTogetherIfTheyAreToBeExact)
{
  const std::pair<const char*, Voxels> vessels[] = { { "x", Row(0) }, { "y", Row(1) },
    { "z", Row(2) }, { "in a plane", Stairs({ 0, 1 }) }, { "in space", Stairs({ 0, 1, 2 }) },
    { "ring", Ring() }, { "from a ball", BallWithRow() } };
  for (const auto& [name, voxels] : vessels)
  {
    for (const Point<3>& spacing : { Point<3>{ 1.0, 1.0, 1.0 }, { 0.5, 0.5, 1.5 } })
    {
      for (const std::uint8_t around : { 0, 2 })
      {
        const LabelImage<3> image = ImageOf(voxels, around, spacing);
        for (const double delta : { 1.0, 2.0, 8.0 })
        {
          MeshingOptions<3> options = WithDelta<3>(delta);
          options.Components.Exact = true;
          std::vector<BrokenComponent> broken;
          const SimplexMesh<3> mesh = MeshListed(image, options, broken);
          const std::string of = std::string(name) + " in " + std::to_string(around) + ", delta " +
            std::to_string(delta) + ", spacing " + std::to_string(spacing[2]);
          EXPECT_EQ(CountFragments(mesh).at(1), 1u) << of;
          EXPECT_TRUE(broken.empty()) << of;
        }
      }
    }
  }
}

//------------------------------------------------------------------------------------------------
TEST(ComponentPieces, OfALabelWithOneComponentBelongToItWhereverTheyAre)
{
  std::vector<std::uint8_t> labels(8 * 8 * 8, 0);
  labels[0] = 1;
  const auto image = LabelImage<3>::FromScalars<std::uint8_t>(
    labels, GridGeometry<3>::Orthogonal({ 8, 8, 8 }, { 1, 1, 1 }));
  SimplexMesh<3> mesh;
  for (const double x : { 0.0, 6.0 })
  {
    const auto first = static_cast<std::uint32_t>(mesh.Points.size());
    for (const Point<3>& p : { Point<3>{ x, 0, 0 }, { x + 1, 0, 0 }, { x, 1, 0 }, { x, 0, 1 } })
    {
      mesh.Points.push_back(p);
    }
    mesh.Simplices.push_back({ first, first + 1, first + 2, first + 3 });
    mesh.Labels.push_back(1);
  }
  const ComponentPieces<3> pieces(ComplexOf<3>(mesh).Elements(), Components<3>(image), image);
  ASSERT_EQ(pieces.All().size(), 2u);
  EXPECT_EQ(pieces.All()[0].Component, 0u);
  EXPECT_EQ(pieces.All()[1].Component, 0u);
}

// A piece across two components belongs to the one with most of it, whether all elements are looked at or some.
TEST(ComponentPieces, AreToldBySomeOfManyElements)
{
  TetrahedralComplex strip = Strip(5000); // along z, from 0 to 1500
  for (Point<3>& p : strip.Points)
  {
    p = { p[0] + 2.0, p[1] + 2.0, p[2] };
  }
  for (const std::int64_t gap : { 500, 1000 })
  {
    const auto grid = GridGeometry<3>::Orthogonal({ 5, 5, 1510 }, { 1.0, 1.0, 1.0 });
    std::vector<std::uint8_t> voxels(5 * 5 * 1510, 1);
    std::fill_n(voxels.begin() + 25 * gap, 25, std::uint8_t{ 0 });
    const LabelImage<3> image = LabelImage<3>::FromScalars<std::uint8_t>(voxels, grid);
    const Components<3> components(image);
    ASSERT_EQ(components.All().size(), 2u);
    const ComponentPieces<3> all(strip.Elements(), components, image);
    const ComponentPieces<3> some(strip.Elements(), components, image, PieceShares::OfSome);
    ASSERT_EQ(all.All().size(), 1u);
    ASSERT_EQ(some.All().size(), 1u);
    const std::uint32_t larger = gap == 500 ? 1 : 0;
    EXPECT_EQ(all.All()[0].Component, larger);
    EXPECT_EQ(some.All()[0].Component, larger);
    ASSERT_EQ(some.All()[0].Shares.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) // of 5,000 elements every fourth
    {
      const double whole = all.All()[0].Shares[k].second;
      EXPECT_NEAR(some.All()[0].Shares[k].second, 0.25 * whole, 0.02 * whole);
    }
  }
}

TEST(ComponentPieces, AreThoseOfTheExtractedMesh)
{
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    const LabelledMesh blobs(Blobs(seed), 5.0);
    SimplexMesh<3> mesh;
    ExtractMesh<3>(blobs.Mesh(), blobs.Surfaces, blobs.Labels, mesh, 1);
    const LabelledTriangulation<3> elements(blobs.Mesh(), blobs.Labels);
    const ComponentPieces<3> pieces(elements, Components<3>(blobs.Image), blobs.Image);
    std::map<std::int64_t, std::uint64_t> numbers;
    for (const auto& piece : pieces.All())
    {
      ++numbers[blobs.Surfaces.LabelValue(piece.Label)];
    }
    EXPECT_EQ(numbers, CountFragments(mesh));
    const ComponentPieces<3> extracted(
      ComplexOf<3>(mesh, &blobs.Surfaces).Elements(), Components<3>(blobs.Image), blobs.Image);
    std::map<std::uint32_t, std::array<double, 2>> sums; // elements and shares of each component
    const auto add = [&sums](const ComponentPieces<3>& some, double sign)
    {
      for (const auto& piece : some.All())
      {
        sums[piece.Component][0] += sign * static_cast<double>(piece.Size);
        for (const auto& [component, volume] : piece.Shares)
        {
          sums[component][1] += sign * volume;
        }
      }
    };
    add(pieces, 1.0);
    add(extracted, -1.0);
    for (const auto& [component, differences] : sums)
    {
      EXPECT_EQ(differences[0], 0.0);
      EXPECT_NEAR(differences[1], 0.0, 1e-6);
    }
  }
}
