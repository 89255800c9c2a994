// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file IsosurfaceImage.h
 * @brief A grey-value image, and the isosurface that bounds the meshed region.
 */
#ifndef voxplex_IsosurfaceImage_h
#define voxplex_IsosurfaceImage_h

#include "Base/GridIndex.h"
#include "Image/LabelImage.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>

namespace voxplex
{

/** The side of the isovalue that is inside. A voxel with exactly the isovalue is always inside. */
enum class IsosurfaceSide
{
  Above, ///< inside is value >= isovalue
  Below  ///< inside is value <= isovalue
};

/** The isosurface to mesh. */
struct Isosurface
{
  double Value = 0.0;
  IsosurfaceSide Inside = IsosurfaceSide::Above;
  std::int64_t Label = 1; ///< label of the inside; at least 1
  /**
   * Standard deviation of a smoothing of the values, in voxels along each axis, from 0 to
   * LargestSigma. It reduces noise, and is done before anything else. The default 0 means no
   * smoothing: grey values already define the surface to a fraction of a voxel, without the
   * staircase of a label image.
   */
  double SmoothingSigma = 0.0;
  /**
   * 4D only. The last frame is the first one again, and must be equal to it. Then the smoothing and the values
   * continue beyond the last frame as after the first one; see LabelImage::IsPeriodicInTime().
   */
  bool PeriodicInTime = false;

  static constexpr double LargestSigma = 5.0;
};

/**
 * @brief The voxels inside an isosurface as a label image, and the margins of all voxels.
 *
 * The *margin* of a voxel is value - isovalue (isovalue - value if the inside is below), times a
 * power of two that brings the image's largest margin near 1. If the margin is at least 0, the
 * voxel is inside. Voxels whose value is NaN are outside, and so is everything beyond the image.
 *
 * Smoothing uses the separable kernel (1 + c) g - c g*g of LabelField, with a second moment of 0.
 * It does not change linear and quadratic functions. So it preserves planes, and nearly preserves
 * curved surfaces. At the image's border the outermost values are repeated, except in time if the image is periodic.
 */
template <int D>
class IsosurfaceImage
{
public:
  using Index = typename GridGeometry<D>::Index;

  /**
   * @param scalars one value per voxel, first axis fastest, of any arithmetic type; they are
   *   compared as double. Unless they are smoothed, they must live as long as this object.
   * @param threads threads of this function; 0 means all cores. The result does not depend on it.
   * @throws InputError if the isovalue is not finite, or outside the image's range (the message has
   *   the range); if all values are NaN; if the image is to be periodic and is not; if the label is below 1; if sigma is out of range; and for
   *   the reasons of CheckGrid()
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  template <typename T>
  static IsosurfaceImage FromScalars(std::span<const T> scalars, const GridGeometry<D>& grid,
    const Isosurface& surface, unsigned threads = 1, const std::stop_token& stop = {});

  /** Voxels that are inside have the id 1. The other voxels are background. */
  const LabelImage<D>& Labels() const { return this->Inside; }
  /** Write access, to remove components. Background voxels count as outside, for any margin. */
  LabelImage<D>& Labels() { return this->Inside; }

  const Isosurface& Surface() const { return this->Which; }
  /** Smallest and largest value of the image, after smoothing, including infinite values. */
  const std::array<double, 2>& Range() const { return this->Values; }

  /**
   * Margins of a run of voxels along the first axis; NaN if the voxel's value is NaN.
   * @param first index of the run's first voxel in the whole grid
   */
  void ReadMargins(const Index& first, std::size_t count, float* margins) const
  {
    this->Read(OffsetOf(first, this->Inside.Grid().Dimensions), count, margins);
  }

private:
  Isosurface Which;
  LabelImage<D> Inside;
  std::array<double, 2> Values{};
  std::function<void(std::size_t first, std::size_t count, float* margins)> Read;
};

} // namespace voxplex

#endif
