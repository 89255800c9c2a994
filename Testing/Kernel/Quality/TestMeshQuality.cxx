// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** Shape measures of simplices with known shapes, and the tallies of small meshes made by hand. */
#include "CubeMeshes.h"
#include "Geometry/SimplexQuality.h"
#include "Mesh/FindInterfaces.h"
#include "Quality/MeshQuality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

namespace
{

using namespace voxplex;

template <int D>
using Vertices = std::array<Point<D>, static_cast<std::size_t>(D + 1)>;

template <int D>
std::array<const Point<D>*, static_cast<std::size_t>(D + 1)> Pointers(const Vertices<D>& vertices)
{
  std::array<const Point<D>*, static_cast<std::size_t>(D + 1)> pointers;
  for (std::size_t i = 0; i < pointers.size(); ++i)
  {
    pointers[i] = &vertices[i];
  }
  return pointers;
}

/** Every other corner of a cube. */
const Vertices<3> RegularTetrahedron = { { { 0, 0, 0 }, { 1, 1, 0 }, { 0, 1, 1 }, { 1, 0, 1 } } };

/** Unit vectors and the point that is as far from them as they are from each other, in 4D. */
Vertices<4> RegularPentatope()
{
  const double t = (1.0 + std::sqrt(5.0)) / 4.0;
  return { { { 1, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, 1, 0 }, { 0, 0, 0, 1 }, { t, t, t, t } } };
}

double Smallest(const std::array<double, 6>& angles)
{
  return *std::min_element(angles.begin(), angles.end());
}

double Largest(const std::array<double, 6>& angles)
{
  return *std::max_element(angles.begin(), angles.end());
}

/** Adds a tetrahedron with points of its own. */
void Append(SimplexMesh<3>& mesh, const Vertices<3>& vertices, std::int64_t label)
{
  const std::uint32_t first = static_cast<std::uint32_t>(mesh.Points.size());
  mesh.Points.insert(mesh.Points.end(), vertices.begin(), vertices.end());
  mesh.Simplices.push_back({ first, first + 1, first + 2, first + 3 });
  mesh.Labels.push_back(label);
}

/** Normalized volume of a tetrahedron in 4D. */
double NormalizedVolumeOfFacet(const std::array<Point<4>, 4>& v)
{
  // The same tetrahedron in a frame of its own, by Gram-Schmidt.
  std::array<Point<4>, 3> axes{};
  std::array<Point<3>, 4> inFrame{};
  for (std::size_t k = 1; k < 4; ++k)
  {
    Point<4> rest = Subtract(v[k], v[0]);
    for (std::size_t a = 0; a + 1 < k; ++a)
    {
      inFrame[k][a] = Dot(rest, axes[a]);
      for (std::size_t i = 0; i < 4; ++i)
      {
        rest[i] -= inFrame[k][a] * axes[a][i];
      }
    }
    inFrame[k][k - 1] = std::sqrt(Dot(rest, rest));
    for (std::size_t i = 0; i < 4; ++i)
    {
      axes[k - 1][i] = rest[i] / inFrame[k][k - 1];
    }
  }
  const std::array<const Point<3>*, 4> points = { &inFrame[0], &inFrame[1], &inFrame[2],
    &inFrame[3] };
  return NormalizedVolume<3>(points.data());
}

} // namespace

//------------------------------------------------------------------------------
TEST(SimplexQuality, RegularTetrahedron)
{
  const auto v = Pointers<3>(RegularTetrahedron);
  for (const double angle : DihedralAngles(v.data()))
  {
    EXPECT_NEAR(angle, 70.528779365509308, 1e-12);
  }
  EXPECT_NEAR(RadiusEdgeRatio<3>(v.data()), std::sqrt(6.0) / 4.0, 1e-14);
  EXPECT_NEAR(NormalizedVolume<3>(v.data()), 1.0, 1e-14);
  EXPECT_NEAR(std::abs(SignedVolume<3>(v.data())), 1.0 / 3.0, 1e-15);
  EXPECT_DOUBLE_EQ(ShortestEdge2<3>(v.data()), 2.0);
}

