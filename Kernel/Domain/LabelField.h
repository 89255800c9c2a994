// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelField.h
 * @brief Where the interfaces of a label image are, to a fraction of a voxel.
 */
#ifndef voxplex_LabelField_h
#define voxplex_LabelField_h

#include "Domain/CutPlanes.h"
#include "Domain/TiledLattice.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stop_token>
#include <utility>

namespace voxplex
{

/**
 * @brief Label of every point of space: the arg max over labels of smoothed, interpolated
 * indicators.
 *
 * **Definition.** For a label l let u_l be +1 at the voxels of l and -1 at all others (background
 * outside of the image), smoothed by the kernel below. At a voxel where the own label lost against
 * another, its value is raised above the other's, so that *every voxel centre keeps its label*;
 * where an object is one voxel thin it is raised by so much that the object stays about one voxel
 * thick. Between the voxels u_l is interpolated multilinearly. Label(p) is the label with the
 * largest u_l(p); the smallest id among equals.
 *
 * **Kernel.** The tensor product of a 1D kernel (1 + c) g - c g*g, where g is a Gaussian of about
 * sigma voxels along each axis. Like 2G - G*G, of which it is a separable form, it hardly moves
 * curved interfaces; it needs one separable pass, not two. Its second moment is not 0 but a little
 * less, which makes up for what remains of the shrinking and for the chords of the mesh.
 * Documentation/Algorithm.md has the measured accuracy.
 *
 * **Border.** Where a 3D image cuts the object (LabelImage::IsCut), labels go on unchanged for the smoothing, and all
 * beyond the outer faces of the outermost voxels is background: the cut is flat, its edges are sharp.
 *
 * **Time.** In 4D the last axis is time. Where the object reaches the first or the last frame it goes on
 * unchanged beyond it, for the smoothing and for queries: the ends are flat.
 *
 * **Storage.** The tiles of a TiledLattice; those outside of the crop are background. A mixed one has 16-bit
 * fixed-point samples:
 *
 *     +---+----------+-----------------------------+
 *     | k | k labels | planes of 8^D samples       |
 *     |   | ascending| k = 2: one, (u_0 - u_1) / 2 |
 *     +---+----------+ k > 2: k, u_l of each label |
 *                    +-----------------------------+
 *
 * In a tile whose samples all have one label no other label can win, by the definition: it is uniform.
 *
 * Immutable after construction: all methods are const and safe to call from any thread. A query
 * costs O(1) in a uniform tile, O(2^D k) in a mixed one.
 */
template <int D>
class LabelField : public TiledLattice<D, std::int16_t>
{
public:
  using typename TiledLattice<D, std::int16_t>::Index;

  /** Root finding along a line ends when the bracket is shorter or the margin smaller, in voxels. */
  static constexpr double RootTolerance = 0.005;
  /** Largest standard deviation of the smoothing, voxels. */
  static constexpr double MaximumSigma = 5.0;

  /**
   * @param image the labels; not referenced after construction
   * @param sigma standard deviation of the smoothing in voxels, 0 (none) to MaximumSigma
   * @param threads threads used for the construction; 0 means all cores. The result does not
   *   depend on it.
   * @param stop ends the construction early, within the time of a tile; the default never does
   * @throws InputError if sigma is out of range; Cancelled if stopped; std::bad_alloc
   */
  LabelField(const LabelImage<D>& image, double sigma, unsigned threads = 1,
    const std::stop_token& stop = {});
  LabelField(LabelField&&) noexcept = default;
  LabelField& operator=(LabelField&&) noexcept = default;

  /** Where the image cuts the object; none in 4D. */
  const CutPlanes<D>& Cuts() const { return this->Planes; }

  /** Label of a point of the frame; background outside of the lattice. */
  LabelId Label(const Point<D>& p) const { return this->LabelAt(this->ToLattice(p)); }

