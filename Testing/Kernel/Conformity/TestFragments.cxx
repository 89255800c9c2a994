// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Crumbs get the label beside them, and thin components hold together if they are to be exact.
#include "Base/DisjointSets.h"
#include "Base/Error.h"
#include "Conformity/Crumbs.h"
#include "Domain/ImageDomain.h"
#include "Image/Components.h"
#include "InterfaceChecks.h"
#include "Mesher/ImageMesher.h"
#include "Phantoms.h"
#include "Quality/Fragments.h"
#include "RefinementChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

//------------------------------------------------------------------------------------------------
/** A refined triangulation of blobs with the labels at circumcentres. */
struct LabelledBlobs
{
  explicit LabelledBlobs(unsigned seed)
    : Surfaces(this->Image = Blobs(seed), 1.0)
    , Context(Refined(this->Surfaces, 5.0))
    , Labels(LabelSimplices<3>(this->Context->Mesh, this->Surfaces))
  {
  }

  const Triangulation<3>& Mesh() const { return this->Context->Mesh; }
  const auto& NeighboursOf(SimplexId s) const { return this->Mesh().GetSimplex(s).N; }
  const auto& VerticesOf(SimplexId s) const { return this->Mesh().GetSimplex(s).V; }

  std::vector<SimplexId> Relabel(unsigned threads, const std::stop_token& stop = {})
  {
    ManifoldRepairOptions<3> options;
    options.Surfaces = &this->Surfaces;
    return RelabelCrumbs(this->Mesh(), this->Labels,
      FindSmallFragments(this->Mesh(), this->Labels, threads, stop), options, threads, stop);
  }

  /** The simplices of each fragment, by one of them. */
  std::map<SimplexId, std::vector<SimplexId>> Fragments() const
  {
    DisjointSets sets(this->Labels.size());
    for (SimplexId s = 0; s < this->Labels.size(); ++s)
    {
      for (std::size_t i = 0; this->Labels[s] != 0 && i < 4; ++i)
      {
        const SimplexId n = this->NeighboursOf(s)[i];
        if (n != None && this->Labels[n] == this->Labels[s])
        {
          sets.Join(s, n);
        }
      }
    }
    std::map<SimplexId, std::vector<SimplexId>> fragments;
    for (SimplexId s = 0; s < this->Labels.size(); ++s)
    {
      if (this->Labels[s] != 0)
      {
        fragments[sets.Find(s)].push_back(s);
      }
    }
    return fragments;
  }

  /** The simplices of crumbs, found without the code under test. */
  std::vector<SimplexId> Crumbs() const
  {
    const auto fragments = this->Fragments();
    std::map<std::pair<VertexId, LabelId>, std::size_t> largest;
    for (const auto& [name, simplices] : fragments)
    {
      for (const SimplexId s : simplices)
      {
        for (const VertexId v : this->VerticesOf(s))
        {
          std::size_t& size = largest[{ v, this->Labels[s] }];
          size = std::max(size, simplices.size());
        }
      }
    }
    std::vector<SimplexId> crumbs;
    for (const auto& [name, simplices] : fragments)
    {
      bool hangs = false;
      bool hasEnd = false;
      for (const SimplexId s : simplices)
      {
        int same = 0;
        for (const SimplexId n : this->NeighboursOf(s))
        {
          same += n != None && this->Labels[n] == this->Labels[s] ? 1 : 0;
        }
        hasEnd = hasEnd || same <= 1;
        for (const VertexId v : this->VerticesOf(s))
        {
          hangs = hangs || largest.at({ v, this->Labels[s] }) > simplices.size();
        }
      }
      if (simplices.size() <= 5 && hangs && hasEnd)
      {
        crumbs.insert(crumbs.end(), simplices.begin(), simplices.end());
      }
    }
    std::sort(crumbs.begin(), crumbs.end());
    return crumbs;
  }

  LabelImage<3> Image;
  const ImageDomain<3> Surfaces;
  const std::unique_ptr<const RefinementContext<3>> Context;
  SimplexLabels Labels;
};

