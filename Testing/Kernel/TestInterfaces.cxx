// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The mesh's interfaces are near the image's, and manifold: guard, edges, repair.
#include "Error.h"
#include "Image/ImageDomain.h"
#include "Image/InterfacePoints.h"
#include "ImageMesher.h"
#include "InterfaceGuard.h"
#include "Mesh/InterfaceDistance.h"
#include "Mesh/InterfaceEdges.h"
#include "Mesh/ManifoldRepair.h"
#include "MeshChecks.h"
#include "Phantoms.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

using namespace voxplex;

namespace
{

/** From the faces between voxels of different labels to the vertices of the mesh's interfaces, at most. */
double LargestDistance(const LabelImage<3>& image, const SimplexMesh<3>& mesh)
{
  std::set<std::uint32_t> used;
  for (const auto& facet : mesh.Facets)
  {
    used.insert(facet.begin(), facet.end());
  }
  const auto& n = image.CropDimensions();
  const auto idOf = [&](const GridGeometry<3>::Index& v) -> int
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      if (v[a] < 0 || v[a] >= n[a])
      {
        return 0;
      }
    }
    return image.Ids()[static_cast<std::size_t>((v[2] * n[1] + v[1]) * n[0] + v[0])];
  };
  double largest = 0.0;
  GridGeometry<3>::Index v;
  for (v[2] = -1; v[2] < n[2]; ++v[2])
  {
    for (v[1] = -1; v[1] < n[1]; ++v[1])
    {
      for (v[0] = -1; v[0] < n[0]; ++v[0])
      {
        for (std::size_t a = 0; a < 3; ++a)
        {
          GridGeometry<3>::Index next = v;
          ++next[a];
          if (idOf(v) == idOf(next))
          {
            continue;
          }
          Point<3> index;
          for (std::size_t b = 0; b < 3; ++b)
          {
            index[b] = static_cast<double>(v[b] + image.CropOrigin()[b]) + (a == b ? 0.5 : 0.0);
          }
          const Point<3> centre = image.Grid().ToFrame(index);
          double nearest = std::numeric_limits<double>::infinity();
          for (const std::uint32_t p : used)
          {
            nearest = std::min(nearest, Distance(mesh.Points[p], centre));
          }
          largest = std::max(largest, nearest);
        }
      }
    }
  }
  return largest;
}

/** Edges at which a label other than background has not two facets of its boundary, counted apart. */
std::set<std::array<std::uint32_t, 2>> BadEdges(const SimplexMesh<3>& mesh)
{
  std::set<std::array<std::uint32_t, 2>> bad;
  for (const auto& [label, ridges] : checks::RidgesOfBoundaries(mesh))
  {
    for (const auto& [edge, count] : ridges)
    {
      if (label != 0 && count != 2)
      {
        bad.insert({ edge[0], edge[1] });
      }
    }
  }
  return bad;
}

/** A block with a hair: one voxel thick, 12 long. */
LabelImage<3> BlockWithHair()
{
  return phantoms::Make(phantoms::Cube(30),
    [](const Point<3>& p) -> std::int16_t
    {
      const bool block = p[0] > 3 && p[0] < 14 && p[1] > 8 && p[1] < 22 && p[2] > 8 && p[2] < 22;
      const bool hair = p[0] >= 14 && p[0] < 26 && p[1] == 15 && p[2] == 15;
      return block || hair ? 4 : 0;
    });
}

/** A crack of background between two labels, and a tip of it in one of them: 5 voxels long, mostly one thick. */
LabelImage<3> BlockWithCrack()
{
  return phantoms::Make(phantoms::Cube(26),
    [](const Point<3>& p) -> std::int16_t
    {
      const bool block = std::all_of(p.begin(), p.end(), [](double x) { return x >= 4 && x < 22; });
      const bool crack = p[0] >= 7 && p[0] < 10;
      const bool tip = (p[1] == 12 && p[2] == 12 && p[0] < 15) ||
        (p[0] < 14 && ((p[1] == 13 && p[2] == 12) || (p[1] == 12 && p[2] == 13)));
      return !block || crack || (p[0] >= 10 && tip) ? 0 : p[0] < 7 ? 7 : 4;
    });
}

