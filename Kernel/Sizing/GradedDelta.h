// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GradedDelta.h
 * @brief A sampling distance that changes from place to place, in the cells of a grid.
 */
#ifndef voxplex_GradedDelta_h
#define voxplex_GradedDelta_h

#include "Geometry/CellGrid.h"
#include "Sizing/GrowthLimit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace voxplex
{

/**
 * @brief Delta(z) of the thesis, constant in each cell of a cubic grid.
 *
 * Values are set at points. A cell keeps the smallest of its values, and Grade() spreads them over
 * the grid. A query is one look-up.
 * Queries may run in any number of threads, but not while another method changes the values.
 */
template <int D>
class GradedDelta
{
public:
  /**
   * @param bounds box of the points where values will be set; a query outside takes the nearest
   *   cell
   * @param cell edge of a cell
   * @throws std::bad_alloc
   */
  GradedDelta(const Box<D>& bounds, double cell)
    : Grid(bounds, cell)
    , Values(CountCells(this->Grid.Cells), std::numeric_limits<float>::infinity())
  {
  }

  /** Lowers the value of the cell of p. */
  void Lower(const Point<D>& p, double delta)
  {
    float& value = this->Values[this->Grid.CellOf(p)];
    value = std::min(value, static_cast<float>(delta));
    this->FinestDelta = std::min(this->FinestDelta, delta);
  }

  /**
   * Limits the growth of the values to `slope` for each unit of length along the axes
   * (LimitGrowth). At least one value must have been set.
   */
  void Grade(double slope, unsigned threads, const std::stop_token& stop)
  {
    std::array<float, static_cast<std::size_t>(D)> steps;
    steps.fill(static_cast<float>(slope / this->Grid.CellsPerLength));
    LimitGrowth(std::span<float>(this->Values), this->Grid.Cells, steps, threads, stop);
  }

  /** Lowers all values to `largest`. */
  void Cap(double largest)
  {
    for (float& value : this->Values)
    {
      value = std::min(value, static_cast<float>(largest));
    }
  }

  /** The sampling distance at a point of the frame. */
  double At(const Point<D>& p) const { return this->Values[this->Grid.CellOf(p)]; }

  /** The smallest value that was set. */
  double Finest() const { return this->FinestDelta; }

  std::size_t MemoryBytes() const { return this->Values.size() * sizeof(float); }

private:
  const CellGrid<D> Grid;
  std::vector<float> Values;
  double FinestDelta = std::numeric_limits<double>::infinity();
};

} // namespace voxplex

#endif
