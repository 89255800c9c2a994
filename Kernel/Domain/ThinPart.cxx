// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Domain/ThinPart.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <tuple>

namespace voxplex
{

namespace
{

/**
 * A label is thin along an axis if its width there is at most this factor times its smallest width.
 */
constexpr double WidthFactor = 1.6;

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
ThinPart<D>::ThinPart(const LabelImage<D>& image, const Domain<D>& surfaces, const Index& voxel)
  : Middle(voxel)
  , Least(std::numeric_limits<double>::infinity())
  , Margin(std::numeric_limits<double>::infinity())
  , Total(0.0)
{
  const LabelId own = image.At(voxel);
  const Point<D> centre = image.CentreOf(voxel);
  std::array<std::array<std::optional<Point<D>>, 2>, D> ends;
  Point<D> width;
  for (std::size_t a = 0; a < D; ++a)
  {
    const double spacing = image.Grid().Spacing(static_cast<int>(a));
    width[a] = 0.0;
    for (std::size_t side = 0; side < 2; ++side)
    {
      Index last = voxel;
      Index next = voxel;
      std::int64_t steps = 0;
      do
      {
        last = next;
        next[a] += side == 0 ? -1 : 1;
        ++steps;
      } while (steps < MostSteps && image.At(next) == own);
      double distance = static_cast<double>(steps) * spacing;
      Point<D> z;
      if (image.At(next) != own &&
        surfaces.FirstCrossing(image.CentreOf(last), own, image.CentreOf(next), z))
      {
        ends[a][side] = z;
        distance = Distance(centre, z);
      }
      this->Margin = std::min(this->Margin, distance);
      width[a] += distance;
    }
    this->Least = std::min(this->Least, width[a]);
    this->Total += width[a];
  }
  for (std::size_t a = 0; a < D; ++a)
  {
    for (std::size_t side = 0; side < 2; ++side)
    {
      if (ends[a][side] && width[a] <= WidthFactor * this->Least)
      {
        this->Crossings.push_back(*ends[a][side]);
      }
    }
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
bool ThinPart<D>::IsBetterThan(const ThinPart& other) const
{
  return std::tie(this->Least, this->Margin, this->Total) >
    std::tie(other.Least, other.Margin, other.Total);
}

template class ThinPart<3>;
template class ThinPart<4>;

} // namespace voxplex
