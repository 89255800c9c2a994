// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Isosurfaces of grey-value images: which voxels are inside, and where the surface is between them.
#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Domain/ScalarField.h"
#include "Image/DropComponents.h"
#include "Image/IsosurfaceImage.h"
#include "MeshRuns.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

using namespace voxplex;

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

template <int D>
GridGeometry<D> UnitGrid(std::int64_t n)
{
  typename GridGeometry<D>::Index dimensions;
  dimensions.fill(n);
  Point<D> spacing;
  spacing.fill(1.0);
  return GridGeometry<D>::Orthogonal(dimensions, spacing);
}

GridGeometry<3> SkewedGrid()
{
  GridGeometry<3> grid = GridGeometry<3>::Orthogonal({ 17, 16, 15 }, { 0.5, 0.7, 1.1 });
  grid.IndexToFrame[0][1] = 0.2;
  grid.IndexToFrame[0][2] = -0.3;
  grid.IndexToFrame[1][2] = 0.4;
  return grid;
}

template <int D>
Point<D> CentreOf(std::size_t voxel, const GridGeometry<D>& grid)
{
  const auto index = IndexAt(voxel, grid.Dimensions);
  Point<D> x;
  std::copy(index.begin(), index.end(), x.begin());
  return grid.ToFrame(x);
}

/** A value for each voxel of a grid, from its index. */
template <typename T = double, int D>
std::vector<T> Fill(const GridGeometry<D>& grid,
  const std::function<double(const typename GridGeometry<D>::Index&)>& value)
{
  std::vector<T> values;
  for (std::size_t v = 0; v < CountCells(grid.Dimensions); ++v)
  {
    values.push_back(static_cast<T>(value(IndexAt(v, grid.Dimensions))));
  }
  return values;
}

/** Uniform in -1 ... 1, in blocks of 2^D voxels, so that there are tiles of all kinds. */
template <int D>
std::vector<double> Noise(const GridGeometry<D>& grid, std::mt19937& random)
{
  std::vector<double> values(CountCells(grid.Dimensions));
  for (std::size_t v = 0; v < values.size(); ++v)
  {
    auto block = IndexAt(v, grid.Dimensions);
    for (std::int64_t& i : block)
    {
      i -= i % 2;
    }
    const std::size_t first = OffsetOf(block, grid.Dimensions);
    values[v] = first < v ? values[first] + std::uniform_real_distribution<>(-0.2, 0.2)(random)
                          : std::uniform_real_distribution<>(-1.0, 1.0)(random);
  }
  return values;
}

template <typename T, int D>
IsosurfaceImage<D> Make(
  const std::vector<T>& values, const GridGeometry<D>& grid, const Isosurface& surface = {})
{
  return IsosurfaceImage<D>::template FromScalars<T>(values, grid, surface);
}

/** The image reads the values as long as it lives. */
template <typename T, int D>
IsosurfaceImage<D> Make(
  std::vector<T>&& values, const GridGeometry<D>& grid, const Isosurface& surface = {}) = delete;

template <typename T, int D>
std::string RefusalOf(
  const std::vector<T>& values, const GridGeometry<D>& grid, const Isosurface& surface)
{
  return checks::MessageOf([&] { Make(values, grid, surface); });
}

template <int D>
Point<D> RandomIndex(const GridGeometry<D>& grid, double beyond, std::mt19937& random)
{
  Point<D> x;
  for (std::size_t a = 0; a < D; ++a)
  {
    x[a] = std::uniform_real_distribution<>(
      -beyond, static_cast<double>(grid.Dimensions[a] - 1) + beyond)(random);
  }
  return x;
}

/** Multilinear interpolation at an index inside of the grid, in double precision. */
template <int D>
double Interpolated(const std::vector<double>& values, const GridGeometry<D>& grid, Point<D> x)
{
  double sum = 0.0;
  for (unsigned corner = 0; corner < (1u << D); ++corner)
  {
    double weight = 1.0;
    std::size_t at = 0;
    for (std::size_t a = D; a-- > 0;)
    {
      const double low = std::min(std::floor(x[a]), static_cast<double>(grid.Dimensions[a] - 2));
      const bool up = ((corner >> a) & 1u) != 0;
      weight *= up ? x[a] - low : 1.0 - (x[a] - low);
      at = at * static_cast<std::size_t>(grid.Dimensions[a]) + static_cast<std::size_t>(low) +
        (up ? 1 : 0);
    }
    sum += weight * values[at];
  }
  return sum;
}

