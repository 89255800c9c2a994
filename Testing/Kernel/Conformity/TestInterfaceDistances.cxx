// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What the check of interfaces looks at and samples, face by face.
#include "Base/Error.h"
#include "Conformity/DistanceCheck.h"
#include "Conformity/InterfaceCheck.h"
#include "Conformity/InterfaceVertices.h"
#include "Conformity/LocalSampling.h"
#include "Domain/ImageDomain.h"
#include "Domain/InterfacePoints.h"
#include "InterfaceChecks.h"
#include "Mesh/SimplexLabels.h"
#include "MeshRuns.h"
#include "Quality/InterfaceDistance.h"
#include "RefinementChecks.h"
#include "Sanitizers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

std::vector<Point<3>> InterfaceVerticesOf(const SimplexMesh<3>& mesh)
{
  std::set<std::uint32_t> used;
  for (const auto& facet : mesh.Facets)
  {
    used.insert(facet.begin(), facet.end());
  }
  std::vector<Point<3>> vertices;
  for (const std::uint32_t v : used)
  {
    vertices.push_back(mesh.Points[v]);
  }
  return vertices;
}

/** From the faces between voxels of different labels to the vertices of the mesh's interfaces, at most. */
double LargestDistance(const LabelImage<3>& image, const SimplexMesh<3>& mesh)
{
  const std::vector<Point<3>> vertices = InterfaceVerticesOf(mesh);
  double largest = 0.0;
  ForEachFace(image,
    [&](const GridGeometry<3>::Index& voxel, const GridGeometry<3>::Index& next)
    {
      const Point<3> centre = Interpolate(image.CentreOf(voxel), image.CentreOf(next), 0.5);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Point<3>& p : vertices)
      {
        nearest = std::min(nearest, Distance(p, centre));
      }
      largest = std::max(largest, nearest);
    });
  return largest;
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

/** Where the interface crosses the faces between voxels whose centres are so near to a point. */
std::set<Point<3>> CrossingsNear(
  const LabelImage<3>& image, const Domain<3>& domain, const Point<3>& p, double radius)
{
  std::set<Point<3>> crossings;
  ForEachFace(image,
    [&](const GridGeometry<3>::Index& voxel, const GridGeometry<3>::Index& next)
    {
      const Point<3> from = image.CentreOf(voxel);
      const Point<3> to = image.CentreOf(next);
      Point<3> z;
      if (Distance(Interpolate(from, to, 0.5), p) <= radius &&
        domain.FirstCrossing(from, image.At(voxel), to, z))
      {
        crossings.insert(z);
      }
    });
  return crossings;
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(InterfaceDistances, BringsOutAThinProcess)
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
TEST(InterfaceDistances, BringsOutAThinTipOfBackground)
{
  const LabelImage<3> image = BlockWithCrack();
  for (const double delta : { 1.3, 1.4, 1.5, 1.6, 1.8 })
  {
    for (const unsigned threads : { 1u, 3u })
    {
      MeshingStatistics statistics;
      const SimplexMesh<3> mesh = Mesh(image, delta, 5, &statistics, threads);
      EXPECT_LE(LargestDistance(image, mesh), 1.5 * delta) << delta;
      // Three threads may come upon the tip by themselves.
      EXPECT_GE(statistics.Interfaces.Rounds, threads == 1 ? 1u : 0u);
    }
  }
}

// Graded meshes have few vertices where interfaces are flat, but their triangles are no farther from the image than those
// of a uniform mesh with the finest delta. Seeds 1 and 12 have places that it takes two rounds for.
TEST(InterfaceDistances, KeepsGradedMeshesNear)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  std::size_t elements[2] = { 0, 0 };
  unsigned far = 0;
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    const LabelImage<3> image = Blobs(seed);
    const std::vector<Point<3>> faces = VoxelFaceCentres(image, 1);
    double distances[2];
    MeshingOptions<3> options = WithDelta<3>(1.2);
    options.Sampling.Grading.Mode = GradingMode::LocalFeatureSize;
    options.Sampling.Grading.Ratio = 2.0;
    for (const unsigned rounds : { 0u, 5u })
    {
      options.Interfaces.Rounds = rounds;
      const SimplexMesh<3> mesh = MeshOf(image, options);
      const unsigned k = rounds > 0 ? 1 : 0;
      distances[k] = MeasureHausdorff(mesh, faces, nullptr, 1).ImageToMesh.Maximum;
      elements[k] += mesh.Simplices.size();
    }
    constexpr double largest = 1.22 * 1.15; // see NearEnough and StairFactor
    far += distances[0] > largest * options.Sampling.Delta ? 1 : 0;
    EXPECT_LE(distances[1], largest * options.Sampling.Delta) << seed;
  }
  EXPECT_GE(far, 6u);
  EXPECT_LT(elements[1], 1.05 * static_cast<double>(elements[0])); // finer only where it has to be
}

