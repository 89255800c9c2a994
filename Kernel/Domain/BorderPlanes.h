// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BorderPlanes.h
 * @brief The planes on which an image's border cuts the object, and their effect on margins.
 */
#ifndef voxplex_BorderPlanes_h
#define voxplex_BorderPlanes_h

#include "Image/LabelImage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace voxplex
{

/**
 * @brief The planes on which the border of a 3D image cuts the object.
 *
 * There is a plane for each face of the image that the object reaches (LabelImage::ReachesBorder).
 *
 * The planes lie half a voxel outside of the outermost voxel centres. The labels of a field
 * continue beyond them; Margin() and Gradient() cut the field's margins there. This is constructive
 * solid geometry: the object is the intersection of the continued object with a box. The background
 * is the rest of space.
 *
 * Points are in lattice coordinates (TiledLattice): the planes are perpendicular to the axes, and
 * distances are in voxels. Plane 2 a + end is the plane at the lower (0) or upper (1) end of axis
 * a. In a set of planes, the bit with a plane's number stands for it.
 *
 * Immutable after construction: all methods are const and safe to call from any thread, and take O(D).
 */
template <int D>
class BorderPlanes
{
public:
  /**
   * @param image not referenced afterwards. A 4D image has no planes; for its flat ends see
   *   ReachesBorderInTime().
   */
  explicit BorderPlanes(const LabelImage<D>& image)
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < D; ++a)
    {
      this->At[0][a] = image.ReachesBorder(a, 0) ? 0.5 : -infinity;
      this->At[1][a] =
        image.ReachesBorder(a, 1) ? static_cast<double>(image.CropDimensions()[a]) + 0.5 : infinity;
      this->Any = this->Any || image.ReachesBorder(a, 0) || image.ReachesBorder(a, 1);
    }
  }

  /** Whether there is any plane. */
  bool Exist() const { return this->Any; }

  /**
   * Distance from x to the nearest plane; negative beyond a plane, infinite if there is no plane.
   */
  double Distance(const Point<D>& x) const
  {
    std::size_t axis = 0;
    double sign = 0.0;
    return this->Distance(x, axis, sign);
  }

  /** The planes that are at most `tolerance` voxels from x. */
  unsigned Near(const Point<D>& x, double tolerance) const
  {
    unsigned planes = 0;
    for (unsigned plane = 0; plane < 2 * D && this->Any; ++plane)
    {
      if (std::abs(x[plane / 2] - this->At[plane % 2][plane / 2]) <= tolerance)
      {
        planes |= 1u << plane;
      }
    }
    return planes;
  }

  /** Whether x lies beyond the plane of this number. */
  bool IsBeyond(const Point<D>& x, unsigned plane) const
  {
    const double at = this->At[plane % 2][plane / 2];
    return plane % 2 == 0 ? x[plane / 2] < at : x[plane / 2] > at;
  }

  /**
   * x moved along the axes onto a set of planes. If a plane does not exist, its coordinate becomes
   * infinite.
   */
  Point<D> MoveOnto(Point<D> x, unsigned planes) const
  {
    for (unsigned plane = 0; plane < 2 * D; ++plane)
    {
      if ((planes >> plane) & 1)
      {
        x[plane / 2] = this->At[plane % 2][plane / 2];
      }
    }
    return x;
  }

  /** The margin of a label in the cut object. `margin` is its margin in the continued object. */
  double Margin(const Point<D>& x, LabelId label, double margin) const
  {
    if (!this->Any)
    {
      return margin;
    }
    const double cut = std::clamp(Slope * this->Distance(x), -2.0, 2.0);
    if (label != 0)
    {
      return std::min(margin, cut);
    }
    // The planes themselves belong to the background: its margin must be positive there.
    return margin > 0.0 || cut > 0.0 ? std::max(margin, -cut)
                                     : std::max(-cut, std::numeric_limits<double>::min());
  }

  /**
   * The gradient of Margin() where a plane determines it.
   * @return false if the continued object determines it; `gradient` is then unchanged
   */
  bool Gradient(const Point<D>& x, LabelId label, double margin, Point<D>& gradient) const
  {
    std::size_t axis = 0;
    double sign = 0.0;
    const double cut = Slope * this->Distance(x, axis, sign);
    if (!(label != 0 ? cut < margin : -cut > margin))
    {
      return false;
    }
    gradient.fill(0.0);
    gradient[axis] = (label != 0 ? Slope : -Slope) * sign;
    return true;
  }

private:
  /** Change of the margin per voxel near a plane. */
  static constexpr double Slope = 2.0;

  /** Distance(), and the axis and sign along which the distance grows. */
  double Distance(const Point<D>& x, std::size_t& axis, double& sign) const
  {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < D; ++a)
    {
      const double low = x[a] - this->At[0][a];
      const double high = this->At[1][a] - x[a];
      if (low < nearest)
      {
        nearest = low;
        axis = a;
        sign = 1.0;
      }
      if (high < nearest)
      {
        nearest = high;
        axis = a;
        sign = -1.0;
      }
    }
    return nearest;
  }

  bool Any = false;
  std::array<Point<D>, 2> At; ///< coordinates of the planes at either end, or infinite
};

} // namespace voxplex

#endif
