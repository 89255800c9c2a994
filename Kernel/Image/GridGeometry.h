// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GridGeometry.h
 * @brief How voxel indices map to the mesher's frame.
 *
 * The mesher's frame has its origin at the centre of voxel (0, ..., 0). Index i lies at
 * `IndexToFrame * i`, where IndexToFrame is upper triangular with a positive diagonal: the R of the QR
 * decomposition of (direction * spacing). For orthogonal axes, the usual case, it is the diagonal
 * matrix of the spacings. The caller keeps Q (a rotation, or a reflection for left-handed axes) and
 * the origin, and applies them to what the mesher returns.
 */
#ifndef voxplex_GridGeometry_h
#define voxplex_GridGeometry_h

#include "Geometry/Point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace voxplex
{

template <int D>
struct GridGeometry
{
  using Index = std::array<std::int64_t, static_cast<std::size_t>(D)>;
  using Matrix = std::array<Point<D>, static_cast<std::size_t>(D)>; ///< rows

  /** Number of voxels along each axis; the first axis varies fastest in memory. */
  Index Dimensions{};
  /** Upper triangular, positive diagonal; row r, column c at IndexToFrame[r][c]. */
  Matrix IndexToFrame{};

  /** A grid with orthogonal axes and these spacings. */
  static GridGeometry Orthogonal(const Index& dimensions, const Point<D>& spacing)
  {
    GridGeometry g;
    g.Dimensions = dimensions;
    for (std::size_t i = 0; i < D; ++i)
    {
      g.IndexToFrame[i].fill(0.0);
      g.IndexToFrame[i][i] = spacing[i];
    }
    return g;
  }

  /** Frame coordinates of a continuous index. */
  Point<D> ToFrame(const Point<D>& index) const
  {
    Point<D> p;
    for (std::size_t r = 0; r < D; ++r)
    {
      p[r] = this->IndexToFrame[r][r] * index[r];
      for (std::size_t c = r + 1; c < D; ++c)
      {
        p[r] += this->IndexToFrame[r][c] * index[c];
      }
    }
    return p;
  }

  /** Continuous index of a point of the frame (back substitution). */
  Point<D> ToIndex(const Point<D>& p) const
  {
    Point<D> index;
    for (std::size_t k = D; k-- > 0;)
    {
      double s = p[k];
      for (std::size_t c = k + 1; c < D; ++c)
      {
        s -= this->IndexToFrame[k][c] * index[c];
      }
      index[k] = s / this->IndexToFrame[k][k];
    }
    return index;
  }

  /**
   * The index between 0 and `last` whose point is nearest to that of another one; if axes are oblique it is not the
   * nearest index. By coordinate descent, in time linear in D^3.
   */
  Point<D> NearestInBox(const Point<D>& index, const Point<D>& last) const
  {
    constexpr int rounds = 10;
    Point<D> nearest;
    for (std::size_t a = 0; a < D; ++a)
    {
      nearest[a] = std::clamp(index[a], 0.0, last[a]);
    }
    for (int round = 0; round < rounds && nearest != index; ++round)
    {
      for (std::size_t a = 0; a < D; ++a)
      {
        Point<D> step = Subtract(nearest, index);
        step[a] = 0.0;
        const Point<D> others = this->ToFrame(step);
        double product = 0.0; // of them and a step along this axis
        double own = 0.0;
        for (std::size_t r = 0; r <= a; ++r)
        {
          product += this->IndexToFrame[r][a] * others[r];
          own += this->IndexToFrame[r][a] * this->IndexToFrame[r][a];
        }
        nearest[a] = std::clamp(index[a] - product / own, 0.0, last[a]);
      }
    }
    return nearest;
  }

  /** Length of the step of one voxel along an axis. */
  double Spacing(int axis) const
  {
    double s = 0.0;
    for (std::size_t r = 0; r < D; ++r)
    {
      const double v = this->IndexToFrame[r][static_cast<std::size_t>(axis)];
      s += v * v;
    }
    return std::sqrt(s);
  }

  /**
   * By how much each index changes, at most, over a unit of length in any direction. 1 / Spacing() if the axes are
   * orthogonal, else more.
   */
  Point<D> VoxelsPerLength() const
  {
    Point<D> voxels{};
    for (std::size_t a = 0; a < D; ++a)
    {
      Point<D> unit{};
      unit[a] = 1.0;
      const Point<D> step = this->ToIndex(unit);
      for (std::size_t b = 0; b < D; ++b)
      {
        voxels[b] = std::hypot(voxels[b], step[b]);
      }
    }
    return voxels;
  }

  double SmallestSpacing() const
  {
    double smallest = this->Spacing(0);
    for (int a = 1; a < D; ++a)
    {
      smallest = std::min(smallest, this->Spacing(a));
    }
    return smallest;
  }
  double LargestSpacing() const
  {
    double largest = this->Spacing(0);
    for (int a = 1; a < D; ++a)
    {
      largest = std::max(largest, this->Spacing(a));
    }
    return largest;
  }

  /** Of a voxel with right angles and these spacings. */
  double VoxelDiagonal() const
  {
    double sum = 0.0;
    for (int a = 0; a < D; ++a)
    {
      sum += this->Spacing(a) * this->Spacing(a);
    }
    return std::sqrt(sum);
  }

  /** Volume (area, hypervolume) of one voxel. */
  double VoxelVolume() const
  {
    double v = 1.0;
    for (std::size_t i = 0; i < D; ++i)
    {
      v *= this->IndexToFrame[i][i];
    }
    return v;
  }
};

} // namespace voxplex

#endif
