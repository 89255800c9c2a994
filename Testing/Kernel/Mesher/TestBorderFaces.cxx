// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Where the border of a 3D image cuts an object: flat faces and straight edges of the mesh. For the domain see
// Domain/TestImageBorder.cxx.
#include "ComplexOf.h"
#include "Conformity/ManifoldRepair.h"
#include "Domain/ImageDomain.h"
#include "Image/IsosurfaceImage.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Optimisation/Tetrahedra/MeshOptimiser.h"
#include "Phantoms.h"
#include "RefinementChecks.h"
#include "RepairTesting.h"
#include "Sanitizers.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

LabelImage<3> LargeCutHalves()
{
  return phantoms::CutHalves(
    GridGeometry<3>::Orthogonal({ 64, 60, 56 }, { 1.0, 1.0, 1.0 }), { 20.3, 30.1, 18.7 }, 28.0);
}

/** Of the facets on each cut face, by its number. */
std::array<double, 6> FlatAreas(const SimplexMesh<3>& mesh, const Domain<3>& domain)
{
  std::array<double, 6> areas{};
  for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
  {
    unsigned faces = ~0u;
    for (const std::uint32_t v : mesh.Facets[f])
    {
      faces &= domain.Border()->FacesAt(mesh.Points[v]);
    }
    for (unsigned face = 0; face < 6; ++face)
    {
      areas[face] += (faces >> face) & 1 ? AreaOf(mesh, mesh.Facets[f]) : 0.0;
    }
  }
  return areas;
}

/** Of a face of a voxel that is perpendicular to, or spanned by the other axes than, an axis of the image. */
double VoxelFace(const GridGeometry<3>& grid, std::size_t axis)
{
  Point<3> a{};
  Point<3> b{};
  a[(axis + 1) % 3] = 1.0;
  b[(axis + 2) % 3] = 1.0;
  const Point<3> n = checks::Cross(grid.ToFrame(a), grid.ToFrame(b));
  return std::sqrt(Dot(n, n));
}

/** Of the voxels of a label, any but background if 0, in the outermost layer at each face of the image. */
std::array<double, 6> VoxelAreas(const LabelImage<3>& image)
{
  std::array<double, 6> areas{};
  const auto& n = image.CropDimensions();
  std::size_t at = 0;
  for (std::int64_t z = 0; z < n[2]; ++z)
  {
    for (std::int64_t y = 0; y < n[1]; ++y)
    {
      for (std::int64_t x = 0; x < n[0]; ++x, ++at)
      {
        const GridGeometry<3>::Index v{ x, y, z };
        for (std::size_t a = 0; a < 3 && image.Ids()[at] != 0; ++a)
        {
          areas[2 * a] += v[a] == 0 && image.ReachesBorder(a, 0) ? VoxelFace(image.Grid(), a) : 0.0;
          areas[2 * a + 1] +=
            v[a] == n[a] - 1 && image.ReachesBorder(a, 1) ? VoxelFace(image.Grid(), a) : 0.0;
        }
      }
    }
  }
  return areas;
}

/**
 * How many points of a cut face, four a voxel and two voxels or more away from its edges, no flat facet of the mesh
 * covers: those over notches.
 */
int CountUncovered(const SimplexMesh<3>& mesh, const LabelImage<3>& image, std::size_t axis)
{
  const GridGeometry<3>& grid = image.Grid();
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  using Flat = std::array<double, 2>;
  std::vector<std::array<Flat, 3>> triangles; // in indices
  for (const auto& facet : mesh.Facets)
  {
    std::array<Flat, 3> triangle;
    bool isFlat = true;
    for (std::size_t i = 0; i < 3; ++i)
    {
      const Point<3> index = grid.ToIndex(mesh.Points[facet[i]]);
      triangle[i] = { index[u], index[v] };
      isFlat = isFlat && std::abs(index[axis] + 0.5) < 1e-6;
    }
    if (isFlat)
    {
      triangles.push_back(triangle);
    }
  }
  const auto side = [](const Flat& a, const Flat& b, const Flat& p)
  { return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]); };
  const auto isInside = [&](std::int64_t i, std::int64_t j)
  {
    GridGeometry<3>::Index voxel{};
    voxel[u] = i - image.CropOrigin()[u];
    voxel[v] = j - image.CropOrigin()[v];
    return i >= 0 && j >= 0 && image.At(voxel) != 0;
  };
  int uncovered = 0;
  for (std::int64_t i = 2; i + 2 < grid.Dimensions[u]; ++i)
  {
    for (std::int64_t j = 2; j + 2 < grid.Dimensions[v]; ++j)
    {
      bool interior = true;
      for (int k = 0; k < 25; ++k)
      {
        interior = interior && isInside(i + k % 5 - 2, j + k / 5 - 2);
      }
      for (int k = 0; k < 4 && interior; ++k)
      {
        const Flat p{ static_cast<double>(i) + 0.5 * (k % 2) + 0.01,
          static_cast<double>(j) + 0.5 * (k / 2) + 0.02 };
        uncovered += std::none_of(triangles.begin(), triangles.end(),
          [&](const std::array<Flat, 3>& t)
          {
            const double a = side(t[0], t[1], p);
            const double b = side(t[1], t[2], p);
            const double c = side(t[2], t[0], p);
            return (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
          });
      }
    }
  }
  return uncovered;
}

