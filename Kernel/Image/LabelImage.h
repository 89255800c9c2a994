// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelImage.h
 * @brief The kernel's label image: dense label ids, cropped to the foreground.
 */
#ifndef voxplex_LabelImage_h
#define voxplex_LabelImage_h

#include "Base/GridIndex.h"
#include "Base/UninitialisedVector.h"
#include "Image/GridGeometry.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** Dense label id: 0 is background, 1 ... n are the image's labels in increasing order of value. */
using LabelId = std::uint32_t;

/**
 * As many labels as an image of so many voxels may have: regions have 8 voxels on average, at least, unless there are
 * few labels. Fewer voxels have grey values (GreyValues.h).
 */
constexpr std::size_t MaximumNumberOfLabels(std::size_t voxels)
{
  constexpr std::size_t few = 65000;
  constexpr std::size_t most = 0xfffffff0; // JunctionLattice has ids of its own
  return std::clamp(voxels / 8, few, most);
}

/**
 * The labels to mesh; all by default. The other labels become background. If there are some to keep, so do whole
 * numbers that are no labels (negative ones, for example), and only what is kept counts against MaximumNumberOfLabels().
 */
struct LabelSelection
{
  std::vector<std::int64_t> Only; ///< only these labels, in any order; empty means all
  std::vector<std::int64_t> But;  ///< without these labels, in any order
};

/**
 * Checks a grid, and that it has as many voxels as scalars.
 * @throws InputError if there are fewer than two voxels along an axis; if the numbers of scalars
 *   and voxels differ; if a spacing is not positive and finite; if the matrix is not upper
 *   triangular
 */
template <int D>
void CheckGrid(const GridGeometry<D>& grid, std::size_t scalars);

/**
 * @brief Dense labels of the bounding box of the foreground. Everything outside is background.
 *
 * Several threads may read it at the same time while no thread changes it.
 */
template <int D>
class LabelImage
{
public:
  using Index = typename GridGeometry<D>::Index;

  /**
   * Reads the scalars of an image. The first axis varies fastest.
   *
   * @param scalars one value per voxel, of any arithmetic type. Values must be labels (LabelValue.h
   *   says which are). 0 is background.
   * @param selection the labels to mesh
   * @param threads number of threads; 0 means all cores
   * @throws Cancelled if a stop was requested before the end
   * @throws InputError if CheckGrid() fails; if a value is fractional, negative or not finite (the
   *   message has the value and its index); if there is no foreground; if there are more than
   *   MaximumNumberOfLabels() labels; if a selected or excluded label does not occur; if no label is
   *   left
   */
  template <typename T>
  static LabelImage FromScalars(std::span<const T> scalars, const GridGeometry<D>& grid,
    const LabelSelection& selection = {}, unsigned threads = 1, const std::stop_token& stop = {});

  /**
   * The same labels on other frames of a space-time image, which covers the same time.
   * @param grid the whole new image
   * @param origin the new bounding box, in indices of the new grid
   * @param extent voxels of the new bounding box
   * @param ids dense ids of the new bounding box
   */
  LabelImage WithFrames(const GridGeometry<D>& grid, const Index& origin, const Index& extent,
    UninitialisedVector<LabelId> ids) const;

  /** The grid of the whole image. */
  const GridGeometry<D>& Grid() const { return this->WholeGrid; }

  /** First voxel of the bounding box of the foreground, in indices of the whole grid. */
  const Index& CropOrigin() const { return this->Origin; }
  /** Voxels of the bounding box along each axis. */
  const Index& CropDimensions() const { return this->Extent; }
  /**
   * Gives a run of voxels along the first axis another label. Counts() are updated. Values() and
   * the bounding box do not change, even if the count of a label becomes 0.
   * @param first index of the run's first voxel in the bounding box
   */
  void Relabel(const Index& first, std::int64_t length, LabelId label);

  /**
   * Changes the value of a label.
   * @param value must keep the increasing order of Values()
   */
  void SetValue(LabelId label, std::int64_t value) { this->LabelValues[label] = value; }

  /** Dense ids of the bounding box, first axis fastest. */
  std::span<const LabelId> Ids() const { return this->Voxels; }