// Also where no feature is so small that delta would be used anywhere.
TEST(InterfaceDistances, KeepsGradedBallsNear)
{
  const LabelImage<3> image = phantoms::Ball(14.0);
  MeshingOptions<3> options = WithDelta<3>(1.5);
  options.Sampling.Grading.Mode = GradingMode::LocalFeatureSize;
  options.Sampling.Grading.Ratio = 2.0;
  const SimplexMesh<3> mesh = MeshOf(image, options);
  const HausdorffFigures figures = MeasureHausdorff(mesh, VoxelFaceCentres(image, 1), nullptr, 1);
  EXPECT_LE(figures.ImageToMesh.Maximum, 1.1 * 1.15 * options.Sampling.Delta);
  options.Sampling.Grading.Mode = GradingMode::Uniform;
  EXPECT_LT(mesh.Simplices.size(), MeshOf(image, options).Simplices.size() / 3);
}

TEST(InterfaceDistances, LeavesManifoldBoundaries)
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

TEST(InterfaceDistances, IsContentWithAGoodMesh)
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
TEST(InterfaceDistances, SamplesMoreFinelyEachTime)
{
  const LabelImage<3> image = BlockWithHair();
  const ImageDomain<3> domain(image, 1.0);
  LocalDelta<3> local(image);
  const SizingField<3> sizing(domain, { .Base = { 4.0 } });
  const DistanceCheck<3> check(image, domain.GetSites(), domain, sizing, 1, {});
  const std::vector<VoxelFace<3>> far = check.FindFar(MeshInterfaces<3>{});
  EXPECT_GT(far.size(), 100u);
  LocalSampling<3> sampling(image, image, domain.GetSites(), domain, sizing, local, {});
  double spacing = 0.8 * 4.0;
  int visits = 0;
  for (;;)
  {
    const std::size_t number = sampling.SampleInterfaces(far, {});
    const std::vector<FeatureSeed<3>> seeds = sampling.TakeSeeds();
    EXPECT_EQ(seeds.size(), number);
    if (seeds.empty())
    {
      break;
    }
    for (const FeatureSeed<3>& seed : seeds)
    {
      EXPECT_DOUBLE_EQ(seed.Delta, spacing);
      EXPECT_LE(domain.DistanceBound(seed.Position), 1e-6);
    }
    EXPECT_LE(local.GradedAt(seeds.front().Position), spacing + 1e-6);
    // From the second time on samples are to keep twice that spacing, too, and at last the spacing.
    EXPECT_EQ(local.HasLowered(), visits > 0);
    const double bound = visits < 4 ? 2.0 * spacing : spacing;
    EXPECT_EQ(local.At(seeds.front().Position).Delta,
      visits > 0 ? static_cast<float>(bound) : std::numeric_limits<float>::infinity());
    EXPECT_EQ(local.At(seeds.front().Position).Label, visits > 0 ? 1 : 0);
    spacing *= 0.5;
    ASSERT_LT(++visits, 10);
  }
  EXPECT_EQ(visits, 5); // 3.2, 1.6, 0.8, 0.4, and a fifth of a voxel
}

TEST(InterfaceDistances, GoesOnForEdges)
{
  const LabelImage<3> image = phantoms::TouchingLabels(14);
  const ImageDomain<3> domain(image, 1.0);
  const double delta = 2.0;
  const std::vector<Point<3>> vertices = InterfaceVerticesOf(Mesh(image, delta, 5));
  const auto refined = Refined(domain, delta);
  LocalDelta<3> local(image);
  const SizingField<3> sizing(domain, { .Base = { delta } });
  const DistanceCheck<3> check(image, domain.GetSites(), domain, sizing, 1, {});
  EXPECT_TRUE(check.FindFar(MeshInterfaces<3>{ vertices, {} }).empty());
  LocalSampling<3> sampling(image, image, domain.GetSites(), domain, sizing, local, {});
  InterfaceStatistics figures;
  InterfaceCheck<3> edges(
    { refined->Mesh, image, domain.GetSites(), domain, sizing, 1 }, 5, sampling, figures, {});
  EXPECT_FALSE(edges.InspectRidges({}));
  ManifoldLabels<3> made;
  made.Places = { vertices[0] };
  EXPECT_TRUE(edges.InspectRidges(made));
  EXPECT_GT(sampling.TakeSeeds().size(), 0u);
}