template <int D>
void CheckVoxelCentres(const GridGeometry<D>& grid, std::mt19937& random)
{
  std::vector<double> values = Noise(grid, random);
  for (double& value : values)
  {
    switch (random() % 12)
    {
      case 0:
        value = NaN;
        break;
      case 1:
        value = 0.1;
        break;
      case 2:
        value = Infinity;
        break;
      case 3:
        value = -Infinity;
        break;
      default:
        break;
    }
  }
  for (const IsosurfaceSide side : { IsosurfaceSide::Above, IsosurfaceSide::Below })
  {
    const IsosurfaceImage<D> image = Make(values, grid, { 0.1, side, 9 });
    const ScalarField<D> field(image);
    std::int64_t inside = 0;
    for (std::size_t v = 0; v < values.size(); ++v)
    {
      const bool isInside = side == IsosurfaceSide::Above ? values[v] >= 0.1 : values[v] <= 0.1;
      ASSERT_EQ(field.Label(CentreOf(v, grid)), isInside ? 1 : 0) << v << ": " << values[v];
      inside += isInside;
    }
    EXPECT_EQ(image.Labels().Counts()[1], inside);
    EXPECT_EQ(image.Labels().Values()[1], 9);
    EXPECT_EQ(image.Labels().NumberOfLabels(), 1);
    EXPECT_EQ(image.Range()[0], -Infinity);
    EXPECT_EQ(image.Range()[1], Infinity);
    // The margin tells what the label tells, for both labels, everywhere.
    for (int i = 0; i < 4000; ++i)
    {
      Point<D> x = field.ToLattice(grid.ToFrame(RandomIndex(grid, 2.0, random)));
      if (i % 4 == 0)
      {
        x[static_cast<std::size_t>(i / 4) % D] = std::floor(x[0]); // on faces of cells, too
      }
      const LabelId label = field.LabelAt(x);
      ASSERT_LE(label, 1);
      for (const LabelId l : { LabelId{ 0 }, LabelId{ 1 } })
      {
        const double margin = field.MarginAt(x, l);
        ASSERT_EQ(margin > 0.0, l == label);
        ASSERT_LE(std::abs(margin), 2.0);
      }
    }
  }
}

template <int D>
void CheckInterpolation(const GridGeometry<D>& grid, std::mt19937& random)
{
  const std::vector<double> values = Noise(grid, random);
  const double isovalue = 0.15;
  const IsosurfaceImage<D> image = Make(values, grid, { isovalue });
  const ScalarField<D> field(image);
  int compared = 0;
  for (int i = 0; i < 5000; ++i)
  {
    const Point<D> index = RandomIndex(grid, 0.0, random);
    const double margin = Interpolated(values, grid, index) - isovalue;
    const Point<D> p = grid.ToFrame(index);
    if (std::abs(margin) > 2e-3) // samples near 0 are raised
    {
      ASSERT_EQ(field.Label(p), margin > 0.0 ? 1 : 0);
    }
    // The gradient is that of the interpolation times a factor.
    Point<D> gradient;
    Point<D> x = field.ToLattice(p);
    if (!field.ExtendedMarginGradientAt(x, 1, gradient))
    {
      continue;
    }
    Point<D> exact;
    constexpr double h = 1e-4;
    bool inOneCell = true;
    for (std::size_t a = 0; a < D; ++a)
    {
      Point<D> low = index;
      Point<D> high = index;
      low[a] -= h;
      high[a] += h;
      inOneCell = inOneCell && low[a] > 0.0 && std::floor(low[a]) == std::floor(high[a]) &&
        high[a] < static_cast<double>(grid.Dimensions[a] - 1);
      exact[a] = inOneCell
        ? (Interpolated(values, grid, high) - Interpolated(values, grid, low)) / (2.0 * h)
        : 0.0;
    }
    const double length = std::sqrt(Dot(exact, exact));
    if (inOneCell && length > 0.05)
    {
      ASSERT_NEAR(Dot(exact, gradient) / (length * std::sqrt(Dot(gradient, gradient))), 1.0, 1e-4);
      Point<D> other;
      ASSERT_TRUE(field.ExtendedMarginGradientAt(x, 0, other));
      ASSERT_EQ(other[0], -gradient[0]);
      ++compared;
    }
  }
  EXPECT_GT(compared, 500);
}

} // namespace

