// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Graded space-time meshes have every guarantee of uniform ones, and fewer pentatopes.
#include "Conformity/DistanceCheck.h"
#include "MeshChecks.h"
#include "Sanitizers.h"
#include "Sizing/Grading/LocalFeatureSize.h"
#include "SlabChecks.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** A large ball (label 1) that rests, a small one (2) that moves, and a plate (3). Flat ends. */
LabelImage<4> SmallAndLarge()
{
  const phantoms::SpaceTimePhantom phantom{ GridGeometry<4>::Orthogonal(
                                              { 42, 30, 34, 11 }, { 1.0, 1.0, 1.0, 2.0 }),
    [](const Point<4>& p) -> std::uint8_t
    {
      if (std::hypot(p[0] - 14.5, p[1] - 14.5, p[2] - 19.5) < 12.0)
      {
        return 1;
      }
      if (std::hypot(p[0] - 35.0, p[1] - 10.0 - 0.4 * p[3], p[2] - 20.0) < 3.0)
      {
        return 2;
      }
      return std::abs(p[2] - 3.5) < 1.5 && std::abs(p[0] - 20.0) < 17.0 &&
          std::abs(p[1] - 14.5) < 11.0
        ? 3
        : 0;
    } };
  return ImageOf(phantom);
}

MeshingOptions<4> Graded(MeshingOptions<4> options, double ratio = 1.0)
{
  options.Sampling.Grading.Mode = GradingMode::LocalFeatureSize;
  options.Sampling.Grading.Ratio = ratio;
  return options;
}

std::vector<Point<4>> PointsOfInterfaces(const SimplexMesh<4>& mesh)
{
  std::vector<Point<4>> points;
  for (const std::uint32_t v : VerticesOfInterfaces(mesh))
  {
    points.push_back(mesh.Points[v]);
  }
  return points;
}

std::size_t CountNear(const std::vector<Point<4>>& points, const Point<4>& p, double distance)
{
  return static_cast<std::size_t>(std::count_if(
    points.begin(), points.end(), [&](const Point<4>& q) { return Distance(p, q) < distance; }));
}

} // namespace

TEST(GradedSpaceTime, IsFineWhereTheShapeIs)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<4> image = SmallAndLarge();
  const MeshingOptions<4> options = SpaceTimeOptions(2.0);
  const SimplexMesh<4> plain = MeshOf(image, options);
  MeshingStatistics statistics;
  const SimplexMesh<4> mesh = MeshOf(image, Graded(options), &statistics);
  Tolerances tolerances;
  tolerances.VertexLinks = false;
  tolerances.FacetsOffInterface = 0.001; // a vertex at an end, with four facets
  ExpectGood(mesh, image, tolerances);
  EXPECT_EQ(statistics.Delta, 2.0);
  EXPECT_GT(statistics.LargestDelta, 2.5);
  EXPECT_GT(statistics.GradingSamples, 3000u);
  EXPECT_GT(statistics.GradingPoles, 500u);
  EXPECT_GT(statistics.Times.Grading, 0.0);
  EXPECT_TRUE(statistics.Components.Lost.empty());
  EXPECT_TRUE(statistics.FrameComponents.Lost.empty());
  EXPECT_LT(mesh.Simplices.size(), plain.Simplices.size() * 3 / 4);
  const std::vector<Point<4>> before = PointsOfInterfaces(plain);
  const std::vector<Point<4>> after = PointsOfInterfaces(mesh);
  const auto share = [&](const Point<4>& p, double distance)
  {
    return static_cast<double>(CountNear(after, p, distance)) /
      static_cast<double>(CountNear(before, p, distance));
  };
  EXPECT_GT(share({ 35.0, 14.0, 20.0, 10.0 }, 8.0), 0.7) << "the small ball";
  EXPECT_GT(share({ 20.0, 14.5, 2.0, 10.0 }, 6.0), 0.7) << "the plate";
  EXPECT_LT(share({ 14.5, 14.5, 31.5, 10.0 }, 9.0), 0.6) << "the large ball";
}

// No face between voxels of two labels is farther from the mesh's interfaces than 1.4 Delta there.
TEST(GradedSpaceTime, InterfacesAreNearThoseOfTheImage)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<4> image = SmallAndLarge();
  const MeshingOptions<4> options = Graded(SpaceTimeOptions(2.0), 2.0);
  const std::vector<Point<4>> vertices = PointsOfInterfaces(MeshOf(image, options));
  const ImageDomain<4> domain(image, 1.0);
  GradingParameters parameters;
  parameters.Finest = 2.0;
  parameters.SampleSpacing = 1.5;
  parameters.Salience = 1.5;
  parameters.Ratio = 2.0;
  parameters.Lambda = 12.0 * std::pow(2.0, 0.25);
  parameters.Coarsest = 20.0;
  parameters.Tolerance = 0.6;
  const LocalFeatureSize<4> lfs(image, domain, parameters, 1, {});
  std::size_t coarse = 0;
  for (std::size_t k = 0; k < lfs.Sample().size(); k += 3)
  {
    const Point<4>& z = lfs.Sample()[k];
    const double delta = lfs.Delta().At(z);
    coarse += delta > 2.5 ? 1 : 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Point<4>& v : vertices)
    {
      nearest = std::min(nearest, Distance(v, z));
    }
    // From a point of the interface to the face of voxels that it lies at: half a time step at most.
    ASSERT_LT(nearest, DistanceCheck<4>::LargestDistance * delta + 1.0) << delta;
  }
  EXPECT_GT(coarse, 200u);
}

