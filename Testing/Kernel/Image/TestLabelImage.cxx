// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Image/LabelImage.h"
#include "MeshRuns.h"
#include "Parallel/ParallelFor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>

using namespace voxplex;

namespace
{

GridGeometry<3> Grid(std::int64_t x, std::int64_t y, std::int64_t z)
{
  return GridGeometry<3>::Orthogonal({ x, y, z }, { 1.0, 2.0, 0.5 });
}

template <typename T, int D = 3>
LabelImage<D> Read(const std::vector<T>& scalars, const GridGeometry<D>& grid,
  const LabelSelection& selection = {}, unsigned threads = 1)
{
  return LabelImage<D>::template FromScalars<T>(scalars, grid, selection, threads);
}

/** Expects an InputError whose text contains all of these. */
void ExpectInputError(const std::function<void()>& function, const std::vector<std::string>& parts)
{
  const std::string message = checks::MessageOf(function);
  for (const std::string& part : parts)
  {
    EXPECT_NE(message.find(part), std::string::npos)
      << "'" << message << "' lacks '" << part << "'";
  }
}

/** 4 x 3 x 2 voxels; voxel (2, 1, 1) has linear index 18. */
template <typename T>
std::vector<T> Small(T value)
{
  std::vector<T> scalars(24, T(0));
  scalars[5] = T(7);
  scalars[18] = value;
  return scalars;
}

template <typename T>
class LabelImageOf : public testing::Test
{
};
using AllScalars = testing::Types<char, signed char, unsigned char, short, unsigned short, int,
  unsigned int, long, unsigned long, long long, unsigned long long, float, double>;
TYPED_TEST_SUITE(LabelImageOf, AllScalars);

TYPED_TEST(LabelImageOf, MapsValuesInIncreasingOrderAndCrops)
{
  const LabelImage<3> image = Read<TypeParam>(Small<TypeParam>(TypeParam(3)), Grid(4, 3, 2));
  EXPECT_EQ(image.NumberOfLabels(), 2);
  EXPECT_EQ(std::vector<std::int64_t>(image.Values().begin(), image.Values().end()),
    (std::vector<std::int64_t>{ 0, 3, 7 }));
  // Foreground: (1, 1, 0) = 7 and (2, 1, 1) = 3.
  EXPECT_EQ(image.CropOrigin(), (LabelImage<3>::Index{ 1, 1, 0 }));
  EXPECT_EQ(image.CropDimensions(), (LabelImage<3>::Index{ 2, 1, 2 }));
  EXPECT_EQ(std::vector<LabelId>(image.Ids().begin(), image.Ids().end()),
    (std::vector<LabelId>{ 2, 0, 0, 1 }));
  EXPECT_EQ(std::vector<std::int64_t>(image.Counts().begin(), image.Counts().end()),
    (std::vector<std::int64_t>{ 2, 1, 1 }));
  EXPECT_EQ(image.Grid().Dimensions, (LabelImage<3>::Index{ 4, 3, 2 }));
}

TYPED_TEST(LabelImageOf, RejectsNegativeOrTooLargeValues)
{
  if constexpr (std::is_signed_v<TypeParam>)
  {
    ExpectInputError([] { Read<TypeParam>(Small<TypeParam>(TypeParam(-2)), Grid(4, 3, 2)); },
      { "-2 ", "(2, 1, 1)", "negative", "isosurface", "choose the labels" });
  }
  else if constexpr (sizeof(TypeParam) == 8)
  {
    ExpectInputError([]
      { Read<TypeParam>(Small<TypeParam>(TypeParam(9223372036854775808u)), Grid(4, 3, 2)); },
      { "9223372036854775808", "(2, 1, 1)", "exceeds" });
  }
  if constexpr (std::is_floating_point_v<TypeParam>)
  {
    ExpectInputError([] { Read<TypeParam>(Small<TypeParam>(TypeParam(1.5)), Grid(4, 3, 2)); },
      { "1.5", "(2, 1, 1)", "not whole", "without interpolation" });
    ExpectInputError([] { Read<TypeParam>(Small<TypeParam>(TypeParam(-2.000001)), Grid(4, 3, 2)); },
      { "-2.000", "(2, 1, 1)", "negative" });
    ExpectInputError([] { Read<TypeParam>(Small<TypeParam>(TypeParam(1e19)), Grid(4, 3, 2)); },
      { "e+1", "(2, 1, 1)", "exceeds" });
    ExpectInputError([]
      { Read<TypeParam>(Small(std::numeric_limits<TypeParam>::quiet_NaN()), Grid(4, 3, 2)); },
      { "nan", "(2, 1, 1)", "not finite", "set such voxels to 0" });
    ExpectInputError([]
      { Read<TypeParam>(Small(std::numeric_limits<TypeParam>::infinity()), Grid(4, 3, 2)); },
      { "inf", "(2, 1, 1)", "not finite" });
  }
}

/** What rounding has taken from whole numbers does not count; what is farther off does. */
TYPED_TEST(LabelImageOf, ForgivesRounding)
{
  if constexpr (std::is_floating_point_v<TypeParam>)
  {
    for (const double value : { 2.999999, 3.000009, 2.9999998 })
    {
      std::vector<TypeParam> scalars = Small<TypeParam>(TypeParam(value));
      scalars[0] = TypeParam(-1e-7); // background
      scalars[23] = TypeParam(3);
      const LabelImage<3> image = Read<TypeParam>(scalars, Grid(4, 3, 2));
      EXPECT_EQ(std::vector<std::int64_t>(image.Values().begin(), image.Values().end()),
        (std::vector<std::int64_t>{ 0, 3, 7 }));
      EXPECT_EQ(image.Counts()[1], 2);
      EXPECT_EQ(image.CropOrigin(), (LabelImage<3>::Index{ 1, 1, 0 }));
    }
    // 1e-5 of a label, and at most 0.01.
    EXPECT_EQ(
      Read<TypeParam>(Small<TypeParam>(TypeParam(500.004)), Grid(4, 3, 2)).Values()[2], 500);
    EXPECT_EQ(
      Read<TypeParam>(Small<TypeParam>(TypeParam(70000.0078125)), Grid(4, 3, 2)).Values()[2],
      70000);
    for (const double value : { 1.00002, 2.9999, -0.00002, 500.006, 70000.015625 })
    {
      ExpectInputError([&] { Read<TypeParam>(Small<TypeParam>(TypeParam(value)), Grid(4, 3, 2)); },
        { "(2, 1, 1)", "not whole" });
    }
  }
}

/** If there are labels to keep, whole numbers that are no labels are background as other labels are. */
TYPED_TEST(LabelImageOf, KeptLabelsCountFirst)
{
  const auto expectSeven = [](TypeParam other)
  {
    const LabelImage<3> image =
      Read<TypeParam>(Small<TypeParam>(other), Grid(4, 3, 2), { { 7 }, {} });
    EXPECT_EQ(image.NumberOfLabels(), 1);
    EXPECT_EQ(image.Values()[1], 7);
    EXPECT_EQ(image.Ids().size(), 1u);
  };
  if constexpr (std::is_signed_v<TypeParam>)
  {
    expectSeven(TypeParam(-2));
  }
  else if constexpr (sizeof(TypeParam) == 8)
  {
    expectSeven(std::numeric_limits<TypeParam>::max());
  }
  if constexpr (std::is_floating_point_v<TypeParam>)
  {
    expectSeven(TypeParam(1e30));
    for (const TypeParam bad : { TypeParam(1.5), std::numeric_limits<TypeParam>::quiet_NaN() })
    {
      EXPECT_THROW(
        Read<TypeParam>(Small<TypeParam>(bad), Grid(4, 3, 2), { { 7 }, {} }), InputError);
    }
  }
}

} // namespace

