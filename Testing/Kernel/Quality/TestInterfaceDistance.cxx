// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** Distances between interfaces of meshes and images: known ones, and searches against brute force. */
#include "CubeMeshes.h"
#include "Domain/ImageDomain.h"
#include "Domain/InterfacePoints.h"
#include "Geometry/BoundingTree.h"
#include "Mesh/FindInterfaces.h"
#include "Phantoms.h"
#include "Quality/InterfaceDistance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace
{

using namespace voxplex;

/** A cube of 4 x 4 x 4 voxels of label 1; its faces lie at 1.5 and 5.5 voxels. */
LabelImage<3> CubeImage(const GridGeometry<3>& grid)
{
  return phantoms::Make(grid,
    [&grid](const Point<3>& p) -> std::int16_t
    {
      const Point<3> index = grid.ToIndex(p);
      return std::all_of(index.begin(), index.end(), [](double x) { return x > 1.5 && x < 5.5; });
    });
}

SimplexMesh<3> CubeMeshAt(double shift, double size)
{
  CubeMesh cubes;
  const double low = 3.5 - 0.5 * size;
  const double high = 3.5 + 0.5 * size;
  cubes.AddBox({ low + shift, low, low }, { high + shift, high, high }, 1);
  FindInterfaces(cubes.Mesh, 1);
  return cubes.Mesh;
}

/** The least distance of a fine lattice of points of the triangle: an upper bound. */
double SampledDistance(const Point<3>& p, const Triangle& t)
{
  constexpr int n = 300;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= n; ++i)
  {
    for (int j = 0; j <= n - i; ++j)
    {
      const double u = static_cast<double>(i) / n;
      const double v = static_cast<double>(j) / n;
      Point<3> q;
      for (std::size_t k = 0; k < 3; ++k)
      {
        q[k] = t.A[k] + u * (t.B[k] - t.A[k]) + v * (t.C[k] - t.A[k]);
      }
      best = std::min(best, Distance(p, q));
    }
  }
  return best;
}

class Random
{
public:
  Point<3> Next(double scale = 1.0)
  {
    return { scale * this->Uniform(this->Engine), scale * this->Uniform(this->Engine),
      scale * this->Uniform(this->Engine) };
  }

private:
  std::mt19937_64 Engine{ 20240607 };
  std::uniform_real_distribution<double> Uniform{ -1.0, 1.0 };
};

} // namespace

//------------------------------------------------------------------------------
TEST(Triangle, DistanceInEachRegion)
{
  const Triangle t{ { 0, 0, 0 }, { 4, 0, 0 }, { 0, 3, 0 } };
  EXPECT_DOUBLE_EQ(Distance2({ 1, 1, 2 }, t), 4.0);   // inside
  EXPECT_DOUBLE_EQ(Distance2({ -1, -2, 2 }, t), 9.0); // vertices
  EXPECT_DOUBLE_EQ(Distance2({ 6, 0, 1 }, t), 5.0);
  EXPECT_DOUBLE_EQ(Distance2({ -1, 5, 0 }, t), 5.0);
  EXPECT_DOUBLE_EQ(Distance2({ 2, -3, 4 }, t), 25.0); // edges
  EXPECT_DOUBLE_EQ(Distance2({ -3, 1, 0 }, t), 9.0);
  EXPECT_NEAR(Distance2({ 2 + 3, 1.5 + 4, 0 }, t), 25.0, 1e-12); // off the middle of the longest
  const Triangle flat{ { 0, 0, 0 }, { 4, 0, 0 }, { 1, 0, 0 } };
  EXPECT_DOUBLE_EQ(Distance2({ 3, 1, 0 }, flat), 1.0);
  EXPECT_DOUBLE_EQ(Distance2({ 5, 0, 0 }, flat), 1.0);
  const Triangle point{ { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } };
  EXPECT_DOUBLE_EQ(Distance2({ 1, 1, 3 }, point), 4.0);
}

