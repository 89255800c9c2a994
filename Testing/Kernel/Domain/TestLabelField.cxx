// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Domain/LabelField.h"
#include "Phantoms.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace voxplex;

namespace
{

template <int D>
LabelImage<D> MakeImage(const std::vector<short>& scalars, const GridGeometry<D>& grid)
{
  return LabelImage<D>::template FromScalars<short>(scalars, grid);
}

template <int D>
GridGeometry<D> UnitGrid(std::int64_t n)
{
  typename GridGeometry<D>::Index dimensions;
  dimensions.fill(n);
  Point<D> spacing;
  spacing.fill(1.0);
  return GridGeometry<D>::Orthogonal(dimensions, spacing);
}

/** Independent labels 0 ... labels at every voxel; blocky > 1 makes cubes of one label. */
template <int D>
std::vector<short> Noise(std::int64_t n, int labels, std::int64_t blocky, std::mt19937& random)
{
  const auto dimensions = UnitGrid<D>(n).Dimensions;
  std::vector<short> blocks(CountCells(dimensions));
  for (short& b : blocks)
  {
    b = static_cast<short>(random() % static_cast<unsigned>(labels + 1));
  }
  std::vector<short> scalars(blocks.size());
  for (std::size_t i = 0; i < scalars.size(); ++i)
  {
    auto block = IndexAt(i, dimensions);
    for (std::int64_t& x : block)
    {
      x /= blocky;
    }
    scalars[i] = blocks[OffsetOf(block, dimensions)];
  }
  return scalars;
}

template <int D, typename Function>
void ForEachVoxel(const LabelImage<D>& image, Function&& function)
{
  for (std::size_t k = 0; k < image.Ids().size(); ++k)
  {
    const auto i = IndexAt(k, image.CropDimensions());
    Point<D> index;
    for (std::size_t a = 0; a < D; ++a)
    {
      index[a] = static_cast<double>(i[a] + image.CropOrigin()[a]);
    }
    function(index, image.Ids()[k]);
  }
}

template <int D>
void CheckCentres(double sigma, int labels, std::int64_t blocky)
{
  std::mt19937 random(static_cast<unsigned>(labels));
  const std::int64_t n = D == 3 ? 24 : 11;
  const LabelImage<D> image = MakeImage<D>(Noise<D>(n, labels, blocky, random), UnitGrid<D>(n));
  const LabelField<D> field(image, sigma);
  ForEachVoxel<D>(image,
    [&](const Point<D>& p, LabelId id)
    {
      ASSERT_EQ(field.Label(p), id);
      ASSERT_GE(field.Margin(p, id), 0.019);
    });
}

template <int D>
void CheckMargin(int labels, std::int64_t blocky, double sigma)
{
  std::mt19937 random(11);
  const std::int64_t n = D == 3 ? 40 : 14;
  const LabelImage<D> image = MakeImage<D>(Noise<D>(n, labels, blocky, random), UnitGrid<D>(n));
  const LabelField<D> field(image, sigma);
  std::uniform_real_distribution<double> coordinate(-2.0, static_cast<double>(n) + 1.0);
  for (int trial = 0; trial < 3000; ++trial)
  {
    Point<D> p;
    for (double& x : p)
    {
      x = coordinate(random);
      x = trial % 3 == 0 ? std::round(2.0 * x) / 2.0 : x; // where ties are
    }
    const LabelId label = field.Label(p);
    int winners = 0;
    for (int l = 0; l <= image.NumberOfLabels(); ++l)
    {
      const double margin = field.Margin(p, static_cast<LabelId>(l));
      ASSERT_EQ(margin > 0.0, l == label) << l << " margin " << margin;
      winners += margin > 0.0;
    }
    ASSERT_EQ(winners, 1);
  }
}

/** Margins of several labels at once are those of one after the other, to the last bit. */
template <int D, std::size_t N>
void CheckMargins(const LabelField<D>& field, const std::array<LabelId, N>& labels)
{
  std::mt19937 random(12);
  int different = 0;
  for (int trial = 0; trial < 4000; ++trial)
  {
    Point<D> x;
    for (std::size_t a = 0; a < D; ++a)
    {
      x[a] = std::uniform_real_distribution<>(
        -1.0, static_cast<double>(field.LatticeDimensions()[a]))(random);
      x[a] = trial % 3 == 0 ? std::round(2.0 * x[a]) / 2.0 : x[a]; // where ties are
    }
    const std::array<double, N> margins = field.ExtendedMarginsAt(x, labels);
    for (std::size_t k = 0; k < N; ++k)
    {
      ASSERT_EQ(margins[k], field.ExtendedMarginAt(x, labels[k])) << trial << ", " << labels[k];
      different += margins[k] != margins[0] ? 1 : 0;
    }
  }
  EXPECT_GT(different, 1000);
}

/** On both sides of a face between tiles margins are the same. */
template <int D>
void CheckFacesOfTiles(std::int64_t n, int labels, double tolerance)
{
  std::mt19937 random(17);
  const LabelField<D> field(MakeImage<D>(Noise<D>(n, labels, 5, random), UnitGrid<D>(n)), 1.0);
  constexpr double beyond = D == 3 ? 1.0 : 0.0; // of the outermost voxels, but not of flat ends
  std::uniform_real_distribution<double> coordinate(1.0 - beyond, static_cast<double>(n) + beyond);
  constexpr double tile = LabelField<D>::TileCells;
  const auto faces = static_cast<unsigned>(static_cast<double>(n) / tile);
  int mixed = 0;
  for (int trial = 0; trial < 15000; ++trial)
  {
    Point<D> low = checks::Drawn<D>([&] { return coordinate(random); });
    const std::size_t axis = static_cast<std::size_t>(trial) % D;
    low[axis] = tile * (1.0 + static_cast<double>(random() % faces));
    Point<D> high = low;
    low[axis] -= 1e-7;
    high[axis] += 1e-7;
    for (int l = 0; l <= labels; ++l)
    {
      const double a = field.ExtendedMarginAt(low, static_cast<LabelId>(l));
      const double b = field.ExtendedMarginAt(high, static_cast<LabelId>(l));
      if (std::abs(a) == 2.0 || std::abs(b) == 2.0)
      {
        ASSERT_EQ(a > 0.0, b > 0.0); // a uniform tile
        continue;
      }
      ++mixed;
      ASSERT_NEAR(a, b, tolerance) << D << "D, " << labels << " labels, axis " << axis;
    }
  }
  EXPECT_GT(mixed, 1000);
}

} // namespace