TEST(SimplexQuality, RegularPentatope)
{
  const Vertices<4> vertices = RegularPentatope();
  const auto v = Pointers<4>(vertices);
  EXPECT_NEAR(RadiusEdgeRatio<4>(v.data()), std::sqrt(10.0) / 5.0, 1e-14);
  EXPECT_NEAR(NormalizedVolume<4>(v.data()), 1.0, 1e-13);
  // sqrt(5) / 96 edge^4 with edge sqrt(2).
  EXPECT_NEAR(std::abs(SignedVolume<4>(v.data())), std::sqrt(5.0) / 24.0, 1e-14);
}

// So a pentatope that is no sliver has no sliver among its facets (Rules4D.h).
TEST(SimplexQuality, NoFacetHasASmallerNormalizedVolumeThanItsPentatope)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  double smallestExcess = 1.0;
  for (int n = 0; n < 20000; ++n)
  {
    const double flatness = std::pow(10.0, -(n % 4)); // of the last axis
    std::array<Point<4>, 5> p;
    std::array<const Point<4>*, 5> points;
    for (std::size_t k = 0; k < 5; ++k)
    {
      p[k] = { coordinate(random), coordinate(random), coordinate(random),
        flatness * coordinate(random) };
      points[k] = &p[k];
    }
    const double ofPentatope = NormalizedVolume<4>(points.data());
    for (std::size_t opposite = 0; opposite < 5; ++opposite)
    {
      std::array<Point<4>, 4> facet;
      std::copy_if(
        p.begin(), p.end(), facet.begin(), [&](const Point<4>& x) { return &x != &p[opposite]; });
      const double ofFacet = NormalizedVolumeOfFacet(facet);
      EXPECT_GE(ofFacet, ofPentatope * (1.0 - 1e-6));
      smallestExcess = std::min(smallestExcess, ofFacet / ofPentatope - 1.0);
    }
  }
  EXPECT_LT(smallestExcess, 0.01) << "the bound is sharp";
}

TEST(SimplexQuality, CornerOfACube)
{
  const Vertices<3> corner = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
  const auto v = Pointers<3>(corner);
  EXPECT_DOUBLE_EQ(SignedVolume<3>(v.data()), 1.0 / 6.0);
  const std::array<double, 6> angles = DihedralAngles(v.data());
  const double slanted = std::atan(std::numbers::sqrt2) * 180.0 / std::numbers::pi; // 54.7
  for (std::size_t i = 0; i < 6; ++i)
  {
    EXPECT_NEAR(angles[i], i < 3 ? 90.0 : slanted, 1e-12) << i;
  }
  EXPECT_NEAR(RadiusEdgeRatio<3>(v.data()), std::sqrt(0.75), 1e-14);

  Vertices<3> mirrored = corner;
  std::swap(mirrored[0], mirrored[1]);
  EXPECT_DOUBLE_EQ(SignedVolume<3>(Pointers<3>(mirrored).data()), -1.0 / 6.0);
}

// A path of three unequal edges at right angles: the angles tell the edges apart.
TEST(SimplexQuality, DihedralAnglesAreInOrder)
{
  const Vertices<3> path = { { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 2, 0 }, { 1, 2, 3 } } };
  const std::array<double, 6> angles = DihedralAngles(Pointers<3>(path).data());
  const double degrees = 180.0 / std::numbers::pi;
  EXPECT_NEAR(angles[0], std::atan2(3.0, 2.0) * degrees, 1e-12); // 01: between z = 0 and y/2 = z/3
  EXPECT_NEAR(angles[1], 90.0, 1e-12);                           // 02
  EXPECT_NEAR(angles[3], 90.0, 1e-12);                           // 12
  EXPECT_NEAR(angles[4], 90.0, 1e-12);                           // 13
  EXPECT_NEAR(angles[5], std::atan2(1.0, 2.0) * degrees, 1e-12); // 23: between x = 1 and y = 2x
  // 03: from the normals (0, 3, -2) and (2, -1, 0).
  EXPECT_NEAR(angles[2], std::acos(3.0 / std::sqrt(65.0)) * degrees, 1e-12);
}