TEST(Triangle, DistanceOfRandomPoints)
{
  Random random;
  for (int i = 0; i < 60; ++i)
  {
    const Triangle t{ random.Next(), random.Next(), random.Next() };
    const Point<3> p = random.Next(2.0);
    const double distance = std::sqrt(Distance2(p, t));
    const double sampled = SampledDistance(p, t);
    EXPECT_LE(distance, sampled + 1e-12);
    EXPECT_NEAR(distance, sampled, 0.01);
  }
}

//------------------------------------------------------------------------------
TEST(BoundingTree, FindsTheNearest)
{
  Random random;
  for (const std::size_t n : { 1u, 7u, 8u, 9u, 1000u })
  {
    std::vector<Triangle> triangles;
    std::vector<Point<3>> points;
    for (std::size_t i = 0; i < n; ++i)
    {
      const Point<3> a = random.Next(10.0);
      const Point<3> b = random.Next();
      const Point<3> c = random.Next();
      triangles.push_back({ a, Subtract(a, b), Subtract(a, c) });
      points.push_back(a);
    }
    const BoundingTree<Triangle> triangleTree(triangles, 2);
    const BoundingTree<Point<3>> pointTree(points, 2);
    std::uint32_t triangleHint = 5000; // beyond the end is no harm
    std::uint32_t pointHint = 0;
    for (int q = 0; q < 200; ++q)
    {
      const Point<3> p = random.Next(20.0);
      double toTriangle = std::numeric_limits<double>::infinity();
      double toPoint = toTriangle;
      for (std::size_t i = 0; i < n; ++i)
      {
        toTriangle = std::min(toTriangle, Distance2(p, triangles[i]));
        toPoint = std::min(toPoint, Distance2(p, points[i]));
      }
      EXPECT_EQ(triangleTree.Distance2To(p, triangleHint), toTriangle);
      EXPECT_EQ(pointTree.Distance2To(p, pointHint), toPoint);
      EXPECT_LT(pointHint, n);
    }
  }
}

TEST(BoundingTree, EmptyAndAllInOnePlace)
{
  std::uint32_t hint = 0;
  EXPECT_TRUE(BoundingTree<Triangle>({}).IsEmpty());
  EXPECT_EQ(BoundingTree<Triangle>({}).Distance2To({ 0, 0, 0 }, hint),
    std::numeric_limits<double>::infinity());
  const BoundingTree<Point<3>> same(std::vector<Point<3>>(100, Point<3>{ 1, 2, 3 }));
  EXPECT_EQ(same.Distance2To({ 1, 2, 5 }, hint), 4.0);
}

//------------------------------------------------------------------------------
TEST(InterfacePoints, FacesOfACube)
{
  const LabelImage<3> image = CubeImage(phantoms::Cube(8));
  const std::vector<Point<3>> faces = VoxelFaceCentres(image, 1);
  ASSERT_EQ(faces.size(), 96U);
  for (const Point<3>& face : faces)
  {
    int atBorder = 0;
    for (const double x : face)
    {
      atBorder += x == 1.5 || x == 5.5;
      EXPECT_TRUE(x == 1.5 || x == 5.5 || (x == std::floor(x) && x >= 2 && x <= 5)) << x;
    }
    EXPECT_EQ(atBorder, 1);
  }
  EXPECT_EQ(VoxelFaceCentres(image, 3), faces);
}

TEST(InterfacePoints, LieInTheFrame)
{
  GridGeometry<3> grid = phantoms::Cube(8);
  grid.IndexToFrame = { { { 2.0, 0.5, 0.25 }, { 0.0, 3.0, 0.125 }, { 0.0, 0.0, 1.0 } } };
  const std::vector<Point<3>> faces = VoxelFaceCentres(CubeImage(grid), 1);
  const std::vector<Point<3>> expected = VoxelFaceCentres(CubeImage(phantoms::Cube(8)), 1);
  ASSERT_EQ(faces.size(), expected.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    EXPECT_EQ(faces[i], grid.ToFrame(expected[i]));
  }
}

