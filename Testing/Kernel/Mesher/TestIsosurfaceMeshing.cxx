// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Meshes of what isosurfaces of grey-value images bound: accuracy, invariants, borders, components.
#include "Base/Error.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Phantoms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>

using namespace voxplex;
using namespace voxplex::checks;
using phantoms::Cube;
using phantoms::Sample;

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/** An image, which reads its values as long as it lives. */
template <typename T>
struct GreyImage
{
  std::vector<T> Values;
  IsosurfaceImage<3> Image;
};

template <typename T>
GreyImage<T> Make(
  std::vector<T> values, const GridGeometry<3>& grid, const Isosurface& surface = {})
{
  GreyImage<T> grey{ std::move(values), {} };
  grey.Image = IsosurfaceImage<3>::FromScalars<T>(grey.Values, grid, surface);
  return grey;
}

template <typename T>
SimplexMesh<3> Mesh(const GreyImage<T>& grey, double delta, MeshingStatistics* statistics = nullptr)
{
  return MeshOf(grey.Image, WithDelta<3>(delta), statistics);
}

struct Distances
{
  double Mean = 0.0;
  double Largest = 0.0;
};

/** Of the vertices of the surface. */
Distances DistancesTo(
  const SimplexMesh<3>& mesh, const std::function<double(const Point<3>&)>& distance)
{
  const std::set<std::uint32_t> vertices = VerticesOfInterfaces(mesh);
  Distances d;
  for (const std::uint32_t v : vertices)
  {
    const double one = std::abs(distance(mesh.Points[v]));
    d.Mean += one / static_cast<double>(vertices.size());
    d.Largest = std::max(d.Largest, one);
  }
  return d;
}

constexpr double BallVolume(double radius)
{
  return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

/** How deep a point lies in a ball; negative outside. */
std::function<double(const Point<3>&)> Depth(double radius, const Point<3>& centre)
{
  return [=](const Point<3>& p) { return radius - Distance(p, centre); };
}

/** The part of a voxel of a cube grid that is in a ball, to 1/512. */
double PartInside(const Point<3>& voxel, double radius, const Point<3>& centre)
{
  const double r = Distance(voxel, centre);
  if (std::abs(r - radius) > 1.0)
  {
    return r < radius ? 1.0 : 0.0;
  }
  int inside = 0;
  for (int i = 0; i < 512; ++i)
  {
    Point<3> p = voxel;
    for (std::size_t a = 0; a < 3; ++a)
    {
      p[a] += (((i >> (3 * a)) & 7) + 0.5) / 8.0 - 0.5;
    }
    inside += Distance(p, centre) < radius;
  }
  return inside / 512.0;
}

} // namespace

TEST(IsosurfaceMeshing, BallOfASignedDistance)
{
  const Point<3> centre{ 23.6, 23.4, 23.7 };
  const auto depth = Depth(20.0, centre);
  const auto grey = Make(Sample<float>(Cube(48), depth), Cube(48));
  const SimplexMesh<3> mesh = Mesh(grey, 2.0);
  ExpectGood(mesh);
  const Distances d = DistancesTo(mesh, depth);
  EXPECT_LT(d.Mean, 0.01);
  EXPECT_LT(d.Largest, 0.02);
  EXPECT_NEAR(WholeVolume(mesh), BallVolume(20.0), 0.012 * BallVolume(20.0));
  // What the same voxels give as a label image.
  const SimplexMesh<3> ofLabels = MeshOf(grey.Image.Labels(), WithDelta<3>(2.0));
  EXPECT_LT(8.0 * d.Mean, DistancesTo(ofLabels, depth).Mean);
}

TEST(IsosurfaceMeshing, SmoothingDoesNotShrink)
{
  const auto depth = Depth(10.0, { 15.6, 15.4, 15.7 });
  const Isosurface smooth{ 0.0, IsosurfaceSide::Above, 1, 1.5 };
  const SimplexMesh<3> mesh = Mesh(Make(Sample<float>(Cube(32), depth), Cube(32), smooth), 2.0);
  EXPECT_LT(DistancesTo(mesh, depth).Mean, 0.04); // a Gaussian moves the surface by 0.2
}

