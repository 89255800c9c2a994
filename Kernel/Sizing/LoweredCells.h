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

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxplex
{

/**
 * Finds out whether a ball may reach a lowered cell of LocalDelta. Lowered cells are counted in
 * blocks of cells, and the counts are added up in a summed-area table (Crow, 1984). It tells at
 * once that no block, or a block inside of a ball's box, has a lowered cell. Otherwise the cells of
 * the blocks at the border of the box are looked at. Most balls are far from all lowered cells; a
 * look at the distance of the block of the ball's centre settles these.
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
    for (std::size_t a = 0; a < D; ++a)
    {
      this->Blocks[a] = (bounds.NumberOfCells()[a] - 1) / Edge + 1;
      this->Extent[a] = this->Blocks[a] + 1;
    }
    this->SortCells();
    this->AddUp();
    this->FindDistances();
  }

  /** Whether a cell that a ball in the frame may reach was lowered. */
  bool AnyWithin(const Point<D>& centre, double radius) const
  {
    if (this->Cells.empty())
    {
      return false;
    }
    const std::size_t block = OffsetOf(BlockOf(this->Bounds.CellOf(centre)), this->Blocks);
    if (radius * this->BlocksPerLength < static_cast<double>(this->Distances[block]) - 1.0)
    {
      return false;
    }
    const auto cells = this->Bounds.CellsAround(centre, radius);
    Index low; // blocks of these cells
    Index high;
    Index lowInside; // blocks all of whose cells are among them
    Index highInside;
    bool hasInside = true;
    for (std::size_t a = 0; a < D; ++a)
    {
      low[a] = cells.first[a] / Edge;
      high[a] = cells.second[a] / Edge;
      lowInside[a] = (cells.first[a] + Edge - 1) / Edge;
      highInside[a] = (cells.second[a] + 1) / Edge - 1;
      hasInside = hasInside && lowInside[a] <= highInside[a];
    }
    if (this->Count(low, high) == 0)
    {
      return false;
    }
    if (hasInside && this->Count(lowInside, highInside) != 0)
    {
      return true;
    }
    bool any = false;
    ForEachIndex(low, high,
      [&](const Index& b) { any = any || this->AnyOfBlock(b, cells.first, cells.second); });
    return any;
  }

private:
  using Index = typename LocalDelta<D>::Index;

  static constexpr std::int64_t Edge = 8;         ///< of a block, in cells
  static constexpr std::uint8_t MostDistance = 5; ///< larger distances count as this one

  static Index BlockOf(Index cell)
  {
    for (std::int64_t& c : cell)
    {
      c /= Edge;
    }
    return cell;
  }

  /** Sorts the lowered cells by block. */
  void SortCells()
  {
    const std::vector<Index>& lowered = this->Bounds.Lowered();
    this->First.assign(CountCells(this->Blocks) + 1, 0);
    for (const Index& cell : lowered)
    {
      ++this->First[OffsetOf(BlockOf(cell), this->Blocks) + 1];
    }
    for (std::size_t b = 1; b < this->First.size(); ++b)
    {
      this->First[b] += this->First[b - 1];
    }
    this->Cells.resize(lowered.size());
    std::vector<std::uint32_t> next = this->First;
    for (const Index& cell : lowered)
    {
      this->Cells[next[OffsetOf(BlockOf(cell), this->Blocks)]++] = cell;
    }
  }

  /** Makes the summed-area table of the numbers of cells in blocks. */
  void AddUp()
  {
    const std::size_t size = CountCells(this->Extent);
    this->Below.assign(size, 0);
    Index last = this->Blocks;
    for (std::int64_t& l : last)
    {
      --l;
    }
    Index one;
    one.fill(1);
    const std::size_t toUpperCorner = OffsetOf(one, this->Extent);
    std::size_t b = 0;
    ForEachIndex(Index{}, last,
      [&](const Index& block)
      {
        this->Below[OffsetOf(block, this->Extent) + toUpperCorner] =
          this->First[b + 1] - this->First[b];
        ++b;
      });
    std::size_t stride = 1;
    for (const std::int64_t extent : this->Extent)
    {
      const std::size_t layer = stride * static_cast<std::size_t>(extent);
      for (std::size_t first = 0; first < size; first += layer)
      {
        for (std::size_t i = first + stride; i < first + layer; ++i)
        {
          this->Below[i] += this->Below[i - stride];
        }
      }
      stride = layer;
    }
  }

  /** Finds how many blocks away from each block, along any axis, the nearest lowered cell is. */
  void FindDistances()
  {
    const std::size_t size = CountCells(this->Blocks);
    std::vector<std::uint8_t> reached(size);
    for (std::size_t b = 0; b < size; ++b)
    {
      reached[b] = this->First[b + 1] > this->First[b] ? 1 : 0;
    }
    this->Distances.assign(size, MostDistance);
    for (std::uint8_t distance = 0; distance < MostDistance; ++distance)
    {
      for (std::size_t b = 0; b < size; ++b)
      {
        this->Distances[b] =
          reached[b] != 0 ? std::min(this->Distances[b], distance) : this->Distances[b];
      }
      std::size_t stride = 1;
      for (const std::int64_t blocks : this->Blocks)
      {
        const auto n = static_cast<std::size_t>(blocks);
        const std::vector<std::uint8_t> before = reached;
        for (std::size_t b = 0; b < size; ++b)
        {
          const std::size_t i = b / stride % n;
          reached[b] |= i > 0 ? before[b - stride] : std::uint8_t{ 0 };
          reached[b] |= i + 1 < n ? before[b + stride] : std::uint8_t{ 0 };
        }
        stride *= n;
      }
    }
    for (std::size_t a = 0; a < D; ++a)
    {
      this->BlocksPerLength = std::max(this->BlocksPerLength,
        this->Bounds.GetVoxelsPerLength()[a] / static_cast<double>(Edge * LocalDelta<D>::Cell));
    }
  }

  /** The number of lowered cells in the blocks from `low` to `high`. */
  std::uint32_t Count(const Index& low, const Index& high) const
  {
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
    return count;
  }

  /** Whether a lowered cell of a block lies between two cells. */
  bool AnyOfBlock(const Index& block, const Index& low, const Index& high) const
  {
    const std::size_t b = OffsetOf(block, this->Blocks);
    for (std::size_t k = this->First[b]; k < this->First[b + 1]; ++k)
    {
      bool isBetween = true;
      for (std::size_t a = 0; a < D; ++a)
      {
        isBetween = isBetween && this->Cells[k][a] >= low[a] && this->Cells[k][a] <= high[a];
      }
      if (isBetween)
      {
        return true;
      }
    }
    return false;
  }

  const LocalDelta<D>& Bounds;
  Index Blocks{};
  Index Extent{};                   ///< blocks + 1
  std::vector<Index> Cells;         ///< the lowered ones, block by block; empty: none was lowered
  std::vector<std::uint32_t> First; ///< of each block, and the end
  std::vector<std::uint8_t> Distances;
  double BlocksPerLength = 0.0; ///< along the axis where it is largest
  /** The number of lowered cells in blocks with smaller indices along all axes. */
  std::vector<std::uint32_t> Below;
};

} // namespace voxplex

#endif