/** Blobs of two labels in a third, and holes. */
LabelImage<3> Blobs(unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<std::array<double, 5>> blobs;
  for (int k = 0; k < 60; ++k)
  {
    blobs.push_back({ 4.0 + random() % 24, 4.0 + random() % 24, 4.0 + random() % 24,
      1.5 + 0.01 * (random() % 250), static_cast<double>(random() % 3) });
  }
  return phantoms::Make(phantoms::Cube(32),
    [=](const Point<3>& p) -> std::int16_t
    {
      for (const auto& b : blobs)
      {
        if (Distance(p, { b[0], b[1], b[2] }) < b[3])
        {
          return static_cast<std::int16_t>(b[4]);
        }
      }
      return Distance(p, { 15.5, 15.5, 15.5 }) < 13.0 ? 3 : 0;
    });
}

SimplexMesh<3> Mesh(const LabelImage<3>& image, double delta, unsigned rounds,
  MeshingStatistics* statistics = nullptr, unsigned threads = 1)
{
  MeshingOptions<3> options;
  options.Delta = delta;
  options.InterfaceRounds = rounds;
  options.Threads = threads;
  ImageMesher<3> mesher(options);
  SimplexMesh<3> mesh;
  EXPECT_EQ(mesher.Run(image, mesh), MeshingOutcome::Done);
  const std::vector<std::string> complaints = checks::Complaints(mesh);
  EXPECT_TRUE(complaints.empty()) << complaints.front();
  if (statistics)
  {
    *statistics = mesher.Statistics();
  }
  return mesh;
}

struct RingShape
{
  double Height = 1.0;         ///< half of the edge's length
  std::vector<double> Degrees; ///< of each tetrahedron; empty: all alike
  bool HasCaps = false;        ///< each tetrahedron has a neighbour of its label below
  /** Number of a vertex between two tetrahedra of a label, which four more of them enclose; 0: none. */
  std::uint32_t Inner = 0;
};