TEST(IsosurfaceMeshing, BallOfPartialVolumesInBytes)
{
  const Point<3> centre{ 23.6, 23.4, 23.7 };
  const auto values = Sample<unsigned char>(
    Cube(48), [&](const Point<3>& p) { return std::round(255.0 * PartInside(p, 20.0, centre)); });
  const SimplexMesh<3> mesh = Mesh(Make(values, Cube(48), { 127.5 }), 2.0);
  ExpectGood(mesh);
  const Distances d = DistancesTo(mesh, Depth(20.0, centre));
  EXPECT_LT(d.Mean, 0.05);
  EXPECT_LT(d.Largest, 0.15);
  EXPECT_NEAR(WholeVolume(mesh), BallVolume(20.0), 0.012 * BallVolume(20.0));
}

TEST(IsosurfaceMeshing, Torus)
{
  const auto depth = [](const Point<3>& p)
  { return 6.0 - std::hypot(std::hypot(p[0] - 25.3, p[1] - 25.6) - 16.0, p[2] - 9.8); };
  const auto grid = GridGeometry<3>::Orthogonal({ 51, 51, 20 }, { 1.0, 1.0, 1.0 });
  const SimplexMesh<3> mesh = Mesh(Make(Sample<float>(grid, depth), grid), 1.0);
  ExpectGood(mesh);
  const Distances d = DistancesTo(mesh, depth);
  EXPECT_LT(d.Mean, 0.03);
  EXPECT_LT(d.Largest, 0.06);
  const double volume = 2.0 * std::numbers::pi * std::numbers::pi * 16.0 * 36.0;
  EXPECT_NEAR(WholeVolume(mesh), volume, 0.015 * volume);
  // Euler characteristic of the boundary: one handle.
  EXPECT_EQ(2 * VerticesOfInterfaces(mesh).size(), mesh.Facets.size());
}

TEST(IsosurfaceMeshing, AnisotropicAndSkewedVoxels)
{
  GridGeometry<3> grid = GridGeometry<3>::Orthogonal({ 60, 46, 26 }, { 0.5, 0.7, 1.1 });
  grid.IndexToFrame[0][1] = 0.15;
  grid.IndexToFrame[0][2] = -0.3;
  grid.IndexToFrame[1][2] = 0.2;
  const auto depth = Depth(9.0, grid.ToFrame({ 29.7, 22.6, 12.4 }));
  const SimplexMesh<3> mesh = Mesh(Make(Sample<float>(grid, depth), grid), 1.2);
  ExpectGood(mesh);
  const Distances d = DistancesTo(mesh, depth);
  EXPECT_LT(d.Mean, 0.02);
  EXPECT_LT(d.Largest, 0.04);
  EXPECT_NEAR(WholeVolume(mesh), BallVolume(9.0), 0.02 * BallVolume(9.0));
}

TEST(IsosurfaceMeshing, BelowAndOtherUnitsGiveTheSameMesh)
{
  const auto depth = Depth(8.0, { 11.4, 11.6, 11.5 });
  const auto values = Sample<double>(Cube(24), depth);
  const SimplexMesh<3> mesh = Mesh(Make(values, Cube(24), { 0.25 }), 1.5);
  auto negated = values;
  auto larger = values;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    negated[i] = -values[i];
    larger[i] = 4096.0 * values[i];
  }
  ExpectSame(mesh, Mesh(Make(negated, Cube(24), { -0.25, IsosurfaceSide::Below }), 1.5));
  ExpectSame(mesh, Mesh(Make(larger, Cube(24), { 1024.0 }), 1.5));
}