TEST(ScalarField, VoxelCentresKeepTheirSide)
{
  std::mt19937 random(11);
  CheckVoxelCentres<3>(UnitGrid<3>(19), random);
  CheckVoxelCentres<3>(SkewedGrid(), random);
  CheckVoxelCentres<4>(UnitGrid<4>(9), random);
}

TEST(ScalarField, InterpolatesMultilinearly)
{
  std::mt19937 random(12);
  CheckInterpolation<3>(UnitGrid<3>(19), random);
  CheckInterpolation<3>(SkewedGrid(), random);
  CheckInterpolation<4>(UnitGrid<4>(9), random);
}

TEST(ScalarField, MarginIsOneFromCornerToCorner)
{
  const auto grid = UnitGrid<3>(9);
  const auto ramp = Fill(grid, [](const auto& i) { return 500.0 * static_cast<double>(i[0]); });
  const IsosurfaceImage<3> image = Make(ramp, grid, { 1625.0 });
  const ScalarField<3> field(image);
  EXPECT_NEAR(field.Margin({ 3.5, 4.2, 4.7 }, 1), 0.25, 1e-5);
  EXPECT_NEAR(field.Margin({ 3.0, 4.2, 4.7 }, 1), -0.25, 1e-5);
  EXPECT_NEAR(field.Margin({ 3.0, 4.2, 4.7 }, 0), 0.25, 1e-5);
}

TEST(ScalarField, TheScaleOfValuesDoesNotMatter)
{
  std::mt19937 random(13);
  const auto grid = UnitGrid<3>(14);
  const std::vector<double> values = Noise(grid, random);
  const IsosurfaceImage<3> image = Make(values, grid, { 0.25 });
  const ScalarField<3> field(image);
  for (const int exponent : { -1040, -300, -40, 12, 1020 }) // with denormal numbers, too
  {
    std::vector<double> scaled = values;
    for (double& v : scaled)
    {
      v = std::ldexp(v, exponent);
    }
    const IsosurfaceImage<3> other = Make(scaled, grid, { std::ldexp(0.25, exponent) });
    const ScalarField<3> scaledField(other);
    const double tolerance = exponent == -1040 ? 1e-4 : 1e-12;
    for (int i = 0; i < 1000; ++i)
    {
      const Point<3> p = RandomIndex(grid, 1.0, random);
      ASSERT_NEAR(field.Margin(p, 1), scaledField.Margin(p, 1), tolerance) << exponent;
    }
  }
}

TEST(ScalarField, EveryScalarType)
{
  std::mt19937 random(14);
  const auto grid = UnitGrid<3>(12);
  const auto at = [](const auto& i)
  { return static_cast<double>((i[0] * i[0] + 3 * i[1] * i[2]) % 117 + (i[0] > 5 ? 10 : 0)); };
  const std::vector<double> doubles = Fill<double>(grid, at);
  const IsosurfaceImage<3> image = Make(doubles, grid, { 63.5 });
  const ScalarField<3> expected(image);
  const auto check = [&]<typename T>(T)
  {
    const std::vector<T> values = Fill<T>(grid, at);
    const IsosurfaceImage<3> typed = Make(values, grid, { 63.5 });
    const ScalarField<3> field(typed);
    for (int i = 0; i < 300; ++i)
    {
      const Point<3> p = RandomIndex(grid, 1.0, random);
      ASSERT_EQ(field.Margin(p, 1), expected.Margin(p, 1));
    }
  };
  check(char());
  check(static_cast<signed char>(0));
  check(static_cast<unsigned char>(0));
  check(short());
  check(static_cast<unsigned short>(0));
  check(int());
  check(0u);
  check(0l);
  check(0ul);
  check(0ll);
  check(0ull);
  check(0.0f);
}