TEST(LabelImage, NamesTheFirstBadValue)
{
  std::vector<short> scalars(64 * 64 * 64, 1);
  scalars[48 * 4096 + 53 * 64] = -5;
  scalars[48 * 4096 + 53 * 64 + 1] = -6;
  scalars[260000] = -7;
  for (const unsigned threads : { 1u, 4u })
  {
    ExpectInputError(
      [&] { Read<short>(scalars, Grid(64, 64, 64), {}, threads); }, { "-5 ", "(0, 53, 48)" });
  }
}

TEST(LabelImage, CropsToWholeRuns)
{
  std::vector<short> scalars(10 * 4 * 4, 0);
  std::fill_n(scalars.begin() + 10 * (2 + 4 * 1) + 3, 5, short{ 2 }); // x = 3 ... 7
  const LabelImage<3> image = Read<short>(scalars, Grid(10, 4, 4));
  EXPECT_EQ(image.CropOrigin(), (LabelImage<3>::Index{ 3, 2, 1 }));
  EXPECT_EQ(image.CropDimensions(), (LabelImage<3>::Index{ 5, 1, 1 }));
  EXPECT_EQ(image.Counts()[1], 5);
}

TEST(LabelImage, KeepsTheLargestValues)
{
  constexpr std::int64_t largest = std::numeric_limits<std::int64_t>::max();
  const LabelImage<3> image = Read<std::int64_t>(Small<std::int64_t>(largest), Grid(4, 3, 2));
  EXPECT_EQ(image.Values()[2], largest);
}

