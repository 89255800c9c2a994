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
#include "Sizing/SparseCells.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief An upper bound of the sampling distance of one label's interfaces in each cell of a few
 * voxels; infinite at first.
 *
 * A query is one or a few look-ups. Memory and time depend on the places where bounds are set, not
 * on the image. If two labels have a bound in one cell, the smaller bound holds.
 * Queries may run in any number of threads, but not beside SetBound(), SetSpacing() and Grade().
 */
template <int D>
class LocalDelta
{
public:
  using Index = typename GridGeometry<D>::Index;

  /** Edge of a cell in voxels. */
  static constexpr std::int64_t Cell = 2;

  /** A bound, and the label whose interfaces it is for. */
  struct Bound
  {
    float Delta = std::numeric_limits<float>::infinity();
    LabelId Label = 0;
  };

  explicit LocalDelta(const LabelImage<D>& image)
    : Grid(image.Grid())
    , Origin(image.CropOrigin())
    , Cells(CellCounts(image))
    , VoxelsPerLength(image.Grid().VoxelsPerLength())
    , Values(Cells, Bound())
    , Graded(Cells, std::numeric_limits<float>::infinity())
  {
  }

  /**
   * Lowers the bound in all cells within a voxel of a run of voxels. `first` is an index of the
   * crop.
   */
  void SetBound(const Index& first, std::int64_t length, LabelId label, double delta)
  {
    this->ForCellsNear(first, length,
      [&](const Index& cell)
      {
        if (delta < this->Values.At(cell).Delta)
        {
          this->Values.Write(cell) = { static_cast<float>(delta), label };
          this->LoweredList.push_back(cell);
        }
      });
    this->SetSpacing(first, length, delta);
  }

  /**
   * Records the spacing of vertices there for GradedAt(); does not constrain the rules.
   */
  void SetSpacing(const Index& first, std::int64_t length, double spacing)
  {
    this->ForCellsNear(first, length,
      [&](const Index& cell)
      { this->Spacings.emplace_back(OffsetOf(cell, this->Cells), static_cast<float>(spacing)); });
    this->SmallestBound = std::min(this->SmallestBound, spacing);
  }
  /** The bound at a point of the frame; outside of the crop that of the nearest cell. */
  Bound At(const Point<D>& p) const
  {
    return this->Values.IsEmpty() ? Bound() : this->Values.At(this->CellOf(p));
  }

  /**
   * The smallest of all bounds at a point, if each bound grows by `Slope` times the distance along
   * the axes from where it was set. It is as of the last Grade(), and nowhere in a cell above the
   * cell's own bound. Where it is below the length that Grade() was given it is continuous;
   * elsewhere it may be too large.
   */
  double GradedAt(const Point<D>& p) const
  {
    if (this->Graded.IsEmpty())
    {
      return std::numeric_limits<double>::infinity();
    }
    const Point<D> index = this->Grid.ToIndex(p);
    Index lower; // the cells whose centres are around p
    Index upper;
    Point<D> fraction;
    for (std::size_t a = 0; a < D; ++a)
    {
      const auto last = static_cast<double>(this->Cells[a] - 1);
      const double x =
        std::clamp((index[a] - static_cast<double>(this->Origin[a]) + 0.5) / Cell - 0.5, 0.0, last);
      lower[a] = static_cast<std::int64_t>(x);
      fraction[a] = x - static_cast<double>(lower[a]);
      upper[a] = lower[a] + (fraction[a] > 0.0 ? 1 : 0);
    }
    if (this->Graded.HasNone(lower, upper))
    {
      return std::numeric_limits<double>::infinity();
    }
    double sum = 0.0;
    for (unsigned corner = 0; corner < (1u << D); ++corner)
    {
      double weight = 1.0;
      Index cell;
      for (std::size_t a = 0; a < D; ++a)
      {
        const bool isUpper = ((corner >> a) & 1u) != 0;
        weight *= isUpper ? fraction[a] : 1.0 - fraction[a];
        cell[a] = isUpper ? upper[a] : lower[a];
      }
      if (weight > 0.0) // the value may be infinite
      {
        sum += weight * static_cast<double>(this->Graded.At(cell));
      }
    }
    return sum;
  }

  /** Whether SetBound() has lowered the bound of any cell since the last ForgetLowered(). */
  bool HasLowered() const { return !this->LoweredList.empty(); }

  /** The cells that were lowered since then; some of them several times. */
  const std::vector<Index>& Lowered() const { return this->LoweredList; }

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

  /** The cell nearest to p. */
  Index CellOf(const Point<D>& p) const
  {
    const Point<D> index = this->Grid.ToIndex(p);
    Index cell;
    for (std::size_t a = 0; a < D; ++a)
    {
      cell[a] = this->CellAlong(a, index[a]);
    }
    return cell;
  }

  /** A point in a cell. @param fraction of the way through the cell, along each axis */
  Point<D> PointIn(const Index& cell, double fraction) const
  {
    Point<D> index;
    for (std::size_t a = 0; a < D; ++a)
    {
      index[a] = static_cast<double>(this->Origin[a]) - 0.5 +
        (static_cast<double>(cell[a]) + fraction) * Cell;
    }
    return this->Grid.ToFrame(index);
  }