TEST(LabelField, EveryVoxelCentreKeepsItsLabel)
{
  for (const double sigma : { 0.0, 0.3, 0.7, 1.0, 1.3, 2.5 })
  {
    SCOPED_TRACE(sigma);
    CheckCentres<3>(sigma, 1, 1);
    CheckCentres<3>(sigma, 2, 3);
    CheckCentres<3>(sigma, 9, 1);
    CheckCentres<3>(sigma, 100, 4);
  }
  for (const double sigma : { 0.0, 1.0 })
  {
    CheckCentres<4>(sigma, 1, 1);
    CheckCentres<4>(sigma, 5, 3);
  }
}

TEST(LabelField, TellsAnyNumberOfLabelsApart)
{
  const LabelImage<3> image = phantoms::Blocks(2, 42);
  ASSERT_GT(image.NumberOfLabels(), 65536);
  const LabelField<3> field(image, 0.0, 2);
  ForEachVoxel<3>(image,
    [&](const Point<3>& p, LabelId id)
    {
      ASSERT_EQ(field.Label(p), id);
      ASSERT_GT(field.Margin(p, id), 0.0);
      ASSERT_LT(field.Margin(p, id ^ 0x10000), 0.0);
    });
}

TEST(LabelField, WithoutSmoothingIsTheArgMaxOfInterpolatedIndicators)
{
  std::mt19937 random(3);
  constexpr std::int64_t n = 20;
  const std::vector<short> scalars = Noise<3>(n, 3, 2, random);
  const LabelField<3> field(MakeImage<3>(scalars, UnitGrid<3>(n)), 0.0);
  std::uniform_real_distribution<double> coordinate(-1.5, n + 0.5);
  for (int trial = 0; trial < 20000; ++trial)
  {
    const Point<3> p{ coordinate(random), coordinate(random), coordinate(random) };
    std::array<double, 4> weight{};
    for (int corner = 0; corner < 8; ++corner)
    {
      double w = 1.0;
      std::int64_t at = 0;
      bool inside = true;
      for (int a = 2; a >= 0; --a)
      {
        const double x = p[static_cast<std::size_t>(a)];
        const double f = x - std::floor(x);
        const auto i = static_cast<std::int64_t>(std::floor(x)) + ((corner >> a) & 1);
        w *= (corner >> a) & 1 ? f : 1.0 - f;
        inside = inside && x > -0.5 && x < n - 0.5; // labels go on to where the image cuts them
        at = at * n + std::clamp<std::int64_t>(i, 0, n - 1);
      }
      weight[inside ? static_cast<std::size_t>(scalars[static_cast<std::size_t>(at)]) : 0] += w;
    }
    const LabelId label = field.Label(p);
    const double largest = *std::max_element(weight.begin(), weight.end());
    EXPECT_NEAR(weight[label], largest, 0.012); // the own label is kept by a small margin
  }
}

