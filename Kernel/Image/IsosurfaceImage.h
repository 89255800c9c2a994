// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file IsosurfaceImage.h
 * @brief A grey-value image and the isosurface in it that bounds what is meshed.
 */
#ifndef voxplex_IsosurfaceImage_h
#define voxplex_IsosurfaceImage_h

#include "Image/LabelImage.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>

namespace voxplex
{

/** Where the values of the inside lie. A voxel that has the isovalue itself is inside in both cases. */
enum class IsosurfaceSide
{
  Above, ///< inside is value >= isovalue
  Below  ///< inside is value <= isovalue
};

/** Which isosurface. */
struct Isosurface
{
  double Value = 0.0;
  IsosurfaceSide Inside = IsosurfaceSide::Above;
  std::int64_t Label = 1; ///< of what is inside; at least 1
  /**
   * Standard deviation, voxels along each axis, of a smoothing of the values before anything else, against
   * noise; 0 to LargestSigma. By default none: grey values say where the surface is to a fraction of a voxel
   * already, there are no stairs to smooth.
   */
  double SmoothingSigma = 0.0;

  static constexpr double LargestSigma = 5.0;
};

/**
 * @brief The voxels inside of an isosurface as a label image, and by how much each is inside or outside.
 *
 * The *margin* of a voxel is value - isovalue (isovalue - value if below is inside), times a power of two
 * that brings the largest one of the image near 1. A voxel is inside if its margin is at least 0. Voxels
 * whose value is not a number are outside; so is everything beyond the image.
 *
 * Smoothing is the separable kernel (1 + c) g - c g*g of LabelField with a second moment of 0: it
 * leaves linear and quadratic functions as they are, and with them planes and, nearly, curved surfaces.
 * At the image's border the outermost values are repeated.
 */
template <int D>
class IsosurfaceImage
{
public:
  using Index = typename GridGeometry<D>::Index;

  /**
   * @param scalars one value per voxel, first axis fastest, any arithmetic type, which is compared as
   *   double; must live as long as this, unless they are smoothed
   * @param threads threads used here; 0 means all cores. The result does not depend on it.
   * @throws InputError: isovalue not finite, or outside of the image's range (says the range); no value is
   *   a number; label below 1, sigma out of range; what LabelImage::FromScalars says of the grid;
   *   Cancelled if a stop was requested before the end; std::bad_alloc
   */
  template <typename T>
  static IsosurfaceImage FromScalars(std::span<const T> scalars, const GridGeometry<D>& grid,
    const Isosurface& surface, unsigned threads = 1, const std::stop_token& stop = {});

  /** What is inside has the id 1, the other voxels are background. */
  const LabelImage<D>& Labels() const { return this->Inside; }
  /** To leave components out. What is background there counts as outside, whatever its margin. */
  LabelImage<D>& Labels() { return this->Inside; }

  const Isosurface& Surface() const { return this->Which; }
  /** Smallest and largest value of the image, after smoothing, infinite ones included. */
  const std::array<double, 2>& Range() const { return this->Values; }

  /**
   * Margins of a run of voxels along the first axis, NaN where there is no number.
   * @param first an index of the whole grid
   */
  void ReadMargins(const Index& first, std::size_t count, float* margins) const
  {
    std::int64_t at = 0;
    for (std::size_t a = D; a-- > 0;)
    {
      at = at * this->Inside.Grid().Dimensions[a] + first[a];
    }
    this->Read(static_cast<std::size_t>(at), count, margins);
  }

private:
  Isosurface Which;
  LabelImage<D> Inside;
  std::array<double, 2> Values{};
  std::function<void(std::size_t first, std::size_t count, float* margins)> Read;
};

} // namespace voxplex

#endif