SimplexMesh<3> Mesh(const LabelImage<3>& image, const MeshingOptions<3>& options)
{
  SimplexMesh<3> mesh = MeshOf(image, options);
  ExpectSound(mesh);
  return mesh;
}

/** Optimisation may do nearly anything. */
OptimisationOptions Wild()
{
  OptimisationOptions options;
  options.SmallestDihedralAngle = 40.0;
  options.LargestDihedralAngle = 115.0;
  options.Shape.FacetAngle = 5.0;
  options.Shape.JunctionFacetAngle = 5.0;
  options.CreaseAngle = 90.0;
  options.InterfaceTolerance = 0.4;
  return options;
}

std::size_t CountOnBorder(const SimplexMesh<3>& mesh, const Domain<3>& domain)
{
  return static_cast<std::size_t>(std::count_if(mesh.Points.begin(), mesh.Points.end(),
    [&](const Point<3>& p) { return domain.Border()->FacesAt(p) != 0; }));
}

} // namespace

//------------------------------------------------------------------------------------------------
// A block comes out as it is with every delta: its volume, six flat faces. So do some with sheared axes.
TEST(BorderFaces, MeshesOfBlocksAreExact)
{
  for (const auto& grid :
    { GridGeometry<3>::Orthogonal({ 20, 17, 14 }, { 1.0, 0.8, 1.5 }), phantoms::ObliqueGrid(20) })
  {
    const LabelImage<3> image = phantoms::Block(grid);
    const ImageDomain<3> domain(image, 1.0);
    const std::array<double, 6> expected = VoxelAreas(image);
    double volume = 1.0;
    for (std::size_t a = 0; a < 3; ++a)
    {
      volume *= grid.IndexToFrame[a][a] * static_cast<double>(grid.Dimensions[a]);
    }
    for (const double delta : { 1.1, 2.3, 5.0 })
    {
      for (const bool optimise : { false, true })
      {
        SCOPED_TRACE(testing::Message() << delta << (optimise ? ", optimised" : ""));
        MeshingOptions<3> options = WithDelta<3>(delta);
        options.Optimisation.Run = optimise;
        const SimplexMesh<3> mesh = Mesh(image, options);
        EXPECT_NEAR(Volumes(mesh).at(1), volume, 1e-9 * volume);
        const std::array<double, 6> areas = FlatAreas(mesh, domain);
        double whole = 0.0;
        for (const auto& facet : mesh.Facets)
        {
          whole += AreaOf(mesh, facet);
        }
        for (unsigned face = 0; face < 6; ++face)
        {
          EXPECT_NEAR(areas[face], expected[face], 1e-9 * expected[face]) << face;
          whole -= areas[face];
        }
        EXPECT_NEAR(whole, 0.0, 1e-9 * volume);
      }
    }
  }
}

// Flat up to chords along the edges, and nothing of the mesh beyond.
TEST(BorderFaces, OfTwoLabelsAreFlatInTheMesh)
{
  for (const auto& grid : { phantoms::Cube(30), phantoms::ObliqueGrid(30) })
  {
    const LabelImage<3> image = phantoms::CutHalves(grid);
    const ImageDomain<3> domain(image, 1.0);
    const std::array<double, 6> expected = VoxelAreas(image);
    for (const double delta : { 0.9, 1.2, 1.5 })
    {
      for (const unsigned threads : { 1u, 3u })
      {
        SCOPED_TRACE(
          testing::Message() << delta << ", threads: " << threads << ", " << grid.Dimensions[1]);
        MeshingOptions<3> options = WithDelta<3>(delta);
        options.Team.Threads = threads;
        const SimplexMesh<3> mesh = Mesh(image, options);
        for (const Point<3>& p : mesh.Points)
        {
          const Point<3> index = grid.ToIndex(p);
          EXPECT_GE(index[0], -0.5 - 1e-9);
          EXPECT_GE(index[2], -0.5 - 1e-9);
        }
        const std::array<double, 6> areas = FlatAreas(mesh, domain);
        for (const unsigned face : { 0u, 4u })
        {
          EXPECT_NEAR(areas[face], expected[face], 0.03 * expected[face]) << face;
          EXPECT_EQ(CountUncovered(mesh, image, face / 2), 0) << face;
        }
        if (threads == 1)
        {
          options.Interfaces.SampleJunctions = false;
          const std::array<double, 6> rough = FlatAreas(Mesh(image, options), domain);
          EXPECT_LT(rough[0], areas[0]); // without their edges faces are not whole
        }
      }
    }
  }
}

