// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FeatureTransform.h
 * @brief The nearest site of every point of a lattice (exact Euclidean feature transform).
 */
#ifndef voxplex_FeatureTransform_h
#define voxplex_FeatureTransform_h

#include "Base/UninitialisedVector.h"
#include "Geometry/Point.h"
#include "Image/BitMask.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stop_token>

namespace voxplex
{

/**
 * @brief Nearest site of every cell centre of a lattice that may be coarser than the sites' grid.
 *
 * Sites are voxels of a grid. The grid is divided into cells of Stride()[a] voxels along axis a.
 * The last cells may extend beyond the grid. The query point of a cell is its centre. If all
 * strides are 1, the cells are the voxels, and this is the usual feature transform. The result is
 * exact for any stride: larger strides reduce the cost, not the precision. Lengths are those of
 * orthogonal axes with the given spacings.
 *
 * The algorithm is separable. It treats one axis after the other, by lower envelopes of parabolas
 * (Maurer, Qi and Raghavan 2003, cited in section 3.1 of the thesis; Meijster et al. 2000). The
 * time of the first pass is linear in the voxels; it reads 64 of them at once. The time of a later
 * pass is linear in its partial results. Their number is divided by the stride along each axis. If
 * several sites are equally near, the result is any of them. The result does not depend on the
 * number of threads.
 *
 * Immutable after construction, and thread-safe.
 */
template <int D>
class FeatureTransform
{
public:
  using Index = typename GridGeometry<D>::Index;
  using Array = std::array<std::uint32_t, static_cast<std::size_t>(D)>;

  /** The result of a query if there are no sites. */
  static constexpr std::uint32_t NoSite = std::numeric_limits<std::uint32_t>::max();

  /**
   * @param sites marks the voxels that are sites; fewer than 2^32 - 1 voxels
   * @param spacing length of a voxel along each axis, positive
   * @param stride voxels of a cell along each axis, at least 1
   * @param threads number of threads; 0 means all cores. The result does not depend on it.
   * @param stop ends the construction early; the default never stops
   * @throws InputError if the grid has too many voxels; Cancelled if a stop was requested;
   *   std::bad_alloc
   */
  FeatureTransform(const BitMask<D>& sites, const Point<D>& spacing, const Array& stride,
    unsigned threads = 1, const std::stop_token& stop = {});

  const Array& Stride() const { return this->CellStride; }
  /** Cells along each axis. */
  const Array& CellDimensions() const { return this->Cells; }
  std::size_t NumberOfCells() const { return this->Features.size(); }

  /** Linear index of the voxel that is the nearest site of a cell's centre, or NoSite. */
  std::uint32_t Site(std::size_t cell) const { return this->Features[cell]; }
  /** Distance from the cell's centre to its nearest site, to float precision; infinity if there are
   * no sites. */
  float Distance(std::size_t cell) const { return this->Distances[cell]; }

  /** Index of a voxel from its linear index. */
  Index IndexOf(std::uint32_t voxel) const
  {
    Index index;
    for (std::size_t a = 0; a + 1 < D; ++a)
    {
      const std::uint32_t q = voxel / this->Voxels[a];
      index[a] = voxel - q * this->Voxels[a];
      voxel = q;
    }
    index[D - 1] = voxel;
    return index;
  }

  /** Coordinate (continuous index) of the centre of cell c along an axis. */
  double Centre(std::size_t axis, std::size_t c) const
  {
    return static_cast<double>(c * this->CellStride[axis]) + this->CentreOffset[axis];
  }

  /** The cell that contains a coordinate along an axis, clamped to the first and the last cell. */
  std::uint32_t CellOf(std::size_t axis, double coordinate) const
  {
    const double c = (coordinate + 0.5) * this->InverseStride[axis];
    const auto last = static_cast<double>(this->Cells[axis] - 1);
    return static_cast<std::uint32_t>(c > 0.0 ? (c < last ? c : last) : 0.0);
  }

  std::size_t MemoryBytes() const
  {
    return this->Features.size() * (sizeof(std::uint32_t) + sizeof(float));
  }

private:
  class Envelope;

  void FirstPass(const BitMask<D>& sites, unsigned threads, const std::stop_token& stop);
  void Pass(std::size_t axis, unsigned threads, const std::stop_token& stop);
  double LowerDistance2(
    std::size_t axes, std::uint32_t site, const std::array<double, D>& query) const;

  Array Voxels{};
  Array Cells{};
  Array CellStride{};
  Point<D> Spacing{};
  Point<D> CentreOffset{};
  Point<D> InverseStride{};
  UninitialisedVector<std::uint32_t> Features;
  UninitialisedVector<float> Distances;
};

extern template class FeatureTransform<3>;
extern template class FeatureTransform<4>;

} // namespace voxplex

#endif