// A sliver: two crossing edges of a square, height apart. Its radius-edge ratio is good, its
// dihedral angles tell: near 0 at the sides of the square and near 180 at the crossing edges.
TEST(SimplexQuality, SliverAnglesAreAccurate)
{
  for (const double height : { 1e-3, 1e-6, 1e-9 })
  {
    const Vertices<3> sliver = { { { -1, 0, 0 }, { 1, 0, 0 }, { 0, -1, height },
      { 0, 1, height } } };
    const auto v = Pointers<3>(sliver);
    const std::array<double, 6> angles = DihedralAngles(v.data());
    // At the edge 01 the two facets rise by height over a distance of 1.
    const double below180 = 2.0 * std::atan(height) * 180.0 / std::numbers::pi;
    EXPECT_NEAR(180.0 - Largest(angles), below180, 1e-6 * below180 + 1e-13);
    // At the sides the facets' normals are (0, h, 1) and (h, 0, 1) up to signs.
    const double small =
      std::atan(height * std::sqrt(2.0 + height * height)) * 180.0 / std::numbers::pi;
    EXPECT_NEAR(Smallest(angles), small, 1e-12 * small);
    EXPECT_NEAR(RadiusEdgeRatio<3>(v.data()), 1.0 / std::numbers::sqrt2, 1e-3);
    EXPECT_LT(NormalizedVolume<3>(v.data()), 2.0 * height);
  }
}

// A cap: a point just above the middle of a regular triangle. Its radius is large.
TEST(SimplexQuality, CapHasALargeRadius)
{
  const double height = 1e-6;
  const double s = 0.5 * std::numbers::sqrt3;
  const Vertices<3> cap = { { { 1, 0, 0 }, { -0.5, s, 0 }, { -0.5, -s, 0 }, { 0, 0, height } } };
  const auto v = Pointers<3>(cap);
  // A sphere through the unit circle and a point at that height over it: R = (1 + h^2) / 2 h.
  const double radius = (1.0 + height * height) / (2.0 * height);
  const double shortest = std::sqrt(1.0 + height * height);
  EXPECT_NEAR(RadiusEdgeRatio<3>(v.data()) / (radius / shortest), 1.0, 1e-9);
  const std::array<double, 6> angles = DihedralAngles(v.data());
  EXPECT_GT(Largest(angles), 179.99);
  EXPECT_NEAR(Smallest(angles), std::atan(2.0 * height) * 180.0 / std::numbers::pi, 1e-12);
}

TEST(SimplexQuality, FlatSimplex)
{
  const Vertices<3> flat = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } } };
  const auto v = Pointers<3>(flat);
  EXPECT_EQ(RadiusEdgeRatio<3>(v.data()), std::numeric_limits<double>::infinity());
  EXPECT_EQ(NormalizedVolume<3>(v.data()), 0.0);
  EXPECT_EQ(Smallest(DihedralAngles(v.data())), 0.0);
  EXPECT_EQ(Largest(DihedralAngles(v.data())), 180.0);
}

TEST(SimplexQuality, PlanarAngles)
{
  const std::array<double, 3> angles =
    PlanarAngles({ 0, 0, 5 }, { 1, 0, 5 }, { 0, std::sqrt(3.0), 5 });
  EXPECT_NEAR(angles[0], 90.0, 1e-12);
  EXPECT_NEAR(angles[1], 60.0, 1e-12);
  EXPECT_NEAR(angles[2], 30.0, 1e-12);

  const double height = 1e-8; // a needle that acos would round to 0 and 180
  const std::array<double, 3> thin = PlanarAngles({ -1, 0, 0 }, { 1, 0, 0 }, { 0, height, 0 });
  const double small = height * 180.0 / std::numbers::pi;
  EXPECT_NEAR(thin[0], small, 1e-12 * small);
  EXPECT_NEAR(thin[1], small, 1e-12 * small);
  EXPECT_NEAR(180.0 - thin[2], 2.0 * small, 1e-6 * small);
}

