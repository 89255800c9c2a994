// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CutPlanes.h
 * @brief The planes on which an image's border cuts the object, and what they do to labels and margins.
 */
#ifndef voxplex_CutPlanes_h
#define voxplex_CutPlanes_h

#include "Image/LabelImage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace voxplex
{

/**
 * @brief Where the border of a 3D image cuts the object (LabelImage::IsCut): one plane for each such face of the image.
 *
 * They lie half a voxel outside of the outermost voxel centres. A field whose labels go on beyond them asks here what
 * becomes of a margin there. This is constructive solid geometry: the object is the intersection of what goes on and
 * of a box, the background the union of the rest.
 *
 * Points are lattice coordinates (TiledLattice), in which the planes are perpendicular to the axes and distances are in
 * voxels. Plane 2 a + end is that at the lower (0) or upper (1) end of axis a; sets of planes are bits of these numbers.
 *
 * Immutable after construction: all methods are const and safe to call from any thread, and take O(D).
 */
template <int D>
class CutPlanes
{
public:
  /** @param image not referenced afterwards; one with time is not cut (IsCutInTime is something else) */
  explicit CutPlanes(const LabelImage<D>& image)
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < D; ++a)
    {
      this->At[0][a] = image.IsCut(a, 0) ? 0.5 : -infinity;
      this->At[1][a] =
        image.IsCut(a, 1) ? static_cast<double>(image.CropDimensions()[a]) + 0.5 : infinity;
      this->Any = this->Any || image.IsCut(a, 0) || image.IsCut(a, 1);
    }
  }

  /** Whether there is one. */
  bool Exist() const { return this->Any; }

  /** From x to the nearest plane; negative beyond it, infinite if there is none. */
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

  /** x moved along the axes onto a set of planes; a coordinate is infinite if there is no such plane. */
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

  /** The margin of a label, of that which it has if the object goes on. */
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
    // Background has the planes themselves: its margin must be positive there.
    return margin > 0.0 || cut > 0.0 ? std::max(margin, -cut)
                                     : std::max(-cut, std::numeric_limits<double>::min());
  }

  /**
   * The gradient of Margin() where that is a plane's.
   * @return false where it is that of the object that goes on; `gradient` stays what it is
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
  /** By how much margins change per voxel at planes. */
  static constexpr double Slope = 2.0;

  /** Distance(), and along which axis with which sign it grows. */
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
