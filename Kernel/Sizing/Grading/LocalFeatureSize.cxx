// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizing/Grading/LocalFeatureSize.h"

#include "Image/FeatureTransform.h"
#include "Parallel/ParallelFor.h"
#include "Sizing/Grading/InterfaceSamples.h"
#include "Sizing/Grading/MedialAxis.h"
#include "Sizing/Grading/PointBounds.h"
#include "Sizing/Grading/SampleCurvature.h"

#include <cstdint>
#include <cstdlib>
#include <utility>

namespace voxplex
{

namespace
{

constexpr std::size_t PointsAtOnce = 4096;

/** Voxels of the grid of poles, one bit each, along an edge of a cell of the feature transform. */
template <int D>
constexpr std::uint32_t Stride = D == 3 ? 4 : 2;

/**
 * Largest growth of Delta over a unit of length. If Delta grows faster, the ball and removal rules
 * undo each other's work. With a slope of 1, refinement of the knee atlas creates 1.5 times as many
 * elements, and the same number stays.
 */
constexpr double LargestSlope = 0.3;

/**
 * Upper bound of Delta^2 / R over the allowed distance, where R is the radius of the bend. A
 * triangle with the circumradius Delta is Delta^2 / (2 R) away. Some triangles are larger, and the
 * stairs of voxels add to the distance. With a factor of 1.6 the mesh is usually too far away in
 * places. The check of the interfaces then adds more elements than the larger factor saves.
 */
constexpr double BendFactor = 1.2;

/**
 * Root mean square roughness of interfaces, in largest voxel spacings. With 0, the stairs of voxels
 * count as bends where Delta is small: the AAL atlas at ratio 2 gets 8 % more elements. The spacing
 * of frames does not count: stairs between frames are as high as an interface moves meanwhile.
 */
constexpr double Roughness = 0.15;

/**
 * Largest number of repetitions: the bend is measured at the scale of Delta, and a strong bend
 * lowers Delta.
 */
constexpr int MostBends = 4;

/**
 * @brief The distance to the nearest of a set of points. It is nearly always exact to an eighth of
 * a cell's diagonal, in 4D to a quarter. Otherwise it is too large, by about a diagonal at most.
 */
template <int D>
class NearestPole
{
public:
  /** Poles outside of the bounds are ignored. */
  NearestPole(const std::vector<Point<D>>& poles, const Box<D>& bounds, double cell,
    unsigned threads, const std::stop_token& stop)
    : Origin(bounds.Min)
    , Voxel(cell / Stride<D>)
    , Features(this->Enter(poles, bounds), Everywhere(this->Voxel), Strides(), threads, stop)
  {
  }

  /** The distance from p to the nearest pole, or `largest` if that is smaller. */
  double Distance(const Point<D>& p, double largest) const
  {
    std::array<std::size_t, static_cast<std::size_t>(D)> low;
    for (std::size_t a = 0; a < D; ++a)
    {
      const double x = this->Coordinate(p, a) - 0.5 * Stride<D>;
      low[a] = this->Features.CellOf(a, x);
    }
    double nearest2 = largest * largest;
    const auto& n = this->Features.CellDimensions();
    for (unsigned corner = 0; corner < (1u << D); ++corner)
    {
      std::size_t cell = 0;
      for (std::size_t a = D; a-- > 0;)
      {
        cell = cell * n[a] + std::min<std::size_t>(low[a] + ((corner >> a) & 1u), n[a] - 1);
      }
      const std::uint32_t site = this->Features.Site(cell);
      if (site != FeatureTransform<D>::NoSite)
      {
        const auto index = this->Features.IndexOf(site);
        double d2 = 0.0;
        for (std::size_t a = 0; a < D; ++a)
        {
          const double d = (this->Coordinate(p, a) - static_cast<double>(index[a])) * this->Voxel;
          d2 += d * d;
        }
        nearest2 = std::min(nearest2, d2);
      }
    }
    return std::sqrt(nearest2);
  }

private:
  static Point<D> Everywhere(double x)
  {
    Point<D> all;
    all.fill(x);
    return all;
  }

  static typename FeatureTransform<D>::Array Strides()
  {
    typename FeatureTransform<D>::Array strides;
    strides.fill(Stride<D>);
    return strides;
  }

  /** A continuous index in the grid of poles. */
  double Coordinate(const Point<D>& p, std::size_t axis) const
  {
    return (p[axis] - this->Origin[axis]) / this->Voxel - 0.5;
  }

  BitMask<D> Enter(const std::vector<Point<D>>& poles, const Box<D>& bounds) const
  {
    typename BitMask<D>::Index dimensions;
    for (std::size_t a = 0; a < D; ++a)
    {
      dimensions[a] = static_cast<std::int64_t>((bounds.Max[a] - bounds.Min[a]) / this->Voxel) + 1;
    }
    BitMask<D> mask(dimensions);
    for (const Point<D>& pole : poles)
    {
      if (bounds.Contains(pole))
      {
        typename BitMask<D>::Index index;
        for (std::size_t a = 0; a < D; ++a)
        {
          index[a] = std::llround(this->Coordinate(pole, a));
          index[a] = std::clamp<std::int64_t>(index[a], 0, dimensions[a] - 1);
        }
        mask.Set(index);
      }
    }
    return mask;
  }

