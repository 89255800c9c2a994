// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Box.h
 * @brief An axis-aligned box in the mesher's frame.
 */
#ifndef voxplex_Box_h
#define voxplex_Box_h

#include "Geometry/Point.h"

#include <limits>

namespace voxplex
{

template <int D>
struct Box
{
  Point<D> Min;
  Point<D> Max;

  /** Whether p is inside the box or on its boundary. */
  bool Contains(const Point<D>& p) const
  {
    for (std::size_t i = 0; i < D; ++i)
    {
      if (!(p[i] >= this->Min[i] && p[i] <= this->Max[i]))
      {
        return false;
      }
    }
    return true;
  }

  /**
   * The point of the box closest to p. A coordinate outside, or inside but nearer to a face than the margin, is set
   * exactly to that of the face.
   */
  Point<D> Clamp(const Point<D>& p, double margin = 0.0) const
  {
    Point<D> q = p;
    for (std::size_t i = 0; i < D; ++i)
    {
      q[i] = p[i] < this->Min[i] + margin ? this->Min[i]
        : p[i] > this->Max[i] - margin    ? this->Max[i]
                                          : p[i];
    }
    return q;
  }
};

/**
 * A box without its upper faces, so that boxes can tile space. Bounds may be infinite.
 */
template <int D>
struct HalfOpenBox
{
  Point<D> Min;
  Point<D> Max;

  bool Contains(const Point<D>& p) const
  {
    bool inside = true;
    for (std::size_t a = 0; a < D; ++a)
    {
      inside &= p[a] >= this->Min[a] && p[a] < this->Max[a];
    }
    return inside;
  }

  /** Whether a ball is in the box. No ball is too large for bounds that are infinite. */
  bool ContainsBall(const Point<D>& p, double radius) const
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    bool inside = true;
    for (std::size_t a = 0; a < D; ++a)
    {
      inside &= this->Min[a] == -infinity || p[a] - radius >= this->Min[a];
      inside &= this->Max[a] == infinity || p[a] + radius < this->Max[a];
    }
    return inside;
  }
};

} // namespace voxplex

#endif