// Vertices of the interface of the two labels just below a face take no facet's place there.
TEST(BorderFaces, HaveNoNotches)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<3> image = LargeCutHalves();
  for (const double delta : { 1.0, 1.5, 2.0, 3.0 })
  {
    const SimplexMesh<3> mesh = Mesh(image, WithDelta<3>(delta));
    EXPECT_EQ(CountUncovered(mesh, image, 0), 0) << delta;
    EXPECT_EQ(CountUncovered(mesh, image, 2), 0) << delta;
  }
}

// Wherever the interface of two labels meets these faces, at any angle.
TEST(BorderFaces, HaveNoNotchesAtAnyInterface)
{
  for (const auto& grid : { phantoms::Cube(30), phantoms::ObliqueGrid(30) })
  {
    for (unsigned seed = 81; seed <= (Sanitized ? 84 : 100); ++seed)
    {
      std::mt19937 random(seed);
      const auto between = [&](double a, double b)
      { return std::uniform_real_distribution<>(a, b)(random); };
      const double x = between(5.0, 9.0);
      const double y = between(13.0, 16.0);
      const Point<3> middle = { x, y, between(5.0, 9.0) };
      const double radius = between(9.0, 12.0);
      const Point<3> normal = Drawn<3>([&] { return between(-1.0, 1.0); });
      const LabelImage<3> image = phantoms::CutHalves(grid, middle, radius, normal, 0.3);
      MeshingOptions<3> options = WithDelta<3>(1.6);
      options.Interfaces.Rounds = 0;
      options.Interfaces.Manifold = false;
      options.Optimisation.Run = false;
      const SimplexMesh<3> mesh = Mesh(image, options);
      for (const std::size_t axis : { 0, 2 })
      {
        EXPECT_TRUE(!image.ReachesBorder(axis, 0) || CountUncovered(mesh, image, axis) == 0)
          << grid.Dimensions[1] << ", seed " << seed << ", axis " << axis;
      }
    }
  }
}

// Around edges in these faces labels change so often that repair has to do there; nothing is dropped for that.
TEST(BorderFaces, GetNoDentsInRepair)
{
  const LabelImage<3> image = phantoms::CutCells(5, 200, 3, 1);
  const ImageDomain<3> domain(image, 1.0);
  for (const double delta : { 2.0, 3.0, 4.0 })
  {
    if (Sanitized && delta < 4.0)
    {
      continue;
    }
    MeshingOptions<3> options = WithDelta<3>(delta);
    options.Interfaces.Rounds = 0;
    options.Interfaces.Manifold = false;
    const SimplexMesh<3> before = Mesh(image, options);
    const auto lostArea = [&](const SimplexMesh<3>& whole, const SimplexMesh<3>& mesh)
    {
      const std::array<double, 6> areas = FlatAreas(whole, domain);
      const std::array<double, 6> left = FlatAreas(mesh, domain);
      double lost = 0.0;
      for (unsigned face = 0; face < 6; ++face)
      {
        lost = std::max(lost, areas[face] - left[face]);
      }
      return lost;
    };
    const auto context = Refined(domain, delta);
    const auto extract = [&](const SimplexLabels& labels)
    {
      SimplexMesh<3> mesh;
      ExtractMesh<3>(context->Mesh, domain, labels, mesh);
      return mesh;
    };
    SimplexLabels labels = LabelSimplices<3>(context->Mesh, domain);
    const SimplexMesh<3> raw = extract(labels);
    for (const bool cut : { false, true })
    {
      SimplexLabels repaired = labels;
      ManifoldRepairOptions<3> repair;
      repair.Surfaces = cut ? &domain : nullptr;
      const Repaired<3> result = RepairAll<3>(context->Mesh, repaired, repair);
      EXPECT_GT(result.Before, 0u);
      EXPECT_TRUE(result.Left.empty());
      EXPECT_EQ(lostArea(raw, extract(repaired)) < 1e-9, cut) << delta;
    }
    // A run asks for that.
    options.Interfaces.Rounds = 1;
    options.Interfaces.Manifold = true;
    MeshingStatistics statistics;
    const SimplexMesh<3> mesh = MeshOf(image, options, &statistics);
    EXPECT_EQ(statistics.Interfaces.NonManifoldLeft, 0u);
    EXPECT_GT(statistics.Interfaces.NonManifoldRepaired, 0u);
    EXPECT_LT(lostArea(before, mesh), 1e-9) << delta;
  }
}