TEST(IsosurfaceMeshing, TheLabelOfTheInside)
{
  const auto values = Sample<float>(Cube(20), Depth(6.0, { 9.5, 9.5, 9.5 }));
  const SimplexMesh<3> mesh =
    Mesh(Make(values, Cube(20), { 0.0, IsosurfaceSide::Above, 417 }), 2.0);
  EXPECT_EQ(
    std::set<std::int64_t>(mesh.Labels.begin(), mesh.Labels.end()), std::set<std::int64_t>{ 417 });
  for (const auto& labels : mesh.FacetLabels)
  {
    ASSERT_EQ(labels, (std::array<std::int64_t, 2>{ 417, 0 }));
  }
}

// A shell: what is outside of the ball up to the border, by far the larger part.
TEST(IsosurfaceMeshing, TheImagesBorderClosesThePlanes)
{
  const auto depth = Depth(8.0, { 11.5, 11.5, 11.5 });
  const auto grey = Make(Sample<float>(Cube(24), depth), Cube(24), { 0.0, IsosurfaceSide::Below });
  const SimplexMesh<3> mesh = Mesh(grey, 1.5);
  ExpectSound(mesh);
  const double volume = 24.0 * 24.0 * 24.0 - BallVolume(8.0);
  EXPECT_NEAR(WholeVolume(mesh), volume, 0.015 * volume);
  std::size_t onPlanes = 0;
  for (const std::uint32_t v : VerticesOfInterfaces(mesh))
  {
    const Point<3>& p = mesh.Points[v];
    int near = 0;  // planes that are near
    int exact = 0; // planes that it is on
    for (const double x : p)
    {
      const double toPlane = std::min(std::abs(x + 0.5), std::abs(x - 23.5));
      near += toPlane < 1.5;
      exact += toPlane < 0.002;
    }
    if (near == 1) // not at an edge of the cube
    {
      ASSERT_EQ(exact, 1);
      ++onPlanes;
    }
    else if (near == 0)
    {
      ASSERT_NEAR(depth(p), 0.0, 0.05);
    }
  }
  EXPECT_GT(onPlanes, 300u);
}

TEST(IsosurfaceMeshing, VoxelsWithoutANumberAreLeftOut)
{
  const auto depth = Depth(9.0, { 11.5, 11.5, 11.5 });
  const auto values =
    Sample<float>(Cube(24), [&](const Point<3>& p) { return p[2] < 11.7 ? NaN : depth(p); });
  const SimplexMesh<3> mesh = Mesh(Make(values, Cube(24)), 1.2);
  EXPECT_NEAR(WholeVolume(mesh), 0.5 * BallVolume(9.0), 0.03 * BallVolume(9.0));
  for (const Point<3>& p : mesh.Points)
  {
    ASSERT_GT(p[2], 11.5 - 0.01);
  }
}

TEST(IsosurfaceMeshing, SmallComponentsAreKeptOrLeftOut)
{
  const auto large = Depth(8.0, { 11.0, 11.0, 11.0 });
  const auto small = Depth(1.6, { 23.3, 23.4, 23.5 });
  auto grey =
    Make(Sample<float>(Cube(28), [&](const Point<3>& p) { return std::max(large(p), small(p)); }),
      Cube(28));
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = Mesh(grey, 5.0, &statistics);
  EXPECT_EQ(statistics.Components.Found, 2u);
  EXPECT_TRUE(statistics.Components.Lost.empty());
  const auto isBeyond = [](const Point<3>& p) { return p[0] > 20.0; };
  EXPECT_TRUE(std::any_of(mesh.Points.begin(), mesh.Points.end(), isBeyond));
  MeshingOptions<3> options = WithDelta<3>(1.5);
  options.SmallestVolume = 100.0;
  ImageMesher<3> mesher(options);
  SimplexMesh<3> rest;
  mesher.Run(grey.Image, rest);
  EXPECT_EQ(mesher.Statistics().DroppedComponents.size(), 1u);
  EXPECT_FALSE(std::any_of(rest.Points.begin(), rest.Points.end(), isBeyond));
  EXPECT_NEAR(WholeVolume(rest), BallVolume(8.0), 0.06 * BallVolume(8.0));
}

