// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GradedGrid.h
 * @brief Lengths that are given at sample points and grow with the distance from them.
 */
#ifndef voxplex_GradedGrid_h
#define voxplex_GradedGrid_h

#include "Base/GridIndex.h"
#include "Image/LabelImage.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

namespace voxplex
{

/**
 * @brief g(p) = min over the samples q of { length(q) + slope |p - q| }: the largest function that
 * is at most length(q) at each sample q and has no more than this slope.
 *
 * Algorithm:
 * 1. The bounding box of the foreground is cut into cells of two voxels along each axis. If these
 *    are more than MostCells, the cells are larger.
 * 2. Each cell keeps the smallest length of its samples, and the bounding box of the samples that
 *    have it.
 * 3. Each cell finds the source of its centre: the cell whose samples make g smallest there.
 *    Neighbours hand on their sources, row by row along each axis, forth and back, until nothing
 *    changes. Distances are measured to the samples' box itself and are no sums of steps, so they
 *    are Euclidean for every spacing and all axes.
 * 4. A query takes the smaller value of two: that of the source of the cell of p, and that of the
 *    cell's own samples.
 *
 * Error:
 * - If each cell has one sample, At() exceeds g by no more than slope times the diagonal of a cell,
 *   and only where two sources compete for the centre of a cell.
 * - If a cell has several samples, At() may miss g by as much in either direction.
 *
 * Source of the limit: P.-O. Persson, "Mesh size functions for implicit geometries and PDE-based
 * gradient limiting", Engineering with Computers 22 (2006). It solves |grad g| = slope by fast
 * marching.
 *
 * Queries may run in any number of threads. Building takes time linear in the number of voxels plus
 * a few times the number of cells. The grid takes 32 bytes a cell in 3D and 40 in 4D. The result
 * does not depend on the number of threads.
 */
template <int D>
class GradedGrid
{
public:
  using Index = typename GridGeometry<D>::Index;

  static constexpr std::int64_t SmallestCell = 2; ///< voxels along an axis
  static constexpr std::size_t MostCells = std::size_t(1) << 20;

  /** No lengths are given: At() is infinite. */
  GradedGrid() = default;

  /**
   * @param slope growth over a unit of length, positive
   * @param sample void(const Index& voxel, LabelId id, auto&& add): calls add(index, length) for
   *   each sample that belongs to a voxel. `index` is a continuous index of the bounding box of the
   *   foreground. The function is called for every voxel that is not background, from several
   *   threads at once. A length that is not positive and finite is left out.
   * @throws Cancelled if a stop was requested before the end
   */
  template <typename Sample>
  GradedGrid(const LabelImage<D>& image, double slope, Sample&& sample, unsigned threads,
    const std::stop_token& stop = {})
    : Grid(image.Grid())
    , Origin(image.CropOrigin())
    , Slope(slope)
  {
    this->Edge = SmallestCell - 1;
    do
    {
      ++this->Edge;
      for (std::size_t a = 0; a < D; ++a)
      {
        this->Cells[a] = (image.CropDimensions()[a] - 1) / this->Edge + 1;
      }
    } while (CountCells(this->Cells) > MostCells);
    const std::size_t count = CountCells(this->Cells);
    this->Places.resize(count);
    this->Source.resize(count);
    std::iota(this->Source.begin(), this->Source.end(), 0u);
    ParallelFor(
      0, count, 256, threads,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t c = first; c < last; ++c)
        {
          this->SampleCell(image, c, sample);
        }
      },
      stop);
    this->HandOn(threads, stop);
  }

  /** g(p) for a point of the frame, inside or outside of the box. */
  double At(const Point<D>& p) const
  {
    if (this->Places.empty())
    {
      return std::numeric_limits<double>::infinity();
    }
    const std::uint32_t cell = this->CellOf(p);
    const double handedOn = this->From(this->Source[cell], p);
    return this->Source[cell] == cell ? handedOn : std::min(handedOn, this->From(cell, p));
  }

  /** Upper bound of the error of At(); see the class. */
  double Tolerance() const
  {
    double diagonal = 0.0;
    for (int a = 0; a < D; ++a)
    {
      diagonal += this->Grid.Spacing(a); // at least the diagonal, for any axes
    }
    return this->Slope * diagonal * static_cast<double>(this->Edge);
  }

  /**
   * The smallest and the largest length that a cell keeps; infinite and 0 if there are no samples.
   */
  std::array<double, 2> Range() const
  {
    std::array<double, 2> range{ std::numeric_limits<double>::infinity(), 0.0 };
    for (const CellSamples& place : this->Places)
    {
      if (std::isfinite(place.Length))
      {
        range[0] = std::min<double>(range[0], place.Length);
        range[1] = std::max<double>(range[1], place.Length);
      }
    }
    return range;
  }