// Foreground (1, 1, 0) = 7 and (2, 1, 1) = 3, so the bounding box begins at (1, 1, 0).
TEST(LabelImage, VoxelsByTheirIndex)
{
  using Index = LabelImage<3>::Index;
  GridGeometry<3> grid = Grid(4, 3, 2);
  grid.IndexToFrame = { { { 2.0, 0.5, 0.25 }, { 0.0, 3.0, 0.125 }, { 0.0, 0.0, 5.0 } } };
  const LabelImage<3> image = Read<short>(Small<short>(3), grid);
  const auto expected = [](const Index& voxel) -> LabelId {
    return voxel == Index{ 0, 0, 0 } ? 2 : voxel == Index{ 1, 0, 1 } ? 1 : 0;
  };
  ForEachIndex<3>({ -2, -2, -2 }, { 3, 3, 3 },
    [&](const Index& v)
    {
      EXPECT_EQ(image.At(v), expected(v)) << v[0] << ' ' << v[1] << ' ' << v[2];
      EXPECT_EQ(image.AtLattice({ v[0] + 1, v[1] + 1, v[2] + 1 }), expected(v));
    });
  const Point<3> last = { 2.0 * 2 + 0.5 + 0.25, 3.0 + 0.125, 5.0 };
  EXPECT_EQ(image.CentreOf({ 1, 0, 1 }), last);
  const Point<3> before = { -0.25, -0.125, -5.0 }; // (0, 0, -1) of the image
  EXPECT_EQ(image.CentreOf({ -1, -1, -1 }), before);
}

TEST(LabelImage, KeptLabels)
{
  const LabelImage<3> image = Read<short>(Small<short>(3), Grid(4, 3, 2), { { 7, 7 }, {} });
  EXPECT_EQ(image.NumberOfLabels(), 1);
  EXPECT_EQ(image.Values()[1], 7);
  EXPECT_EQ(image.CropOrigin(), (LabelImage<3>::Index{ 1, 1, 0 }));
  EXPECT_EQ(image.Ids().size(), 1u);
  ExpectInputError(
    [] {
      Read<short>(Small<short>(3), Grid(4, 3, 2), { { 7, 8 }, {} });
    },
    { "Label 8 ", "does not occur", "3, 7" });
  ExpectInputError(
    [] {
      Read<short>(Small<short>(3), Grid(4, 3, 2), { { 0 }, {} });
    },
    { "Label 0 " });
}