// A surface through voxel centres, and a plateau of the isovalue itself.
TEST(IsosurfaceMeshing, TiesEnd)
{
  const auto cube = Sample<short>(Cube(20),
    [](const Point<3>& p)
    {
      const auto within = [](double x) { return x >= 5.0 && x <= 14.0; };
      return within(p[0]) && within(p[1]) && within(p[2]) ? 1.0 : 0.0;
    });
  const SimplexMesh<3> mesh = Mesh(Make(cube, Cube(20), { 1.0 }), 1.0);
  ExpectSound(mesh);
  EXPECT_NEAR(WholeVolume(mesh), 729.0, 30.0);
  const auto checker = Sample<short>(Cube(12),
    [](const Point<3>& p) { return std::fmod(p[0] + p[1] + p[2], 2.0) < 0.5 ? 7.0 : 3.0; });
  const SimplexMesh<3> maze = Mesh(Make(checker, Cube(12), { 5.0 }), 1.0);
  ExpectSound(maze);
}

TEST(IsosurfaceMeshing, StatisticsAndCancelling)
{
  const auto values = Sample<float>(Cube(40), Depth(15.0, { 19.5, 19.5, 19.5 }));
  const auto grey = Make(values, Cube(40), { 0.0, IsosurfaceSide::Above, 1, 0.75 });
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = Mesh(grey, 2.0, &statistics);
  EXPECT_EQ(statistics.SmoothingSigma, 0.75);
  EXPECT_GT(statistics.LabelFieldBytes, 0u);
  EXPECT_GT(statistics.DistanceBytes, 0u);
  ImageMesher<3> mesher(MeshingOptions<3>{});
  mesher.Progress = [](double) { return false; };
  SimplexMesh<3> none;
  EXPECT_EQ(mesher.Run(grey.Image, none), MeshingOutcome::Cancelled);
  EXPECT_TRUE(none.Simplices.empty());
}

TEST(IsosurfaceMeshing, SeveralThreads)
{
  const auto depth = Depth(15.0, { 19.4, 19.5, 19.6 });
  const auto grey = Make(Sample<float>(Cube(40), depth), Cube(40));
  MeshingOptions<3> options = WithDelta<3>(1.5);
  options.Team.Threads = 3;
  options.Optimisation.Run = true;
  const SimplexMesh<3> mesh = MeshOf(grey.Image, options);
  ExpectSound(mesh);
  EXPECT_LT(DistancesTo(mesh, depth).Largest, 0.15); // optimisation may move vertices by a tenth
  EXPECT_NEAR(WholeVolume(mesh), BallVolume(15.0), 0.015 * BallVolume(15.0));
}

TEST(IsosurfaceMeshing, SpaceTime)
{
  const auto grid = GridGeometry<4>::Orthogonal({ 14, 14, 14, 5 }, { 1.0, 1.0, 1.0, 1.0 });
  const auto values = Sample<float>(grid,
    [](const Point<4>& p)
    { return 4.0 + 0.25 * p[3] - std::hypot(p[0] - 6.5, p[1] - 6.5, p[2] - 6.5); });
  const auto image = IsosurfaceImage<4>::FromScalars<float>(values, grid, {});
  MeshingOptions<4> options = WithDelta<4>(1.5);
  options.SpaceTime.Slivers.VolumeBound = 0.0;
  const SimplexMesh<4> mesh = MeshOf(image, options);
  const double volume = WholeVolume(mesh);
  const auto integral = [](double r) { return std::numbers::pi / 3.0 * r * r * r * r; };
  const double expected = (integral(5.0) - integral(4.0)) / 0.25;
  // Its vertices lie on a surface that is convex at every time: the mesh is inside, by what chords of 1.5 cut off.
  EXPECT_LT(volume, expected);
  EXPECT_GT(volume, 0.87 * expected);
  for (const Point<4>& p : mesh.Points)
  {
    ASSERT_GE(p[3], 0.0);
    ASSERT_LE(p[3], 4.0);
  }
}