/** Tetrahedra around an edge with the labels given, in a ring of radius 1; none where the label is 0. */
SimplexMesh<3> Ring(const std::vector<std::int64_t>& labels, const RingShape& shape = {})
{
  const double height = shape.Height;
  SimplexMesh<3> mesh;
  mesh.Points.push_back({ 0.0, 0.0, -height });
  mesh.Points.push_back({ 0.0, 0.0, height });
  const std::size_t n = labels.size();
  std::vector<double> angles{ 0.0 };
  for (std::size_t k = 0; k < n; ++k)
  {
    const double degrees =
      shape.Degrees.empty() ? 360.0 / static_cast<double>(n) : shape.Degrees[k];
    mesh.Points.push_back({ std::cos(angles[k]), std::sin(angles[k]), 0.0 });
    angles.push_back(angles[k] + degrees * std::numbers::pi / 180.0);
  }
  std::map<std::array<std::uint32_t, 3>, std::vector<std::size_t>> sides;
  constexpr unsigned outward[4][3] = { { 1, 2, 3 }, { 2, 0, 3 }, { 0, 1, 3 }, { 1, 0, 2 } };
  for (std::size_t k = 0; k < n; ++k)
  {
    if (labels[k] == 0)
    {
      continue;
    }
    const auto first = static_cast<std::uint32_t>(2 + k);
    const auto second = static_cast<std::uint32_t>(2 + (k + 1) % n);
    mesh.Simplices.push_back({ 0, 1, first, second });
    mesh.Labels.push_back(labels[k]);
    if (shape.HasCaps)
    {
      const double middle = 0.5 * (angles[k] + angles[k + 1]);
      const auto apex = static_cast<std::uint32_t>(mesh.Points.size());
      mesh.Points.push_back({ 0.5 * std::cos(middle), 0.5 * std::sin(middle), -height - 1.0 });
      mesh.Simplices.push_back({ apex, 0, first, second });
      mesh.Labels.push_back(labels[k]);
    }
  }
  if (shape.Inner != 0)
  {
    const std::uint32_t inner = 2 + shape.Inner;
    const auto outer = static_cast<std::uint32_t>(mesh.Points.size());
    mesh.Points.push_back({ 2.0 * mesh.Points[inner][0], 2.0 * mesh.Points[inner][1], 0.0 });
    for (const std::uint32_t pole : { 0u, 1u })
    {
      for (const std::uint32_t beside : { inner - 1, inner + 1 })
      {
        const bool isTurned = (pole == 0) != (beside < inner);
        mesh.Simplices.push_back(
          { pole, outer, isTurned ? beside : inner, isTurned ? inner : beside });
        mesh.Labels.push_back(labels[shape.Inner]);
      }
    }
  }
  const auto keyOf = [&](std::size_t t, unsigned i)
  {
    const auto& v = mesh.Simplices[t];
    std::array<std::uint32_t, 3> key{ v[outward[i][0]], v[outward[i][1]], v[outward[i][2]] };
    std::sort(key.begin(), key.end());
    return key;
  };
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    for (unsigned i = 0; i < 4; ++i)
    {
      sides[keyOf(t, i)].push_back(t);
    }
  }
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    for (unsigned i = 0; i < 4; ++i)
    {
      std::int64_t other = 0;
      for (const std::size_t s : sides[keyOf(t, i)])
      {
        other = s != t ? mesh.Labels[s] : other;
      }
      if (other < mesh.Labels[t])
      {
        const auto& v = mesh.Simplices[t];
        mesh.Facets.push_back({ v[outward[i][0]], v[outward[i][1]], v[outward[i][2]] });
        mesh.FacetLabels.push_back({ mesh.Labels[t], other });
      }
    }
  }
  return mesh;
}

/** Adds another mesh, so far along each axis. */
void Append(const SimplexMesh<3>& other, double offset, SimplexMesh<3>& mesh)
{
  const auto first = static_cast<std::uint32_t>(mesh.Points.size());
  for (Point<3> p : other.Points)
  {
    for (double& x : p)
    {
      x += offset;
    }
    mesh.Points.push_back(p);
  }
  for (auto cell : other.Simplices)
  {
    for (std::uint32_t& v : cell)
    {
      v += first;
    }
    mesh.Simplices.push_back(cell);
  }
  for (auto facet : other.Facets)
  {
    for (std::uint32_t& v : facet)
    {
      v += first;
    }
    mesh.Facets.push_back(facet);
  }
  mesh.Labels.insert(mesh.Labels.end(), other.Labels.begin(), other.Labels.end());
  mesh.FacetLabels.insert(
    mesh.FacetLabels.end(), other.FacetLabels.begin(), other.FacetLabels.end());
}