// If the ball stays as large, coarse meshes get many elements there: the knee atlas 13 times as many at a delta of 60.
TEST(InterfaceDistances, SamplesLessFarAroundAnEdgeEachTime)
{
  const LabelImage<3> image = phantoms::TouchingLabels(30);
  const ImageDomain<3> domain(image, 1.0);
  const double delta = 40.0;
  LocalDelta<3> local(image);
  const SizingField<3> sizing(domain, { .Base = { delta }, .Local = &local });
  LocalSampling<3> sampling(image, image, domain.GetSites(), domain, sizing, local, {});
  const Point<3> edge = InterfaceVerticesOf(Mesh(image, 4.0, 0)).front();
  std::vector<std::size_t> points{ 0 };
  do
  {
    points.push_back(sampling.SampleInterfaces({}, { edge }));
    sampling.TakeSeeds();
  } while (points.back() > 0);
  EXPECT_EQ(points.size(), 11u); // nothing; spacings of 32, 16 ... 0.25, 0.2; nothing
  EXPECT_GT(points[1], 100u);
  EXPECT_LT(points[points.size() - 2], 20u);
}

TEST(InterfaceDistances, CanBeCancelled)
{
  const LabelImage<3> image = BlockWithHair();
  const ImageDomain<3> domain(image, 1.0);
  std::stop_source stop;
  const SizingField<3> sizing(domain, { .Base = { 4.0 } });
  const DistanceCheck<3> check(image, domain.GetSites(), domain, sizing, 1, stop.get_token());
  stop.request_stop();
  EXPECT_THROW(check.FindFar(MeshInterfaces<3>{}), Cancelled);
}

// Around an edge it samples all that is near, also where the axes of the image are oblique and voxels long.
TEST(InterfaceDistances, ReachesAsFarInShearedImages)
{
  GridGeometry<3> sheared = GridGeometry<3>::Orthogonal({ 60, 30, 30 }, { 1.0, 1.0, 1.0 });
  sheared.IndexToFrame[0][1] = 1.5;
  sheared.IndexToFrame[0][2] = -0.8;
  sheared.IndexToFrame[1][2] = 0.9;
  const double delta = 6.0;
  for (const GridGeometry<3>& grid : { phantoms::Cube(30), sheared })
  {
    const Point<3> centre =
      grid.ToFrame({ 0.5 * static_cast<double>(grid.Dimensions[0]), 15.0, 15.0 });
    const LabelImage<3> image = phantoms::Make(
      grid, [&](const Point<3>& p) -> std::int16_t { return Distance(p, centre) < 11.0 ? 1 : 0; });
    const ImageDomain<3> domain(image, 1.0);
    const SimplexMesh<3> mesh = MeshOf(image, WithDelta<3>(delta));
    std::size_t all = 0;
    for (std::size_t f = 0; f < mesh.Facets.size(); f += 7)
    {
      const Point<3> middle =
        Interpolate(mesh.Points[mesh.Facets[f][0]], mesh.Points[mesh.Facets[f][1]], 0.5);
      const std::set<Point<3>> expected = CrossingsNear(image, domain, middle, 0.25 * delta);
      LocalDelta<3> local(image);
      const SizingField<3> sizing(domain, { .Base = { delta } });
      LocalSampling<3> sampling(image, image, domain.GetSites(), domain, sizing, local, {});
      std::set<Point<3>> found;
      sampling.SampleInterfaces({}, { middle });
      for (const FeatureSeed<3>& seed : sampling.TakeSeeds())
      {
        found.insert(seed.Position);
      }
      all += expected.size();
      EXPECT_EQ(found, expected) << f;
    }
    EXPECT_GT(all, 20u);
  }
}