//------------------------------------------------------------------------------
TEST(MeshQuality, EmptyMesh)
{
  const MeshQuality quality = MeasureQuality<3>(SimplexMesh<3>(), 2.0, 30.0, 1);
  for (const double figure :
    { quality.ShortestEdge, quality.MaximumRadiusEdgeRatio, quality.MeanRadiusEdgeRatio,
      quality.RadiusEdgeRatioDeviation, quality.MeanNormalizedVolume,
      quality.NormalizedVolumeDeviation, quality.MinimumDihedralAngle, quality.MinimumFacetAngle })
  {
    EXPECT_TRUE(std::isnan(figure));
  }
  EXPECT_EQ(std::count(quality.NormalizedVolumes.begin(), quality.NormalizedVolumes.end(), 0U), 20);
  EXPECT_EQ(quality.InvertedSimplices, 0U);
  EXPECT_TRUE(quality.Labels.empty());
}

TEST(MeshQuality, CountsElements)
{
  const Vertices<3> corner = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
  Vertices<3> inverted = corner;
  std::swap(inverted[2], inverted[3]);
  const Vertices<3> flat = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } } };
  const Vertices<3> needle = { { { 0, 0, 0 }, { 0.1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };

  SimplexMesh<3> mesh;
  Append(mesh, corner, 7);
  Append(mesh, needle, -2);
  Append(mesh, corner, 7);
  MeshQuality quality = MeasureQuality(mesh, 2.0, 30.0, 1);
  EXPECT_EQ(quality.InvertedSimplices, 0U);
  EXPECT_NEAR(quality.MaximumRadiusEdgeRatio, std::sqrt(2.01) / 2.0 / 0.1, 1e-12);
  EXPECT_EQ(quality.RadiusEdgeViolations, 1U);
  EXPECT_NEAR(quality.MaximumDihedralAngle, 90.0, 1e-12);
  EXPECT_LT(quality.MinimumDihedralAngle, 54.0);
  EXPECT_GT(quality.MinimumDihedralAngle, 5.0);
  EXPECT_LT(quality.MinimumNormalizedVolume, quality.MeanNormalizedVolume);
  ASSERT_EQ(quality.Labels.size(), 2U);
  EXPECT_EQ(quality.Labels[0].Label, -2);
  EXPECT_EQ(quality.Labels[0].Elements, 1U);
  EXPECT_NEAR(quality.Labels[0].Volume, 0.1 / 6.0, 1e-15);
  EXPECT_EQ(quality.Labels[1].Label, 7);
  EXPECT_EQ(quality.Labels[1].Elements, 2U);
  EXPECT_NEAR(quality.Labels[1].Volume, 2.0 / 6.0, 1e-15);
  EXPECT_TRUE(std::isnan(quality.MinimumFacetAngle));

  // A ratio that equals the bound violates it.
  EXPECT_EQ(MeasureQuality(mesh, quality.MaximumRadiusEdgeRatio, 30.0, 1).RadiusEdgeViolations, 1U);
  EXPECT_EQ(MeasureQuality(mesh, 0.5, 30.0, 1).RadiusEdgeViolations, 3U);

  Append(mesh, inverted, 7);
  Append(mesh, flat, 7);
  quality = MeasureQuality(mesh, 2.0, 30.0, 1);
  EXPECT_EQ(quality.InvertedSimplices, 2U);
  EXPECT_EQ(quality.RadiusEdgeViolations, 2U);
  EXPECT_EQ(quality.MaximumRadiusEdgeRatio, std::numeric_limits<double>::infinity());
  EXPECT_EQ(quality.MinimumNormalizedVolume, 0.0);
  EXPECT_EQ(quality.MaximumDihedralAngle, 180.0);
}

//------------------------------------------------------------------------------
// Regular tetrahedra have normalized volume 1 and the smallest ratio; corners of a cube with edges
// 1, 1 and h have the circumradius sqrt(2 + h^2) / 2.
TEST(MeshQuality, MeansAndDeviations)
{
  SimplexMesh<3> mesh;
  Append(mesh, RegularTetrahedron, 1);
  MeshQuality quality = MeasureQuality(mesh, 2.0, 30.0, 1);
  EXPECT_DOUBLE_EQ(quality.ShortestEdge, std::numbers::sqrt2);
  EXPECT_NEAR(quality.MeanRadiusEdgeRatio, std::sqrt(6.0) / 4.0, 1e-14);
  EXPECT_EQ(quality.RadiusEdgeRatioDeviation, 0.0);
  EXPECT_EQ(quality.NormalizedVolumeDeviation, 0.0);
  EXPECT_EQ(quality.NormalizedVolumes.back(), 1U); // 1, give or take rounding

  const double heights[] = { 0.9, 0.5, 0.25 };
  for (const double h : heights)
  {
    Append(mesh, { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, h } } }, 1);
  }
  std::vector<double> ratios = { std::sqrt(6.0) / 4.0 };
  std::vector<double> volumes = { 1.0 };
  for (const double h : heights)
  {
    const double radius = std::sqrt(2.0 + h * h) / 2.0;
    ratios.push_back(radius / h);
    volumes.push_back(h / 6.0 / (8.0 / (9.0 * std::numbers::sqrt3) * radius * radius * radius));
  }
  const auto mean = [](const std::vector<double>& x) { return (x[0] + x[1] + x[2] + x[3]) / 4.0; };
  const auto deviation = [&mean](const std::vector<double>& x)
  {
    double sum = 0.0;
    for (const double v : x)
    {
      sum += (v - mean(x)) * (v - mean(x)) / 4.0;
    }
    return std::sqrt(sum);
  };
  quality = MeasureQuality(mesh, 2.0, 30.0, 1);
  EXPECT_DOUBLE_EQ(quality.ShortestEdge, 0.25);
  EXPECT_NEAR(quality.MeanRadiusEdgeRatio, mean(ratios), 1e-14);
  EXPECT_NEAR(quality.RadiusEdgeRatioDeviation, deviation(ratios), 1e-14);
  EXPECT_NEAR(quality.MeanNormalizedVolume, mean(volumes), 1e-14);
  EXPECT_NEAR(quality.NormalizedVolumeDeviation, deviation(volumes), 1e-14);

  std::array<std::uint64_t, MeshQuality::NumberOfBins> bins{};
  bins.back() = 1;
  for (std::size_t i = 1; i < volumes.size(); ++i)
  {
    ++bins[static_cast<std::size_t>(std::floor(20.0 * volumes[i]))];
  }
  EXPECT_EQ(quality.NormalizedVolumes, bins);
}

