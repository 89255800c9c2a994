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
inline Box<3> BoundsOf(std::span<const Point<3>> points)
{
  Box<3> box{ points.front(), points.front() };
  for (const Point<3>& p : points)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      box.Min[a] = std::min(box.Min[a], p[a]);
      box.Max[a] = std::max(box.Max[a], p[a]);
    }
  }
  return box;
}

/**
 * The smallest edge of a cell, `edge` or more, for which a grid over the box has about 16 million
 * cells at most.
 */
inline double CellEdge(const Box<3>& box, double edge)
{
  constexpr double MostCells = 16.0 * 1024.0 * 1024.0;
  double volume = 1.0;
  for (std::size_t a = 0; a < 3; ++a)
  {
    volume *= std::max(box.Max[a] - box.Min[a], edge);
  }
  return std::max(edge, std::cbrt(volume / MostCells));
}

} // namespace voxplex

#endif
