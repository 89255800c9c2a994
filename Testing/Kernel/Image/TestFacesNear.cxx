// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The search for faces near to points finds what a look at each face finds.
#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Image/FacesNear.h"
#include "Image/SurfaceVoxels.h"
#include "InterfaceChecks.h"

#include <algorithm>
#include <random>
#include <vector>

using namespace voxplex;
using checks::ForEachFace;

namespace
{

/** One look at each face and ball, in the order of faces. */
std::vector<VoxelFace<3>> FacesNear(
  const LabelImage<3>& image, const std::vector<SearchBall<3>>& balls)
{
  std::vector<VoxelFace<3>> faces;
  ForEachFace(image,
    [&](const GridGeometry<3>::Index& voxel, const GridGeometry<3>::Index& next)
    {
      unsigned axis = 0;
      while (voxel[axis] == next[axis])
      {
        ++axis;
      }
      const VoxelFace<3> face{ voxel, axis };
      const Point<3> centre = CentreOf(face, image);
      if (std::any_of(balls.begin(), balls.end(),
            [&](const SearchBall<3>& ball)
            { return Distance2(centre, ball.Centre) <= ball.Radius * ball.Radius; }))
      {
        faces.push_back(face);
      }
    });
  std::sort(faces.begin(), faces.end());
  return faces;
}

/** Labels 0 to 2 in columns along the first axis, so that some words of a mask are empty. */
LabelImage<3> Columns(const GridGeometry<3>& grid, unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<std::uint8_t> scalars;
  std::uint8_t label = 1;
  for (std::size_t k = 0; k < CountCells(grid.Dimensions); ++k)
  {
    label = random() % 20 == 0 ? static_cast<std::uint8_t>(random() % 3) : label;
    scalars.push_back(label);
  }
  return LabelImage<3>::FromScalars<std::uint8_t>(scalars, grid);
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(FacesNear, AreThoseInAnyBall)
{
  std::mt19937 random(11);
  const auto uniform = [&](double low, double high)
  { return std::uniform_real_distribution<double>(low, high)(random); };
  std::size_t some = 0;
  for (const GridGeometry<3>& grid : { phantoms::Cube(12), phantoms::Sheared({ 90, 9, 11 }, 0.0),
         phantoms::Sheared({ 90, 9, 11 }, 3.0), phantoms::Sheared({ 5, 2, 70 }, -2.0) })
  {
    const LabelImage<3> image = Columns(grid, static_cast<unsigned>(random()));
    const BitMask<3> sites = FindSurfaceVoxels(image, 1, {});
    for (const std::size_t count : { 0u, 1u, 2u, 9u, 60u, 400u })
    {
      for (const double largest : { 0.4, 2.0, 9.0, 70.0, 1000.0 })
      {
        std::vector<SearchBall<3>> balls;
        for (std::size_t b = 0; b < count; ++b)
        {
          Point<3> index;
          for (std::size_t a = 0; a < 3; ++a)
          {
            const auto n = static_cast<double>(grid.Dimensions[a]);
            index[a] = uniform(-0.2 * n, 1.2 * n);
          }
          balls.push_back({ grid.ToFrame(index), largest * uniform(0.0, 1.0) });
        }
        const std::vector<VoxelFace<3>> expected = FacesNear(image, balls);
        EXPECT_EQ(FindFacesNear<3>(image, sites, balls, {}), expected) << count << ", " << largest;
        some += expected.size();
      }
    }
  }
  EXPECT_GT(some, 10000u);
}

// The guard's balls are around faces, with whole radii often: some faces are on spheres.
TEST(FacesNear, CountOnTheSphere)
{
  const LabelImage<3> image = phantoms::Block(phantoms::Cube(9));
  const BitMask<3> sites = FindSurfaceVoxels(image, 1, {});
  const Point<3> centre = CentreOf(VoxelFace<3>{ { 4, 4, 8 }, 2 }, image);
  for (const double radius : { 0.0, 1.0, 2.0, 5.0 })
  {
    const auto found =
      FindFacesNear<3>(image, sites, std::vector<SearchBall<3>>{ { centre, radius } }, {});
    EXPECT_EQ(found, FacesNear(image, { { centre, radius } })) << radius;
    const auto left = static_cast<std::int64_t>(4.0 - radius);
    EXPECT_EQ(std::count(found.begin(), found.end(), VoxelFace<3>{ { left, 4, 8 }, 2 }),
      radius < 5.0 ? 1 : 0);
  }
}

TEST(FacesNear, CanBeStopped)
{
  const LabelImage<3> image = phantoms::Ball(5.0);
  const BitMask<3> sites = FindSurfaceVoxels(image, 1, {});
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(FindFacesNear<3>(image, sites,
                 std::vector<SearchBall<3>>{ { { 9.0, 9.0, 9.0 }, 20.0 } }, stop.get_token()),
    Cancelled);
}
