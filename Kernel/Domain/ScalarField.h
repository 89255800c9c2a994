// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ScalarField.h
 * @brief Where the isosurface of a grey-value image is.
 */
#ifndef voxplex_ScalarField_h
#define voxplex_ScalarField_h

#include "Domain/CutPlanes.h"
#include "Domain/TiledLattice.h"
#include "Image/IsosurfaceImage.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stop_token>

namespace voxplex
{

/**
 * @brief Inside (id 1) or outside (background) of an isosurface for every point of space: the sign of
 * interpolated margins.
 *
 * **Definition.** Every voxel has a sample: its margin (IsosurfaceImage) with the sign that the label
 * image says, positive inside. A sample that is less than a thousandth of one across a face is raised to
 * that, so that *every voxel centre keeps its side*, also one that has the isovalue itself. Between the voxels
 * samples are interpolated multilinearly. Inside is where the result is positive. So the isosurface is that of
 * the multilinear interpolant, which on grid edges is where vtkFlyingEdges3D and marching cubes have
 * their points, to a thousandth of a voxel.
 *
 * **Without a value.** At voxels that have no number, and in 4D beyond the image, the sample is the mean of
 * the margins of the nearest inside voxels among the 3^D - 1 around (those across a face before those across
 * an edge), with a minus sign: the object is closed halfway, by a plane half a voxel beyond the outermost voxels, as
 * label images are.
 *
 * **Border.** Where a 3D image cuts the object (LabelImage::IsCut), values go on unchanged, and all
 * beyond the outer faces of the outermost voxels is outside: the cut is flat, its edges are sharp.
 *
 * **Time.** In 4D flat ends are as in LabelField.
 *
 * **Storage.** The tiles of a TiledLattice; a mixed one has 8^D floats.
 *
 * Immutable after construction: all methods are const and safe to call from any thread. A query
 * costs O(1) in a uniform tile, O(2^D) in a mixed one.
 */
template <int D>
class ScalarField : public TiledLattice<D, float>
{
public:
  using typename TiledLattice<D, float>::Index;

  /** See LabelField; finer here, where images tell surfaces to that. */
  static constexpr double RootTolerance = 0.001;

  /**
   * @param image not referenced after construction
   * @param threads threads used for the construction; 0 means all cores. The result does not
   *   depend on it.
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  ScalarField(
    const IsosurfaceImage<D>& image, unsigned threads = 1, const std::stop_token& stop = {});
  ScalarField(ScalarField&&) noexcept = default;
  ScalarField& operator=(ScalarField&&) noexcept = default;

  /** Where the image cuts the object; none in 4D. */
  const CutPlanes<D>& Cuts() const { return this->Planes; }

  /** 1 inside, else 0, at a point of the frame. */
  LabelId Label(const Point<D>& p) const { return this->LabelAt(this->ToLattice(p)); }
  /** Label() at lattice coordinates. */
  LabelId LabelAt(const Point<D>& x) const
  {
    return this->Planes.Exist() && !(this->Planes.Distance(x) > 0.0) ? LabelId{ 0 }
                                                                     : this->ExtendedLabelAt(x);
  }
  /** Margin() at lattice coordinates. */
  double MarginAt(const Point<D>& x, LabelId label) const
  {
    return this->Planes.Margin(x, label, this->ExtendedMarginAt(x, label));
  }
  /** LabelAt(), but the object goes on beyond the faces where the image cuts it. */
  LabelId ExtendedLabelAt(const Point<D>& x) const
  {
    const Cell cell = this->Locate(x);
    return cell.Tile ? static_cast<LabelId>(Interpolate(cell).Value > 0.0f) : cell.Uniform;
  }

  /**
   * By how much a label (0 or 1) wins (> 0, exactly where Label(p) == label) or loses (<= 0) at a point: the
   * interpolated samples in units of the difference between the largest and smallest one of the cell, so that
   * it changes by about 1 from voxel to voxel whatever the values mean; -2 to +2. Continuous in a cell,
   * and across its faces where it is 0.
   */
  double Margin(const Point<D>& p, LabelId label) const
  {
    return this->MarginAt(this->ToLattice(p), label);
  }
  /** MarginAt(), but the object goes on beyond the faces where the image cuts it. */
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

  /**
   * A multiple of the gradient of MarginAt() in the cell of x, with respect to lattice coordinates.
   * @return false in a uniform tile away from cuts
   */
  bool MarginGradientAt(const Point<D>& x, LabelId label, Point<D>& gradient) const
  {
    return (this->Planes.Exist() &&
             this->Planes.Gradient(x, label, this->ExtendedMarginAt(x, label), gradient)) ||
      this->ExtendedMarginGradientAt(x, label, gradient);
  }
  /** That of ExtendedMarginAt(). */
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
    float Range; ///< of the cell's corners
  };
  static Interpolation Interpolate(const Cell& cell);

  class Builder;

  CutPlanes<D> Planes;
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
  // What is not positive is background: its margin must be positive there.
  return margin != 0.0 ? -margin : std::numeric_limits<double>::min();
}

extern template class ScalarField<3>;
extern template class ScalarField<4>;

} // namespace voxplex

#endif
