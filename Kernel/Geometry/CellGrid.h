// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellGrid.h
 * @brief Cubic cells over a box.
 */
#ifndef voxplex_CellGrid_h
#define voxplex_CellGrid_h

#include "Base/GridIndex.h"
#include "Geometry/Box.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace voxplex
{

/** @brief A grid of cubic cells that covers a box. Cells are numbered as in GridIndex.h. */
template <int D>
struct CellGrid
{
  using Index = std::array<std::size_t, static_cast<std::size_t>(D)>;

  /** @param edge of a cell */
  CellGrid(const Box<D>& bounds, double edge)
    : Origin(bounds.Min)
    , CellsPerLength(1.0 / edge)
  {
    for (std::size_t a = 0; a < D; ++a)
    {
      this->Cells[a] =
        static_cast<std::size_t>((bounds.Max[a] - bounds.Min[a]) * this->CellsPerLength) + 1;
    }
  }

  /** The cell along an axis that is nearest to a coordinate. */
  std::size_t CellAlong(std::size_t axis, double x) const
  {
    const double cell = (x - this->Origin[axis]) * this->CellsPerLength;
    return static_cast<std::size_t>(
      std::clamp(cell, 0.0, static_cast<double>(this->Cells[axis] - 1)));
  }

  /** The number of the cell nearest to p. */
  std::size_t CellOf(const Point<D>& p) const
  {
    Index cell;
    for (std::size_t a = 0; a < D; ++a)
    {
      cell[a] = this->CellAlong(a, p[a]);
    }
    return OffsetOf(cell, this->Cells);
  }

  Point<D> Origin;
  double CellsPerLength;
  Index Cells; ///< along each axis
};

} // namespace voxplex

#endif