TEST(LabelField, MarginIsPositiveExactlyForTheLabel)
{
  for (const double sigma : { 0.0, 1.0 })
  {
    CheckMargin<3>(1, 1, sigma);
    CheckMargin<3>(4, 3, sigma);
    CheckMargin<3>(12, 9, sigma);
    CheckMargin<4>(3, 3, sigma);
  }
}

TEST(LabelField, MarginsOfSeveralLabelsAreThoseOfEach)
{
  std::mt19937 random(13);
  for (const double sigma : { 0.0, 1.0 }) // without smoothing labels tie in many places
  {
    for (const int labels : { 1, 2, 5 })
    {
      SCOPED_TRACE(testing::Message() << sigma << ", " << labels << " labels");
      const LabelField<3> field(
        MakeImage<3>(Noise<3>(24, labels, 3, random), UnitGrid<3>(24)), sigma);
      CheckMargins<3, 3>(field, { 0, 1, 2 });
      CheckMargins<3, 4>(field, { 5, 2, 4, 0 });
    }
    const LabelField<4> field(MakeImage<4>(Noise<4>(11, 4, 3, random), UnitGrid<4>(11)), sigma);
    CheckMargins<4, 3>(field, { 3, 1, 0 });
  }
}

TEST(LabelField, TilesAgreeOnTheirFaces)
{
  for (const int labels : { 1, 2, 6 })
  {
    CheckFacesOfTiles<3>(40, labels, 1e-5);
    CheckFacesOfTiles<4>(16, labels, 2e-4);
  }
}

// Both smoothing and the balance of volumes see the frames of the other end.
TEST(LabelField, APeriodIsAsTheMiddleOneOfThree)
{
  constexpr std::int64_t n = 10;
  constexpr std::int64_t period = 8;
  std::mt19937 random(3);
  std::vector<short> one = Noise<4>(n, 3, 3, random);
  one.resize(n * n * n * period);
  const auto repeated = [&](std::int64_t frames)
  {
    std::vector<short> scalars;
    for (std::size_t i = 0; i < static_cast<std::size_t>(n * n * n * frames); ++i)
    {
      scalars.push_back(one[i % one.size()]);
    }
    return MakeImage<4>(
      scalars, GridGeometry<4>::Orthogonal({ n, n, n, frames }, { 1.0, 1.0, 1.0, 1.0 }));
  };
  LabelImage<4> image = repeated(period + 1);
  image.MakePeriodicInTime();
  const LabelField<4> field(image, 1.0);
  const LabelField<4> three(repeated(3 * period), 1.0);
  std::uniform_real_distribution<double> inSpace(-0.5, n - 0.5);
  std::uniform_real_distribution<double> inTime(0.0, period);
  int near = 0; // to interfaces
  for (int k = 0; k < 20000; ++k)
  {
    Point<4> p{ inSpace(random), inSpace(random), inSpace(random), inTime(random) };
    p[3] = k % 8 == 0 ? 0.0 : k % 8 == 1 ? period : p[3];
    const LabelId label = field.Label(p);
    const double margin = field.ExtendedMarginAt(field.ToLattice(p), label);
    p[3] += period;
    ASSERT_EQ(label, three.Label(p));
    if (margin < 0.5) // where tiles of both are mixed
    {
      ASSERT_NEAR(margin, three.ExtendedMarginAt(three.ToLattice(p), label), 1e-5);
      ++near;
    }
  }
  EXPECT_GT(near, 1000);
}

