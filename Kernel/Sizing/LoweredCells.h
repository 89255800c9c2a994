// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LoweredCells.h
 * @brief Which regions contain a cell whose local bound of delta was lowered.
 */
#ifndef voxplex_LoweredCells_h
#define voxplex_LoweredCells_h

#include "Base/GridIndex.h"
#include "Sizing/LocalDelta.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxplex
{

/**
 * Counts the lowered cells of LocalDelta in boxes of cells, by a summed-area table (Crow, 1984). A
 * circumball may span the whole image, so the cost of a question must not depend on its size.
 *
 * It is a snapshot: cells that are lowered later are not counted. Immutable after construction,
 * which costs O(D n) for n cells; a question costs O(2^D).
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
    Index last = bounds.NumberOfCells();
    std::size_t size = 1;
    for (std::size_t a = 0; a < D; ++a)
    {
      this->Extent[a] = last[a] + 1;
      size *= static_cast<std::size_t>(this->Extent[a]);
      --last[a];
    }
    this->Below.assign(size, 0);
    Index one;
    one.fill(1);
    const std::size_t toUpperCorner = OffsetOf(one, this->Extent);
    auto lowered = bounds.Lowered().begin();
    ForEachIndex(Index{}, last,
      [&](const Index& cell)
      { this->Below[OffsetOf(cell, this->Extent) + toUpperCorner] = *lowered++; });
    std::size_t stride = 1;
    for (const std::int64_t extent : this->Extent)
    {
      const std::size_t block = stride * static_cast<std::size_t>(extent);
      for (std::size_t first = 0; first < size; first += block)
      {
        for (std::size_t i = first + stride; i < first + block; ++i)
        {
          this->Below[i] += this->Below[i - stride];
        }
      }
      stride = block;
    }
  }

  /** Whether a cell that a ball in the frame may reach was lowered. */
  bool AnyWithin(const Point<D>& centre, double radius) const
  {
    if (this->Below.empty())
    {
      return false;
    }
    const auto [low, high] = this->Bounds.CellsAround(centre, radius);
    std::uint32_t count = 0; // modulo 2^32, since the terms have both signs
    for (unsigned corner = 0; corner < (1u << D); ++corner)
    {
      Index index;
      std::uint32_t sign = 1;
      for (std::size_t a = 0; a < D; ++a)
      {
        const bool upper = ((corner >> a) & 1u) != 0;
        index[a] = upper ? high[a] + 1 : low[a];
        sign = upper ? sign : 0 - sign;
      }
      count += sign * this->Below[OffsetOf(index, this->Extent)];
    }
    return count != 0;
  }

private:
  using Index = typename LocalDelta<D>::Index;

  const LocalDelta<D>& Bounds;
  Index Extent{};
  /** The number of lowered cells with smaller indices along all axes. Empty: none was lowered. */
  std::vector<std::uint32_t> Below;
};

} // namespace voxplex

#endif
