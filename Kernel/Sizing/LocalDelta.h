// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LocalDelta.h
 * @brief Upper bounds of the sampling distance where something small or thin needs a finer one.
 */
#ifndef voxplex_LocalDelta_h
#define voxplex_LocalDelta_h

#include "Base/GridIndex.h"
#include "Image/LabelImage.h"
#include "Parallel/ParallelFor.h"
#include "Sizing/GrowthLimit.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief An upper bound of the sampling distance of one label's interfaces in each cell of a few
 * voxels; infinite at first.
 *
 * A query is one look-up. The memory is allocated when the first bound is set: two bytes a voxel in
 * 3D. If two labels have a bound in one cell, the smaller bound holds.
 * Queries may run in any number of threads, but not beside SetBound().
 */
template <int D>
class LocalDelta
{
public:
  using Index = typename GridGeometry<D>::Index;

  /** Edge of a cell in voxels. */
  static constexpr std::int64_t Cell = 2;

  /** @param threads of Grade(); 0 means all cores; bounds do not depend on it */
  explicit LocalDelta(const LabelImage<D>& image, unsigned threads = 1)
    : Threads(threads)
    , Grid(image.Grid())
    , Origin(image.CropOrigin())
    , VoxelsPerLength(image.Grid().VoxelsPerLength())
  {
    for (std::size_t a = 0; a < D; ++a)
    {
      this->Cells[a] = (image.CropDimensions()[a] - 1) / Cell + 1;
    }
  }

  /** A bound, and the label whose interfaces it is for. */
  struct Bound
  {
    float Delta = std::numeric_limits<float>::infinity();
    LabelId Label = 0;
  };

  /**
   * Lowers the bound in all cells within a voxel of a run of voxels. `first` is an index of the
   * crop.
   */
  void SetBound(const Index& first, std::int64_t length, LabelId label, double delta)
  {
    this->ForCellsNear(first, length,
      [&](std::size_t cell)
      {
        Bound& bound = this->Values[cell];
        if (delta < bound.Delta)
        {
          bound = { static_cast<float>(delta), label };
          this->IsLowered.resize(this->Values.size(), 0);
          this->IsLowered[cell] = 1;
        }
      });
    this->SetSpacing(first, length, delta);
    this->SmallestBound = std::min(this->SmallestBound, delta);
  }

  /**
   * Lowers GradedAt() alone: vertices there are this close to each other, but no rule asks for it.
   */
  void SetSpacing(const Index& first, std::int64_t length, double spacing)
  {
    this->ForCellsNear(first, length,
      [&](std::size_t cell)
      { this->Spacings[cell] = std::min(this->Spacings[cell], static_cast<float>(spacing)); });
    this->SmallestBound = std::min(this->SmallestBound, spacing);
  }
  /** The bound at a point of the frame; outside of the crop that of the nearest cell. */
  Bound At(const Point<D>& p) const
  {
    return this->Values.empty() ? Bound() : this->Values[this->CellOf(p)];
  }

  /**
   * The smallest of all bounds at a point, if each bound grows by `Slope` times the distance along
   * the axes from where it was set. It is as of the last Grade(), continuous, and nowhere in a cell
   * above the cell's own bound.
   */
  double GradedAt(const Point<D>& p) const
  {
    if (this->Graded.empty())
    {
      return std::numeric_limits<double>::infinity();
    }
    const Point<D> index = this->Grid.ToIndex(p);
    std::array<std::size_t, D> offset; // of the lower cell along each axis, in values
    std::array<std::size_t, D> step;   // from the lower to the upper cell
    Point<D> fraction;
    std::size_t stride = 1;
    for (std::size_t a = 0; a < D; ++a)
    {
      const auto last = static_cast<double>(this->Cells[a] - 1);
      const double x =
        std::clamp((index[a] - static_cast<double>(this->Origin[a]) + 0.5) / Cell - 0.5, 0.0, last);
      const auto lower = static_cast<std::size_t>(x);
      fraction[a] = x - static_cast<double>(lower);
      offset[a] = lower * stride;
      step[a] = fraction[a] > 0.0 ? stride : 0;
      stride *= static_cast<std::size_t>(this->Cells[a]);
    }
    double sum = 0.0;
    for (unsigned corner = 0; corner < (1u << D); ++corner)
    {
      double weight = 1.0;
      std::size_t cell = 0;
      for (std::size_t a = 0; a < D; ++a)
      {
        const bool upper = ((corner >> a) & 1u) != 0;
        weight *= upper ? fraction[a] : 1.0 - fraction[a];
        cell += offset[a] + (upper ? step[a] : 0);
      }
      sum += weight * static_cast<double>(this->Graded[cell]);
    }
    return sum;
  }

  /** Whether SetBound() has lowered the bound of any cell since the last ForgetLowered(). */
  bool HasLowered() const { return !this->IsLowered.empty(); }

  /** Whether each cell was lowered since then; empty if none was. */
  const std::vector<std::uint8_t>& Lowered() const { return this->IsLowered; }

  /** The number of cells along each axis. */
  const Index& NumberOfCells() const { return this->Cells; }

