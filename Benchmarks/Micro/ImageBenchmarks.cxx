// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Measures, on a label image of balls, the time of the preparation and of the queries of the rules.
#include "Domain/ImageDomain.h"
#include "Domain/LabelField.h"
#include "Image/FeatureTransform.h"
#include "RandomPoints.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>

namespace
{

using namespace voxplex;
using namespace voxplex::benchmarks;

template <int D>
constexpr std::int64_t Side = D == 3 ? 160 : 40;
constexpr double Sigma = 1.0;

/**
 * Balls with random centres and radii, each with its own label. Later balls cover earlier ones, so
 * balls touch, nest and meet in junctions. Voxels are twice as long along the last axis.
 */
template <int D>
LabelImage<D> MakeBalls()
{
  constexpr std::uint8_t numberOfBalls = 20;
  typename GridGeometry<D>::Index dimensions;
  dimensions.fill(Side<D>);
  dimensions.back() /= 2;
  Point<D> spacing;
  spacing.fill(1.0);
  spacing.back() = 2.0;
  const auto grid = GridGeometry<D>::Orthogonal(dimensions, spacing);

  const std::vector<Point<D>> centres = RandomPoints<D>(numberOfBalls, Cube<D>(Side<D>));
  std::size_t voxels = 1;
  for (const std::int64_t n : dimensions)
  {
    voxels *= static_cast<std::size_t>(n);
  }
  std::vector<std::uint8_t> labels(voxels, 0);
  for (std::size_t voxel = 0; voxel < voxels; ++voxel)
  {
    Point<D> index;
    std::size_t rest = voxel;
    for (std::size_t axis = 0; axis < index.size(); ++axis)
    {
      const auto n = static_cast<std::size_t>(dimensions[axis]);
      index[axis] = static_cast<double>(rest % n);
      rest /= n;
    }
    const Point<D> p = grid.ToFrame(index);
    for (std::uint8_t ball = 0; ball < numberOfBalls; ++ball)
    {
      const double radius = (0.1 + 0.01 * ball) * Side<D>;
      if (Distance2(p, centres[ball]) < radius * radius)
      {
        labels[voxel] = static_cast<std::uint8_t>(ball + 1);
      }
    }
  }
  return LabelImage<D>::template FromScalars<std::uint8_t>(labels, grid);
}

template <int D>
const LabelImage<D>& Balls()
{
  static const LabelImage<D> image = MakeBalls<D>();
  return image;
}

template <int D>
const ImageDomain<D>& BallsDomain()
{
  static const ImageDomain<D> domain(Balls<D>(), Sigma);
  return domain;
}

template <int D>
std::int64_t NumberOfVoxels()
{
  std::int64_t voxels = 1;
  for (const std::int64_t n : Balls<D>().CropDimensions())
  {
    voxels *= n;
  }
  return voxels;
}

//--- Preparation; items are voxels of the foreground's bounding box
//--------------------------------

template <int D>
void BuildLabelField(benchmark::State& state)
{
  const LabelImage<D>& image = Balls<D>();
  for (auto _ : state)
  {
    const LabelField<D> field(image, Sigma);
    benchmark::DoNotOptimize(field.MemoryBytes());
  }
  state.SetItemsProcessed(state.iterations() * NumberOfVoxels<D>());
}

/** The exact Euclidean feature transform; the argument is the cell's edge in voxels. */
template <int D>
void BuildFeatureTransform(benchmark::State& state)
{
  const BitMask<D>& sites = BallsDomain<D>().GetSites();
  Point<D> spacing;
  for (int axis = 0; axis < D; ++axis)
  {
    spacing[static_cast<std::size_t>(axis)] = Balls<D>().Grid().Spacing(axis);
  }
  typename FeatureTransform<D>::Array stride;
  stride.fill(static_cast<std::uint32_t>(state.range(0)));
  for (auto _ : state)
  {
    const FeatureTransform<D> transform(sites, spacing, stride);
    benchmark::DoNotOptimize(transform.NumberOfCells());
  }
  state.SetItemsProcessed(state.iterations() * NumberOfVoxels<D>());
}

//--- Queries
//----------------------------------------------------------------------------------------

enum class Where
{
  Anywhere,   ///< uniformly in the bounding box
  AtInterface ///< within the smallest voxel spacing of an interface
};

template <int D>
std::vector<Point<D>> QueryPoints(Where where)
{
  constexpr std::size_t wanted = 4096;
  const ImageDomain<D>& domain = BallsDomain<D>();
  std::vector<Point<D>> points = RandomPoints<D>(wanted, domain.Bounds());
  if (where == Where::AtInterface)
  {
    Box<D> step;
    step.Min.fill(-0.5);
    step.Max.fill(0.5);
    const std::vector<Point<D>> steps = RandomPoints<D>(wanted, step, 2);
    for (std::size_t i = 0; i < wanted; ++i)
    {
      Point<D> z = points[i];
      domain.ClosestSurfacePoint(points[i], domain.Label(points[i]), z);
      for (std::size_t axis = 0; axis < z.size(); ++axis)
      {
        points[i][axis] = z[axis] + steps[i][axis];
      }
    }
  }
  return points;
}

/** Times `query(domain, p, Label(p))` over all points in turn. */
template <int D, Where where, typename Query>
void RunQuery(benchmark::State& state, Query query)
{
  const ImageDomain<D>& domain = BallsDomain<D>();
  const std::vector<Point<D>> points = QueryPoints<D>(where);
  std::vector<LabelId> labels;
  for (const Point<D>& p : points)
  {
    labels.push_back(domain.Label(p));
  }
  std::size_t next = 0;
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(query(domain, points[next], labels[next]));
    next = next + 1 == points.size() ? 0 : next + 1;
  }
}

