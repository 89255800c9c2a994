// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GridIndex.h
 * @brief Numbers the cells of a box-shaped grid; the first axis is the fastest.
 */
#ifndef voxplex_GridIndex_h
#define voxplex_GridIndex_h

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace voxplex
{

/** The number of cells. @param extent cells along each axis, here and below */
template <typename Integer, std::size_t D>
std::size_t CountCells(const std::array<Integer, D>& extent)
{
  std::size_t count = 1;
  for (const Integer n : extent)
  {
    count *= static_cast<std::size_t>(n);
  }
  return count;
}

/** The number of a row of cells along the first axis. */
template <typename Integer, std::size_t D>
std::size_t RowOf(const std::array<Integer, D>& index, const std::array<Integer, D>& extent)
{
  std::size_t row = 0;
  for (std::size_t a = D; a-- > 1;)
  {
    row = row * static_cast<std::size_t>(extent[a]) + static_cast<std::size_t>(index[a]);
  }
  return row;
}

/** The number of the cell at an index. */
template <typename Integer, std::size_t D>
std::size_t OffsetOf(const std::array<Integer, D>& index, const std::array<Integer, D>& extent)
{
  return RowOf(index, extent) * static_cast<std::size_t>(extent[0]) +
    static_cast<std::size_t>(index[0]);
}

/** The index of the cell with a number. */
template <typename Integer, std::size_t D>
std::array<Integer, D> IndexAt(std::size_t offset, const std::array<Integer, D>& extent)
{
  std::array<Integer, D> index;
  for (std::size_t a = 0; a < D; ++a)
  {
    index[a] = static_cast<Integer>(offset % static_cast<std::size_t>(extent[a]));
    offset /= static_cast<std::size_t>(extent[a]);
  }
  return index;
}

/** The cell whose centre is nearest, along each axis. */
template <std::size_t D>
std::array<std::int64_t, D> NearestIndex(const std::array<double, D>& place)
{
  std::array<std::int64_t, D> index;
  for (std::size_t a = 0; a < D; ++a)
  {
    const auto towardsZero = static_cast<std::int64_t>(place[a]); // std::llround() is a call
    const double rest = place[a] - static_cast<double>(towardsZero);
    index[a] = towardsZero + (rest >= 0.5 ? 1 : rest <= -0.5 ? -1 : 0);
  }
  return index;
}

/**
 * Calls visit(index) for all indices from `low` to `high`, both included, in the order of their
 * numbers. There is none if `high` is below `low` along any axis.
 */
template <std::size_t D, typename Visit>
void ForEachIndex(
  const std::array<std::int64_t, D>& low, const std::array<std::int64_t, D>& high, Visit&& visit)
{
  for (std::size_t a = 0; a < D; ++a)
  {
    if (high[a] < low[a])
    {
      return;
    }
  }
  for (std::array<std::int64_t, D> index = low; index[D - 1] <= high[D - 1];)
  {
    visit(index);
    for (std::size_t a = 0; a < D && ++index[a] > high[a] && a + 1 < D; ++a)
    {
      index[a] = low[a];
    }
  }
}

} // namespace voxplex

#endif
