// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SparseCells.h
 * @brief One value for each cell of a grid, most of which have the same value.
 */
#ifndef voxplex_SparseCells_h
#define voxplex_SparseCells_h

#include "Base/GridIndex.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace voxplex
{

/**
 * @brief The values of the cells of a grid, in blocks. Memory is allocated for blocks that are
 * written to; all other cells have the initial value.
 *
 * Blocks have 8 cells along each axis in 3D, and 4 in 4D. Reading is safe in any number of threads,
 * but not beside writing.
 */
template <int D, typename T>
class SparseCells
{
public:
  using Index = std::array<std::int64_t, static_cast<std::size_t>(D)>;

  /** The logarithm of the edge of a block, in cells. */
  static constexpr unsigned BlockBits = D == 3 ? 3 : 2;

  /** @param cells number of cells along each axis, at least 1 */
  SparseCells(const Index& cells, const T& initial)
    : Initial(initial)
  {
    for (std::size_t a = 0; a < D; ++a)
    {
      this->Blocks[a] = ((cells[a] - 1) >> BlockBits) + 1;
    }
    this->Directory.resize(CountCells(this->Blocks));
  }

  /** Whether no cell was ever written to. */
  bool IsEmpty() const { return this->NumberOfBlocks == 0; }

  const T& At(const Index& cell) const
  {
    const T* const block = this->Directory[this->BlockOf(cell)].get();
    return block ? block[Offset(cell)] : this->Initial;
  }

  /** True only if all cells from `low` to `high` have the initial value; cheap. */
  bool HasNone(const Index& low, const Index& high) const
  {
    const std::size_t block = this->BlockOf(low);
    return block == this->BlockOf(high) && !this->Directory[block];
  }

  /** The value of a cell, to be written. */
  T& Write(const Index& cell)
  {
    std::unique_ptr<T[]>& block = this->Directory[this->BlockOf(cell)];
    if (!block)
    {
      block = std::make_unique_for_overwrite<T[]>(BlockSize);
      std::fill_n(block.get(), BlockSize, this->Initial);
      ++this->NumberOfBlocks;
    }
    return block[Offset(cell)];
  }

  /** Memory held in bytes. */
  std::size_t MemoryBytes() const
  {
    return this->NumberOfBlocks * BlockSize * sizeof(T) +
      this->Directory.size() * sizeof(std::unique_ptr<T[]>);
  }

private:
  static constexpr std::size_t BlockSize = std::size_t{ 1 } << (D * BlockBits);

  std::size_t BlockOf(const Index& cell) const
  {
    std::size_t block = 0;
    for (std::size_t a = D; a-- > 0;)
    {
      block = block * static_cast<std::size_t>(this->Blocks[a]) +
        static_cast<std::size_t>(cell[a] >> BlockBits);
    }
    return block;
  }
  static std::size_t Offset(const Index& cell)
  {
    constexpr std::int64_t mask = (std::int64_t{ 1 } << BlockBits) - 1;
    std::size_t offset = 0;
    for (std::size_t a = D; a-- > 0;)
    {
      offset = (offset << BlockBits) | static_cast<std::size_t>(cell[a] & mask);
    }
    return offset;
  }

  T Initial;
  Index Blocks{};
  std::vector<std::unique_ptr<T[]>> Directory;
  std::size_t NumberOfBlocks = 0;
};

} // namespace voxplex

#endif
