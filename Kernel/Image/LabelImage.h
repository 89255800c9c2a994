// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelImage.h
 * @brief A label image as the kernel keeps it: dense label ids, cropped to the foreground.
 */
#ifndef voxplex_LabelImage_h
#define voxplex_LabelImage_h

#include "Base/UninitialisedVector.h"
#include "Image/GridGeometry.h"

#include <array>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** Dense label id: 0 is background, 1 ... n are the image's labels in increasing order of value. */
using LabelId = std::uint16_t;

/** More distinct labels than this and the image is taken for a grey-value image. */
inline constexpr int MaximumNumberOfLabels = 2000;

/** Which labels of an image to mesh; the others become background. By default all. */
struct LabelSelection
{
  std::vector<std::int64_t> Only; ///< these, in any order; none means all
  std::vector<std::int64_t> But;  ///< but not these, in any order
};

/**
 * @throws InputError: fewer than two voxels along an axis, another number of scalars than of voxels, a
 *   spacing that is not positive and finite, a matrix that is not upper triangular
 */
template <int D>
void CheckGrid(const GridGeometry<D>& grid, std::size_t scalars);

/**
 * @brief Dense labels of the bounding box of the foreground; everything outside is background.
 *
 * Safe to read from any thread while nobody calls Relabel().
 */
template <int D>
class LabelImage
{
public:
  using Index = typename GridGeometry<D>::Index;

  /**
   * Reads the scalars of an image: the first axis varies fastest.
   *
   * @param scalars one value per voxel; 0 is background. Any arithmetic type; values must be whole,
   *   finite and not negative.
   * @param selection which labels to mesh
   * @param threads threads used for the conversion; 0 means all cores
   * @throws Cancelled if a stop was requested before the end
   * @throws InputError: fewer than two voxels along an axis, spacing not positive and finite,
   *   fractional, negative or non-finite values (says which value and at which index), no foreground,
   *   more than MaximumNumberOfLabels labels (a grey-value image?), a selected or excluded label
   *   that does not occur, no label left
   */
  template <typename T>
  static LabelImage FromScalars(std::span<const T> scalars, const GridGeometry<D>& grid,
    const LabelSelection& selection = {}, unsigned threads = 1, const std::stop_token& stop = {});

  /** The whole grid, as given. */
  const GridGeometry<D>& Grid() const { return this->WholeGrid; }

  /** First voxel of the bounding box of the foreground, in indices of the whole grid. */
  const Index& CropOrigin() const { return this->Origin; }
  /** Voxels of the bounding box along each axis. */
  const Index& CropDimensions() const { return this->Extent; }
  /**
   * Gives a run of voxels along the first axis another label. Counts() follow; Values() stay, if with a
   * count of 0, and so does the bounding box.
   * @param first an index of the bounding box
   */
  void Relabel(const Index& first, std::int64_t length, LabelId label);

  /**
   * Gives a label another value than that of the image.
   * @param value above that of the label before and below that of the one after
   */
  void SetValue(LabelId label, std::int64_t value) { this->LabelValues[label] = value; }

  /** Dense ids of the bounding box, first axis fastest. */
  std::span<const LabelId> Ids() const { return this->Voxels; }

  /** Dense id of a voxel of the bounding box; 0 for all beyond it. */
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

  /**
   * The same at an index of the lattice of a field, which begins one layer before the bounding box
   * (TiledLattice). Fields go on beyond the cut of a space-time image; this does not.
   */
  LabelId AtLattice(Index lattice) const
  {
    for (std::int64_t& i : lattice)
    {
      --i;
    }
    return this->At(lattice);
  }

  /** The centre of a voxel of the bounding box, or beyond it, in the frame of Grid(). */
  Point<D> CentreOf(const Index& voxel) const
  {
    Point<D> index;
    for (std::size_t a = 0; a < D; ++a)
    {
      index[a] = static_cast<double>(this->Origin[a] + voxel[a]);
    }
    return this->WholeGrid.ToFrame(index);
  }

  /**
   * Whether the first (0) or last (1) frame of a space-time image has foreground, so that the object
   * is cut there and ends flat; false in 3D, and if the time axis is not orthogonal to space.
   */
  bool IsCutInTime(unsigned end) const { return this->CutInTime[end]; }

  /**
   * Whether the first (0) or last (1) layer of voxels along an axis of a 3D image has foreground, so that
   * the object is cut by the outer faces of these voxels; false in 4D.
   */
  bool IsCut(std::size_t axis, unsigned end) const
  {
    return D == 3 &&
      (end == 0 ? this->Origin[axis] == 0
                : this->Origin[axis] + this->Extent[axis] == this->WholeGrid.Dimensions[axis]);
  }

  /** The image's label value of each dense id; Values()[0] = 0. */
  std::span<const std::int64_t> Values() const { return this->LabelValues; }
  /** Voxels of each dense id (that of background counts the bounding box only). */
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
};

} // namespace voxplex

#endif