TEST(ScalarField, ClosedHalfAVoxelBeyondTheBorder)
{
  const auto grid = UnitGrid<3>(10);
  const auto values = Fill(grid,
    [](const auto& i)
    { return i[0] + i[1] + i[2] == 27 ? -1.0 : 1.0 + static_cast<double>(i[1] * i[2]); });
  const IsosurfaceImage<3> image = Make(values, grid);
  const ScalarField<3> field(image);
  std::mt19937 random(15);
  for (int i = 0; i < 500; ++i)
  {
    const Point<3> p =
      checks::Drawn<3>([&] { return std::uniform_real_distribution<>(0.0, 7.9)(random); });
    for (std::size_t a = 0; a < 3; ++a)
    {
      for (const double side : { -0.5, 9.5 })
      {
        Point<3> in = p;
        Point<3> out = p;
        in[a] = side < 0.0 ? side + 1e-4 : side - 1e-4;
        out[a] = side < 0.0 ? side - 1e-4 : side + 1e-4;
        ASSERT_EQ(field.Label(in), 1);
        ASSERT_EQ(field.Label(out), 0);
      }
    }
  }
}

// Beyond each face where the image cuts the object all is as in the outermost voxels, also across edges and corners.
TEST(ScalarField, ValuesGoOnBeyondTheFacesOfTheImage)
{
  std::mt19937 random(21);
  const auto grid = UnitGrid<3>(10);
  const std::vector<double> values = Noise(grid, random);
  const IsosurfaceImage<3> image = Make(values, grid, { 0.05 });
  const ScalarField<3> field(image);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    ASSERT_TRUE(image.Labels().ReachesBorder(axis, 0) && image.Labels().ReachesBorder(axis, 1))
      << axis;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    int labels[2] = {};
    for (int i = 0; i < 2000; ++i)
    {
      Point<3> beyond = field.ToLattice(grid.ToFrame(RandomIndex(grid, 0.9, random)));
      beyond[axis] = std::uniform_real_distribution<>(0.0, 1.0)(random);
      beyond[axis] = i % 2 == 0 ? beyond[axis] : 11.0 - beyond[axis];
      Point<3> on = beyond;
      for (double& x : on)
      {
        x = std::clamp(x, 1.0, 10.0);
      }
      // But what is near 0, which is raised by what is beside it: that may be another amount at the border.
      if (std::abs(field.ExtendedMarginAt(on, 1)) > 1e-2)
      {
        ASSERT_EQ(field.ExtendedLabelAt(beyond), field.ExtendedLabelAt(on)) << axis;
        ++labels[field.ExtendedLabelAt(on)];
      }
    }
    EXPECT_GT(labels[0], 200);
    EXPECT_GT(labels[1], 200);
  }
}

TEST(ScalarField, VoxelsWithoutANumberAreOutsideByHalfAVoxel)
{
  const auto grid = UnitGrid<3>(12);
  auto values = Fill<float>(
    grid, [](const auto& i) { return i[0] < 6 ? NaN : 5.5 + static_cast<double>(i[1]); });
  const std::size_t hole = (8 * 12 + 6) * 12 + 9;
  values[hole] = std::numeric_limits<float>::quiet_NaN();
  values[(1 * 12 + 6) * 12 + 9] = 4.0f; // for the isovalue to be in the range
  const IsosurfaceImage<3> image = Make(values, grid, { 5.0 });
  EXPECT_EQ(image.Range()[0], 4.0);
  EXPECT_EQ(image.Range()[1], 16.5);
  EXPECT_EQ(image.Labels().Counts()[1], 6 * 12 * 12 - 2);
  const ScalarField<3> field(image);
  for (const double y : { 1.0, 3.7, 10.2 })
  {
    EXPECT_EQ(field.Label({ 5.51, y, 6.3 }), 1);
    EXPECT_EQ(field.Label({ 5.49, y, 6.3 }), 0);
    EXPECT_EQ(field.Label({ 2.0, y, 6.3 }), 0);
  }
  EXPECT_EQ(field.Label({ 8.51, 6.0, 8.0 }), 0); // values there are as large on both sides along x
  EXPECT_EQ(field.Label({ 8.49, 6.0, 8.0 }), 1);
  EXPECT_EQ(field.Label({ 9.49, 6.0, 8.0 }), 0);
  EXPECT_EQ(field.Label({ 9.51, 6.0, 8.0 }), 1);
}