// A flat element has no radius: the mean is infinite, and the deviation undefined.
TEST(MeshQuality, FlatElements)
{
  SimplexMesh<3> mesh;
  Append(mesh, RegularTetrahedron, 1);
  Append(mesh, { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } } }, 1);
  Append(mesh, RegularTetrahedron, 1);
  const MeshQuality quality = MeasureQuality(mesh, 2.0, 30.0, 1);
  EXPECT_DOUBLE_EQ(quality.ShortestEdge, 1.0);
  EXPECT_EQ(quality.MeanRadiusEdgeRatio, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(quality.RadiusEdgeRatioDeviation));
  EXPECT_NEAR(quality.NormalizedVolumeDeviation, std::sqrt(2.0) / 3.0, 1e-14);
  EXPECT_EQ(quality.NormalizedVolumes.front(), 1U);
  EXPECT_EQ(quality.NormalizedVolumes.back(), 2U);
}

// Deviations that are small compared with the mean survive, over more chunks than one.
TEST(MeshQuality, DeviationsDoNotCancel)
{
  SimplexMesh<3> mesh;
  const auto corner = [](double h) {
    return Vertices<3>{ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, h } } };
  };
  const double low = 0.5;
  const double high = 0.5 + 1e-9;
  for (int i = 0; i < 20000; ++i)
  {
    Append(mesh, corner(i < 10000 ? low : high), 1);
  }
  const auto ratio = [&corner](double h)
  {
    const Vertices<3> vertices = corner(h);
    return RadiusEdgeRatio<3>(Pointers<3>(vertices).data());
  };
  const double expected = (ratio(low) - ratio(high)) / 2.0;
  EXPECT_NEAR(MeasureQuality(mesh, 2.0, 30.0, 2).RadiusEdgeRatioDeviation / expected, 1.0, 1e-4);
}