  /** Dense id of a voxel of the bounding box; 0 outside the box. */
  LabelId At(const Index& voxel) const
  {
    std::int64_t at = 0;
    for (std::size_t a = D; a-- > 0;)
    {
      if (voxel[a] < 0 || voxel[a] >= this->Extent[a])
      {
        return 0;
      }
      at = at * this->Extent[a] + voxel[a];
    }
    return this->Voxels[static_cast<std::size_t>(at)];
  }

  /** Dense ids of the row of the box along the first axis at an index; empty outside the box. */
  std::span<const LabelId> RowAt(const Index& voxel) const
  {
    for (std::size_t a = 1; a < D; ++a)
    {
      if (voxel[a] < 0 || voxel[a] >= this->Extent[a])
      {
        return {};
      }
    }
    const auto length = static_cast<std::size_t>(this->Extent[0]);
    return std::span(this->Voxels).subspan(RowOf(voxel, this->Extent) * length, length);
  }

  /**
   * Dense id at an index of a field's lattice, which begins one layer before the bounding box
   * (TiledLattice). Fields extend beyond a flat end of a space-time image; this function returns 0
   * there.
   */
  LabelId AtLattice(Index lattice) const
  {
    for (std::int64_t& i : lattice)
    {
      --i;
    }
    return this->At(lattice);
  }

  /** The centre of a voxel in the frame of Grid(). The index may be outside the bounding box. */
  Point<D> CentreOf(const Index& voxel) const
  {
    Point<D> index;
    for (std::size_t a = 0; a < D; ++a)
    {
      index[a] = static_cast<double>(this->Origin[a] + voxel[a]);
    }
    return this->WholeGrid.ToFrame(index);
  }

  /** Where a point is in the bounding box, in indices; the inverse of CentreOf(). */
  Point<D> ToCrop(const Point<D>& p) const
  {
    Point<D> index = this->WholeGrid.ToIndex(p);
    for (std::size_t a = 0; a < D; ++a)
    {
      index[a] -= static_cast<double>(this->Origin[a]);
    }
    return index;
  }
  /** The voxel whose centre is nearest to a point, along each axis. It may be outside the bounding box. */
  Index VoxelAt(const Point<D>& p) const { return NearestIndex(this->ToCrop(p)); }

  /**
   * Whether the first (end 0) or last (end 1) frame of a space-time image has foreground. Then the
   * object is cut there, and has a flat end. False in 3D, and if the time axis is not orthogonal to
   * space.
   */
  bool ReachesBorderInTime(unsigned end) const { return this->CutInTime[end]; }

  /**
   * Whether the last frame of a space-time image is the first one again. Then fields continue
   * beyond the last frame as after the first one, and before the first as before the last.
   */
  bool IsPeriodicInTime() const { return this->Periodic; }
  /**
   * Makes the image periodic in time.
   * @throws InputError if the first and the last frame differ, with a voxel where they do
   */
  void MakePeriodicInTime();

  /**
   * Whether the first (end 0) or last (end 1) layer of voxels along an axis of a 3D image has
   * foreground. Then the outer faces of these voxels cut the object. False in 4D.
   */
  bool ReachesBorder(std::size_t axis, unsigned end) const
  {
    return D == 3 &&
      (end == 0 ? this->Origin[axis] == 0
                : this->Origin[axis] + this->Extent[axis] == this->WholeGrid.Dimensions[axis]);
  }

  /** The image's label value of each dense id; Values()[0] = 0. */
  std::span<const std::int64_t> Values() const { return this->LabelValues; }
  /** Number of voxels of each dense id. Background is counted in the bounding box only. */
  std::span<const std::int64_t> Counts() const { return this->LabelCounts; }
  int NumberOfLabels() const { return static_cast<int>(this->LabelValues.size()) - 1; }

private:
  GridGeometry<D> WholeGrid;
  Index Origin{};
  Index Extent{};
  UninitialisedVector<LabelId> Voxels;
  std::vector<std::int64_t> LabelValues;
  std::vector<std::int64_t> LabelCounts;
  std::array<bool, 2> CutInTime{};
  bool Periodic = false;
};

} // namespace voxplex

#endif
