// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageDomain.txx
 * @brief Implementation of ImageDomain.h, for the sources that instantiate it: construction. The
 *   searches are in ImageDomainSearch.txx.
 *
 * There is one source for each field. With two fields in one source, the compiler inlines less, and
 * a run on labels executes 2 % more instructions.
 */
#ifndef voxplex_ImageDomain_txx
#define voxplex_ImageDomain_txx

#include "Domain/ImageDomain.h"

#include "Base/Stopwatch.h"
#include "Domain/ImageDomainSearch.txx"
#include "Geometry/SymmetricEigen.h"
#include "Image/SurfaceVoxels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace voxplex
{
namespace
{

/** Runs a step of the constructor and adds its time to `seconds`. */
template <typename Function>
auto Timed(double& seconds, Function&& function)
{
  const Stopwatch time;
  auto result = function();
  seconds += time.Seconds();
  return result;
}

/**
 * Voxels per cell along each axis: the edges are about ImageDomain::CoarseCell smallest spacings
 * long.
 */
template <int D>
typename FeatureTransform<D>::Array ChooseStride(const Point<D>& spacing)
{
  const double smallest = *std::min_element(spacing.begin(), spacing.end());
  typename FeatureTransform<D>::Array stride;
  for (std::size_t a = 0; a < D; ++a)
  {
    stride[a] = static_cast<std::uint32_t>(
      std::max(1.0, std::floor(ImageDomain<D>::CoarseCell * smallest / spacing[a] + 0.5)));
  }
  return stride;
}

template <int D>
Point<D> Spacings(const GridGeometry<D>& grid)
{
  Point<D> spacing;
  for (int a = 0; a < D; ++a)
  {
    spacing[static_cast<std::size_t>(a)] = grid.Spacing(a);
  }
  return spacing;
}

/**
 * Clang before 16 instantiates constructors even if their constraints fail. Those are never called.
 */
template <typename FieldType, typename... Arguments>
FieldType Construct(const Arguments&... arguments)
{
  if constexpr (std::constructible_from<FieldType, const Arguments&...>)
  {
    return FieldType(arguments...);
  }
  else
  {
    __builtin_unreachable();
  }
}

} // namespace

template <int D, typename FieldType>
template <typename Function>
typename ImageDomain<D, FieldType>::TimedField ImageDomain<D, FieldType>::MakeField(Function&& make)
{
  double seconds = 0.0;
  FieldType field = Timed(seconds, make);
  return { std::move(field), seconds };
}

template <int D, typename FieldType>
ImageDomain<D, FieldType>::ImageDomain(const LabelImage<D>& image, double sigma, unsigned threads,
  const std::stop_token& stop) requires std::same_as<FieldType, LabelField<D>>
  : ImageDomain(image, MakeField([&] { return Construct<FieldType>(image, sigma, threads, stop); }),
      threads, stop)
{
}

template <int D, typename FieldType>
ImageDomain<D, FieldType>::ImageDomain(const IsosurfaceImage<D>& image, unsigned threads,
  const std::stop_token& stop) requires std::same_as<FieldType, ScalarField<D>>
  : ImageDomain(image.Labels(),
      MakeField([&] { return Construct<FieldType>(image, threads, stop); }), threads, stop)
{
}

template <int D, typename FieldType>
ImageDomain<D, FieldType>::ImageDomain(
  const LabelImage<D>& image, TimedField&& field, unsigned threads, const std::stop_token& stop)
  : Image(image)
  , FieldSeconds(field.Seconds)
  , Field(std::move(field.Field))
  , Sites(Timed(this->FeatureSeconds, [&] { return FindSurfaceVoxels(image, threads, stop); }))
  , Spacing(Spacings(image.Grid()))
  , Features(Timed(this->FeatureSeconds,
      [&]
      {
        return FeatureTransform<D>(
          this->Sites, this->Spacing, ChooseStride<D>(this->Spacing), threads, stop);
      }))
{
  const GridGeometry<D>& grid = image.Grid();
  this->IsOrthogonal = true;
  typename GridGeometry<D>::Matrix gram; // Gram matrix of the unit vectors along the axes
  for (std::size_t r = 0; r < D; ++r)
  {
    for (std::size_t c = 0; c < D; ++c)
    {
      gram[r][c] = 0.0;
      for (std::size_t k = 0; k < D; ++k)
      {
        gram[r][c] += grid.IndexToFrame[k][r] * grid.IndexToFrame[k][c];
      }
      gram[r][c] /= this->Spacing[r] * this->Spacing[c];
      this->IsOrthogonal = this->IsOrthogonal && (r == c || grid.IndexToFrame[r][c] == 0.0);
    }
  }
  if (!this->IsOrthogonal)
  {
    this->SmallestStretch = std::sqrt(std::max(0.0, SmallestEigenvalue<D>(gram) - 1e-12));
  }

  // An interface point lies in a cell with an edge that joins two sites. Along this edge, the point
  // is at most half of the edge away from one of them.
  const double diagonal2 = Dot(this->Spacing, this->Spacing);
  const double smallest = *std::min_element(this->Spacing.begin(), this->Spacing.end());
  this->SiteDistance = std::sqrt(diagonal2 - 0.75 * smallest * smallest);
  this->VoxelDiagonal = std::sqrt(diagonal2);

  this->BoundingBox.Min.fill(std::numeric_limits<double>::max());
  this->BoundingBox.Max.fill(std::numeric_limits<double>::lowest());
  for (unsigned corner = 0; corner < (1u << D); ++corner)
  {
    Point<D> x{};
    for (std::size_t a = 0; a < D; ++a)
    {
      x[a] = (corner >> a) & 1u ? static_cast<double>(this->Field.LatticeDimensions()[a] - 1) : 0.0;
    }
    const Point<D> p = this->Field.ToFrame(x);
    for (std::size_t a = 0; a < D; ++a)
    {
      this->BoundingBox.Min[a] = std::min(this->BoundingBox.Min[a], p[a]);
      this->BoundingBox.Max[a] = std::max(this->BoundingBox.Max[a], p[a]);
    }
  }
  if (image.ReachesBorderInTime(0))
  {
    this->BoundingBox.Min[D - 1] = 0.0;
  }
  if (image.ReachesBorderInTime(1))
  {
    this->BoundingBox.Max[D - 1] =
      static_cast<double>(grid.Dimensions[D - 1] - 1) * grid.IndexToFrame[D - 1][D - 1];
  }
}

} // namespace voxplex

#endif