  void ForgetLowered() { this->LoweredList.clear(); }

  /** Growth of bounds over a unit of length. */
  static constexpr double Slope = 0.25;

  /**
   * Prepares GradedAt(), which will be exact where it is below `needed`. The time depends on the
   * number of cells that bounds set since the last call reach.
   *
   * A bound first holds in its cell and in the cells around it, too. GradedAt() interpolates
   * between the centres of cells, so it stays below a cell's value up to the cell's border. Then
   * values spread along one axis after the other, and stop where they change nothing.
   */
  void Grade(double needed = std::numeric_limits<double>::infinity())
  {
    std::vector<Index> lowered = this->SpreadToNeighbours();
    std::array<float, static_cast<std::size_t>(D)> steps;
    double most = needed; // if one corner of an interpolation is below `needed`, all are below this
    for (std::size_t a = 0; a < D; ++a)
    {
      steps[a] = static_cast<float>(Slope * Cell * this->Grid.Spacing(static_cast<int>(a)));
      most += static_cast<double>(steps[a]);
    }
    const auto limit = static_cast<float>(most * (1.0 + 1e-5));
    for (std::size_t a = 0; a < D; ++a)
    {
      const std::size_t before = lowered.size();
      for (std::size_t k = 0; k < before; ++k)
      {
        this->Spread(lowered[k], a, -1, steps[a], limit, lowered);
        this->Spread(lowered[k], a, 1, steps[a], limit, lowered);
      }
    }
  }

  /** The smallest bound that was set; infinite if none was. */
  double Smallest() const { return this->SmallestBound; }

  /** Memory held in bytes. */
  std::size_t MemoryBytes() const
  {
    return this->Values.MemoryBytes() + this->Graded.MemoryBytes();
  }

private:
  static Index CellCounts(const LabelImage<D>& image)
  {
    Index cells;
    for (std::size_t a = 0; a < D; ++a)
    {
      cells[a] = (image.CropDimensions()[a] - 1) / Cell + 1;
    }
    return cells;
  }

  /** Calls function(cell) for all cells within a voxel of a run of voxels. */
  template <typename Function>
  void ForCellsNear(const Index& first, std::int64_t length, Function&& function)
  {
    Index low;
    Index high;
    for (std::size_t a = 0; a < D; ++a)
    {
      const std::int64_t last = first[a] + (a == 0 ? length - 1 : 0);
      low[a] = std::clamp<std::int64_t>((first[a] - 1) / Cell, 0, this->Cells[a] - 1);
      high[a] = std::clamp<std::int64_t>((last + 1) / Cell, 0, this->Cells[a] - 1);
    }
    ForEachIndex(low, high, function);
  }

  /** Lowers the cells of new spacings and the cells around these. Returns those that it has lowered. */
  std::vector<Index> SpreadToNeighbours()
  {
    std::vector<Index> lowered;
    std::sort(
      this->Spacings.begin(), this->Spacings.end()); // of each cell the smallest comes first
    std::size_t done = std::numeric_limits<std::size_t>::max();
    for (const auto& [offset, spacing] : this->Spacings)
    {
      if (offset == done)
      {
        continue;
      }
      done = offset;
      Index low = IndexAt(offset, this->Cells);
      Index high = low;
      for (std::size_t a = 0; a < D; ++a)
      {
        low[a] = std::max<std::int64_t>(low[a] - 1, 0);
        high[a] = std::min(high[a] + 1, this->Cells[a] - 1);
      }
      ForEachIndex(low, high,
        [&, value = spacing](const Index& cell)
        {
          if (value < this->Graded.At(cell))
          {
            this->Graded.Write(cell) = value;
            lowered.push_back(cell);
          }
        });
    }
    this->Spacings.clear();
    return lowered;
  }

  /** Lowers the cells beyond a cell along an axis, as far as its value goes. Adds them to a list. */
  void Spread(Index cell, std::size_t axis, std::int64_t direction, float step, float limit,
    std::vector<Index>& lowered)
  {
    float value = this->Graded.At(cell) + step;
    for (cell[axis] += direction; cell[axis] >= 0 && cell[axis] < this->Cells[axis] &&
         value < limit && value < this->Graded.At(cell);
         cell[axis] += direction, value += step)
    {
      this->Graded.Write(cell) = value;
      lowered.push_back(cell);
    }
  }

  /** The cell along axis a nearest to a coordinate of the image's index space. */
  std::int64_t CellAlong(std::size_t a, double index) const
  {
    const double x = (index - static_cast<double>(this->Origin[a]) + 0.5) / Cell;
    return static_cast<std::int64_t>(std::clamp(x, 0.0, static_cast<double>(this->Cells[a] - 1)));
  }

  GridGeometry<D> Grid;
  Index Origin;
  Index Cells;
  Point<D> VoxelsPerLength;
  SparseCells<D, Bound> Values;
  SparseCells<D, float> Graded; ///< the values of GradedAt() at the centres of cells
  /** What SetSpacing() has set since the last Grade(), by the numbers of cells. */
  std::vector<std::pair<std::size_t, float>> Spacings;
  std::vector<Index> LoweredList; ///< see Lowered()
  double SmallestBound = std::numeric_limits<double>::infinity();
};

} // namespace voxplex

#endif