TEST(ScalarField, BelowMirrorsAbove)
{
  std::mt19937 random(16);
  const auto grid = UnitGrid<3>(13);
  const std::vector<double> values = Noise(grid, random);
  std::vector<double> negated = values;
  for (double& v : negated)
  {
    v = -v;
  }
  const IsosurfaceImage<3> above = Make(values, grid, { 0.3, IsosurfaceSide::Above });
  const IsosurfaceImage<3> below = Make(negated, grid, { -0.3, IsosurfaceSide::Below });
  const IsosurfaceImage<3> other = Make(values, grid, { 0.3, IsosurfaceSide::Below });
  const ScalarField<3> a(above);
  const ScalarField<3> b(below);
  const ScalarField<3> c(other);
  for (int i = 0; i < 2000; ++i)
  {
    const Point<3> p = RandomIndex(grid, 1.0, random);
    ASSERT_EQ(a.Margin(p, 1), b.Margin(p, 1));
    const Point<3> q = RandomIndex(grid, 0.0, random); // within the image the two are complements
    if (std::abs(a.Margin(q, 1)) > 5e-3)               // samples near 0 are raised, on both sides
    {
      ASSERT_NE(a.Label(q), c.Label(q));
    }
  }
}

TEST(ScalarField, DroppedComponentsAreOutside)
{
  const auto grid = UnitGrid<3>(20);
  const auto values = Fill(grid,
    [](const auto& i)
    {
      const Point<3> p{ static_cast<double>(i[0]), static_cast<double>(i[1]),
        static_cast<double>(i[2]) };
      return std::max(
        5.0 - Distance(p, { 7.0, 7.0, 7.0 }), 1.5 - Distance(p, { 16.0, 16.0, 16.0 }));
    });
  IsosurfaceImage<3> image = Make(values, grid);
  const ScalarField<3> with(image);
  EXPECT_EQ(with.Label({ 16.0, 16.0, 16.0 }), 1);
  const std::vector<ComponentReport> dropped = DropComponents(image.Labels(), 50.0);
  ASSERT_EQ(dropped.size(), 1u);
  const ScalarField<3> without(image);
  std::mt19937 random(17);
  for (int i = 0; i < 3000; ++i)
  {
    const Point<3> p = RandomIndex(grid, 0.0, random);
    const bool near = Distance(p, { 16.0, 16.0, 16.0 }) < 3.0;
    ASSERT_EQ(without.Label(p), near ? 0 : with.Label(p));
  }
}

TEST(ScalarField, ThreadsMakeNoDifference)
{
  std::mt19937 random(18);
  const auto grid = UnitGrid<3>(120);
  const std::vector<double> values = Noise(grid, random);
  for (const double sigma : { 0.0, 1.3 })
  {
    const Isosurface surface{ 0.2, IsosurfaceSide::Above, 1, sigma };
    const auto one = IsosurfaceImage<3>::FromScalars<double>(values, grid, surface, 1);
    const auto four = IsosurfaceImage<3>::FromScalars<double>(values, grid, surface, 4);
    EXPECT_EQ(one.Range(), four.Range());
    const ScalarField<3> a(one, 1);
    const ScalarField<3> b(four, 4);
    EXPECT_EQ(a.MemoryBytes() > 0, b.MemoryBytes() > 0);
    for (int i = 0; i < 3000; ++i)
    {
      const Point<3> p = RandomIndex(grid, 1.0, random);
      ASSERT_EQ(a.Margin(p, 1), b.Margin(p, 1));
    }
  }
}