// Where the image's border cuts an object, there are faces, too.
TEST(InterfacePoints, BorderOfTheImage)
{
  const LabelImage<3> all =
    phantoms::Make(phantoms::Cube(3), [](const Point<3>&) -> std::int16_t { return 2; });
  EXPECT_EQ(VoxelFaceCentres(all, 1).size(), 54U);
}

TEST(InterfacePoints, SmoothPointsLieOnTheInterface)
{
  const LabelImage<3> image = phantoms::NestedBalls(15);
  const LabelField<3> field(image, 1.0);
  const std::vector<Point<3>> voxels = VoxelFaceCentres(image, 1);
  const std::vector<Point<3>> smooth = SmoothInterfacePoints(image, field, 1);
  ASSERT_EQ(smooth.size(), voxels.size());
  EXPECT_EQ(SmoothInterfacePoints(image, field, 3), smooth);
  double moved = 0.0;
  for (std::size_t i = 0; i < smooth.size(); ++i)
  {
    EXPECT_LE(Distance(smooth[i], voxels[i]), 0.5 + 1e-12);
    moved += Distance(smooth[i], voxels[i]);
    // The label changes along one of the axes.
    bool changes = false;
    for (std::size_t a = 0; a < 3; ++a)
    {
      Point<3> before = smooth[i];
      Point<3> behind = smooth[i];
      before[a] -= 2e-3;
      behind[a] += 2e-3;
      changes = changes || field.Label(before) != field.Label(behind);
    }
    EXPECT_TRUE(changes);
  }
  EXPECT_GT(moved / static_cast<double>(smooth.size()), 0.05);
}

