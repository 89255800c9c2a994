// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Interfaces of images that have an object at all their borders lie within the box of these borders, however sheared.
#include "ComplexOf.h"
#include "Domain/ImageDomain.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Optimisation/Tetrahedra/MeshOptimiser.h"
#include "Phantoms.h"
#include "Sanitizers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** Two labels that meet in a plane through the middle, oblique to the borders. */
LabelImage<3> Halves(const GridGeometry<3>& grid)
{
  const Point<3> middle = grid.ToFrame({ 6.2, 5.1, 4.3 });
  return phantoms::Make(grid,
    [&](const Point<3>& p) -> std::int16_t
    { return p[0] - middle[0] + 0.6 * (p[1] - middle[1]) > 0.3 * (p[2] - middle[2]) ? 1 : 2; });
}

double LargestDistanceOutside(const SimplexMesh<3>& mesh, const GridGeometry<3>& grid)
{
  double largest = 0.0;
  for (const std::uint32_t v : VerticesOfInterfaces(mesh))
  {
    largest = std::max(largest, DistanceOutside(grid, mesh.Points[v]));
  }
  return largest;
}

} // namespace

//------------------------------------------------------------------------------------------------
// Where axes meet at acute angles another face may be nearer along a diagonal than along an axis; labels go on there.
TEST(BorderBounds, HoldWhereEdgesAreLookedFor)
{
  for (const double shear : { 0.0, 1.0, 2.0, -2.5, 4.0 })
  {
    SCOPED_TRACE(testing::Message() << "shear " << shear);
    const GridGeometry<3> grid = phantoms::Sheared({ 14, 12, 10 }, shear);
    const LabelImage<3> image = phantoms::Block(grid);
    const ImageDomain<3> domain(image, 1.0);
    std::mt19937 random(11);
    int found = 0;
    for (int i = 0; i < 3000; ++i)
    {
      Point<3> index;
      for (std::size_t a = 0; a < 3; ++a)
      {
        index[a] = std::uniform_real_distribution<>(
          -0.5, static_cast<double>(grid.Dimensions[a]) - 0.5)(random);
      }
      const auto axis = static_cast<std::size_t>(i % 3);
      index[axis] = i % 2 == 0 ? -0.5 : static_cast<double>(grid.Dimensions[axis]) - 0.5;
      const Point<3> p = grid.ToFrame(index);
      const double reach = 1.0 + 0.001 * i;
      Point<3> z;
      if (domain.Border()->FindEdge(p, reach, z))
      {
        ++found;
        ASSERT_LT(DistanceOutside(grid, z), 1e-9);
        ASSERT_NEAR(grid.ToIndex(z)[axis], index[axis], 1e-9);
        ASSERT_LT(Distance(p, z), reach + 1e-9);
      }
    }
    EXPECT_GT(found, 1000);
  }
}

TEST(BorderBounds, HoldInRefinement)
{
  for (const double shear : { 1.0, 2.0, 3.0, -2.5 })
  {
    if (Sanitized && shear != 2.0)
    {
      continue;
    }
    const GridGeometry<3> grid = phantoms::Sheared({ 14, 12, 10 }, shear);
    const LabelImage<3> block = phantoms::Block(grid);
    const LabelImage<3> halves = Halves(grid);
    for (const LabelImage<3>* image : { &block, &halves })
    {
      for (const double delta : { 1.1, 2.3, 5.0 })
      {
        const SimplexMesh<3> mesh = MeshOf(*image, WithDelta<3>(delta));
        ExpectSound(mesh);
        EXPECT_GT(mesh.Facets.size(), 20u);
        EXPECT_LT(LargestDistanceOutside(mesh, grid), 1e-5)
          << "shear " << shear << ", delta " << delta << ", labels: " << image->NumberOfLabels();
      }
    }
  }
}

// Vertices of edges and junctions are nudged, on their cut faces or near them, but none through another one.
TEST(BorderBounds, HoldInOptimisation)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  OptimisationOptions eager;
  eager.SmallestDihedralAngle = 40.0;
  eager.LargestDihedralAngle = 115.0;
  eager.InterfaceTolerance = 0.4;
  for (const double shear : { 0.0, 1.0, 2.0 })
  {
    const GridGeometry<3> grid = phantoms::Sheared({ 14, 12, 10 }, shear);
    const LabelImage<3> image = Halves(grid);
    const ImageDomain<3> domain(image, 1.0);
    for (const double delta : { 3.0, 5.0 })
    {
      SimplexMesh<3> mesh = MeshOf(image, WithDelta<3>(delta));
      EXPECT_GT(checks::OptimiseMesh(mesh, domain, eager, 1).Smoothing.MovesOffInterfaces, 20u);
      ExpectSound(mesh);
      EXPECT_LT(LargestDistanceOutside(mesh, grid), 1e-5)
        << "shear " << shear << ", delta " << delta;
    }
  }
}
