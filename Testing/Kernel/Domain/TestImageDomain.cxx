// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Domain/ImageDomain.h"
#include "Parallel/CycleClock.h"
#include "Parallel/ParallelFor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>
#include <stop_token>

using namespace voxplex;

namespace
{

template <int D>
double SmallestDimension(const GridGeometry<D>& grid)
{
  return static_cast<double>(*std::min_element(grid.Dimensions.begin(), grid.Dimensions.end()));
}

/** A point at these shares of a grid's extent, in voxels. */
template <int D>
Point<D> Between(const GridGeometry<D>& grid, double low, double high, std::mt19937& random)
{
  Point<D> p;
  for (std::size_t a = 0; a < D; ++a)
  {
    p[a] = std::uniform_real_distribution<double>(low, high)(random) *
      static_cast<double>(grid.Dimensions[a]);
  }
  return p;
}

/** The centre of a voxel, in voxels. */
template <int D>
Point<D> PointAt(std::size_t voxel, const GridGeometry<D>& grid)
{
  const auto index = IndexAt(voxel, grid.Dimensions);
  Point<D> p;
  std::copy(index.begin(), index.end(), p.begin());
  return p;
}

/** Overlapping balls of labels 1 ... balls; the later wins. */
template <int D>
LabelImage<D> Balls(const GridGeometry<D>& grid, int balls, std::mt19937& random)
{
  std::vector<short> scalars(CountCells(grid.Dimensions), 0);
  for (int b = 1; b <= balls; ++b)
  {
    const Point<D> centre = Between(grid, 0.2, 0.8, random);
    const double radius =
      std::uniform_real_distribution<double>(0.1, 0.35)(random) * SmallestDimension(grid);
    for (std::size_t i = 0; i < scalars.size(); ++i)
    {
      if (Distance(PointAt(i, grid), centre) <= radius)
      {
        scalars[i] = static_cast<short>(b);
      }
    }
  }
  return LabelImage<D>::template FromScalars<short>(scalars, grid);
}

GridGeometry<3> SkewedGrid()
{
  GridGeometry<3> grid = GridGeometry<3>::Orthogonal({ 26, 24, 15 }, { 0.5, 0.7, 1.1 });
  grid.IndexToFrame[0][1] = 0.2;
  grid.IndexToFrame[0][2] = -0.3;
  grid.IndexToFrame[1][2] = 0.4;
  return grid;
}

template <int D>
std::vector<GridGeometry<D>> Grids()
{
  if constexpr (D == 3)
  {
    return { GridGeometry<3>::Orthogonal({ 24, 25, 26 }, { 1.0, 1.0, 1.0 }),
      GridGeometry<3>::Orthogonal({ 36, 33, 12 }, { 0.3, 0.3, 1.0 }), SkewedGrid() };
  }
  else
  {
    GridGeometry<4> skewed = GridGeometry<4>::Orthogonal({ 12, 11, 10, 9 }, { 1.0, 0.7, 1.2, 0.8 });
    skewed.IndexToFrame[0][3] = 0.3;
    return { GridGeometry<4>::Orthogonal({ 12, 11, 13, 9 }, { 0.5, 0.5, 0.5, 1.5 }), skewed };
  }
}

template <int D>
Point<D> RandomPoint(const Box<D>& box, double enlarge, std::mt19937& random)
{
  Point<D> p;
  for (std::size_t a = 0; a < D; ++a)
  {
    const double more = enlarge * (box.Max[a] - box.Min[a]);
    p[a] = std::uniform_real_distribution<double>(box.Min[a] - more, box.Max[a] + more)(random);
  }
  return p;
}

/** Interface points: where Label() changes along random short segments, to 1e-6. */
template <int D, typename Field>
std::vector<Point<D>> SampleInterfaces(
  const ImageDomain<D, Field>& domain, std::size_t count, std::mt19937& random)
{
  std::vector<Point<D>> samples;
  const double step = domain.GetImage().Grid().IndexToFrame[0][0];
  while (samples.size() < count)
  {
    Point<D> a = RandomPoint<D>(domain.Bounds(), 0.0, random);
    Point<D> b = a;
    for (double& x : b)
    {
      x += std::uniform_real_distribution<double>(-step, step)(random);
    }
    b = domain.Bounds().Clamp(b); // beyond a flat end there are no interfaces
    const LabelId label = domain.Label(a);
    if (label == domain.Label(b))
    {
      continue;
    }
    while (Distance(a, b) > 1e-6)
    {
      const Point<D> middle = Interpolate(a, b, 0.5);
      (domain.Label(middle) == label ? a : b) = middle;
    }
    samples.push_back(a);
  }
  return samples;
}

template <int D>
Point<D> NearestSample(const std::vector<Point<D>>& samples, const Point<D>& p)
{
  return *std::min_element(samples.begin(), samples.end(),
    [&](const Point<D>& a, const Point<D>& b) { return Distance2(p, a) < Distance2(p, b); });
}

/** The point of the lattice nearest to p: p itself inside of it. */
template <int D, typename Field>
Point<D> NearestInLattice(const ImageDomain<D, Field>& domain, const Point<D>& p)
{
  const Point<D> x = domain.GetLabelField().ToLattice(p);
  Point<D> last;
  for (std::size_t a = 0; a < D; ++a)
  {
    last[a] = static_cast<double>(domain.GetLabelField().LatticeDimensions()[a] - 1);
  }
  const GridGeometry<D>& grid = domain.GetImage().Grid();
  return Subtract(p, grid.ToFrame(Subtract(x, grid.NearestInBox(x, last))));
}

/** Whether Label() is `label` at a point within r of z, and another at another. */
template <int D, typename Field>
bool IsOnInterface(const ImageDomain<D, Field>& domain, const Point<D>& z, LabelId label, double r)
{
  std::mt19937 random(1);
  bool same = false;
  bool other = false;
  for (int i = 0; i < 400 && !(same && other); ++i)
  {
    Point<D> p = z;
    for (double& x : p)
    {
      x += std::uniform_real_distribution<double>(-r, r)(random);
    }
    (domain.Label(p) == label ? same : other) = true;
  }
  return same && other;
}

template <int D>
double SmallestSpacing(const GridGeometry<D>& grid)
{
  double s = grid.Spacing(0);
  for (int a = 1; a < D; ++a)
  {
    s = std::min(s, grid.Spacing(a));
  }
  return s;
}

template <int D>
double Diagonal(const GridGeometry<D>& grid)
{
  double s = 0.0;
  for (int a = 0; a < D; ++a)
  {
    s += grid.Spacing(a) * grid.Spacing(a);
  }
  return std::sqrt(s);
}

template <int D, typename Field>
void CheckDistanceBound(
  const ImageDomain<D, Field>& domain, const GridGeometry<D>& grid, std::mt19937& random)
{
  const std::vector<Point<D>> samples = SampleInterfaces(domain, 6000, random);
  const double diagonal = Diagonal(grid);
  double looseness = 0.0;
  double loosenessOutside = 0.0;
  int inside = 0;
  constexpr int queries = 600;
  for (int q = 0; q < queries; ++q)
  {
    const Point<D> p = RandomPoint<D>(domain.Bounds(), q % 3 == 0 ? 2.0 : 0.0, random);
    const double bound = domain.DistanceBound(p);
    const double sampled = Distance(p, NearestSample<D>(samples, p)); // at least the true distance
    ASSERT_GE(bound, 0.0);
    ASSERT_LE(bound, sampled + 1e-5);
    // Samples miss what is small; what is found may be that.
    double nearest = sampled;
    const LabelId label = domain.Label(p);
    Point<D> z;
    if (domain.ClosestSurfacePoint(p, label, z))
    {
      ASSERT_GE(Distance(p, z), bound - 1e-9);
      const bool isFound = IsOnInterface(domain, z, label, 0.03 * SmallestSpacing(grid));
      nearest = isFound ? std::min(nearest, Distance(p, z)) : nearest;
    }
    // In voxels; outside of the lattice the nearest point of it stands for p.
    const double outside = Distance(p, NearestInLattice(domain, p));
    const double loose = (nearest - bound) / (outside + diagonal);
    inside += outside == 0.0 ? 1 : 0;
    (outside == 0.0 ? looseness : loosenessOutside) += loose;
  }
  EXPECT_LT(looseness, 1.5 * inside);
  EXPECT_LT(loosenessOutside, 0.8 * (queries - inside));
}

template <int D, typename Field>
void CheckClosestSurfacePoint(
  const ImageDomain<D, Field>& domain, const GridGeometry<D>& grid, std::mt19937& random)
{
  const std::vector<Point<D>> samples = SampleInterfaces(domain, 20000, random);
  const double diagonal = Diagonal(grid);
  double excess = 0.0;
  double off = 0.0;
  constexpr int queries = 300;
  for (int k = 0; k < queries; ++k)
  {
    const Point<D> p = RandomPoint<D>(domain.Bounds(), k % 3 == 0 ? 0.5 : 0.0, random);
    const LabelId label = domain.Label(p);
    Point<D> z;
    ASSERT_TRUE(domain.ClosestSurfacePoint(p, label, z));
    // At the tip of something thin random points hardly ever meet it: there the margin tells, by the tolerance
    // of root finding.
    ASSERT_TRUE(IsOnInterface(domain, z, label, 0.03 * SmallestSpacing(grid)) ||
      std::abs(domain.GetLabelField().Margin(z, label)) < Field::RootTolerance);
    // What is found is near the voxel nearest to c, which is p itself inside of the lattice. If q is the nearest
    // interface point of p, that voxel is at most a voxel's size farther from c than q is.
    const Point<D> q = NearestSample<D>(samples, p);
    const Point<D> c = NearestInLattice(domain, p);
    const double more = Distance(p, z) - (Distance(p, c) + Distance(c, q));
    ASSERT_LT(more, 1.75 * diagonal); // a rare point; the mean below is what counts
    excess += std::max(0.0, more) / queries;
    // The quick estimate: next to an interface too, by the samples' own spacing.
    Point<D> quick;
    double error;
    ASSERT_TRUE(domain.NearSurfacePoint(p, label, quick, error));
    typename Domain<D>::Search search;
    Point<D> again;
    ASSERT_TRUE(domain.StartSearch(p, label, again, error, search));
    ASSERT_EQ(again, quick);
    ASSERT_TRUE(search.IsStarted);
    ASSERT_TRUE(domain.FinishSearch(search, p, label, again));
    ASSERT_EQ(again, z);
    ASSERT_LE(error, 0.25 * diagonal);
    off += (Distance(quick, NearestSample<D>(samples, quick)) -
             Distance(z, NearestSample<D>(samples, z))) /
      (diagonal * queries);
  }
  EXPECT_LT(excess, 0.12 * diagonal);
  EXPECT_LT(off, 0.05);
}

template <int D, typename Field>
void CheckFirstCrossing(
  const ImageDomain<D, Field>& domain, const GridGeometry<D>& grid, std::mt19937& random)
{
  int found = 0;
  for (int q = 0; q < 300; ++q)
  {
    const double enlarge = q % 3 == 0 ? 3.0 : 0.0;
    const Point<D> a = RandomPoint<D>(domain.Bounds(), enlarge, random);
    const Point<D> b = RandomPoint<D>(domain.Bounds(), enlarge, random);
    const LabelId label = domain.Label(a);
    Point<D> z;
    const bool crosses = domain.FirstCrossing(a, label, b, z);
    // Samples the segment finely. Parts thinner than half a voxel may be missed.
    const double length = Distance(a, b);
    const int steps = static_cast<int>(length / (0.02 * SmallestSpacing(grid))) + 1;
    double first = std::numeric_limits<double>::infinity();
    double run = 0.0; // at a stretch, on other labels
    double longest = 0.0;
    for (int i = 0; i <= steps; ++i)
    {
      const double t = static_cast<double>(i) / steps;
      if (domain.Label(Interpolate(a, b, t)) != label)
      {
        first = std::min(first, t * length);
        run += length / steps;
        longest = std::max(longest, run);
      }
      else
      {
        run = 0.0;
      }
    }
    if (!crosses)
    {
      ASSERT_LE(longest, 0.5 * Diagonal(grid));
      continue;
    }
    ++found;
    ASSERT_TRUE(IsOnInterface(domain, z, label, 0.03 * SmallestSpacing(grid)));
    ASSERT_NEAR(Distance(a, z) + Distance(z, b), length, 1e-6 * length + 1e-9);
    ASSERT_GE(Distance(a, z), first - 0.05 * SmallestSpacing(grid));
  }
  EXPECT_GT(found, 20);
}

/** A sum of a few blobs, positive and negative, and noise: an isosurface of many shapes. */
template <int D>
std::vector<float> Blobs(const GridGeometry<D>& grid, std::mt19937& random)
{
  struct Blob
  {
    Point<D> Centre;
    double Width;
    double Height;
  };
  std::vector<Blob> blobs(6);
  for (std::size_t b = 0; b < blobs.size(); ++b)
  {
    blobs[b].Centre = Between(grid, 0.1, 0.9, random);
    blobs[b].Width = std::uniform_real_distribution<>(0.1, 0.25)(random) * SmallestDimension(grid);
    blobs[b].Height = b % 3 == 2 ? -1.0 : 1.0;
  }
  std::vector<float> values(CountCells(grid.Dimensions));
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const Point<D> p = PointAt(i, grid);
    double value = std::uniform_real_distribution<>(-0.02, 0.02)(random);
    for (const Blob& blob : blobs)
    {
      value += blob.Height * std::exp(-0.5 * Distance2(p, blob.Centre) / (blob.Width * blob.Width));
    }
    // Not cut in time: queries beyond a flat end are not what is tested here.
    const bool isEnd =
      D == 4 && (p[D - 1] == 0.0 || p[D - 1] == static_cast<double>(grid.Dimensions[D - 1] - 1));
    values[i] = isEnd ? -1.0f : static_cast<float>(value);
  }
  return values;
}