//------------------------------------------------------------------------------
TEST(InterfaceDistance, SameCube)
{
  const std::vector<Point<3>> faces = VoxelFaceCentres(CubeImage(phantoms::Cube(8)), 1);
  const HausdorffFigures figures = MeasureHausdorff(CubeMeshAt(0.0, 4.0), faces, nullptr, 1);
  EXPECT_EQ(figures.ImageToMesh.Points, 96U);
  EXPECT_EQ(figures.ImageToMesh.Maximum, 0.0);
  // A vertex is half a voxel, along two axes, from the centres of the faces beside it.
  EXPECT_EQ(figures.MeshToImage.Points, 8U + 12U);
  EXPECT_DOUBLE_EQ(figures.MeshToImage.Maximum, std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(figures.Distance(), std::sqrt(0.5));
}

TEST(InterfaceDistance, TranslatedCube)
{
  const std::vector<Point<3>> faces = VoxelFaceCentres(CubeImage(phantoms::Cube(8)), 1);
  const HausdorffFigures figures = MeasureHausdorff(CubeMeshAt(0.25, 4.0), faces, nullptr, 1);
  EXPECT_DOUBLE_EQ(figures.ImageToMesh.Maximum, 0.25);
  EXPECT_DOUBLE_EQ(figures.ImageToMesh.Mean, 0.25 * 32.0 / 96.0); // two faces of six are off
  EXPECT_DOUBLE_EQ(figures.ImageToMesh.Percentile99, 0.25);
  EXPECT_TRUE(figures.ImageToMesh.Place[0] == 1.5 || figures.ImageToMesh.Place[0] == 5.5);
}

// A mesh that is too large by 1 all around: the farthest from the image are its corners.
TEST(InterfaceDistance, LargerCube)
{
  const std::vector<Point<3>> faces = VoxelFaceCentres(CubeImage(phantoms::Cube(8)), 1);
  const HausdorffFigures figures = MeasureHausdorff(CubeMeshAt(0.0, 6.0), faces, nullptr, 1);
  EXPECT_DOUBLE_EQ(figures.ImageToMesh.Maximum, 1.0);
  EXPECT_DOUBLE_EQ(figures.ImageToMesh.Mean, 1.0);
  const double corner = std::sqrt(1.0 + 2.0 * 1.5 * 1.5);
  EXPECT_DOUBLE_EQ(figures.MeshToImage.Maximum, corner);
  EXPECT_DOUBLE_EQ(figures.Distance(), corner);
  for (const double x : figures.MeshToImage.Place)
  {
    EXPECT_TRUE(x == 0.5 || x == 6.5);
  }
}

// With the interface itself instead of points a voxel apart, what is left is what the mesh is off.
TEST(InterfaceDistance, Domain)
{
  const LabelImage<3> image = CubeImage(phantoms::Cube(8));
  const ImageDomain<3> domain(image, 0.0);
  const HausdorffFigures figures =
    MeasureHausdorff(CubeMeshAt(0.0, 4.0), VoxelFaceCentres(image, 1), &domain, 1);
  EXPECT_LT(figures.MeshToImage.Mean, 0.3);
  const HausdorffFigures points =
    MeasureHausdorff(CubeMeshAt(0.0, 4.0), VoxelFaceCentres(image, 1), nullptr, 1);
  EXPECT_LT(figures.MeshToImage.Mean, points.MeshToImage.Mean);
  EXPECT_LE(figures.MeshToImage.Maximum, points.MeshToImage.Maximum);
}

TEST(InterfaceDistance, NothingThere)
{
  const std::vector<Point<3>> faces{ { 1, 2, 3 } };
  const HausdorffFigures noMesh = MeasureHausdorff(SimplexMesh<3>(), faces, nullptr, 1);
  EXPECT_EQ(noMesh.ImageToMesh.Maximum, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(noMesh.MeshToImage.Maximum));
  EXPECT_TRUE(std::isnan(noMesh.Distance()));
  EXPECT_EQ(MeasureHausdorff(CubeMeshAt(0.0, 1.0), {}, nullptr, 1).MeshToImage.Maximum,
    std::numeric_limits<double>::infinity());
}

// Percentiles are those of NumPy: interpolated between ranks.
TEST(InterfaceDistance, Percentile)
{
  SimplexMesh<3> mesh = CubeMeshAt(0.0, 2.0);
  std::vector<Point<3>> points;
  for (int i = 0; i < 11; ++i)
  {
    points.push_back({ 3.5, 3.5, 4.5 + i }); // distances 0 ... 10 from the face at 4.5
  }
  const HausdorffFigures figures = MeasureHausdorff(mesh, points, nullptr, 1);
  EXPECT_DOUBLE_EQ(figures.ImageToMesh.Percentile99, 9.9);
  EXPECT_DOUBLE_EQ(figures.ImageToMesh.Mean, 5.0);
  EXPECT_EQ(figures.ImageToMesh.Place, points.back());
}

TEST(InterfaceDistance, DoesNotDependOnThreads)
{
  const LabelImage<3> image = phantoms::NestedBalls(24);
  const std::vector<Point<3>> faces = VoxelFaceCentres(image, 1);
  CubeMesh cubes;
  Random random;
  for (int i = 0; i < 3000; ++i)
  {
    const Point<3> p = random.Next(20.0);
    cubes.AddTetrahedron(
      { p, Subtract(p, random.Next()), Subtract(p, random.Next()), random.Next(20.0) }, 1);
  }
  FindInterfaces(cubes.Mesh, 1);
  const HausdorffFigures one = MeasureHausdorff(cubes.Mesh, faces, nullptr, 1);
  const HausdorffFigures three = MeasureHausdorff(cubes.Mesh, faces, nullptr, 3);
  EXPECT_GT(one.MeshToImage.Points, 8192U);
  for (const auto direction : { &HausdorffFigures::MeshToImage, &HausdorffFigures::ImageToMesh })
  {
    EXPECT_EQ((one.*direction).Maximum, (three.*direction).Maximum);
    EXPECT_EQ((one.*direction).Mean, (three.*direction).Mean);
    EXPECT_EQ((one.*direction).Percentile99, (three.*direction).Percentile99);
    EXPECT_EQ((one.*direction).Place, (three.*direction).Place);
  }
}