//------------------------------------------------------------------------------------------------
TEST(InterfaceDistances, FindsAllFacesThatAreFarFromVertices)
{
  GridGeometry<3> sheared = GridGeometry<3>::Orthogonal({ 90, 22, 20 }, { 0.7, 1.1, 1.6 });
  sheared.IndexToFrame[0][1] = 0.9;
  sheared.IndexToFrame[0][2] = -0.6;
  sheared.IndexToFrame[1][2] = 0.5;
  std::mt19937 random(5);
  std::normal_distribution<double> off(0.0, 2.0);
  for (const GridGeometry<3>& grid : { phantoms::Cube(30), sheared })
  {
    const Point<3> centre = grid.ToFrame({ 0.5 * static_cast<double>(grid.Dimensions[0]),
      0.5 * static_cast<double>(grid.Dimensions[1]),
      0.5 * static_cast<double>(grid.Dimensions[2]) });
    const LabelImage<3> image = phantoms::Make(grid,
      [&](const Point<3>& p) -> std::int16_t {
        return Distance(p, centre) < 9.0 ? 1 : p[2] > centre[2] + 3.0 ? 2 : 0;
      });
    const ImageDomain<3> domain(image, 1.0);
    const double delta = 2.5;
    const double limit = std::max(DistanceCheck<3>::LargestDistance * delta,
      std::sqrt(grid.Spacing(0) * grid.Spacing(0) + grid.Spacing(1) * grid.Spacing(1) +
        grid.Spacing(2) * grid.Spacing(2)));
    std::vector<Point<3>> centres;
    ForEachFace(image,
      [&](const GridGeometry<3>::Index& voxel, const GridGeometry<3>::Index& next)
      { centres.push_back(Interpolate(image.CentreOf(voxel), image.CentreOf(next), 0.5)); });
    for (const std::size_t step : { 10u, 40u, 200u })
    {
      std::vector<Point<3>> vertices; // near the faces, some of them outside of the image
      for (std::size_t i = random() % step; i < centres.size(); i += 1 + random() % (2 * step))
      {
        vertices.push_back(centres[i]);
        const double scale = random() % 4 == 0 ? 0.0 : 1.0;
        for (double& x : vertices.back())
        {
          x += scale * off(random);
        }
      }
      const auto expected = std::count_if(centres.begin(), centres.end(),
        [&](const Point<3>& face)
        {
          return std::none_of(vertices.begin(), vertices.end(),
            [&](const Point<3>& p) { return Distance(p, face) < limit; });
        });
      EXPECT_GT(expected, 0);
      EXPECT_LT(static_cast<std::size_t>(expected), centres.size());
      for (const unsigned threads : { 1u, 3u })
      {
        const SizingField<3> sizing(domain, { .Base = { delta } });
        const DistanceCheck<3> check(image, domain.GetSites(), domain, sizing, threads, {});
        EXPECT_EQ(check.FindFar(MeshInterfaces<3>{ vertices, {} }).size(),
          static_cast<std::size_t>(expected))
          << step;
      }
    }
  }
}

// Among some faces it finds those that it finds among all. In a mesh it takes the marked vertices, graded ones their facets.
TEST(InterfaceDistances, FindsTheSameAmongSomeFaces)
{
  const LabelImage<3> image = phantoms::TouchingLabels(30);
  const ImageDomain<3> domain(image, 1.0);
  const auto refined = Refined(domain, 6.0);
  const SimplexLabels labels = LabelSimplices<3>(refined->Mesh, domain);
  MarkInterfaceVertices<3>(refined->Mesh, labels, 1, {});
  const LabelledTriangulation<3> elements(refined->Mesh, labels);
  MeshInterfaces<3> interfaces;
  for (VertexId v = 0; v < refined->Mesh.VertexIdEnd(); ++v)
  {
    const VertexRecord<3>& vertex = refined->Mesh.GetVertex(v);
    if (vertex.Alive && vertex.OnInterface)
    {
      interfaces.Vertices.push_back(vertex.Position);
    }
  }
  const std::vector<VoxelFace<3>> every =
    FindFacesNear<3>(image, domain.GetSites(), { { {}, 1e3 } }, {});
  GradedDelta<3> graded(domain.Bounds(), 5.0);
  graded.Lower({ 15.0, 15.0, 15.0 }, 1.0);
  graded.Cap(1.0);
  const BaseDistance<3> base{ 2.0 };
  const InterfaceSizes<3> sizes(
    image, { { image.Values()[1], InterfaceSize::AnyLabel, 1.5 } }, base, 0.3, 1);
  for (const SizingSources<3>& sources :
    { SizingSources<3>{ .Base = base }, SizingSources<3>{ .Base = base, .Interfaces = &sizes },
      SizingSources<3>{ .Base = { 1.0, &graded } } })
  {
    const SizingField<3> sizing(domain, sources);
    for (const unsigned threads : { 1u, 3u })
    {
      const DistanceCheck<3> check(image, domain.GetSites(), domain, sizing, threads, {});
      const std::vector<VoxelFace<3>> all = check.FindFar(elements);
      EXPECT_GT(all.size(), 20u);
      EXPECT_LT(all.size(), every.size());
      if (!sources.Base.Graded)
      {
        EXPECT_TRUE(check.FindFar(interfaces) == all);
      }
      const std::vector<VoxelFace<3>> some(all.begin(), all.begin() + 10);
      EXPECT_TRUE(check.FindFar(elements, some) == some);
      std::vector<VoxelFace<3>> sorted = all;
      std::sort(sorted.begin(), sorted.end());
      EXPECT_TRUE(check.FindFar(elements, every) == sorted);
      for (std::size_t f = 0; f < every.size(); f += 50) // vertices around one face only are taken
      {
        EXPECT_EQ(check.FindFar(elements, { every[f] }).size(),
          std::binary_search(sorted.begin(), sorted.end(), every[f]) ? 1u : 0u);
      }
    }
  }
}