//------------------------------------------------------------------------------
// Two facets meet in point 0 and one lies far away, all below the bound. With labels 1 | 2
// everywhere there is no junction; another label on one of the two makes point 0 a junction, which
// the third never touches.
TEST(MeshQuality, CountsFacetsAtJunctions)
{
  SimplexMesh<3> mesh;
  mesh.Points = { { 0, 0, 0 }, { 4, 1, 0 }, { 4, 0, 0 }, { -4, 1, 0 }, { -4, 0, 0 }, { 9, 9, 9 },
    { 13, 10, 9 }, { 13, 9, 9 }, { 20, 0, 0 }, { 21, 0, 0 }, { 20, 1, 0 } };
  mesh.Facets = { { 1, 0, 2 }, { 3, 4, 0 }, { 5, 6, 7 }, { 8, 9, 10 } };
  mesh.FacetLabels = { { 2, 1 }, { 2, 1 }, { 2, 1 }, { 2, 1 } };
  MeshQuality quality = MeasureQuality(mesh, 2.0, 30.0, 1);
  EXPECT_NEAR(quality.MinimumFacetAngle, std::atan(0.25) * 180.0 / std::numbers::pi, 1e-12);
  EXPECT_EQ(quality.FacetAngleViolations, 3U); // the last facet has 45, 45 and 90 degrees
  EXPECT_EQ(quality.FacetAngleViolationsAtJunctions, 0U);

  mesh.FacetLabels[1] = { 3, 2 };
  quality = MeasureQuality(mesh, 2.0, 30.0, 1);
  EXPECT_EQ(quality.FacetAngleViolations, 3U);
  EXPECT_EQ(quality.FacetAngleViolationsAtJunctions, 2U);

  mesh.FacetLabels[1] = { 2, 0 }; // background is a label
  EXPECT_EQ(MeasureQuality(mesh, 2.0, 30.0, 1).FacetAngleViolationsAtJunctions, 2U);

  // Four labels at a point, in two disjoint pairs.
  mesh.FacetLabels[1] = { 4, 3 };
  EXPECT_EQ(MeasureQuality(mesh, 2.0, 30.0, 1).FacetAngleViolationsAtJunctions, 2U);

  EXPECT_EQ(MeasureQuality(mesh, 2.0, 10.0, 1).FacetAngleViolations, 0U);
  EXPECT_EQ(MeasureQuality(mesh, 2.0, 10.0, 1).FacetAngleViolationsAtJunctions, 0U);
}

//------------------------------------------------------------------------------
// Kuhn's split of a cube: each tetrahedron has dihedral angles of 45, 45, 60, 90, 90 and 90 degrees, the
// cube's faces those of halved squares; all have the cube's circumsphere.
TEST(MeshQuality, HistogramsOfACube)
{
  CubeMesh cubes;
  cubes.AddBox({ 0, 0, 0 }, { 1, 1, 1 }, 1);
  cubes.AddTetrahedron({ { { 5, 5, 5 }, { 6, 6, 5 }, { 5, 6, 6 }, { 6, 5, 6 } } }, 1); // regular
  FindInterfaces(cubes.Mesh, 1);
  const MeshQuality quality = MeasureQuality(cubes.Mesh, 2.0, 30.0, 1);
  const auto total = [](const auto& bins)
  { return std::accumulate(bins.begin(), bins.end(), std::uint64_t{ 0 }); };
  EXPECT_EQ(total(quality.DihedralAngles), 42U);
  EXPECT_EQ(quality.DihedralAngles[22], 12U); // 45 degrees
  EXPECT_EQ(
    quality.DihedralAngles[29] + quality.DihedralAngles[30], 6U); // 60, give or take rounding
  EXPECT_EQ(quality.DihedralAngles[35], 6U);                      // 70.53
  EXPECT_EQ(quality.DihedralAngles[44] + quality.DihedralAngles[45], 18U); // 90
  EXPECT_EQ(total(quality.RadiusEdgeRatios), 7U);
  EXPECT_EQ(quality.RadiusEdgeRatios[12], 1U); // sqrt(6) / 4 = 0.612
  EXPECT_EQ(quality.RadiusEdgeRatios[17], 6U); // sqrt(3) / 2 = 0.866
  EXPECT_EQ(total(quality.PlanarAngles), 48U);
  EXPECT_EQ(quality.PlanarAngles[22], 24U);
  EXPECT_EQ(quality.PlanarAngles[44] + quality.PlanarAngles[45], 12U);
  EXPECT_EQ(quality.PlanarAngles[29] + quality.PlanarAngles[30], 12U);
}