  const Point<D> Origin;
  const double Voxel;
  FeatureTransform<D> Features;
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
LocalFeatureSize<D>::LocalFeatureSize(const LabelImage<D>& image, const Domain<D>& domain,
  const GradingParameters& parameters, unsigned threads, const std::stop_token& stop)
  : LargestDelta(parameters.Finest)
  , EquivalentDelta(parameters.Finest)
{
  LabelChanges<D> changes =
    SampleLabelChanges<D>(image, domain, parameters.SampleSpacing, threads, stop);
  this->Points = std::move(changes.Points);
  Box<D> bounds = this->Points.empty() ? domain.Bounds() : BoundsOf<D>(this->Points);
  const double margin = std::min(parameters.Lambda, Distance(bounds.Min, bounds.Max));
  MedialBalls balls;
  balls.LargestRadius = margin;
  balls.Salience = parameters.Salience;
  const std::vector<Point<D>> poles = FindPoles<D>(this->Points, balls, threads, stop);
  this->Poles = poles.size();
  this->Graded = std::make_unique<GradedDelta<D>>(bounds, CellEdge<D>(bounds, parameters.Finest));

  this->SizeOfPoint.assign(this->Points.size(), parameters.Lambda);
  if (!poles.empty())
  {
    constexpr double WidestMargin = 16.0;
    for (std::size_t a = 0; a < D; ++a)
    {
      bounds.Min[a] -= std::min(margin, WidestMargin * parameters.Finest);
      bounds.Max[a] += std::min(margin, WidestMargin * parameters.Finest);
    }
    const NearestPole<D> nearest(
      poles, bounds, CellEdge<D>(bounds, parameters.Finest), threads, stop);
    ParallelFor(
      0, this->Points.size(), PointsAtOnce, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t k = begin; k < end; ++k)
        {
          this->SizeOfPoint[k] = nearest.Distance(this->Points[k], parameters.Lambda);
        }
      },
      stop);
  }

  double density = 0.0; // sum of 1 / Delta^(D - 1)
  const GridGeometry<D>& grid = image.Grid();
  const double volume = grid.VoxelVolume();
  const double spacing =
    std::max(parameters.SampleSpacing, D == 3 ? std::cbrt(volume) : std::pow(volume, 1.0 / D));
  const double roughness =
    Roughness * std::max({ grid.Spacing(0), grid.Spacing(1), grid.Spacing(2) });
  const std::vector<double> deltas =
    this->DeltaOfPoints(changes.Labels, spacing, roughness, parameters, threads, stop);
  for (std::size_t k = 0; k < this->Points.size(); ++k)
  {
    this->Graded->Lower(this->Points[k], deltas[k]);
  }
  if (this->Points.empty())
  {
    this->Graded->Lower(bounds.Min, parameters.Finest);
  }
  this->Graded->Grade(std::min(LargestSlope, parameters.Ratio), threads, stop);
  for (const Point<D>& p : this->Points)
  {
    const double delta = this->Graded->At(p);
    this->LargestDelta = std::max(this->LargestDelta, delta);
    density += 1.0 / (D == 3 ? delta * delta : delta * delta * delta);
  }
  this->Graded->Cap(this->LargestDelta);
  if (!this->Points.empty())
  {
    const double mean = static_cast<double>(this->Points.size()) / density;
    this->EquivalentDelta = D == 3 ? std::sqrt(mean) : std::cbrt(mean);
  }
}

//------------------------------------------------------------------------------------------------
// Within the local feature size of a point there is only one sheet, so a deviation from a plane is
// a bend.
template <int D>
std::vector<double> LocalFeatureSize<D>::DeltaOfPoints(
  const std::vector<std::array<LabelId, 2>>& labels, double spacing, double roughness,
  const GradingParameters& parameters, unsigned threads, const std::stop_token& stop) const
{
  std::vector<double> deltas(this->Points.size(), parameters.Finest);
  if (this->Points.empty())
  {
    return deltas;
  }
  const SampleCurvature<D> curvature(this->Points, labels, spacing);
  ParallelFor(
    0, this->Points.size(), PointsAtOnce, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t k = begin; k < end; ++k)
      {
        const double size = this->SizeOfPoint[k];
        // In 4D there are few points within a small size. Then the bend may be that of a ball.
        const double unknown = D == 3 ? 0.0 : 1.0 / size;
        double delta = std::min(parameters.Ratio * size, parameters.Coarsest);
        for (int i = 0; i < MostBends && delta > parameters.Finest; ++i)
        {
          const double bend =
            curvature.At(this->Points[k], labels[k], std::min(size, delta), roughness, unknown);
          if (bend * delta * delta <= BendFactor * parameters.Tolerance)
          {
            break;
          }
          delta = std::sqrt(BendFactor * parameters.Tolerance / bend);
        }
        deltas[k] = std::max(parameters.Finest, delta);
      }
    },
    stop);
  return deltas;
}

template class LocalFeatureSize<3>;
template class LocalFeatureSize<4>;

} // namespace voxplex
