// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BitMask.h
 * @brief One bit per voxel of a grid.
 */
#ifndef voxplex_BitMask_h
#define voxplex_BitMask_h

#include "Base/GridIndex.h"
#include "Image/GridGeometry.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxplex
{

/**
 * @brief One bit per voxel of a D-dimensional grid, all 0 at first.
 *
 * Each row along the first axis begins in a new 64-bit word. The bits past the end of a row are 0.
 * Different threads may write different rows at the same time. Reading is thread-safe.
 */
template <int D>
class BitMask
{
public:
  using Index = typename GridGeometry<D>::Index;

  BitMask() = default;
  /** @param dimensions voxels along each axis, at least 1 */
  explicit BitMask(const Index& dimensions)
    : Extent(dimensions)
    , Words((static_cast<std::size_t>(dimensions[0]) + 63) / 64)
  {
    this->Bits.resize(
      CountCells(dimensions) / static_cast<std::size_t>(dimensions[0]) * this->Words);
  }

  const Index& Dimensions() const { return this->Extent; }
  std::size_t NumberOfRows() const { return this->Words ? this->Bits.size() / this->Words : 0; }
  std::size_t WordsPerRow() const { return this->Words; }

  /** Row number of an index. The second axis varies fastest. */
  std::size_t RowOf(const Index& index) const { return voxplex::RowOf(index, this->Extent); }

  /** The words of a row. Bit i of word w is voxel 64 w + i. */
  std::span<const std::uint64_t> Row(std::size_t row) const
  {
    return { this->Bits.data() + row * this->Words, this->Words };
  }
  std::span<std::uint64_t> Row(std::size_t row)
  {
    return { this->Bits.data() + row * this->Words, this->Words };
  }

  /** @param index inside the grid */
  bool Test(const Index& index) const
  {
    const auto x = static_cast<std::size_t>(index[0]);
    return (this->Bits[this->RowOf(index) * this->Words + x / 64] >> (x % 64)) & 1u;
  }
  void Set(const Index& index)
  {
    const auto x = static_cast<std::size_t>(index[0]);
    this->Bits[this->RowOf(index) * this->Words + x / 64] |= std::uint64_t{ 1 } << (x % 64);
  }

  /** The bits of word w of a row that belong to the voxels from `first` to `last` of this row. */
  static std::uint64_t RunInWord(std::int64_t first, std::int64_t last, std::int64_t w)
  {
    const std::int64_t low = std::max(first - 64 * w, std::int64_t{ 0 });
    const std::int64_t high = std::min(last - 64 * w, std::int64_t{ 63 });
    return low > high ? 0 : (~std::uint64_t{ 0 } >> (63 - (high - low))) << low;
  }

  /**
   * Clears a run of voxels along the first axis. Several threads may clear any runs at the same
   * time. A thread sees the changes of other threads only after a synchronisation, such as the end
   * of ParallelFor().
   *
   * @param first the run's first voxel, inside the grid
   * @param last index of the run's last voxel along the first axis, inside the grid; if it is
   *   before the first voxel, nothing is cleared
   */
  void ClearRun(const Index& first, std::int64_t last)
  {
    const auto words = this->Row(this->RowOf(first));
    for (std::int64_t w = first[0] / 64; 64 * w <= last; ++w)
    {
      const std::uint64_t bits = RunInWord(first[0], last, w);
      const std::atomic_ref<std::uint64_t> word(words[static_cast<std::size_t>(w)]);
      if ((word.load(std::memory_order_relaxed) & bits) != 0)
      {
        word.fetch_and(~bits, std::memory_order_relaxed);
      }
    }
  }

  /**
   * Sets a bit. Several threads may set any bits at the same time.
   *
   * @param index inside the grid
   * @return whether this call has set it; if several threads set a bit, this is true for one
   */
  bool SetIfClear(const Index& index)
  {
    const auto x = static_cast<std::size_t>(index[0]);
    const std::uint64_t bit = std::uint64_t{ 1 } << (x % 64);
    const std::atomic_ref<std::uint64_t> word(
      this->Bits[this->RowOf(index) * this->Words + x / 64]);
    return (word.load(std::memory_order_relaxed) & bit) == 0 &&
      (word.fetch_or(bit, std::memory_order_relaxed) & bit) == 0;
  }

  std::size_t MemoryBytes() const { return this->Bits.size() * sizeof(std::uint64_t); }

private:
  Index Extent{};
  std::size_t Words = 0;
  std::vector<std::uint64_t> Bits;
};

} // namespace voxplex

#endif