// Samples are raised where neighbours in time are much larger, and closed beside voxels without a number. So what is
// before the first frame matters there.
TEST(ScalarField, EndsOfAPeriodAreEqual)
{
  const auto grid = UnitGrid<4>(7);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> decades(-6.0, 2.0);
  std::vector<double> values = Fill(grid,
    [&](const auto& i)
    {
      const double r = std::hypot(static_cast<double>(i[0]) - 3.0, static_cast<double>(i[1]) - 3.0,
        static_cast<double>(i[2]) - 3.0);
      const double depth = std::pow(10.0, decades(random));
      return depth < 1e-5 ? NaN : r < 2.5 ? depth : -depth;
    });
  const std::size_t frame = values.size() / 7;
  std::copy_n(values.begin(), frame, values.end() - static_cast<std::ptrdiff_t>(frame));
  for (const bool isPeriodic : { true, false })
  {
    Isosurface surface;
    surface.PeriodicInTime = isPeriodic;
    const auto image = IsosurfaceImage<4>::FromScalars<double>(values, grid, surface);
    const ScalarField<4> field(image);
    std::size_t differ = 0;
    for (int k = 0; k < 2000; ++k)
    {
      Point<4> p = RandomIndex(grid, 0.0, random);
      p[3] = 0.0;
      const double first = field.Margin(p, 1);
      p[3] = 6.0;
      differ += std::abs(field.Margin(p, 1) - first) > 1e-5 ? 1 : 0;
    }
    EXPECT_EQ(differ > 0, !isPeriodic) << differ;
  }
}

TEST(ScalarField, FlatEndsInTime)
{
  const auto grid = UnitGrid<4>(9);
  const auto values = Fill(grid,
    [](const auto& i)
    {
      const double r = std::hypot(static_cast<double>(i[0]) - 4.0, static_cast<double>(i[1]) - 4.0,
        static_cast<double>(i[2]) - 4.0);
      return 2.7 - r + 0.02 * static_cast<double>(i[3]);
    });
  const IsosurfaceImage<4> image = Make(values, grid);
  const ScalarField<4> field(image);
  EXPECT_EQ(field.FlatEnds()[1] - field.FlatEnds()[0], 8.0);
  std::mt19937 random(19);
  for (int i = 0; i < 500; ++i)
  {
    Point<4> p = RandomIndex(grid, 0.0, random);
    p[3] = 0.0;
    const double first = field.Margin(p, 1);
    p[3] = -3.0;
    ASSERT_EQ(field.Margin(p, 1), first);
  }
}

TEST(IsosurfaceImage, SmoothingLeavesPlanesAndTakesNoise)
{
  const auto grid = UnitGrid<3>(40);
  const auto plane = [](const Point<3>& p) { return 0.6 * p[0] + 0.5 * p[1] - 0.4 * p[2]; };
  const auto ramp = Fill(grid,
    [&](const auto& i)
    {
      return plane(
        { static_cast<double>(i[0]), static_cast<double>(i[1]), static_cast<double>(i[2]) });
    });
  std::mt19937 random(20);
  std::vector<double> noisy = ramp;
  for (double& v : noisy)
  {
    v += std::normal_distribution<>(0.0, 0.5)(random);
  }
  const double isovalue = plane({ 20.0, 20.0, 20.0 });
  const Isosurface smooth{ isovalue, IsosurfaceSide::Above, 1, 1.5 };
  const IsosurfaceImage<3> cleanImage = Make(ramp, grid, smooth);
  const IsosurfaceImage<3> smoothImage = Make(noisy, grid, smooth);
  const IsosurfaceImage<3> noisyImage = Make(noisy, grid, { isovalue });
  const ScalarField<3> clean(cleanImage);
  const ScalarField<3> denoised(smoothImage);
  const ScalarField<3> raw(noisyImage);
  int wrong = 0;
  int wrongDenoised = 0;
  for (int i = 0; i < 4000; ++i)
  {
    const Point<3> p =
      checks::Drawn<3>([&] { return std::uniform_real_distribution<>(10.0, 29.0)(random); });
    const double height = plane(p) - isovalue;
    const LabelId expected = height > 0.0 ? 1 : 0;
    if (std::abs(height) > 1e-3)
    {
      ASSERT_EQ(clean.Label(p), expected);
    }
    if (std::abs(height) < 1.0)
    {
      wrong += raw.Label(p) != expected;
      wrongDenoised += denoised.Label(p) != expected;
    }
  }
  EXPECT_GT(wrong, 50);
  EXPECT_LT(wrongDenoised, wrong / 5);
}