/** Sheets that stay or move. Without the balance those of 2 and 3 voxels are 4 to 21 % too large. */
TEST(LabelField, ThinSheetsOfSpaceTimeKeepTheirVolume)
{
  struct Case
  {
    double Thickness;
    double Speed; ///< voxels a frame
    double Tolerance;
  };
  constexpr std::int64_t n = 20;
  for (const Case& one : { Case{ 2.0, 0.0, 0.06 }, { 2.0, 0.5, 0.1 }, { 3.0, 0.0, 0.02 },
         { 3.0, 0.5, 0.02 }, { 3.0, 1.0, 0.07 }, { 4.0, 0.5, 0.01 } })
  {
    std::vector<short> scalars;
    for (std::int64_t i = 0; i < n * n * n * n; ++i)
    {
      const auto at = [i](std::int64_t stride)
      { return static_cast<double>(i / stride % n) - 9.37; };
      const double across = 0.955 * (at(1) - one.Speed * at(n * n * n)) + 0.296 * at(n);
      scalars.push_back(std::abs(across) < 0.5 * one.Thickness ? 1 : 0);
    }
    const LabelImage<4> image = MakeImage<4>(scalars, UnitGrid<4>(n));
    const LabelField<4> field(image, 1.0);
    // In the middle, where neither sides nor ends are near.
    constexpr int fine = 3;
    constexpr std::int64_t first = 6;
    constexpr std::int64_t last = 13;
    double inImage = 0.0;
    double inField = 0.0;
    for (std::int64_t t = first; t <= last; ++t)
    {
      for (std::int64_t z = first; z <= last; ++z)
      {
        for (std::int64_t y = first; y <= last; ++y)
        {
          for (std::int64_t x = 0; x < n; ++x)
          {
            inImage += scalars[static_cast<std::size_t>(((t * n + z) * n + y) * n + x)];
            for (int k = 0; k < fine * fine * fine * fine; ++k)
            {
              const auto part = [k](int stride)
              { return (static_cast<double>(k / stride % fine) + 0.5) / fine - 0.5; };
              const Point<4> p{ static_cast<double>(x) + part(1), static_cast<double>(y) + part(3),
                static_cast<double>(z) + part(9), static_cast<double>(t) + part(27) };
              inField += field.Label(p) / 81.0;
            }
          }
        }
      }
    }
    EXPECT_NEAR(inField / inImage, 1.0, one.Tolerance)
      << one.Thickness << " voxels, " << one.Speed << " voxels a frame";
  }
}

TEST(LabelField, ThreadsGiveTheSameField)
{
  std::mt19937 random(23);
  constexpr std::int64_t n = 45;
  const LabelImage<3> image = MakeImage<3>(Noise<3>(n, 5, 6, random), UnitGrid<3>(n));
  const LabelField<3> one(image, 1.0, 1);
  const LabelField<3> four(image, 1.0, 4);
  std::uniform_real_distribution<double> coordinate(-1.0, static_cast<double>(n));
  for (int trial = 0; trial < 50000; ++trial)
  {
    const Point<3> p{ coordinate(random), coordinate(random), coordinate(random) };
    const LabelId label = one.Label(p);
    ASSERT_EQ(label, four.Label(p));
    ASSERT_EQ(one.Margin(p, label), four.Margin(p, label));
  }
}

/** A ball through the image's border is closed by the background around it. */
TEST(LabelField, IsBackgroundOutside)
{
  const LabelField<3> field(
    MakeImage<3>(std::vector<short>(10 * 10 * 10, 4), UnitGrid<3>(10)), 1.0);
  EXPECT_EQ(field.Label({ 0.0, 5.0, 9.0 }), 1);
  EXPECT_EQ(field.Label({ -1.0, 5.0, 5.0 }), 0);
  EXPECT_EQ(field.Label({ 10.0, 5.0, 5.0 }), 0);
  EXPECT_EQ(field.Label({ 5.0, 1e300, 5.0 }), 0);
  EXPECT_EQ(field.Label({ 5.0, std::nan(""), 5.0 }), 0);
  EXPECT_NEAR(field.Margin({ 5.0, -0.5, 5.0 }, 1), 0.0, 1e-3);
}

TEST(LabelField, RejectsBadSigma)
{
  const LabelImage<3> image = MakeImage<3>(std::vector<short>(10 * 10 * 10, 4), UnitGrid<3>(10));
  for (const double sigma : { -0.1, 5.1, std::nan("") })
  {
    EXPECT_THROW(LabelField<3>(image, sigma), InputError) << sigma;
  }
}

