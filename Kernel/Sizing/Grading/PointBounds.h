// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointBounds.h
 * @brief The bounding box of points, and the cell size of a grid over it.
 */
#ifndef voxplex_PointBounds_h
#define voxplex_PointBounds_h

#include "Geometry/Box.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace voxplex
{

/** @param points at least one */
template <int D>
Box<D> BoundsOf(std::span<const Point<D>> points)
{
  Box<D> box{ points.front(), points.front() };
  for (const Point<D>& p : points)
  {
    for (std::size_t a = 0; a < D; ++a)
    {
      box.Min[a] = std::min(box.Min[a], p[a]);
      box.Max[a] = std::max(box.Max[a], p[a]);
    }
  }
  return box;
}

/**
 * The smallest edge of a cell, `edge` or more, for which a grid over the box has about 16 million
 * cells at most; 4 million in 4D, where a cell has more neighbours and parts.
 */
template <int D>
double CellEdge(const Box<D>& box, double edge)
{
  constexpr double MostCells = (D == 3 ? 16.0 : 4.0) * 1024.0 * 1024.0;
  double volume = 1.0;
  for (std::size_t a = 0; a < D; ++a)
  {
    volume *= std::max(box.Max[a] - box.Min[a], edge);
  }
  return std::max(
    edge, D == 3 ? std::cbrt(volume / MostCells) : std::pow(volume / MostCells, 1.0 / D));
}

} // namespace voxplex

#endif