template <int D, typename Function>
void OnIsosurfaces(std::mt19937& random, Function&& check)
{
  for (const auto& grid : Grids<D>())
  {
    const std::vector<float> values = Blobs<D>(grid, random);
    const auto image = IsosurfaceImage<D>::template FromScalars<float>(values, grid, { 0.3 });
    check(ImageDomain<D, ScalarField<D>>(image), grid);
  }
}

template <int D, typename Function>
void OnLabels(std::mt19937& random, Function&& check)
{
  for (const auto& grid : Grids<D>())
  {
    const LabelImage<D> image = Balls<D>(grid, 4, random);
    check(ImageDomain<D>(image, 1.0), grid);
  }
}

/** Calls check(domain, grid) for domains of labels and of isosurfaces. */
template <typename Function>
void OnEveryDomain(std::mt19937& random, Function&& check)
{
  OnLabels<3>(random, check);
  OnLabels<4>(random, check);
  OnIsosurfaces<3>(random, check);
  OnIsosurfaces<4>(random, check);
}

} // namespace

TEST(ImageDomain, DistanceBoundHolds)
{
  std::mt19937 random(1);
  OnEveryDomain(random,
    [&]<int D, typename Field>(const ImageDomain<D, Field>& domain, const GridGeometry<D>& grid)
    { CheckDistanceBound(domain, grid, random); });
}