TEST(LabelField, FollowsABall)
{
  constexpr double radius = 20.0;
  const Point<3> centre{ 23.3, 22.9, 23.1 };
  const auto ball = phantoms::Sample<short>(
    UnitGrid<3>(47), [&](const Point<3>& p) { return Distance(p, centre) <= radius; });
  const LabelField<3> field(MakeImage<3>(ball, UnitGrid<3>(47)), 1.0);
  std::mt19937 random(29);
  std::normal_distribution<double> normal;
  double distance = 0.0;
  double angle = 0.0;
  double volume = 0.0;
  constexpr int rays = 5000;
  for (int ray = 0; ray < rays; ++ray)
  {
    Point<3> u{ normal(random), normal(random), normal(random) };
    const double length = std::sqrt(Dot(u, u));
    double low = radius - 3.0;
    double high = radius + 3.0;
    Point<3> p;
    while (high - low > 1e-4)
    {
      const double middle = 0.5 * (low + high);
      for (std::size_t a = 0; a < 3; ++a)
      {
        p[a] = centre[a] + u[a] / length * middle;
      }
      (field.Label(p) == 1 ? low : high) = middle;
    }
    Point<3> gradient;
    for (std::size_t a = 0; a < 3; ++a)
    {
      Point<3> q = p;
      q[a] += 1e-3;
      gradient[a] = -field.Margin(q, 1);
      q[a] -= 2e-3;
      gradient[a] += field.Margin(q, 1);
    }
    distance += std::abs(low - radius) / rays;
    volume += low * low * low / (radius * radius * radius) / rays;
    angle += std::acos(std::clamp(
               Dot(gradient, u) / (length * std::sqrt(Dot(gradient, gradient))), -1.0, 1.0)) /
      rays * 57.29577951308232;
  }
  EXPECT_LT(distance, 0.075);
  EXPECT_LT(angle, 6.0); // between voxels too; facets of a mesh average it to less than 4
  EXPECT_NEAR(volume, 1.0, 0.01);
}

// A layer of background one voxel thick stays open everywhere, between two labels or within one.
TEST(LabelField, KeepsGapsOpen)
{
  constexpr std::int64_t n = 26;
  constexpr double gap = 12.0; // voxels between 4 and 21
  for (const std::size_t axis : { 0u, 1u, 2u })
  {
    for (const short other : { 1, 2 })
    {
      std::vector<short> scalars;
      for (std::int64_t k = 0; k < n * n * n; ++k)
      {
        const std::array<std::int64_t, 3> voxel{ k % n, k / n % n, k / (n * n) };
        const bool inside =
          std::all_of(voxel.begin(), voxel.end(), [](auto x) { return x >= 4 && x <= 21; });
        const auto height = static_cast<double>(voxel[axis]);
        scalars.push_back(!inside || height == gap ? 0 : height < gap ? short{ 1 } : other);
      }
      const LabelField<3> field(MakeImage<3>(scalars, UnitGrid<3>(n)), 1.0);
      std::mt19937 random(31);
      std::uniform_real_distribution<double> along(4.0, 21.0);
      std::uniform_real_distribution<double> across(-0.3, 0.3);
      for (int trial = 0; trial < 2000; ++trial)
      {
        Point<3> p{ along(random), along(random), along(random) };
        p[axis] = gap + across(random);
        ASSERT_EQ(field.Label(p), 0) << p[0] << ' ' << p[1] << ' ' << p[2];
        // It is no wider than a voxel and a half: not too much is raised.
        p[axis] = gap + (trial % 2 == 0 ? 0.75 : -0.75);
        const bool isInner = *std::min_element(p.begin(), p.end()) > 6.0 &&
          *std::max_element(p.begin(), p.end()) < 19.0;
        if (isInner)
        {
          ASSERT_NE(field.Label(p), 0) << p[0] << ' ' << p[1] << ' ' << p[2];
        }
      }
    }
  }
}

// Where legs of one voxel meet that voxel is not between two others, but nothing is thick: legs are as wide as they are.
TEST(LabelField, KeepsTheWidthOfLegsThatMeet)
{
  constexpr std::int64_t n = 12;
  for (const bool isFour : { true, false })
  {
    std::vector<short> scalars;
    for (std::int64_t k = 0; k < n * n * n; ++k)
    {
      const std::array<std::int64_t, 3> d{ k % n - 5, k / n % n - 5, k / (n * n) - 5 };
      const bool isLeg =
        std::all_of(d.begin(), d.end(), [](auto x) { return x >= 0; }) && d[0] + d[1] + d[2] <= 1;
      const bool isFifth = !isFour && d == std::array<std::int64_t, 3>{ 1, 1, 0 };
      scalars.push_back(isLeg || isFifth ? 1 : 0);
    }
    const LabelImage<3> image = MakeImage<3>(scalars, UnitGrid<3>(n));
    ASSERT_EQ(image.Counts()[1], isFour ? 4 : 5);
    const LabelField<3> field(image, 1.0);
    ForEachVoxel<3>(image,
      [&](const Point<3>& centre, LabelId id)
      {
        const bool isMeetingPoint = centre == Point<3>{ 5.0, 5.0, 5.0 };
        for (std::size_t a = 0; a < 3 && id == 1 && !isMeetingPoint; ++a)
        {
          for (const double step : { -0.25, 0.25 })
          {
            Point<3> p = centre;
            p[a] += step;
            EXPECT_EQ(field.Label(p), 1) << p[0] << ' ' << p[1] << ' ' << p[2];
          }
        }
      });
  }
}
