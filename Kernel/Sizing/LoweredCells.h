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

#include <cstddef>
#include <cstdint>

namespace voxplex
{

/**
 * Finds out whether a ball may reach a lowered cell of LocalDelta.
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
    for (const Index& cell : bounds.Lowered())
    {
      this->IsLowered.Set(cell);
    }
  }

  /** Whether a cell that a ball in the frame may reach was lowered. */
  bool AnyWithin(const Point<D>& centre, double radius) const
  {
    if (this->IsLowered.NumberOfRows() == 0)
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
        for (std::int64_t w = first / 64; 64 * w <= last && !any; ++w)
        {
          any = (words[static_cast<std::size_t>(w)] & BitMask<D>::RunInWord(first, last, w)) != 0;
        }
      });
    return any;
  }

private:
  using Index = typename LocalDelta<D>::Index;

  const LocalDelta<D>& Bounds;
  BitMask<D> IsLowered; ///< by cell
};

} // namespace voxplex

#endif