TEST(ImageDomain, ClosestSurfacePointIsOnAnInterfaceAndNear)
{
  std::mt19937 random(5);
  OnEveryDomain(random,
    [&]<int D, typename Field>(const ImageDomain<D, Field>& domain, const GridGeometry<D>& grid)
    { CheckClosestSurfacePoint(domain, grid, random); });
}

TEST(ImageDomain, FirstCrossingIsFirst)
{
  std::mt19937 random(3);
  OnEveryDomain(random,
    [&]<int D, typename Field>(const ImageDomain<D, Field>& domain, const GridGeometry<D>& grid)
    { CheckFirstCrossing(domain, grid, random); });
}

TEST(ImageDomain, SegmentsThatMissTheImage)
{
  std::mt19937 random(4);
  const LabelImage<3> image = Balls<3>(Grids<3>()[0], 2, random);
  const ImageDomain<3> domain(image, 1.0);
  const Box<3> box = domain.Bounds();
  Point<3> z;
  EXPECT_FALSE(
    domain.FirstCrossing({ box.Min[0] - 1.0, 0.0, 0.0 }, 0, { box.Min[0] - 1.0, 30.0, 30.0 }, z));
  EXPECT_FALSE(domain.FirstCrossing(box.Min, 0, box.Min, z));
  EXPECT_FALSE(domain.FirstCrossing(box.Max, 0, { 1e6, 1e6, 1e6 }, z));
}

