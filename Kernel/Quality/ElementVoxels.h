// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementVoxels.h
 * @brief Which voxels an element lies in, for LostComponents and ComponentGuard.
 */
#ifndef voxplex_ElementVoxels_h
#define voxplex_ElementVoxels_h

#include "Base/GridIndex.h"
#include "Image/Components.h"
#include "Image/LabelImage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace voxplex
{

/**
 * @brief The voxels of the crop where an element shows that a component is not lost: that of its
 * centroid, and those around it.
 */
template <int D>
class ElementVoxels
{
public:
  using Index = typename GridGeometry<D>::Index;

  using Corners = std::array<const Point<D>*, D + 1>;

  /** The image must outlive this object. */
  ElementVoxels(const Components<D>& components, const LabelImage<D>& image)
    : Extent(components.Extent())
    , Image(image)
  {
  }

  /**
   * Calls visit with the voxel that contains the centroid of an element. If components are those of
   * frames: with the voxels that contain the centroid of its cut at each frame.
   */
  template <typename Visit>
  void ForEachVoxel(const Corners& element, const Visit& visit) const
  {
    if (this->Extent == D)
    {
      visit(this->Image.VoxelAt(Centroid(element)));
      return;
    }
    std::array<Point<D>, D + 1> corners;
    for (std::size_t i = 0; i <= D; ++i)
    {
      corners[i] = this->Image.ToCrop(*element[i]);
    }
    constexpr std::size_t time = D - 1;
    const auto [first, last] = std::minmax_element(corners.begin(), corners.end(),
      [](const Point<D>& p, const Point<D>& q) { return p[time] < q[time]; });
    const auto end = std::llround(std::floor((*last)[time] + OnFrame));
    for (auto frame = std::llround(std::ceil((*first)[time] - OnFrame)); frame <= end; ++frame)
    {
      Point<D> centroid;
      if (CutCentroid(corners, static_cast<double>(frame), centroid))
      {
        visit(NearestIndex(centroid));
      }
    }
  }

  /** Calls visit with each voxel of the block of three voxels along each axis of a component. */
  template <typename Visit>
  void ForEachAround(const Index& centre, const Visit& visit) const
  {
    ForEachIndex(this->Shifted(centre, -1), this->Shifted(centre, 1), visit);
  }

  /** Shifted along each axis of a component. */
  Index Shifted(Index index, std::int64_t by) const
  {
    for (std::size_t a = 0; a < this->Extent; ++a)
    {
      index[a] += by;
    }
    return index;
  }

private:
  /** A point counts as lying at a frame's time if it is no farther from it, in frames. */
  static constexpr double OnFrame = 1e-9;

  /** The centroid of the corners of a cut. False if the cut has no volume. */
  static bool CutCentroid(
    const std::array<Point<D>, D + 1>& corners, double frame, Point<D>& centroid)
  {
    std::array<int, D + 1> side;
    for (std::size_t i = 0; i <= D; ++i)
    {
      const double after = corners[i][D - 1] - frame;
      side[i] = after > OnFrame ? 1 : after < -OnFrame ? -1 : 0;
    }
    centroid = {};
    std::size_t number = 0;
    const auto add = [&](const Point<D>& p)
    {
      for (std::size_t a = 0; a < D; ++a)
      {
        centroid[a] += p[a];
      }
      ++number;
    };
    for (std::size_t i = 0; i <= D; ++i)
    {
      if (side[i] == 0)
      {
        add(corners[i]);
      }
      for (std::size_t j = 0; j < i; ++j)
      {
        if (side[i] * side[j] < 0)
        {
          add(Interpolate(corners[i], corners[j],
            (frame - corners[i][D - 1]) / (corners[j][D - 1] - corners[i][D - 1])));
        }
      }
    }
    for (double& x : centroid)
    {
      x /= static_cast<double>(number);
    }
    return number >= D; // fewer corners span no volume
  }

  const std::size_t Extent;
  const LabelImage<D>& Image;
};

} // namespace voxplex

#endif