TEST(MeshQuality, WhatLiesBeyondTheLastBinCountsThere)
{
  SimplexMesh<3> mesh;
  Append(mesh, { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } } }, 1); // flat
  const MeshQuality quality = MeasureQuality(mesh, 2.0, 30.0, 1);
  EXPECT_EQ(quality.RadiusEdgeRatios.back(), 1U);
  EXPECT_EQ(quality.DihedralAngles.front(), 4U);
  EXPECT_EQ(quality.DihedralAngles.back(), 2U); // 180
}

// Facets with angles of 14 and 45 degrees, at a junction and off it.
TEST(MeshQuality, SmallestFacetAngleAtJunctionsAndOffThem)
{
  SimplexMesh<3> mesh;
  mesh.Points = { { 0, 0, 0 }, { 4, 1, 0 }, { 4, 0, 0 }, { -4, 1, 0 }, { -4, 0, 0 }, { 20, 0, 0 },
    { 21, 0, 0 }, { 20, 1, 0 } };
  mesh.Facets = { { 1, 0, 2 }, { 3, 4, 0 }, { 5, 6, 7 } };
  mesh.FacetLabels = { { 2, 1 }, { 3, 2 }, { 2, 1 } };
  MeshQuality quality = MeasureQuality(mesh, 2.0, 30.0, 1);
  const double small = std::atan(0.25) * 180.0 / std::numbers::pi;
  EXPECT_NEAR(quality.MinimumFacetAngleAtJunctions, small, 1e-12);
  EXPECT_NEAR(quality.MinimumFacetAngleOffJunctions, 45.0, 1e-12);
  EXPECT_NEAR(quality.MinimumFacetAngle, small, 1e-12);
  EXPECT_EQ(quality.SmallFacetAnglesAtJunctions, 2U);

  mesh.FacetLabels[1] = { 2, 1 }; // no junction
  quality = MeasureQuality(mesh, 2.0, 30.0, 1);
  EXPECT_TRUE(std::isnan(quality.MinimumFacetAngleAtJunctions));
  EXPECT_NEAR(quality.MinimumFacetAngleOffJunctions, small, 1e-12);
  EXPECT_EQ(quality.SmallFacetAnglesAtJunctions, 0U);

  mesh.FacetLabels[1] = { 3, 2 };
  mesh.Points[1][1] = mesh.Points[3][1] = 1.6; // 21.8 degrees: below 30, not below 20
  quality = MeasureQuality(mesh, 2.0, 30.0, 1);
  EXPECT_EQ(quality.FacetAngleViolationsAtJunctions, 2U);
  EXPECT_EQ(quality.SmallFacetAnglesAtJunctions, 0U);
}