/** Four tetrahedra around an edge that is not manifold; whoever changes sides there makes a facet with 25 degrees. */
SimplexMesh<3> SharpRing()
{
  RingShape shape;
  shape.Height = 0.15;
  shape.Degrees = { 25.0, 155.0, 25.0, 155.0 };
  shape.HasCaps = true;
  return Ring({ 1, 2, 1, 2 }, shape);
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(InterfaceEdges, AreFoundByTheirLabels)
{
  EXPECT_TRUE(FindNonManifoldEdges(Ring({ 1, 1, 2, 2 })).empty());
  const auto alternating = FindNonManifoldEdges(Ring({ 1, 2, 1, 2 }));
  ASSERT_EQ(alternating.size(), 1u);
  EXPECT_EQ(alternating[0].Ends, (std::array<std::uint32_t, 2>{ 0, 1 }));
  EXPECT_FALSE(alternating[0].IsJunction);
  const auto junction = FindNonManifoldEdges(Ring({ 1, 2, 1, 3 }));
  ASSERT_EQ(junction.size(), 1u);
  EXPECT_TRUE(junction[0].IsJunction);
  // Background may be there in as many pieces as it likes, if no label is.
  EXPECT_TRUE(FindNonManifoldEdges(Ring({ 1, 0, 2, 0 })).empty());
  EXPECT_EQ(FindNonManifoldEdges(Ring({ 1, 0, 1, 0 })).size(), 1u);
}

TEST(InterfaceEdges, AgreeWithCountingByLabel)
{
  const SimplexMesh<3> mesh = Mesh(Blobs(1), 3.0, 0);
  std::set<std::array<std::uint32_t, 2>> found;
  for (const InterfaceEdge& edge : FindNonManifoldEdges(mesh))
  {
    found.insert(edge.Ends);
  }
  EXPECT_GT(found.size(), 3u);
  EXPECT_EQ(found, BadEdges(mesh));
}

//------------------------------------------------------------------------------------------------
TEST(ManifoldRepair, GivesATetrahedronToItsNeighbour)
{
  SimplexMesh<3> mesh = Ring({ 1, 2, 1, 2 });
  ASSERT_TRUE(checks::Complaints(mesh).empty());
  const ManifoldRepairCounts counts = RepairManifold(mesh);
  EXPECT_EQ(counts.Before, 1u);
  EXPECT_EQ(counts.After, 0u);
  EXPECT_TRUE(counts.Left.empty());
  EXPECT_TRUE(BadEdges(mesh).empty());
  EXPECT_TRUE(checks::Complaints(mesh).empty());
  EXPECT_EQ(mesh.Simplices.size(), 4u);
  EXPECT_EQ(std::count(mesh.Labels.begin(), mesh.Labels.end(), 1) % 2, 1); // one has changed
}

// A tetrahedron that hangs on an edge only goes, and its points with it.
TEST(ManifoldRepair, DropsWhatHangsOnAnEdge)
{
  SimplexMesh<3> mesh = Ring({ 1, 1, 0, 1, 0 });
  ASSERT_EQ(FindNonManifoldEdges(mesh).size(), 1u);
  EXPECT_EQ(RepairManifold(mesh).After, 0u);
  EXPECT_EQ(mesh.Simplices.size(), 2u);
  EXPECT_EQ(mesh.Points.size(), 5u);
  EXPECT_TRUE(checks::Complaints(mesh).empty());
}

// Whoever changes sides here leaves a triangle between itself and its cap, with an angle of 25 degrees in the narrow
// tetrahedra and of 12 in the wide ones.
TEST(ManifoldRepair, MakesNoSharpFacets)
{
  const SimplexMesh<3> ring = SharpRing();
  ASSERT_TRUE(checks::Complaints(ring).empty());
  SimplexMesh<3> mesh = ring;
  ManifoldRepairOptions options;
  options.FacetAngle = 26.0;
  options.JunctionFacetAngle = 26.0;
  const ManifoldRepairCounts counts = RepairManifold(mesh, options);
  EXPECT_EQ(counts.After, 1u);
  ASSERT_EQ(counts.Left.size(), 1u);
  EXPECT_EQ(counts.Left[0].Ends, FindNonManifoldEdges(mesh)[0].Ends);
  EXPECT_EQ(mesh.Labels, ring.Labels);
  options.FacetAngle = 20.0;
  options.JunctionFacetAngle = 20.0;
  EXPECT_EQ(RepairManifold(mesh, options).After, 0u);
  EXPECT_EQ(mesh.Labels[2], 2); // a wide one stays
  EXPECT_TRUE(checks::Complaints(mesh).empty());
}

// The label in the narrow gap would be the cheapest to give up, but it has nothing else.
TEST(ManifoldRepair, LosesNoLabel)
{
  RingShape shape;
  shape.Degrees = { 110.0, 30.0, 110.0, 110.0 };
  SimplexMesh<3> mesh = Ring({ 1, 2, 1, 3 }, shape);
  ManifoldRepairOptions options; // no angle stands in the way
  options.FacetAngle = 0.0;
  options.JunctionFacetAngle = 0.0;
  EXPECT_EQ(RepairManifold(mesh, options).After, 0u);
  EXPECT_TRUE(checks::Complaints(mesh).empty());
  const std::set<std::int64_t> labels(mesh.Labels.begin(), mesh.Labels.end());
  EXPECT_EQ(labels, (std::set<std::int64_t>{ 1, 2, 3 }));
}

// The first two tetrahedra are the smallest, but the vertex between them is inside of their label: the image has no
// interface there, so none may come to it.
TEST(ManifoldRepair, BringsNoInterfaceToInnerVertices)
{
  RingShape shape;
  shape.Degrees = { 15.0, 15.0, 110.0, 110.0, 110.0 };
  ManifoldRepairOptions options; // no angle stands in the way
  options.FacetAngle = 0.0;
  options.JunctionFacetAngle = 0.0;
  for (const bool enclosed : { false, true })
  {
    shape.Inner = enclosed ? 1 : 0;
    SimplexMesh<3> mesh = Ring({ 1, 1, 2, 1, 2 }, shape);
    ASSERT_TRUE(checks::Complaints(mesh).empty());
    EXPECT_EQ(RepairManifold(mesh, options).After, 0u);
    EXPECT_TRUE(checks::Complaints(mesh).empty());
    EXPECT_EQ(mesh.Labels[0], enclosed ? 1 : 2);
    EXPECT_EQ(mesh.Labels[1], enclosed ? 1 : 2);
  }
}

TEST(ManifoldRepair, LeavesAGoodMeshAlone)
{
  SimplexMesh<3> mesh = Ring({ 1, 1, 2, 3 });
  const SimplexMesh<3> before = mesh;
  EXPECT_EQ(RepairManifold(mesh).Before, 0u);
  EXPECT_EQ(mesh.Labels, before.Labels);
  EXPECT_EQ(mesh.Facets, before.Facets);
}

// A face where the image cuts the object lies in the plane of the edge and of the outer facets of the first and the
// last tetrahedron. One of these may be dropped or go over to the label between them.
TEST(ManifoldRepair, LeavesNoDentsWhereTheImageCuts)
{
  const LabelImage<3> image = phantoms::CutBall(12);
  const ImageDomain<3> domain(image, 1.0);
  RingShape shape;
  shape.Degrees = { 60.0, 60.0, 60.0, 180.0 };
  ManifoldRepairOptions options;
  for (const bool cut : { false, true })
  {
    options.Cut = cut ? &domain : nullptr;
    for (const std::vector<std::int64_t>& labels :
      { std::vector<std::int64_t>{ 1, 2, 1, 0 }, { 1, 0, 1, 0 } })
    {
      SimplexMesh<3> mesh = Ring(labels, shape);
      for (Point<3>& p : mesh.Points)
      {
        p = { p[2] + 14.0, p[0] + 14.0, p[1] - 0.5 }; // the image's lower face along z is at -0.5
      }
      ASSERT_TRUE(checks::Complaints(mesh).empty());
      const std::size_t tetrahedra = mesh.Simplices.size();
      const ManifoldRepairCounts counts = RepairManifold(mesh, options);
      EXPECT_EQ(counts.Before, 1u);
      EXPECT_EQ(counts.After, 0u);
      EXPECT_TRUE(checks::Complaints(mesh).empty());
      EXPECT_EQ(mesh.Simplices.size(), tetrahedra - (cut && labels[1] == 2 ? 0 : 1));
    }
  }
}

TEST(ManifoldRepair, MendsRealMeshes)
{
  for (const unsigned seed : { 1u, 2u })
  {
    SimplexMesh<3> mesh = Mesh(Blobs(seed), 3.0, 0);
    const std::map<std::int64_t, double> volumes = checks::Volumes(mesh);
    const std::size_t before = BadEdges(mesh).size();
    double smallest = 180.0;
    const ManifoldRepairCounts counts = RepairManifold(mesh);
    EXPECT_EQ(counts.Before, before);
    EXPECT_EQ(counts.After, BadEdges(mesh).size());
    EXPECT_LT(counts.After, before / 3 + 1);
    const std::vector<std::string> complaints = checks::Complaints(mesh);
    EXPECT_TRUE(complaints.empty()) << complaints.front();
    for (const auto& facet : mesh.Facets)
    {
      smallest = std::min(smallest, checks::SmallestAngle(mesh, facet));
    }
    EXPECT_GE(smallest, 20.0);
    EXPECT_EQ(checks::Volumes(mesh).size(), volumes.size()); // no label is lost
  }
}

void ExpectTellsWhatIsLeft(const SimplexMesh<3>& mesh, const ManifoldRepairCounts& counts)
{
  const std::vector<InterfaceEdge> expected = FindNonManifoldEdges(mesh);
  EXPECT_EQ(counts.After, expected.size());
  ASSERT_EQ(counts.Left.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
  {
    EXPECT_EQ(counts.Left[k].Ends, expected[k].Ends) << k;
    EXPECT_EQ(counts.Left[k].IsJunction, expected[k].IsJunction) << k;
  }
}

TEST(ManifoldRepair, TellsWhatIsLeft)
{
  std::size_t left = 0;
  for (const unsigned seed : { 1u, 2u, 3u, 4u })
  {
    for (const double angle : { 20.0, 38.0, 55.0 })
    {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", angle " << angle);
      SimplexMesh<3> mesh = Mesh(Blobs(seed), 3.0, 0);
      const ManifoldRepairCounts counts = RepairManifold(mesh, { angle, angle });
      ExpectTellsWhatIsLeft(mesh, counts);
      left += counts.Before > counts.After ? counts.After : 0;
    }
  }
  EXPECT_GT(left, 5u); // where some were mended, but not all

  // By the numbers that points have when others have gone with their tetrahedron.
  SimplexMesh<3> mesh = Ring({ 1, 1, 0, 1, 0 });
  Append(SharpRing(), 10.0, mesh);
  const ManifoldRepairCounts counts = RepairManifold(mesh, { 26.0, 26.0 });
  ExpectTellsWhatIsLeft(mesh, counts);
  EXPECT_EQ(counts.Before, 2u);
  ASSERT_EQ(counts.Left.size(), 1u);
  EXPECT_EQ(counts.Left[0].Ends, (std::array<std::uint32_t, 2>{ 5, 6 })); // two points have gone
}

//------------------------------------------------------------------------------------------------
TEST(InterfaceGuard, BringsOutAThinProcess)
{
  const LabelImage<3> image = BlockWithHair();
  const double delta = 4.0;
  EXPECT_GT(LargestDistance(image, Mesh(image, delta, 0)), 1.5 * delta);
  for (const unsigned threads : { 1u, 3u })
  {
    MeshingStatistics statistics;
    const SimplexMesh<3> mesh = Mesh(image, delta, 5, &statistics, threads);
    EXPECT_LE(LargestDistance(image, mesh), 1.5 * delta);
    EXPECT_GE(statistics.Interfaces.Rounds, 1u);
    EXPECT_GT(statistics.Interfaces.Seeds, 0u);
  }
}

// Points on the tip alone leave it without an element: no circumcentre lies in it.
TEST(InterfaceGuard, BringsOutAThinTipOfBackground)
{
  const LabelImage<3> image = BlockWithCrack();
  for (const double delta : { 1.3, 1.4, 1.5, 1.6, 1.8 })
  {
    for (const unsigned threads : { 1u, 3u })
    {
      MeshingStatistics statistics;
      const SimplexMesh<3> mesh = Mesh(image, delta, 5, &statistics, threads);
      EXPECT_LE(LargestDistance(image, mesh), 1.5 * delta) << delta;
      EXPECT_GE(statistics.Interfaces.Rounds, 1u);
    }
  }
}

// Graded meshes have few vertices where interfaces are flat, but their triangles are no farther from the image than those
// of a uniform mesh with the finest delta.
TEST(InterfaceGuard, KeepsGradedMeshesNear)
{
  for (const unsigned seed : { 1u, 2u, 3u })
  {
    const LabelImage<3> image = Blobs(seed);
    const std::vector<Point<3>> faces = VoxelFaceCentres(image, 1);
    double distances[2];
    std::size_t elements[2];
    MeshingOptions<3> options;
    options.Delta = 1.2;
    options.Grading.Mode = GradingMode::LocalFeatureSize;
    options.Grading.Ratio = 2.0;
    for (const unsigned rounds : { 0u, 5u })
    {
      options.InterfaceRounds = rounds;
      SimplexMesh<3> mesh;
      ImageMesher<3> mesher(options);
      ASSERT_EQ(mesher.Run(image, mesh), MeshingOutcome::Done);
      const unsigned k = rounds > 0 ? 1 : 0;
      distances[k] = MeasureHausdorff(mesh, faces, nullptr, 1).ImageToMesh.Maximum;
      elements[k] = mesh.Simplices.size();
    }
    constexpr double largest = 1.1 * 1.15; // see NearEnough() and StairFactor
    EXPECT_GT(distances[0], largest * options.Delta) << seed;
    EXPECT_LE(distances[1], largest * options.Delta) << seed;
    EXPECT_LT(elements[1], elements[0] + elements[0] / 20) << seed; // finer only where it has to be
  }
}

// Also where no feature is so small that delta would be used anywhere.
TEST(InterfaceGuard, KeepsGradedBallsNear)
{
  const LabelImage<3> image = phantoms::Ball(14.0);
  MeshingOptions<3> options;
  options.Delta = 1.5;
  options.Grading.Mode = GradingMode::LocalFeatureSize;
  options.Grading.Ratio = 2.0;
  SimplexMesh<3> mesh;
  ASSERT_EQ(ImageMesher<3>(options).Run(image, mesh), MeshingOutcome::Done);
  const HausdorffFigures figures = MeasureHausdorff(mesh, VoxelFaceCentres(image, 1), nullptr, 1);
  EXPECT_LE(figures.ImageToMesh.Maximum, 1.1 * 1.15 * options.Delta);
  options.Grading.Mode = GradingMode::Uniform;
  SimplexMesh<3> uniform;
  ASSERT_EQ(ImageMesher<3>(options).Run(image, uniform), MeshingOutcome::Done);
  EXPECT_LT(mesh.Simplices.size(), uniform.Simplices.size() / 3);
}

TEST(InterfaceGuard, LeavesManifoldBoundaries)
{
  for (const unsigned seed : { 1u, 2u, 3u })
  {
    const LabelImage<3> image = Blobs(seed);
    EXPECT_GT(BadEdges(Mesh(image, 2.5, 0)).size(), 0u);
    MeshingStatistics statistics;
    const SimplexMesh<3> mesh = Mesh(image, 2.5, 5, &statistics);
    EXPECT_EQ(BadEdges(mesh).size(), 0u);
    EXPECT_EQ(statistics.Interfaces.NonManifoldLeft, 0u);
    for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
    {
      EXPECT_LT(checks::RadiusEdge(mesh, t), 2.0 + 1e-9);
    }
  }
}

TEST(InterfaceGuard, IsContentWithAGoodMesh)
{
  const LabelImage<3> image = phantoms::Ball(8.0);
  MeshingStatistics statistics;
  const SimplexMesh<3> with = Mesh(image, 2.0, 5, &statistics);
  const SimplexMesh<3> without = Mesh(image, 2.0, 0);
  EXPECT_EQ(statistics.Interfaces.Rounds, 0u);
  EXPECT_EQ(with.Points, without.Points);
  EXPECT_EQ(with.Simplices, without.Simplices);
}

// Half as far apart each time, until the label field has no more to show.
TEST(InterfaceGuard, SamplesMoreFinelyEachTime)
{
  const LabelImage<3> image = BlockWithHair();
  const ImageDomain<3> domain(image, 1.0);
  LocalDelta<3> local(image);
  InterfaceGuard guard(image, domain.GetSites(), domain, { 4.0 }, nullptr, local, 1, {});
  SimplexMesh<3> nothing;
  double spacing = 4.0;
  int visits = 0;
  for (;;)
  {
    const std::vector<FeatureSeed<3>> seeds = guard.Inspect(nothing, {});
    if (seeds.empty())
    {
      break;
    }
    EXPECT_GT(guard.NumberOfFarFaces(), 100u);
    for (const FeatureSeed<3>& seed : seeds)
    {
      EXPECT_DOUBLE_EQ(seed.Delta, 0.5 * spacing);
      const DistanceInterval bounds = domain.DistanceBounds(seed.Position);
      EXPECT_LE(bounds.Lower, 1e-6);
    }
    spacing *= 0.5;
    EXPECT_LE(local.GradedAt(seeds.front().Position), spacing);
    // From the second time on R1 is to keep that spacing, too.
    EXPECT_EQ(local.HasLowered(), visits > 0);
    EXPECT_EQ(local.At(seeds.front().Position).Delta,
      visits > 0 ? static_cast<float>(spacing) : std::numeric_limits<float>::infinity());
    EXPECT_EQ(local.At(seeds.front().Position).Label, visits > 0 ? 1 : 0);
    local.ForgetLowered();
    ASSERT_LT(++visits, 10);
  }
  EXPECT_EQ(visits, 4); // 2, 1, 0.5, 0.25; 0.125 is below a fifth of a voxel
}

// Where three labels meet a boundary may pinch in the image itself: that alone is no reason for another round.
TEST(InterfaceGuard, GoesOnForEdgesOffJunctionsOnly)
{
  const LabelImage<3> image = phantoms::TouchingLabels(14);
  const double delta = 2.0;
  const ImageDomain<3> domain(image, 1.0);
  const SimplexMesh<3> good = Mesh(image, delta, 5);
  for (const bool atJunction : { false, true })
  {
    // Four tetrahedra more around an edge, on the interface of the two labels.
    SimplexMesh<3> mesh = good;
    Append(Ring({ 1, 2, 1, atJunction ? 3 : 2 }), 10.5, mesh);
    LocalDelta<3> local(image);
    InterfaceGuard guard(image, domain.GetSites(), domain, { delta }, nullptr, local, 1, {});
    EXPECT_TRUE(guard.Inspect(good, FindNonManifoldEdges(good)).empty());
    EXPECT_EQ(guard.NumberOfNonManifoldEdges(), 0u);
    EXPECT_EQ(guard.Inspect(mesh, FindNonManifoldEdges(mesh)).empty(), atJunction);
    EXPECT_EQ(guard.NumberOfNonManifoldEdges(), 1u);
    EXPECT_EQ(guard.NumberOfFarFaces(), 0u);
  }
}

TEST(InterfaceGuard, CanBeCancelled)
{
  const LabelImage<3> image = BlockWithHair();
  const ImageDomain<3> domain(image, 1.0);
  LocalDelta<3> local(image);
  std::stop_source stop;
  InterfaceGuard guard(
    image, domain.GetSites(), domain, { 4.0 }, nullptr, local, 1, stop.get_token());
  stop.request_stop();
  EXPECT_THROW(guard.Inspect({}, {}), Cancelled);
}
