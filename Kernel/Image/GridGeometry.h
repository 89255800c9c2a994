// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GridGeometry.h
 * @brief The map from voxel indices to the mesher's frame.
 *
 * The origin of the mesher's frame is the centre of voxel (0, ..., 0). Index i lies at
 * `IndexToFrame * i`. IndexToFrame is upper triangular with a positive diagonal: it is the R of the
 * QR decomposition of (direction * spacing). For orthogonal axes, the usual case, it is the
 * diagonal matrix of the spacings. The caller keeps the origin and Q (a rotation, or a reflection
 * for left-handed axes), and applies them to the mesher's output.
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
  /** Upper triangular, with a positive diagonal. IndexToFrame[r][c] is row r, column c. */
  Matrix IndexToFrame{};

  /** A grid with orthogonal axes and the given spacings. */
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
   * The index in the box from 0 to `last` whose point is nearest to the point of `index`. If the
   * axes are oblique, this is not the nearest index. Uses coordinate descent; time O(D^3).
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
        double product = 0.0; // dot product of `others` and the step along this axis
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

  /** Length of a step of one voxel along an axis. */
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
   * The largest change of each index over a unit of length in any direction. It is 1 / Spacing() if
   * the axes are orthogonal, and larger otherwise.
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

  /** Diagonal of a voxel with right angles and these spacings. */
  double VoxelDiagonal() const
  {
    double sum = 0.0;
    for (int a = 0; a < D; ++a)
    {
      sum += this->Spacing(a) * this->Spacing(a);
    }
    return std::sqrt(sum);
  }

  /** Volume of one voxel; its hypervolume in 4D. */
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
