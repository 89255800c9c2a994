// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Grey values that were taken for labels are refused, and no segmentation is.
#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Image/GreyValues.h"
#include "MeshRuns.h"
#include "Mesher/ImageMesher.h"
#include "Phantoms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace voxplex;

namespace
{

/** Voxels independent of each other, with `labels` labels from `lowest` on. */
template <int D>
LabelImage<D> Noise(const typename GridGeometry<D>::Index& dimensions, int labels, int lowest = 1)
{
  std::mt19937 random(7);
  Point<D> spacing;
  spacing.fill(1.0);
  std::vector<std::int16_t> scalars(CountCells(dimensions));
  for (std::int16_t& s : scalars)
  {
    s = static_cast<std::int16_t>(
      lowest + static_cast<int>(random() % static_cast<unsigned>(labels)));
  }
  scalars.front() = scalars.back() = 1;
  return LabelImage<D>::template FromScalars<std::int16_t>(
    scalars, GridGeometry<D>::Orthogonal(dimensions, spacing));
}

/** Voronoi cells of points, one at random in each of along^3 boxes. */
LabelImage<3> Grains(std::int64_t along, std::int64_t side)
{
  std::mt19937 random(11);
  const double box = static_cast<double>(side) / static_cast<double>(along);
  std::vector<Point<3>> seeds;
  for (std::int64_t k = 0; k < along * along * along; ++k)
  {
    const auto coordinate = [&](std::int64_t at) {
      return box * (static_cast<double>(at % along) + 0.01 * static_cast<double>(random() % 100));
    };
    seeds.push_back({ coordinate(k), coordinate(k / along), coordinate(k / along / along) });
  }
  return phantoms::Make(phantoms::Cube(side),
    [&](const Point<3>& p) -> std::int16_t
    {
      std::int64_t nearest = 0;
      const auto first = [&](double x)
      { return std::max<std::int64_t>(static_cast<std::int64_t>(x / box) - 1, 0); };
      const auto end = [&](double x) { return std::min(first(x) + 3, along); };
      for (std::int64_t z = first(p[2]); z < end(p[2]); ++z)
      {
        for (std::int64_t y = first(p[1]); y < end(p[1]); ++y)
        {
          for (std::int64_t x = first(p[0]); x < end(p[0]); ++x)
          {
            const std::int64_t seed = (z * along + y) * along + x;
            const auto distance = [&](std::int64_t k)
            { return Distance(seeds[static_cast<std::size_t>(k)], p); };
            nearest = distance(seed) < distance(nearest) ? seed : nearest;
          }
        }
      }
      return static_cast<std::int16_t>(1 + nearest);
    });
}

/** A smooth wave of grey values, as many as `amplitude`. */
LabelImage<3> Wave(double amplitude)
{
  return phantoms::Make(phantoms::Cube(40),
    [=](const Point<3>& p) -> std::int16_t
    {
      const double x = std::sin(0.3 * p[0]) * std::cos(0.2 * p[1]) + std::sin(0.25 * p[2]);
      return static_cast<std::int16_t>(1.0 + amplitude * (0.25 * x + 0.5));
    });
}

template <int D>
void ExpectPairs(const LabelImage<D>& image)
{
  NeighbourPairs expected;
  for (std::size_t at = 0; at < image.Ids().size(); ++at)
  {
    const auto voxel = IndexAt(at, image.CropDimensions());
    for (std::size_t a = 0; a < D; ++a)
    {
      auto next = voxel;
      ++next[a];
      const bool isPair = image.At(voxel) != 0 && image.At(next) != 0;
      expected.All += isPair ? 1 : 0;
      expected.Different += isPair && image.At(voxel) != image.At(next) ? 1 : 0;
    }
  }
  ASSERT_GT(expected.Different, 0);
  for (const unsigned threads : { 1u, 3u })
  {
    const NeighbourPairs pairs = CountNeighbourPairs(image, threads);
    EXPECT_EQ(pairs.All, expected.All);
    EXPECT_EQ(pairs.Different, expected.Different);
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(GreyValues, PairsAreThoseOfAFullSearch)
{
  ExpectPairs<3>(Noise<3>({ 2, 31, 47 }, 5, 0));
  ExpectPairs<3>(Noise<3>({ 90, 3, 11 }, 3, 0));
  ExpectPairs<4>(Noise<4>({ 7, 6, 5, 9 }, 3, 0));
  EXPECT_EQ(NeighbourPairs().ShareOfDifferent(), 0.0);
}

//------------------------------------------------------------------------------------------------
TEST(GreyValues, AreRefused)
{
  for (const int labels : { 40, 255, 2000 })
  {
    EXPECT_THROW(CheckSegmented(Noise<3>({ 30, 30, 30 }, labels)), InputError) << labels;
    EXPECT_THROW(CheckSegmented(Noise<3>({ 30, 30, 30 }, labels), 3), InputError) << labels;
  }
  EXPECT_THROW(CheckSegmented(Noise<4>({ 12, 13, 11, 14 }, 100)), InputError);
  EXPECT_THROW(CheckSegmented(Wave(255.0)), InputError);
}

TEST(GreyValues, AreRefusedInSmallImagesOfVeryManyLabels)
{
  EXPECT_THROW(
    CheckSegmented(phantoms::Blocks(1, 16)), InputError);   // 4096 labels in as many voxels
  EXPECT_NO_THROW(CheckSegmented(phantoms::Blocks(1, 12))); // 1728
  EXPECT_THROW(phantoms::Blocks(1, 41), InputError);        // 68,921
}

/** A polycrystal: the number of labels alone says nothing. */
TEST(GreyValues, ThousandsOfGrainsAreNot)
{
  const LabelImage<3> image = Grains(15, 48);
  EXPECT_GT(image.NumberOfLabels(), 3000);
  EXPECT_NO_THROW(CheckSegmented(image));
  EXPECT_LT(CountNeighbourPairs(image).ShareOfDifferent(), 0.45);
  EXPECT_NO_THROW(CheckSegmented(phantoms::Blocks(2, 16)));
  EXPECT_NO_THROW(CheckSegmented(phantoms::Blocks(2, 42))); // 74,088
}

TEST(GreyValues, SegmentationsAreNot)
{
  EXPECT_NO_THROW(CheckSegmented(Noise<3>({ 60, 60, 60 }, 30)));   // noise, but few labels
  EXPECT_NO_THROW(CheckSegmented(Noise<3>({ 24, 24, 24 }, 1000))); // small
  EXPECT_NO_THROW(CheckSegmented(Noise<4>({ 10, 10, 10, 10 }, 100)));
  EXPECT_NO_THROW(CheckSegmented(phantoms::Blocks(2, 12)));
  EXPECT_NO_THROW(CheckSegmented(phantoms::Blocks(4, 8)));
  EXPECT_NO_THROW(CheckSegmented(Wave(30.0)));
  EXPECT_NO_THROW(CheckSegmented(phantoms::CutCells(3, 400, 400, 1)));
  // As a checkerboard all neighbours differ, but there are two labels.
  EXPECT_NO_THROW(CheckSegmented(phantoms::Make(phantoms::Cube(40),
    [](const Point<3>& p) -> std::int16_t
    { return static_cast<int>(p[0] + p[1] + p[2]) % 2 == 0 ? 1 : 2; })));
  // Specks with labels of their own, far from each other.
  EXPECT_NO_THROW(CheckSegmented(phantoms::Make(phantoms::Cube(100),
    [](const Point<3>& p) -> std::int16_t
    {
      const bool isSpeck =
        std::all_of(p.begin(), p.end(), [](double x) { return static_cast<int>(x) % 10 == 3; });
      return isSpeck ? static_cast<std::int16_t>(1 + p[0] + p[1] + p[2] + 100 * (p[2] > 50)) : 0;
    })));
}

//------------------------------------------------------------------------------------------------
TEST(GreyValues, AreRefusedByTheMesherUnlessForced)
{
  const LabelImage<3> image = Noise<3>({ 30, 30, 30 }, 200);
  MeshingOptions<3> options = checks::WithDelta<3>(20.0);
  SimplexMesh<3> mesh;
  const std::string message = checks::MessageOf([&] { ImageMesher<3>(options).Run(image, mesh); });
  EXPECT_NE(message.find("200 labels look like grey values"), std::string::npos) << message;
  EXPECT_NE(message.find("mesh an isosurface of it with {isosurface}"), std::string::npos)
    << message;
  EXPECT_NE(message.find("or go on with {force}"), std::string::npos) << message;
  options.Limits.Force = true;
  ImageMesher<3> mesher(options);
  mesher.Progress = [](double) { return false; };
  EXPECT_EQ(mesher.Run(image, mesh), MeshingOutcome::Cancelled);

  MeshingOptions<4> inTime;
  SimplexMesh<4> pentatopes;
  EXPECT_THROW(
    ImageMesher<4>(inTime).Run(Noise<4>({ 12, 13, 11, 14 }, 100), pentatopes), InputError);
}

TEST(GreyValues, CountingCanBeStopped)
{
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(CheckSegmented(Noise<3>({ 30, 30, 30 }, 200), 1, stop.get_token()), Cancelled);
}