// Where delta is graded edges get vertices where flat facets need them; without these 90 % are left of the faces.
TEST(BorderFaces, HaveEdgesInGradedMeshes)
{
  const LabelImage<3> image = LargeCutHalves();
  const ImageDomain<3> domain(image, 1.0);
  MeshingOptions<3> options = WithDelta<3>(1.5);
  options.Sampling.Grading.Mode = GradingMode::LocalFeatureSize;
  const std::array<double, 6> areas = FlatAreas(Mesh(image, options), domain);
  const std::array<double, 6> expected = VoxelAreas(image);
  EXPECT_GT(areas[0] + areas[4], 0.94 * (expected[0] + expected[4]));
}

// Optimisation moves vertices in the faces, not their edges; also when it may do nearly anything.
TEST(BorderFaces, StayFlatInOptimisation)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  for (const bool upright : { false, true })
  {
    const GridGeometry<3> grid = upright ? phantoms::Cube(15) : phantoms::ObliqueGrid(20);
    for (const bool block : { false, true })
    {
      const LabelImage<3> image = block ? phantoms::Block(grid) : phantoms::CutHalves(grid);
      const ImageDomain<3> domain(image, 1.0);
      MeshingOptions<3> options = WithDelta<3>(1.2);
      options.Optimisation.Run = false;
      const SimplexMesh<3> before = Mesh(image, options);
      for (const bool wild : { false, true })
      {
        SimplexMesh<3> after = before;
        const OptimisationOptions optimisation = wild ? Wild() : OptimisationOptions();
        const OptimisationStatistics statistics =
          checks::OptimiseMesh(after, domain, optimisation, 1);
        ExpectSound(after);
        if (wild)
        {
          EXPECT_GT(statistics.Flips.InterfaceFlips, 20u);
          EXPECT_GT(statistics.Smoothing.SurfaceMoves, 20u);
          EXPECT_GT(statistics.Smoothing.MovesOffInterfaces, 20u);
        }
        const std::array<double, 6> areas = FlatAreas(before, domain);
        const std::array<double, 6> optimised = FlatAreas(after, domain);
        for (unsigned face = 0; face < 6; ++face)
        {
          // Sides may be nudged, and with them the edges, but in the face; those of an upright block may not.
          const double tolerance = wild && !(block && upright) ? 0.05 : 1e-9;
          EXPECT_NEAR(optimised[face], areas[face], tolerance * areas[face]) << face;
        }
      }
    }
  }
}

// Beside a shallow scoop in a cut face, whose side is the nearest interface of vertices on the face over chords of its rim.
TEST(BorderFaces, KeepTheirVerticesInOptimisation)
{
  for (const double height : { -7.5, -7.0 })
  {
    const LabelImage<3> image = phantoms::Make(phantoms::Cube(28),
      [=](const Point<3>& p) -> std::int16_t
      {
        return p[2] < 9.0 && Distance(p, { 13.5, 13.5, 0.0 }) < 12.5 &&
            !(Distance(p, { 13.6, 13.4, height }) < 8.3)
          ? 1
          : 0;
      });
    const ImageDomain<3> domain(image, 1.0);
    for (const double delta : { 3.0, 3.5, 4.0, 4.5, 5.0 })
    {
      if (Sanitized && delta != 4.0)
      {
        continue;
      }
      MeshingOptions<3> options = WithDelta<3>(delta);
      options.Optimisation.Run = false;
      SimplexMesh<3> mesh = Mesh(image, options);
      const std::size_t before = CountOnBorder(mesh, domain);
      EXPECT_GT(before, 15u);
      EXPECT_GT(checks::OptimiseMesh(mesh, domain, Wild(), 1).Smoothing.SurfaceMoves, 0u);
      EXPECT_GE(CountOnBorder(mesh, domain), before) << height << " " << delta;
    }
  }
}

//------------------------------------------------------------------------------------------------
// An isosurface is cut by the border like labels.
TEST(BorderFaces, OfIsosurfacesAreFlat)
{
  const auto grid = phantoms::Cube(24);
  const Point<3> centre{ 11.6, 11.4, 3.2 };
  const auto values =
    phantoms::Sample<float>(grid, [&](const Point<3>& p) { return 9.0 - Distance(p, centre); });
  const auto image = IsosurfaceImage<3>::FromScalars<float>(values, grid, { 0.0 });
  const ImageDomain<3, ScalarField<3>> domain(image);
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = MeshOf(image, WithDelta<3>(1.3), &statistics);
  ExpectSound(mesh);
  const double radius2 = 81.0 - 3.2 * 3.2; // the outermost values go on
  const std::array<double, 6> areas = FlatAreas(mesh, domain);
  EXPECT_NEAR(areas[4], std::numbers::pi * radius2, 0.03 * std::numbers::pi * radius2);
  EXPECT_EQ(statistics.Interfaces.JunctionCurves, 1u);
}