TEST(LabelImage, ExcludedLabels)
{
  const LabelImage<3> image = Read<short>(Small<short>(3), Grid(4, 3, 2), { {}, { 3, 3 } });
  EXPECT_EQ(image.NumberOfLabels(), 1);
  EXPECT_EQ(image.Values()[1], 7);
  EXPECT_EQ(image.CropOrigin(), (LabelImage<3>::Index{ 1, 1, 0 }));
  EXPECT_EQ(Read<short>(Small<short>(3), Grid(4, 3, 2), { { 3, 7 }, { 7 } }).Values()[1], 3);
  const auto expectError = [](
                             const LabelSelection& selection, const std::vector<std::string>& parts)
  { ExpectInputError([&] { Read<short>(Small<short>(3), Grid(4, 3, 2), selection); }, parts); };
  expectError({ {}, { 8 } }, { "Label 8 ", "excluded", "does not occur", "3, 7", "to exclude" });
  expectError({ {}, { 0 } }, { "Label 0 ", "excluded", "background" });
  expectError({ {}, { 3, 7 } }, { "All labels", "excluded" });
  expectError({ { 3 }, { 3 } }, { "All labels", "excluded" });
}

TEST(LabelImage, RejectsBadGrids)
{
  const std::vector<short> scalars = Small<short>(3);
  ExpectInputError([&] { Read<short>(scalars, Grid(24, 1, 1)); }, { "1 voxel", "axis 1" });
  ExpectInputError([&] { Read<short>(scalars, Grid(4, 3, 3)); }, { "24 scalars", "36" });
  ExpectInputError([&]
    { Read<short>(scalars, Grid(std::int64_t{ 1 } << 31, std::int64_t{ 1 } << 31, 2)); },
    { "too large", "2147483648" });
  for (const double bad :
    { 0.0, -2.0, 1e-90, 1e60, std::nan(""), std::numeric_limits<double>::infinity() })
  {
    GridGeometry<3> grid = Grid(4, 3, 2);
    grid.IndexToFrame[1][1] = bad;
    ExpectInputError([&] { Read<short>(scalars, grid); }, { "spacing", "axis 1", "positive" });
    grid = Grid(4, 3, 2);
    grid.IndexToFrame[2][0] = bad;
    if (bad != 0.0)
    {
      ExpectInputError([&] { Read<short>(scalars, grid); }, { "(2, 0)", "upper triangular" });
    }
  }
}

TEST(LabelImage, RejectsImagesWithoutForeground)
{
  ExpectInputError([] { Read<float>(std::vector<float>(24, 0.0f), Grid(4, 3, 2)); },
    { "no foreground", "24 voxels" });
}

TEST(LabelImage, HasAnyNumberOfRegions)
{
  constexpr std::int64_t n = 90;
  constexpr std::size_t labels = n * n * n / 8;
  static_assert(labels > 65536 && MaximumNumberOfLabels(n * n * n) == labels);
  std::vector<std::int64_t> values(n * n * n);
  const auto fill = [&](std::size_t number)
  {
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      values[i] = static_cast<std::int64_t>(i % number) * 1000003 + 1;
    }
  };
  fill(labels);
  const LabelImage<3> image = Read<std::int64_t>(values, Grid(n, n, n), {}, 3);
  ASSERT_EQ(image.NumberOfLabels(), labels);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    ASSERT_EQ(image.Ids()[i], 1 + i % labels);
    ASSERT_EQ(image.Values()[image.Ids()[i]], values[i]);
  }
  fill(labels + 1);
  ExpectInputError([&] { Read<std::int64_t>(values, Grid(n, n, n)); }, { "91125", "8 voxels" });
}