TEST(ImageDomain, SitesAreTheVoxelsBesideAnotherLabel)
{
  std::mt19937 random(5);
  const LabelImage<3> image = Balls<3>(Grids<3>()[1], 3, random);
  const ImageDomain<3> domain(image, 1.0, 3);
  const auto& n = domain.GetLabelField().LatticeDimensions();
  ForEachIndex<3>({ 0, 0, 0 }, { n[0] - 1, n[1] - 1, n[2] - 1 },
    [&](const GridGeometry<3>::Index& v)
    {
      bool site = false;
      for (std::size_t a = 0; a < 3; ++a)
      {
        for (const int step : { -1, 1 })
        {
          GridGeometry<3>::Index beside = v;
          beside[a] += step;
          site = site || image.AtLattice(beside) != image.AtLattice(v);
        }
      }
      ASSERT_EQ(domain.GetSites().Test(v), site) << v[0] << " " << v[1] << " " << v[2];
    });
}

TEST(ImageDomain, BoundsAndValues)
{
  std::vector<short> scalars(8 * 8 * 8, 0);
  scalars[3 + 8 * (4 + 8 * 5)] = 77;
  const auto grid = GridGeometry<3>::Orthogonal({ 8, 8, 8 }, { 0.5, 1.0, 2.0 });
  const LabelImage<3> image = LabelImage<3>::FromScalars<short>(scalars, grid);
  const CycleClock clock;
  const ImageDomain<3> domain(image, 1.0);
  EXPECT_GT(domain.LabelFieldSeconds(), 0.0);
  EXPECT_GT(domain.DistanceSeconds(), 0.0);
  EXPECT_LE(domain.LabelFieldSeconds() + domain.DistanceSeconds(), clock.Seconds());
  EXPECT_EQ(domain.Bounds().Min, (Point<3>{ 1.0, 3.0, 8.0 }));
  EXPECT_EQ(domain.Bounds().Max, (Point<3>{ 2.0, 5.0, 12.0 }));
  EXPECT_EQ(domain.LabelValue(1), 77);
  EXPECT_EQ(domain.LabelValue(0), 0);
  EXPECT_GT(domain.MemoryBytes(), // the features besides
    domain.GetLabelField().MemoryBytes() + domain.GetSites().MemoryBytes());
  // A single voxel is still there, and its surface is found from both sides.
  EXPECT_EQ(domain.Label({ 1.5, 4.0, 10.0 }), 1);
  Point<3> z;
  EXPECT_TRUE(domain.ClosestSurfacePoint({ 1.5, 4.0, 10.0 }, 1, z));
  EXPECT_TRUE(domain.ClosestSurfacePoint({ -20.0, 50.0, 10.0 }, 0, z));
}