TEST(IsosurfaceImage, SmoothedValuesThatAreNoNumbersStayOutside)
{
  const auto grid = UnitGrid<3>(12);
  auto values = Fill<float>(grid, [](const auto& i) { return static_cast<double>(i[0]); });
  const std::size_t voxel = (6 * 12 + 6) * 12 + 9;
  values[voxel] = std::numeric_limits<float>::quiet_NaN();
  const IsosurfaceImage<3> image = Make(values, grid, { 4.5, IsosurfaceSide::Above, 1, 1.0 });
  EXPECT_EQ(image.Labels().Counts()[1], 7 * 12 * 12 - 1);
  EXPECT_EQ(ScalarField<3>(image).Label(CentreOf(voxel, grid)), 0);
  EXPECT_GT(image.Range()[0], 0.0 - 1e-3); // the kernel leaves ramps alone, but repeats the ends
  EXPECT_LT(image.Range()[1], 11.1);
}

TEST(IsosurfaceImage, SaysWhatIsWrong)
{
  const auto grid = UnitGrid<3>(4);
  const auto ramp = Fill(grid, [](const auto& i) { return static_cast<double>(i[0]) - 1.0; });
  EXPECT_EQ(RefusalOf(ramp, grid, { 2.5 }),
    "The isovalue 2.5 is outside of the image's range, which is from -1 to 2. Choose an isovalue "
    "in between.");
  EXPECT_NE(RefusalOf(ramp, grid, { -1.5 }).find("from -1 to 2"), std::string::npos);
  EXPECT_NE(
    RefusalOf(ramp, grid, { 2.5, IsosurfaceSide::Below }).find("from -1 to 2"), std::string::npos);
  EXPECT_EQ(RefusalOf(ramp, grid, { 2.0 }), ""); // the largest value has an inside
  EXPECT_EQ(RefusalOf(ramp, grid, { -1.0, IsosurfaceSide::Below }), "");
  EXPECT_NE(RefusalOf(ramp, grid, { 2.0, IsosurfaceSide::Above, 1, 2.0 }).find("after smoothing"),
    std::string::npos);
  EXPECT_NE(RefusalOf(ramp, grid, { NaN }).find("must be finite"), std::string::npos);
  EXPECT_NE(RefusalOf(ramp, grid, { Infinity }).find("must be finite"), std::string::npos);
  EXPECT_NE(
    RefusalOf(ramp, grid, { 0.0, IsosurfaceSide::Above, 0 }).find("label of the inside is 0"),
    std::string::npos);
  for (const double sigma : { -1.0, 5.5, NaN })
  {
    EXPECT_NE(RefusalOf(ramp, grid, { 0.0, IsosurfaceSide::Above, 1, sigma }).find("between 0"),
      std::string::npos);
  }
  const auto nothing = Fill(grid, [](const auto&) { return NaN; });
  EXPECT_NE(RefusalOf(nothing, grid, { 0.0 }).find("are NaN"), std::string::npos);
  auto flat = grid;
  flat.Dimensions[1] = 1;
  EXPECT_NE(RefusalOf(ramp, flat, { 0.0 }).find("1 voxel(s) along axis 1"), std::string::npos);
  auto larger = grid;
  larger.Dimensions[1] = 5;
  EXPECT_NE(RefusalOf(ramp, larger, { 0.0, IsosurfaceSide::Above, 1, 1.0 }).find("64 scalars"),
    std::string::npos);
}