  /** The first and the last cell along each axis that a ball in the frame may reach. */
  std::pair<Index, Index> CellsAround(const Point<D>& centre, double radius) const
  {
    const Point<D> index = this->Grid.ToIndex(centre);
    std::pair<Index, Index> cells;
    for (std::size_t a = 0; a < D; ++a)
    {
      const double voxels = radius * this->VoxelsPerLength[a];
      cells.first[a] = this->CellAlong(a, index[a] - voxels);
      cells.second[a] = this->CellAlong(a, index[a] + voxels);
    }
    return cells;
  }

  void ForgetLowered() { this->IsLowered.clear(); }

  /** Growth of bounds over a unit of length. */
  static constexpr double Slope = 0.25;

  /**
   * Prepares GradedAt(). Linear in the number of cells.
   *
   * A cell first takes the smallest value of itself and its neighbours. GradedAt() interpolates
   * between the centres of cells, so it stays below a cell's value up to the cell's border.
   */
  void Grade()
  {
    this->Graded = this->Spacings;
    std::array<std::size_t, static_cast<std::size_t>(D)> cells;
    std::array<float, static_cast<std::size_t>(D)> steps;
    std::size_t stride = 1;
    for (std::size_t a = 0; a < D; ++a)
    {
      cells[a] = static_cast<std::size_t>(this->Cells[a]);
      steps[a] = static_cast<float>(Slope * Cell * this->Grid.Spacing(static_cast<int>(a)));
      this->TakeLeastOfNeighbours(stride, cells[a]);
      stride *= cells[a];
    }
    LimitGrowth(std::span<float>(this->Graded), cells, steps, this->Threads);
  }

  /** The smallest bound that was set; infinite if none was. */
  double Smallest() const { return this->SmallestBound; }

private:
  /** Calls function(cell) for all cells within a voxel of a run of voxels. */
  template <typename Function>
  void ForCellsNear(const Index& first, std::int64_t length, Function&& function)
  {
    if (this->Values.empty())
    {
      const std::size_t count = CountCells(this->Cells);
      this->Values.assign(count, Bound());
      this->Spacings.assign(count, std::numeric_limits<float>::infinity());
    }
    Index low;
    Index high;
    for (std::size_t a = 0; a < D; ++a)
    {
      const std::int64_t last = first[a] + (a == 0 ? length - 1 : 0);
      low[a] = std::clamp<std::int64_t>((first[a] - 1) / Cell, 0, this->Cells[a] - 1);
      high[a] = std::clamp<std::int64_t>((last + 1) / Cell, 0, this->Cells[a] - 1);
    }
    ForEachIndex(low, high, [&](const Index& cell) { function(OffsetOf(cell, this->Cells)); });
  }

  /**
   * Lowers each cell to the smaller value of its two neighbours along an axis of n cells. The next
   * cell along the axis is `stride` values away.
   */
  void TakeLeastOfNeighbours(std::size_t stride, std::size_t n)
  {
    constexpr std::size_t longest = 4096; // cells beside each other that a thread handles at once
    const std::size_t strips = (stride - 1) / longest + 1;
    ParallelFor(0, this->Graded.size() / (stride * n) * strips,
      std::max<std::size_t>(longest / (stride * n), 1), this->Threads,
      [&](std::size_t begin, std::size_t end)
      {
        std::vector<float> before; // values of the cells before, not yet lowered
        for (std::size_t s = begin; s < end; ++s)
        {
          const std::size_t offset = s % strips * longest;
          const std::size_t length = std::min(longest, stride - offset);
          float* row = this->Graded.data() + s / strips * stride * n + offset;
          before.assign(row, row + length);
          for (std::size_t k = 0; k < n; ++k, row += stride)
          {
            const float* const behind = k + 1 < n ? row + stride : row;
            for (std::size_t c = 0; c < length; ++c)
            {
              const float own = row[c];
              row[c] = std::min(std::min(before[c], own), behind[c]);
              before[c] = own;
            }
          }
        }
      });
  }

  /** The cell nearest to p. */
  std::size_t CellOf(const Point<D>& p) const
  {
    const Point<D> index = this->Grid.ToIndex(p);
    Index cell;
    for (std::size_t a = 0; a < D; ++a)
    {
      cell[a] = this->CellAlong(a, index[a]);
    }
    return OffsetOf(cell, this->Cells);
  }

  /** The cell along axis a nearest to a coordinate of the image's index space. */
  std::int64_t CellAlong(std::size_t a, double index) const
  {
    const double x = (index - static_cast<double>(this->Origin[a]) + 0.5) / Cell;
    return static_cast<std::int64_t>(std::clamp(x, 0.0, static_cast<double>(this->Cells[a] - 1)));
  }

  const unsigned Threads;
  GridGeometry<D> Grid;
  Index Origin;
  Index Cells{};
  Point<D> VoxelsPerLength;
  std::vector<Bound> Values;           ///< empty: no bound is set
  std::vector<float> Spacings;         ///< the values at which GradedAt() starts
  std::vector<float> Graded;           ///< the values of GradedAt() at the centres of cells
  std::vector<std::uint8_t> IsLowered; ///< see Lowered()
  double SmallestBound = std::numeric_limits<double>::infinity();
};

} // namespace voxplex

#endif