TEST(ImageDomain, StoppedConstructorsThrowCancelled)
{
  std::mt19937 random(6);
  const LabelImage<3> image = Balls<3>(Grids<3>()[0], 3, random);
  const ImageDomain<3> domain(image, 1.0); // never stopped by default
  const Point<3> spacing{ 1.0, 1.0, 1.0 };
  std::stop_source source;
  const std::stop_token stop = source.get_token();
  EXPECT_NO_THROW(ImageDomain<3>(image, 1.0, 2, stop)); // not yet
  source.request_stop();
  for (const unsigned threads : { 1u, 4u })
  {
    EXPECT_THROW(LabelField<3>(image, 1.0, threads, stop), Cancelled);
    EXPECT_THROW(
      FeatureTransform<3>(domain.GetSites(), spacing, { 4, 4, 4 }, threads, stop), Cancelled);
    EXPECT_THROW(ImageDomain<3>(image, 1.0, threads, stop), Cancelled);
    const auto grid = Grids<3>()[0];
    const std::vector<float> values = Blobs<3>(grid, random);
    EXPECT_THROW(
      IsosurfaceImage<3>::FromScalars<float>(values, grid, { 0.3 }, threads, stop), Cancelled);
    const auto isosurface = IsosurfaceImage<3>::FromScalars<float>(values, grid, { 0.3 });
    EXPECT_THROW(ScalarField<3>(isosurface, threads, stop), Cancelled);
    EXPECT_THROW((ImageDomain<3, ScalarField<3>>(isosurface, threads, stop)), Cancelled);
  }
}

TEST(ImageDomain, StoppedLoopsStartNoMoreChunks)
{
  for (const unsigned threads : { 1u, 4u })
  {
    std::stop_source source;
    std::atomic<std::size_t> chunks = 0;
    const auto stopAtOnce = [&](std::size_t, std::size_t)
    {
      ++chunks;
      source.request_stop();
    };
    EXPECT_THROW(ParallelFor(0, 1000, 1, threads, stopAtOnce, source.get_token()), Cancelled);
    EXPECT_LE(chunks, threads); // those that were running
  }
}