  /**
   * By how much a label wins (> 0, exactly where Label(p) == label) or loses (<= 0) at a point:
   * u_label(p) - max over the other labels of u_l(p), between -2 and +2 or a little more.
   * Continuous in a mixed tile and across the faces of mixed tiles; +2 or -2 in uniform tiles.
   */
  double Margin(const Point<D>& p, LabelId label) const
  {
    return this->MarginAt(this->ToLattice(p), label);
  }

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
  /** LabelAt(), but labels go on beyond the faces where the image cuts the object. */
  LabelId ExtendedLabelAt(const Point<D>& x) const;
  /** MarginAt(), but labels go on beyond the faces where the image cuts the object. */
  double ExtendedMarginAt(const Point<D>& x, LabelId label) const;
  /** ExtendedMarginAt() of several labels. */
  template <std::size_t N>
  std::array<double, N> ExtendedMarginsAt(
    const Point<D>& x, const std::array<LabelId, N>& labels) const;

  /**
   * Gradient of MarginAt() with respect to the lattice coordinates.
   * @return false in a uniform tile away from cuts, or where `label` is not near: the gradient is unknown
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
  using Base = TiledLattice<D, std::int16_t>;
  using Base::PlaneSize;
  using Base::TileSamples;
  using typename Base::Cell;
  using typename Base::Sample;
  static constexpr double SampleOne = 16384.0; ///< fixed-point representation of 1

  static float InterpolatePlane(const Sample* plane, const Cell& cell);
  static std::size_t HeaderSize(std::size_t labels) { return (labels + 8) & ~std::size_t{ 7 }; }

  class Builder;

  CutPlanes<D> Planes;
};

// Four pairs of samples at a time, where the compiler has vectors; the result is the same without.
template <int D>
inline float LabelField<D>::InterpolatePlane(const Sample* plane, const Cell& cell)
{
  constexpr unsigned corners = 1u << (D - 1);
  const Sample* s = plane + cell.Offset;
  const auto offset = [](unsigned c)
  {
    unsigned at = 0;
    for (unsigned a = 1; a < static_cast<unsigned>(D); ++a)
    {
      at += ((c >> (a - 1)) & 1u) << (3 * a);
    }
    return at;
  };
  std::array<float, corners> v;
#if defined(__GNUC__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
  using Integers [[gnu::vector_size(16)]] = std::int32_t;
  using Floats [[gnu::vector_size(16)]] = float;
  for (unsigned c = 0; c < corners; c += 4)
  {
    std::int32_t pairs[4]; // the lower sample in the lower half
    for (unsigned k = 0; k < 4; ++k)
    {
      std::memcpy(&pairs[k], s + offset(c + k), sizeof(pairs[k]));
    }
    const Integers pair = { pairs[0], pairs[1], pairs[2], pairs[3] };
    const Floats low = __builtin_convertvector((pair << 16) >> 16, Floats);
    const Floats high = __builtin_convertvector(pair >> 16, Floats);
    const Floats between = low + cell.Fraction[0] * (high - low);
    std::memcpy(&v[c], &between, sizeof(between));
  }
#else
  for (unsigned c = 0; c < corners; ++c)
  {
    const float low = s[offset(c)];
    v[c] = low + cell.Fraction[0] * (static_cast<float>(s[offset(c) + 1]) - low);
  }
#endif
  for (unsigned a = 1; a < static_cast<unsigned>(D); ++a)
  {
    for (unsigned c = 0; c < (corners >> a); ++c)
    {
      v[c] = v[2 * c] + cell.Fraction[a] * (v[2 * c + 1] - v[2 * c]);
    }
  }
  return v[0];
}

template <int D>
inline LabelId LabelField<D>::ExtendedLabelAt(const Point<D>& x) const
{
  const Cell cell = this->Locate(x);
  if (!cell.Tile)
  {
    return cell.Uniform;
  }
  const auto labels = static_cast<std::size_t>(cell.Tile[0]);
  const Sample* planes = cell.Tile + HeaderSize(labels);
  if (labels == 2)
  {
    return static_cast<LabelId>(cell.Tile[InterpolatePlane(planes, cell) >= 0.0f ? 1 : 2]);
  }
  std::size_t best = 0;
  float bestValue = InterpolatePlane(planes, cell);
  for (std::size_t l = 1; l < labels; ++l)
  {
    const float value = InterpolatePlane(planes + l * PlaneSize, cell);
    if (value > bestValue)
    {
      best = l;
      bestValue = value;
    }
  }
  return static_cast<LabelId>(cell.Tile[1 + best]);
}

template <int D>
inline double LabelField<D>::ExtendedMarginAt(const Point<D>& x, LabelId label) const
{
  const Cell cell = this->Locate(x);
  if (!cell.Tile)
  {
    return cell.Uniform == label ? 2.0 : -2.0;
  }
  // Of equal values the smallest id wins: the margin of the winner must be positive.
  constexpr double tie = std::numeric_limits<double>::min();
  const auto labels = static_cast<std::size_t>(cell.Tile[0]);
  const Sample* planes = cell.Tile + HeaderSize(labels);
  if (labels == 2)
  {
    const double difference =
      (2.0 / SampleOne) * static_cast<double>(InterpolatePlane(planes, cell));
    if (label == static_cast<LabelId>(cell.Tile[1]))
    {
      return difference != 0.0 ? difference : tie;
    }
    return label == static_cast<LabelId>(cell.Tile[2]) ? -difference : -2.0;
  }
  float own = -static_cast<float>(SampleOne); // of a label that is not near
  float other = -std::numeric_limits<float>::max();
  bool first = true; // no smaller id has the largest value of the others
  for (std::size_t l = 0; l < labels; ++l)
  {
    const float value = InterpolatePlane(planes + l * PlaneSize, cell);
    const auto id = static_cast<LabelId>(cell.Tile[1 + l]);
    if (id == label)
    {
      own = value;
    }
    else if (value > other)
    {
      other = value;
      first = id > label;
    }
  }
  const double margin = (1.0 / SampleOne) * static_cast<double>(own - other);
  return margin != 0.0 || !first ? margin : tie;
}

// Of all labels the best and the next best, of equal ones the smallest id.
template <int D>
template <std::size_t N>
std::array<double, N> LabelField<D>::ExtendedMarginsAt(
  const Point<D>& x, const std::array<LabelId, N>& labels) const
{
  std::array<double, N> margins;
  const Cell cell = this->Locate(x);
  if (!cell.Tile || cell.Tile[0] == 2)
  {
    for (std::size_t k = 0; k < N; ++k)
    {
      margins[k] = this->ExtendedMarginAt(x, labels[k]);
    }
    return margins;
  }
  struct
  {
    float Value = -std::numeric_limits<float>::max();
    LabelId Id = 0;
  } best, next;
  std::array<float, N> own;
  own.fill(-static_cast<float>(SampleOne));
  const auto count = static_cast<std::size_t>(cell.Tile[0]);
  const Sample* planes = cell.Tile + HeaderSize(count);
  for (std::size_t l = 0; l < count; ++l)
  {
    const float value = InterpolatePlane(planes + l * PlaneSize, cell);
    const auto id = static_cast<LabelId>(cell.Tile[1 + l]);
    if (value > best.Value)
    {
      next = std::exchange(best, { value, id });
    }
    else if (value > next.Value)
    {
      next = { value, id };
    }
    for (std::size_t k = 0; k < N; ++k)
    {
      own[k] = id == labels[k] ? value : own[k];
    }
  }
  for (std::size_t k = 0; k < N; ++k)
  {
    const auto& other = labels[k] == best.Id ? next : best;
    const double margin = (1.0 / SampleOne) * static_cast<double>(own[k] - other.Value);
    margins[k] =
      margin != 0.0 || other.Id < labels[k] ? margin : std::numeric_limits<double>::min();
  }
  return margins;
}

extern template class LabelField<3>;
extern template class LabelField<4>;

} // namespace voxplex

#endif
