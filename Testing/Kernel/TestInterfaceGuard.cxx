// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What the guard of interfaces looks at and samples, face by face.
#include "Image/ImageDomain.h"
#include "ImageMesher.h"
#include "InterfaceGuard.h"
#include "Mesh/InterfaceVertices.h"
#include "Mesh/MeshExtraction.h"
#include "Phantoms.h"
#include "Refinement/Refiner.h"
#include "Refinement/Rules3D.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>
#include <vector>

using namespace voxplex;

namespace
{

/** Where the interface crosses the faces between voxels whose centres are so near to a point. */
std::set<Point<3>> CrossingsNear(
  const LabelImage<3>& image, const Domain<3>& domain, const Point<3>& p, double radius)
{
  std::set<Point<3>> crossings;
  const auto& n = image.CropDimensions();
  GridGeometry<3>::Index voxel;
  for (voxel[2] = -1; voxel[2] < n[2]; ++voxel[2])
  {
    for (voxel[1] = -1; voxel[1] < n[1]; ++voxel[1])
    {
      for (voxel[0] = -1; voxel[0] < n[0]; ++voxel[0])
      {
        for (std::size_t a = 0; a < 3; ++a)
        {
          GridGeometry<3>::Index next = voxel;
          ++next[a];
          const Point<3> from = image.CentreOf(voxel);
          const Point<3> to = image.CentreOf(next);
          Point<3> z;
          if (image.At(voxel) != image.At(next) &&
            Distance(Interpolate(from, to, 0.5), p) <= radius &&
            domain.FirstCrossing(from, image.At(voxel), to, z))
          {
            crossings.insert(z);
          }
        }
      }
    }
  }
  return crossings;
}

} // namespace

// Around an edge it samples all that is near, also where the axes of the image are oblique and voxels long.
TEST(InterfaceGuard, ReachesAsFarInShearedImages)
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
    MeshingOptions<3> options;
    options.Delta = delta;
    SimplexMesh<3> mesh;
    ASSERT_EQ(ImageMesher<3>(options).Run(image, mesh), MeshingOutcome::Done);
    for (std::size_t f = 0; f < mesh.Facets.size(); f += 7)
    {
      const InterfaceEdge edge{ { mesh.Facets[f][0], mesh.Facets[f][1] }, false };
      const Point<3> middle =
        Interpolate(mesh.Points[edge.Ends[0]], mesh.Points[edge.Ends[1]], 0.5);
      const std::set<Point<3>> expected = CrossingsNear(image, domain, middle, 0.5 * delta);
      LocalDelta<3> local(image);
      InterfaceGuard guard(image, domain.GetSites(), domain, { delta }, nullptr, local, 1, {});
      std::set<Point<3>> found;
      for (const FeatureSeed<3>& seed : guard.Inspect(mesh, { edge }))
      {
        found.insert(seed.Position);
      }
      EXPECT_EQ(guard.NumberOfFarFaces(), 0u);
      EXPECT_GT(expected.size(), 10u);
      EXPECT_EQ(found, expected) << f;
    }
  }
}

//------------------------------------------------------------------------------------------------
TEST(InterfaceVertices, AreThoseOfTheFacetsOfTheMesh)
{
  const LabelImage<3> image = phantoms::TouchingLabels(24);
  const ImageDomain<3> domain(image, 1.0);
  RefinementSettings<3> settings;
  settings.Delta = 2.5;
  Box<3> box = domain.Bounds();
  for (std::size_t a = 0; a < 3; ++a)
  {
    box.Min[a] -= 2.0 * settings.Delta;
    box.Max[a] += 2.0 * settings.Delta;
  }
  RefinementContext<3> context(domain, settings, box, 1000);
  Refiner<Rules3D> refiner(context);
  ASSERT_TRUE(refiner.Run(nullptr));
  SimplexMesh<3> mesh;
  ExtractMesh<3>(context.Mesh, domain, mesh);
  std::set<Point<3>> expected;
  for (const auto& facet : mesh.Facets)
  {
    for (const std::uint32_t v : facet)
    {
      expected.insert(mesh.Points[v]);
    }
  }
  EXPECT_GT(expected.size(), 100u);
  EXPECT_LT(expected.size(), mesh.Points.size());
  for (const unsigned threads : { 1u, 3u })
  {
    const std::vector<Point<3>> found = FindInterfaceVertices(context.Mesh, domain, threads);
    EXPECT_EQ(found.size(), expected.size());
    EXPECT_EQ(std::set<Point<3>>(found.begin(), found.end()), expected);
  }
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(FindInterfaceVertices(context.Mesh, domain, 1, stop.get_token()), Cancelled);
}

// Later inspections look only around vertices that have gone, and find the same as one that looks at all.
TEST(InterfaceGuard, LooksAgainWhereVerticesHaveGone)
{
  const LabelImage<3> image = phantoms::TouchingLabels(30);
  const ImageDomain<3> domain(image, 1.0);
  const BaseDensity<3> base{ 3.0 };
  InterfaceSize size;
  size.Label = image.Values()[1];
  size.Size = 5.0;
  const InterfaceSizes<3> sizes(image, { size }, base, 0.3, 1);
  const std::set<Point<3>> all =
    CrossingsNear(image, domain, { 0.0, 0.0, 0.0 }, std::numeric_limits<double>::infinity());
  ASSERT_GT(all.size(), 1000u);
  for (const InterfaceSizes<3>* const with :
    { static_cast<const InterfaceSizes<3>*>(nullptr), &sizes })
  {
    std::size_t holes = 0;
    for (auto centre = all.begin(); centre != all.end();
         std::advance(centre, std::min<std::ptrdiff_t>(400, std::distance(centre, all.end()))))
    {
      std::vector<Point<3>> left;
      std::copy_if(all.begin(), all.end(), std::back_inserter(left),
        [&](const Point<3>& p) { return Distance(p, *centre) > 7.2; });
      LocalDelta<3> local(image);
      InterfaceGuard again(image, domain.GetSites(), domain, base, with, local, 1, {});
      EXPECT_TRUE(again.InspectVertices({ all.begin(), all.end() }).empty());
      LocalDelta<3> other(image);
      InterfaceGuard fresh(image, domain.GetSites(), domain, base, with, other, 1, {});
      const auto found = again.InspectVertices(left);
      const auto expected = fresh.InspectVertices(left);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i)
      {
        EXPECT_EQ(found[i].Position, expected[i].Position);
      }
      holes += expected.empty() ? 0 : 1;
    }
    EXPECT_GT(holes, 3u);
  }
}