//------------------------------------------------------------------------------------------------
/** A block with four wavy rods, less than three voxels thick: much thinner than the block. */
LabelImage<3> BlockWithRods()
{
  std::vector<std::uint8_t> labels;
  const std::pair<double, double> rods[] = { { 12.0, 12.0 }, { 30.0, 14.0 }, { 14.0, 32.0 },
    { 34.0, 34.0 } };
  for (int z = 0; z < 48; ++z)
  {
    for (int y = 0; y < 48; ++y)
    {
      for (int x = 0; x < 48; ++x)
      {
        bool inside = x > 4 && x < 28 && y > 4 && y < 44 && z > 4 && z < 44;
        for (const auto& [cy, cz] : rods)
        {
          const double dy = y - cy - 3.0 * std::sin(x / 4.0);
          const double dz = z - cz - 3.0 * std::cos(x / 5.0);
          inside = inside || (x >= 28 && x < 46 && dy * dy + dz * dz < 1.3 * 1.3);
        }
        labels.push_back(inside ? 1 : 0);
      }
    }
  }
  return LabelImage<3>::FromScalars(std::span<const std::uint8_t>(labels), phantoms::Cube(48));
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
  MeshingOptions<3> options;
  options.Sampling.Delta = 6.0;
  options.Components.Exact = exact;
  SimplexMesh<3> mesh;
  ImageMesher<3> mesher(options);
  EXPECT_EQ(mesher.Run(BlockWithRods(), mesh), MeshingOutcome::Done);
  const std::size_t number = NumberOfFragments(mesh);
  EXPECT_EQ(CountFragments(mesh), (std::map<std::int64_t, std::uint64_t>{ { 1, number } }));
  return number;
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(Crumbs, GetTheLabelBesideThem)
{
  std::size_t found = 0;
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    LabelledBlobs blobs(seed);
    const SimplexLabels before = blobs.Labels;
    const std::vector<SimplexId> crumbs = blobs.Crumbs();
    const std::vector<SimplexId> changed = blobs.Relabel(1);
    EXPECT_TRUE(std::includes(crumbs.begin(), crumbs.end(), changed.begin(), changed.end()));
    EXPECT_LE(4 * blobs.Crumbs().size(), crumbs.size()); // some must keep angles good, or are new
    found += changed.size();
    for (SimplexId s = 0; s < before.size(); ++s)
    {
      const bool isChanged = std::binary_search(changed.begin(), changed.end(), s);
      EXPECT_EQ(blobs.Labels[s] != before[s], isChanged);
      if (isChanged) // to a label beside its crumb
      {
        std::vector<SimplexId> crumb{ s };
        bool isBeside = false;
        for (std::size_t k = 0; k < crumb.size(); ++k)
        {
          for (const SimplexId n : blobs.NeighboursOf(crumb[k]))
          {
            const LabelId now = n == None ? LabelId{ 0 } : blobs.Labels[n];
            isBeside =
              isBeside || (now == blobs.Labels[s] && (n == None || before[n] != before[s]));
            if (n != None && before[n] == before[s] &&
              std::find(crumb.begin(), crumb.end(), n) == crumb.end())
            {
              crumb.push_back(n);
            }
          }
        }
        EXPECT_TRUE(isBeside);
      }
    }
  }
  EXPECT_GT(found, 10u);
}

TEST(Crumbs, DoNotDependOnThreads)
{
  LabelledBlobs one(1);
  LabelledBlobs three(1);
  const auto changed = one.Relabel(1);
  EXPECT_EQ(changed, three.Relabel(3));
  EXPECT_TRUE(std::equal(one.Labels.begin(), one.Labels.end(), three.Labels.begin()));
}

TEST(Crumbs, CanBeStopped)
{
  LabelledBlobs blobs(1);
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW(blobs.Relabel(1, source.get_token()), Cancelled);
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
TEST(FragmentCheck, ThinPartsHoldTogetherIfTheyAreToBeExact)
{
  const LabelImage<3> image = BlockWithRods();
  ASSERT_EQ(Components<3>(image).All().size(), 1u);
  EXPECT_GT(FragmentsOfBlockWithRods(false), 1u); // or the image is too easy
  EXPECT_EQ(FragmentsOfBlockWithRods(true), 1u);
}