//------------------------------------------------------------------------------
TEST(MeshQuality, DoesNotDependOnThreads)
{
  SimplexMesh<3> mesh;
  for (int i = 0; i < 20000; ++i)
  {
    const double t = 1e-3 * i;
    Append(mesh, { { { t, 0, 0 }, { 1, std::sin(t), 0 }, { 0, 1, std::cos(t) }, { 0, t, 1.5 } } },
      i % 7);
    const std::uint32_t first = mesh.Simplices.back()[0];
    mesh.Facets.push_back({ first, first + 1, first + 2 });
    mesh.FacetLabels.push_back({ i % 3 + 1, 0 });
  }
  const MeshQuality one = MeasureQuality(mesh, 1.0, 30.0, 1);
  const MeshQuality three = MeasureQuality(mesh, 1.0, 30.0, 3);
  EXPECT_EQ(one.MaximumRadiusEdgeRatio, three.MaximumRadiusEdgeRatio);
  EXPECT_EQ(one.RadiusEdgeViolations, three.RadiusEdgeViolations);
  EXPECT_EQ(one.MinimumDihedralAngle, three.MinimumDihedralAngle);
  EXPECT_EQ(one.MaximumDihedralAngle, three.MaximumDihedralAngle);
  EXPECT_EQ(one.ShortestEdge, three.ShortestEdge);
  EXPECT_EQ(one.MeanRadiusEdgeRatio, three.MeanRadiusEdgeRatio);
  EXPECT_EQ(one.RadiusEdgeRatioDeviation, three.RadiusEdgeRatioDeviation);
  EXPECT_GT(one.RadiusEdgeRatioDeviation, 0.0);
  EXPECT_EQ(one.MeanNormalizedVolume, three.MeanNormalizedVolume);
  EXPECT_EQ(one.NormalizedVolumeDeviation, three.NormalizedVolumeDeviation);
  EXPECT_EQ(one.NormalizedVolumes, three.NormalizedVolumes);
  EXPECT_EQ(one.DihedralAngles, three.DihedralAngles);
  EXPECT_EQ(one.RadiusEdgeRatios, three.RadiusEdgeRatios);
  EXPECT_EQ(one.PlanarAngles, three.PlanarAngles);
  EXPECT_EQ(
    std::accumulate(one.NormalizedVolumes.begin(), one.NormalizedVolumes.end(), 0U), 20000U);
  EXPECT_EQ(one.InvertedSimplices, three.InvertedSimplices);
  EXPECT_EQ(one.MinimumFacetAngle, three.MinimumFacetAngle);
  EXPECT_EQ(one.FacetAngleViolations, three.FacetAngleViolations);
  ASSERT_EQ(one.Labels.size(), 7U);
  ASSERT_EQ(three.Labels.size(), 7U);
  std::uint64_t elements = 0;
  for (std::size_t i = 0; i < 7; ++i)
  {
    EXPECT_EQ(one.Labels[i].Volume, three.Labels[i].Volume);
    EXPECT_EQ(one.Labels[i].Elements, three.Labels[i].Elements);
    elements += one.Labels[i].Elements;
  }
  EXPECT_EQ(elements, 20000U);
}

//------------------------------------------------------------------------------
TEST(MeshQuality, Pentatopes)
{
  SimplexMesh<4> mesh;
  const Vertices<4> vertices = RegularPentatope();
  mesh.Points.assign(vertices.begin(), vertices.end());
  const bool positive = SignedVolume<4>(Pointers<4>(vertices).data()) > 0.0;
  mesh.Simplices = { { 0, 1, 2, 3, 4 }, { 1, 0, 2, 3, 4 } };
  mesh.Labels = { 5, 5 };
  const MeshQuality quality = MeasureQuality(mesh, 2.0, 30.0, 1);
  EXPECT_EQ(quality.InvertedSimplices, 1U);
  EXPECT_NEAR(quality.MaximumRadiusEdgeRatio, std::sqrt(10.0) / 5.0, 1e-14);
  EXPECT_NEAR(quality.MeanRadiusEdgeRatio, std::sqrt(10.0) / 5.0, 1e-14);
  EXPECT_NEAR(quality.RadiusEdgeRatioDeviation, 0.0, 1e-14);
  EXPECT_NEAR(quality.ShortestEdge, std::numbers::sqrt2, 1e-14);
  EXPECT_NEAR(quality.MinimumNormalizedVolume, 1.0, 1e-13);
  EXPECT_NEAR(quality.MeanNormalizedVolume, 1.0, 1e-13);
  EXPECT_EQ(quality.NormalizedVolumes.back(), 2U);
  EXPECT_TRUE(std::isnan(quality.MinimumDihedralAngle));
  EXPECT_TRUE(std::isnan(quality.MinimumFacetAngle));
  mesh.Simplices.resize(1);
  mesh.Labels.resize(1);
  EXPECT_EQ(MeasureQuality(mesh, 2.0, 30.0, 1).InvertedSimplices, positive ? 0U : 1U);
}
