// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ScalarField.h
 * @brief The isosurface of a grey-value image.
 */
#ifndef voxplex_ScalarField_h
#define voxplex_ScalarField_h

#include "Domain/BorderedField.h"
#include "Image/IsosurfaceImage.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stop_token>

namespace voxplex
{

/**
 * @brief Tells whether a point of space is inside (id 1) or outside (background) of an isosurface.
 *
 * The sign of interpolated margins decides.
 *
 * **Definition.** The sample of a voxel is its margin (IsosurfaceImage). Its sign follows from the
 * label image: positive inside. If a sample is smaller than a thousandth of the sample of a face
 * neighbour, it is raised to that, so that *every voxel centre keeps its side*, even if its value
 * is the isovalue itself. Between the voxels samples are interpolated multilinearly. A point is
 * inside if the result is positive. So the isosurface is that of the multilinear interpolant. On
 * grid edges it coincides with the points of vtkFlyingEdges3D and marching cubes, to a thousandth
 * of a voxel.
 *
 * **Without a value.** A voxel whose value is not a number, or in 4D a voxel beyond the image,
 * takes a sample from the nearest inside voxels among the 3^D - 1 around it: minus the mean of
 * their margins. Face neighbours come before edge neighbours. So the object is closed halfway, by a
 * plane half a voxel beyond the outermost voxels, as in label images.
 *
 * **Border.** Where a 3D image cuts the object (LabelImage::ReachesBorder), values continue
 * unchanged. Beyond the outer faces of the outermost voxels all points are outside: the cut is
 * flat, its edges are sharp.
 *
 * **Time.** Flat ends in 4D are as in LabelField.
 *
 * **Storage.** The tiles of a TiledLattice. A mixed tile has 8^D floats.
 *
 * Immutable after construction: all methods are const and safe to call from any thread. A query
 * costs O(1) in a uniform tile, O(2^D) in a mixed one.
 */
template <int D>
class ScalarField : public BorderedField<D, float, ScalarField<D>>
{
public:
  using typename TiledLattice<D, float>::Index;

  /** See LabelField. It is finer here because grey values determine the surface more exactly. */
  static constexpr double RootTolerance = 0.001;

  /**
   * @param image not referenced after construction
   * @param threads threads used for the construction; 0 means all cores. The result does not depend
   *   on it.
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  ScalarField(
    const IsosurfaceImage<D>& image, unsigned threads = 1, const std::stop_token& stop = {});
  ScalarField(ScalarField&&) noexcept = default;
  ScalarField& operator=(ScalarField&&) noexcept = default;

  /** LabelAt(), but the object continues beyond the faces where the image cuts it. */
  LabelId ExtendedLabelAt(const Point<D>& x) const
  {
    const Cell cell = this->Locate(x);
    return cell.Tile ? static_cast<LabelId>(Interpolate(cell).Value > 0.0f) : cell.Uniform;
  }

  /**
   * MarginAt(), but the object continues beyond the faces where the image cuts it. The margin is
   * the interpolated sample divided by the difference between the largest and the smallest sample
   * of the cell. So it changes by about 1 from voxel to voxel, independent of the unit of the
   * values. Its range is -2 to +2. It is continuous in a cell, and across the cell's faces where it
   * is 0.
   */
  double ExtendedMarginAt(const Point<D>& x, LabelId label) const;
  /** ExtendedMarginAt() of several labels. */
  template <std::size_t N>
  std::array<double, N> ExtendedMarginsAt(
    const Point<D>& x, const std::array<LabelId, N>& labels) const
  {
    std::array<double, N> margins;
    for (std::size_t k = 0; k < N; ++k)
    {
      margins[k] = this->ExtendedMarginAt(x, labels[k]);
    }
    return margins;
  }

  /** A multiple of the gradient of ExtendedMarginAt() in the cell of x. @return false in a uniform tile */
  bool ExtendedMarginGradientAt(const Point<D>& x, LabelId label, Point<D>& gradient) const;

private:
  using Base = TiledLattice<D, float>;
  using Base::PlaneSize;
  using Base::TileSamples;
  using typename Base::Cell;
  using typename Base::Sample;

  struct Interpolation
  {
    float Value;
    float Range; ///< largest minus smallest sample of the cell's corners
  };
  static Interpolation Interpolate(const Cell& cell);

  class Builder;
};

template <int D>
inline typename ScalarField<D>::Interpolation ScalarField<D>::Interpolate(const Cell& cell)
{
  constexpr unsigned corners = 1u << D;
  const Sample* s = cell.Tile + cell.Offset;
  std::array<float, corners> v;
  for (unsigned c = 0; c < corners; ++c)
  {
    unsigned at = 0;
    for (unsigned a = 0; a < static_cast<unsigned>(D); ++a)
    {
      at += ((c >> a) & 1u) << (3 * a);
    }
    v[c] = s[at];
  }
  float least = v[0];
  float most = v[0];
  for (unsigned c = 1; c < corners; ++c)
  {
    least = std::min(least, v[c]);
    most = std::max(most, v[c]);
  }
  for (unsigned a = 0; a < static_cast<unsigned>(D); ++a)
  {
    for (unsigned c = 0; c < (corners >> (a + 1)); ++c)
    {
      v[c] = v[2 * c] + cell.Fraction[a] * (v[2 * c + 1] - v[2 * c]);
    }
  }
  return { v[0], most - least };
}

template <int D>
inline double ScalarField<D>::ExtendedMarginAt(const Point<D>& x, LabelId label) const
{
  const Cell cell = this->Locate(x);
  if (!cell.Tile)
  {
    return cell.Uniform == label ? 2.0 : -2.0;
  }
  const auto [value, range] = Interpolate(cell);
  double margin = value > 0.0f ? 2.0 : -2.0;
  if (range > 0.5f * std::abs(value))
  {
    margin = static_cast<double>(value) / static_cast<double>(range);
  }
  if (label != 0)
  {
    return margin;
  }
  // A point whose value is not positive is background: background's margin must be positive there.
  return margin != 0.0 ? -margin : std::numeric_limits<double>::min();
}

extern template class ScalarField<3>;
extern template class ScalarField<4>;

} // namespace voxplex

#endif