TEST(LabelImage, RefusesMoreLabelsThanRegions)
{
  constexpr std::int64_t n = 41; // more voxels than labels
  constexpr int most = static_cast<int>(MaximumNumberOfLabels(n * n * n));
  std::vector<unsigned short> scalars(n * n * n);
  const auto fill = [&](int labels)
  {
    for (std::size_t i = 0; i < scalars.size(); ++i)
    {
      scalars[i] = static_cast<unsigned short>(i % (static_cast<std::size_t>(labels) + 1));
    }
  };
  fill(most);
  const LabelImage<3> all = Read<unsigned short>(scalars, Grid(n, n, n));
  EXPECT_EQ(all.NumberOfLabels(), most);
  EXPECT_TRUE(std::ranges::equal(all.Ids(), scalars));
  const std::vector<double> doubles(scalars.begin(), scalars.end());
  EXPECT_EQ(Read<double>(doubles, Grid(n, n, n)).NumberOfLabels(), most);
  fill(most + 1);
  ExpectInputError([&] { Read<unsigned short>(scalars, Grid(n, n, n)); },
    { "65000", "grey-value image", "Segment it", "choose the labels" });
  const std::vector<int> ints(scalars.begin(), scalars.end());
  ExpectInputError([&] { Read<int>(ints, Grid(n, n, n), {}, 4); }, { "grey-value image" });

  // Only what was asked for counts.
  std::vector<int> many(ints.size());
  for (std::size_t i = 0; i < many.size(); ++i)
  {
    many[i] = 3 + static_cast<int>(i);
  }
  many[5] = 1;
  many.back() = 2;
  for (const unsigned threads : { 1u, 3u })
  {
    const LabelImage<3> two = Read<int>(many, Grid(n, n, n), { { 2, 1 }, {} }, threads);
    EXPECT_EQ(two.NumberOfLabels(), 2);
    EXPECT_EQ(two.Counts()[1], 1);
    EXPECT_EQ(two.Counts()[2], 1);
    EXPECT_EQ(two.At({ 0, 0, 0 }), 1);
    const LabelImage<3> one =
      Read<int>(many, Grid(n, n, n), { { 60000, 60001 }, { 60000 } }, threads);
    EXPECT_EQ(one.Values()[1], 60001);
    EXPECT_EQ(one.Ids().size(), 1u);
  }
  ExpectInputError(
    [&] {
      Read<int>(many, Grid(n, n, n), { { 1, 8 }, {} });
    },
    { "Label 8 ", "does not occur", "1, 3, 4" });
}

TEST(LabelImage, ThreadsAndTypesAgree)
{
  std::mt19937 random(5);
  GridGeometry<4> grid = GridGeometry<4>::Orthogonal({ 31, 29, 37, 11 }, { 1.0, 1.0, 1.0, 1.0 });
  std::vector<short> shorts(31 * 29 * 37 * 11, 0);
  for (std::size_t i = 40000; i < 300000; ++i)
  {
    shorts[i] = static_cast<short>(random() % 4 == 0 ? random() % 300 : 0);
  }
  const std::vector<double> doubles(shorts.begin(), shorts.end());
  const LabelImage<4> one = Read<short, 4>(shorts, grid);
  const LabelImage<4> four = Read<short, 4>(shorts, grid, {}, 4);
  const LabelImage<4> other = Read<double, 4>(doubles, grid, {}, 3);
  for (const LabelImage<4>* image : { &four, &other })
  {
    EXPECT_EQ(one.CropOrigin(), image->CropOrigin());
    EXPECT_EQ(one.CropDimensions(), image->CropDimensions());
    EXPECT_TRUE(std::ranges::equal(one.Ids(), image->Ids()));
    EXPECT_TRUE(std::ranges::equal(one.Values(), image->Values()));
    EXPECT_TRUE(std::ranges::equal(one.Counts(), image->Counts()));
  }
  // Against the definition.
  for (std::size_t k = 0; k < one.Ids().size(); ++k)
  {
    auto voxel = IndexAt(k, one.CropDimensions());
    for (std::size_t a = 0; a < 4; ++a)
    {
      voxel[a] += one.CropOrigin()[a];
    }
    ASSERT_EQ(one.Values()[one.Ids()[k]], shorts[OffsetOf(voxel, grid.Dimensions)]);
  }
  EXPECT_EQ(std::accumulate(one.Counts().begin(), one.Counts().end(), std::int64_t{ 0 }),
    static_cast<std::int64_t>(one.Ids().size()));
}

TEST(LabelImage, StopsWhenAsked)
{
  const std::vector<short> scalars(20 * 20 * 20, 1);
  std::stop_source source;
  const auto read = [&](unsigned threads)
  {
    return LabelImage<3>::FromScalars<short>(
      scalars, Grid(20, 20, 20), {}, threads, source.get_token());
  };
  EXPECT_EQ(read(2).NumberOfLabels(), 1); // not yet
  source.request_stop();
  for (const unsigned threads : { 1u, 2u, 3u, 8u })
  {
    EXPECT_THROW(read(threads), Cancelled);
  }
}