// Volumes are as near to the image's as without grading, to two parts in a hundred.
TEST(GradedSpaceTime, DefaultOptionsKeepVolumes)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<4> image = SmallAndLarge();
  MeshingOptions<4> options = WithDelta<4>(2.0);
  options.Optimisation.Run = true;
  options.Team.Threads = 1;
  const std::map<std::int64_t, double> plain = Volumes(MeshOf(image, options));
  MeshingStatistics statistics;
  const SimplexMesh<4> mesh = MeshOf(image, Graded(options), &statistics);
  ExpectSound(mesh);
  EXPECT_EQ(FindManifoldDefects(mesh).Triangles, 0u);
  EXPECT_GT(statistics.Optimisation.SmallestVolumeAfter, 0.01);
  const std::map<std::int64_t, double> volumes = Volumes(mesh);
  for (const auto& [label, volume] : Hypervolumes(image))
  {
    EXPECT_LT(
      std::abs(volumes.at(label) - volume), std::abs(plain.at(label) - volume) + 0.02 * volume)
      << label << ": " << volumes.at(label) / volume << ", " << plain.at(label) / volume;
  }
}

// With a ratio that gives no more than delta anywhere, the mesh is the uniform one, bit for bit.
TEST(GradedSpaceTime, OfSmallRatioIsUniform)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<4> image = ImageOf(PulsatingBalls(9, 2.0));
  const MeshingOptions<4> options = SpaceTimeOptions(2.0);
  const SimplexMesh<4> plain = MeshOf(image, options);
  const SimplexMesh<4> mesh = MeshOf(image, Graded(options, 0.01));
  EXPECT_EQ(mesh.Points, plain.Points);
  EXPECT_EQ(mesh.Simplices, plain.Simplices);
}

TEST(GradedSpaceTime, KeepsLabelsAndComponentsThatAreSmall)
{
  const phantoms::SpaceTimePhantom phantom{ GridGeometry<4>::Orthogonal(
                                              { 30, 30, 30, 10 }, { 1.0, 1.0, 1.0, 2.0 }),
    [](const Point<4>& p) -> std::uint8_t
    {
      const auto isSpeck = [&](double x, double y, double z) {
        return p[0] >= x && p[0] < x + 2 && p[1] >= y && p[1] < y + 2 && p[2] >= z && p[2] < z + 2;
      };
      const bool isThere = p[3] > 5.0 && p[3] < 11.0;
      if (isSpeck(1, 1, 1) || (isThere && isSpeck(14, 14, 14)))
      {
        return 7;
      }
      return std::hypot(p[0] - 14.5, p[1] - 14.5, p[2] - 14.5) < 12.0 ? 1 : 0;
    } };
  const LabelImage<4> image = ImageOf(phantom);
  MeshingStatistics statistics;
  const SimplexMesh<4> mesh = MeshOf(image, Graded(SpaceTimeOptions(2.5), 2.0), &statistics);
  EXPECT_EQ(statistics.Components.Found, 3u);
  EXPECT_TRUE(statistics.Components.Lost.empty());
  EXPECT_TRUE(statistics.FrameComponents.Lost.empty());
  EXPECT_GE(NumberOfComponents(mesh, 7), 2u);
}

// No interface is sampled more coarsely than the slabs are thick; both sides of a plane match.
TEST(GradedSpaceTime, ConformsToTimePlanes)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(13, 2.0, 0.0));
  for (const bool periodic : { false, true })
  {
    MeshingOptions<4> options = Graded(SpaceTimeOptions(2.0), 2.0);
    options.Planes.Times = { 3.0, 12.0 };
    options.Planes.Periodic = periodic;
    MeshingStatistics statistics;
    const SimplexMesh<4> mesh = MeshOf(image, options, &statistics);
    EXPECT_GT(statistics.LargestDelta, 2.2);
    EXPECT_LE(statistics.LargestDelta, 3.0 + 1e-6);
    for (const double time : { 3.0, 12.0 })
    {
      const std::multiset<FlatFacet> before = FacetsAt(mesh, time, -1);
      EXPECT_GT(before.size(), 50u);
      EXPECT_EQ(before, FacetsAt(mesh, time, 1));
    }
    EXPECT_EQ(mesh.Twins.empty(), !periodic);
  }
}

TEST(GradedSpaceTime, OfImagesWithHardlyAnyInterface)
{
  for (const int free : { 0, 1 }) // voxels of background
  {
    const phantoms::SpaceTimePhantom phantom{ GridGeometry<4>::Orthogonal(
                                                { 3, 3, 3, 3 }, { 1.0, 1.0, 1.0, 1.0 }),
      [free](const Point<4>& p) -> std::uint8_t
      { return free == 1 && p[0] + p[1] + p[2] + p[3] == 0.0 ? 0 : 1; } };
    const SimplexMesh<4> mesh = MeshOf(ImageOf(phantom), Graded(SpaceTimeOptions(2.0)));
    ExpectSound(mesh);
    EXPECT_FALSE(mesh.Simplices.empty());
  }
}

TEST(GradedSpaceTime, IsTheSameForAnyNumberOfThreadsIfReproducible)
{
  const LabelImage<4> image = SmallAndLarge();
  SimplexMesh<4> first;
  for (const unsigned threads : { 1u, 3u })
  {
    MeshingOptions<4> options = Graded(SpaceTimeOptions(3.0, threads));
    options.Team.Reproducible = true;
    const SimplexMesh<4> mesh = MeshOf(image, options);
    first = threads == 1 ? mesh : first;
    EXPECT_EQ(mesh.Points, first.Points);
    EXPECT_EQ(mesh.Simplices, first.Simplices);
  }
}