private:
  static constexpr float None = std::numeric_limits<float>::infinity();

  /**
   * The smallest length of a cell's samples, and the bounding box in the frame of the samples with
   * it.
   */
  struct CellSamples
  {
    float Length = None;
    std::array<float, static_cast<std::size_t>(D)> Low{};
    std::array<float, static_cast<std::size_t>(D)> High{};
  };

  template <typename Sample>
  void SampleCell(const LabelImage<D>& image, std::size_t cell, Sample& sample)
  {
    const Index& extent = image.CropDimensions();
    Index first = IndexAt(cell, this->Cells);
    Index last;
    for (std::size_t a = 0; a < D; ++a)
    {
      first[a] *= this->Edge;
      last[a] = std::min(first[a] + this->Edge, extent[a]) - 1;
    }
    double smallest = std::numeric_limits<double>::infinity();
    // The bounding box of the samples, in continuous indices of the foreground's bounding box.
    Point<D> low{};
    Point<D> high{};
    const auto add = [&](const Point<D>& index, double length)
    {
      if (length < smallest && length > 0.0)
      {
        smallest = length;
        low = index;
        high = index;
      }
      else if (length == smallest)
      {
        for (std::size_t a = 0; a < D; ++a)
        {
          low[a] = std::min(low[a], index[a]);
          high[a] = std::max(high[a], index[a]);
        }
      }
    };
    ForEachIndex(first, last,
      [&](const Index& voxel)
      {
        const LabelId id = image.Ids()[OffsetOf(voxel, extent)];
        if (id != 0)
        {
          sample(voxel, id, add);
        }
      });
    this->Places[cell] = this->MakeCellSamples(smallest, low, high);
  }

  /**
   * If the axes are oblique, the box in the frame is larger than the box of indices, and lengths
   * come out smaller.
   */
  CellSamples MakeCellSamples(double length, const Point<D>& low, const Point<D>& high) const
  {
    CellSamples place;
    place.Length = static_cast<float>(length);
    for (std::size_t r = 0; r < D; ++r)
    {
      double least = 0.0;
      double most = 0.0;
      for (std::size_t c = r; c < D; ++c)
      {
        const double x =
          (low[c] + static_cast<double>(this->Origin[c])) * this->Grid.IndexToFrame[r][c];
        const double y =
          (high[c] + static_cast<double>(this->Origin[c])) * this->Grid.IndexToFrame[r][c];
        least += std::min(x, y);
        most += std::max(x, y);
      }
      place.Low[r] = static_cast<float>(least);
      place.High[r] = static_cast<float>(most);
    }
    return place;
  }

  /**
   * Finds the source of every cell. Rows of cells along an axis are independent, so threads share
   * them.
   */
  void HandOn(unsigned threads, const std::stop_token& stop)
  {
    std::vector<float> values(this->Places.size());
    for (std::size_t c = 0; c < values.size(); ++c)
    {
      values[c] = static_cast<float>(this->From(static_cast<std::uint32_t>(c), this->CentreOf(c)));
    }
    // Three rounds are enough for the atlases of Documentation/Benchmarks.md.
    constexpr int MostRounds = 16;
    std::atomic<bool> changed{ true };
    for (int round = 0; round < MostRounds && changed; ++round)
    {
      changed = false;
      std::size_t stride = 1;
      for (std::size_t a = 0; a < D; ++a)
      {
        const auto n = static_cast<std::size_t>(this->Cells[a]);
        Point<D> step;
        for (std::size_t r = 0; r < D; ++r)
        {
          step[r] = static_cast<double>(this->Edge) * this->Grid.IndexToFrame[r][a];
        }
        ParallelFor(
          0, values.size() / n, 64, threads,
          [&](std::size_t first, std::size_t last)
          {
            bool any = false;
            for (std::size_t row = first; row < last; ++row)
            {
              any |= this->HandOnInRow(
                row / stride * stride * n + row % stride, n, stride, step, values);
            }
            if (any)
            {
              changed.store(true, std::memory_order_relaxed);
            }
          },
          stop);
        stride *= n;
      }
    }
  }

  /**
   * Hands the sources on along one row. A cell hands nothing to a neighbour whose value is not
   * larger than its own: lengths grow on the straight way from a source.
   * @param step from the centre of a cell to the centre of the next
   */
  bool HandOnInRow(std::size_t start, std::size_t n, std::size_t stride, const Point<D>& step,
    std::vector<float>& values)
  {
    bool any = false;
    const Point<D> origin = this->CentreOf(start);
    const auto handOn = [&](std::size_t i, std::size_t j)
    {
      const std::size_t from = start + i * stride;
      const std::size_t to = start + j * stride;
      if (!(values[from] < values[to]))
      {
        return;
      }
      Point<D> centre;
      for (std::size_t a = 0; a < D; ++a)
      {
        centre[a] = origin[a] + static_cast<double>(j) * step[a];
      }
      const float value = static_cast<float>(this->From(this->Source[from], centre));
      if (value < values[to])
      {
        values[to] = value;
        this->Source[to] = this->Source[from];
        any = true;
      }
    };
    for (std::size_t i = 1; i < n; ++i)
    {
      handOn(i - 1, i);
    }
    for (std::size_t i = n - 1; i-- > 0;)
    {
      handOn(i + 1, i);
    }
    return any;
  }

  /** The length at p by the samples of one cell. */
  double From(std::uint32_t source, const Point<D>& p) const
  {
    const CellSamples& place = this->Places[source];
    double distance2 = 0.0;
    for (std::size_t a = 0; a < D; ++a)
    {
      const double outside =
        std::max({ 0.0, place.Low[a] - p[a], p[a] - static_cast<double>(place.High[a]) });
      distance2 += outside * outside;
    }
    return place.Length + this->Slope * std::sqrt(distance2);
  }

  Point<D> CentreOf(std::size_t cell) const
  {
    const Index at = IndexAt(cell, this->Cells);
    Point<D> index;
    for (std::size_t a = 0; a < D; ++a)
    {
      index[a] = static_cast<double>(this->Origin[a]) - 0.5 +
        (static_cast<double>(at[a]) + 0.5) * static_cast<double>(this->Edge);
    }
    return this->Grid.ToFrame(index);
  }

  /** The cell nearest to p. */
  std::uint32_t CellOf(const Point<D>& p) const
  {
    const Point<D> index = this->Grid.ToIndex(p);
    std::size_t cell = 0;
    for (std::size_t a = D; a-- > 0;)
    {
      const double x =
        (index[a] - static_cast<double>(this->Origin[a]) + 0.5) / static_cast<double>(this->Edge);
      cell = cell * static_cast<std::size_t>(this->Cells[a]) +
        static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(this->Cells[a] - 1)));
    }
    return static_cast<std::uint32_t>(cell);
  }

  GridGeometry<D> Grid;
  Index Origin{};
  Index Cells{};
  std::int64_t Edge = SmallestCell; ///< edge of a cell, in voxels
  double Slope = 0.0;
  std::vector<CellSamples> Places;   ///< by cell
  std::vector<std::uint32_t> Source; ///< by cell: the source of its centre
};

} // namespace voxplex

#endif