template <int D, Where where>
void Label(benchmark::State& state)
{
  RunQuery<D, where>(state,
    [](const ImageDomain<D>& domain, const Point<D>& p, LabelId) { return domain.Label(p); });
}

template <int D, Where where>
void DistanceBound(benchmark::State& state)
{
  RunQuery<D, where>(state,
    [](const ImageDomain<D>& domain, const Point<D>& p, LabelId)
    { return domain.DistanceBound(p); });
}

template <int D, Where where>
void ClosestSurfacePoint(benchmark::State& state)
{
  RunQuery<D, where>(state,
    [](const ImageDomain<D>& domain, const Point<D>& p, LabelId label)
    {
      Point<D> z{};
      domain.ClosestSurfacePoint(p, label, z);
      return z;
    });
}

BENCHMARK(BuildLabelField<3>)->Unit(benchmark::kMillisecond);
BENCHMARK(BuildLabelField<4>)->Unit(benchmark::kMillisecond);
BENCHMARK(BuildFeatureTransform<3>)->Arg(1)->Arg(4)->Unit(benchmark::kMillisecond);
BENCHMARK(BuildFeatureTransform<4>)->Arg(1)->Arg(4)->Unit(benchmark::kMillisecond);
BENCHMARK(Label<3, Where::Anywhere>);
BENCHMARK(Label<3, Where::AtInterface>);
BENCHMARK(Label<4, Where::Anywhere>);
BENCHMARK(Label<4, Where::AtInterface>);
BENCHMARK(DistanceBound<3, Where::Anywhere>);
BENCHMARK(DistanceBound<3, Where::AtInterface>);
BENCHMARK(DistanceBound<4, Where::Anywhere>);
BENCHMARK(DistanceBound<4, Where::AtInterface>);
BENCHMARK(ClosestSurfacePoint<3, Where::Anywhere>);
BENCHMARK(ClosestSurfacePoint<3, Where::AtInterface>);
BENCHMARK(ClosestSurfacePoint<4, Where::Anywhere>);
BENCHMARK(ClosestSurfacePoint<4, Where::AtInterface>);

} // namespace
