// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LoweredCells.h
 * @brief Which regions contain a cell whose local bound of delta was lowered.
 */
#ifndef voxplex_LoweredCells_h
#define voxplex_LoweredCells_h

#include "Base/GridIndex.h"
#include "Image/BitMask.h"
#include "Sizing/LocalDelta.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * Finds out whether a ball may reach a lowered cell of LocalDelta. Most balls are far from all lowered
 * cells; a look at the distance of the block of cells around the ball's centre settles these. For the
 * others, rows of cells are looked at.
 *
 * It is a snapshot: cells that are lowered later are not counted. Immutable after construction.
 */
template <int D>
class LoweredCells
{
public:
  /** @param bounds must outlive this */
  explicit LoweredCells(const LocalDelta<D>& bounds)
    : Bounds(bounds)
  {
    if (!bounds.HasLowered())
    {
      return;
    }
    this->IsLowered = BitMask<D>(bounds.NumberOfCells());
    for (std::size_t a = 0; a < D; ++a)
    {
      this->Blocks[a] = (bounds.NumberOfCells()[a] - 1) / Edge + 1;
      this->BlocksPerLength = std::max(this->BlocksPerLength,
        bounds.GetVoxelsPerLength()[a] / static_cast<double>(Edge * LocalDelta<D>::Cell));
    }
    std::vector<std::uint8_t> reached(CountCells(this->Blocks));
    for (const Index& cell : bounds.Lowered())
    {
      this->IsLowered.Set(cell);
      reached[this->BlockOf(cell)] = 1;
    }
    this->FindDistances(std::move(reached));
  }

  /** Whether a cell that a ball in the frame may reach was lowered. */
  bool AnyWithin(const Point<D>& centre, double radius) const
  {
    if (this->Distances.empty() ||
      radius * this->BlocksPerLength <
        static_cast<double>(this->Distances[this->BlockOf(this->Bounds.CellOf(centre))]) - 1.0)
    {
      return false;
    }
    const auto [low, high] = this->Bounds.CellsAround(centre, radius);
    Index lastRow = high;
    lastRow[0] = low[0];
    bool any = false;
    ForEachIndex(low, lastRow,
      [&, first = low[0], last = high[0]](const Index& row)
      {
        const auto words = this->IsLowered.Row(this->IsLowered.RowOf(row));
        for (std::int64_t w = first / 64; 64 * w <= last; ++w)
        {
          any |= (words[static_cast<std::size_t>(w)] & BitMask<D>::RunInWord(first, last, w)) != 0;
        }
      });
    return any;
  }

private:
  using Index = typename LocalDelta<D>::Index;

  static constexpr std::int64_t Edge = 4;         ///< of a block, in cells
  static constexpr std::uint8_t MostDistance = 8; ///< larger distances count as this one

  std::size_t BlockOf(Index cell) const
  {
    for (std::int64_t& c : cell)
    {
      c /= Edge;
    }
    return OffsetOf(cell, this->Blocks);
  }

  /** Finds how many blocks away from each block, along any axis, the nearest lowered cell is. */
  void FindDistances(std::vector<std::uint8_t> reached)
  {
    const std::size_t size = reached.size();
    this->Distances.assign(size, 0);
    for (std::uint8_t distance = 0; distance < MostDistance; ++distance)
    {
      for (std::size_t b = 0; b < size; ++b)
      {
        this->Distances[b] =
          reached[b] != 0 ? this->Distances[b] : static_cast<std::uint8_t>(distance + 1);
      }
      std::size_t stride = 1;
      for (const std::int64_t blocks : this->Blocks)
      {
        const std::size_t layer = stride * static_cast<std::size_t>(blocks);
        const std::vector<std::uint8_t> before = reached;
        for (std::size_t first = 0; first < size; first += layer)
        {
          for (std::size_t b = first; b + stride < first + layer; ++b)
          {
            reached[b] |= before[b + stride];
            reached[b + stride] |= before[b];
          }
        }
        stride = layer;
      }
    }
  }

  const LocalDelta<D>& Bounds;
  BitMask<D> IsLowered;                ///< by cell
  Index Blocks{};                      ///< along each axis
  std::vector<std::uint8_t> Distances; ///< of blocks; empty: no cell was lowered
  double BlocksPerLength = 0.0;        ///< along the axis where it is largest
};

} // namespace voxplex

#endif
