// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizing/GradedSize.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace voxplex
{

namespace
{

/**
 * Sizes of the labels of an image, by dense id; empty if the function depends on more than the
 * label.
 */
template <int D>
std::vector<double> SizesOfLabels(const SizeFunction<D>& size, const LabelImage<D>& image)
{
  std::vector<double> sizes;
  if (size.DependsOnLabelAlone())
  {
    for (const std::int64_t value : image.Values())
    {
      sizes.push_back(value != 0 ? size.Evaluate(Point<D>{}, value) : 0.0);
    }
  }
  return sizes;
}

template <int D>
Point<D> ToPoint(const typename GridGeometry<D>::Index& index)
{
  Point<D> p;
  for (std::size_t a = 0; a < D; ++a)
  {
    p[a] = static_cast<double>(index[a]);
  }
  return p;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
std::shared_ptr<const SizeFunction<D>> GradedSize<D>::Limit(
  std::shared_ptr<const SizeFunction<D>> size, const LabelImage<D>& image, double gradation,
  unsigned threads, const std::stop_token& stop)
{
  if (!size || !(gradation > 0.0))
  {
    return size;
  }
  std::atomic<bool> unbounded{ false }; // at some voxel
  const std::vector<double> ofLabel = SizesOfLabels<D>(*size, image);
  GradedGrid<D> grid(
    image, gradation,
    [&](const typename GridGeometry<D>::Index& voxel, LabelId id, auto&& add)
    {
      const Point<D> index = ToPoint<D>(voxel);
      const double s =
        ofLabel.empty() ? size->Evaluate(image.CentreOf(voxel), image.Values()[id]) : ofLabel[id];
      add(index, s);
      if (!(s > 0.0 && std::isfinite(s)) && !unbounded.load(std::memory_order_relaxed))
      {
        unbounded.store(true, std::memory_order_relaxed);
      }
    },
    threads, stop);
  const auto [smallest, largest] = grid.Range();
  if (!std::isfinite(smallest) || (smallest == largest && !unbounded && !ofLabel.empty()))
  {
    return size;
  }
  return std::shared_ptr<const SizeFunction<D>>(new GradedSize(std::move(size), std::move(grid)));
}

//------------------------------------------------------------------------------------------------
template <int D>
GradedSize<D>::GradedSize(std::shared_ptr<const SizeFunction<D>> size, GradedGrid<D> grid)
  : Size(std::move(size))
  , Grid(std::move(grid))
{
}

//------------------------------------------------------------------------------------------------
template <int D>
double GradedSize<D>::Evaluate(const Point<D>& p, std::int64_t label) const
{
  const double own = this->Size->Evaluate(p, label);
  const double graded = this->Grid.At(p);
  return own > 0.0 ? std::min(own, graded) : graded;
}

template class GradedSize<3>;
template class GradedSize<4>;

} // namespace voxplex
