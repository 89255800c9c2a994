// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelField.h
 * @brief The interfaces of a label image, to a fraction of a voxel.
 */
#ifndef voxplex_LabelField_h
#define voxplex_LabelField_h

#include "Domain/BorderedField.h"

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
 *   indicators.
 *
 * **Definition.** For a label l the indicator u_l is +1 at the voxels of l and -1 at all others.
 * Voxels outside of the image are background. u_l is smoothed by the kernel below. If another label
 * wins at a voxel afterwards, the value of the voxel's own label is raised above the winner's, so
 * that *every voxel centre keeps its label*. Where an object is one voxel thin, the value is raised
 * farther, so that the object stays about one voxel thick. In 3D the same is done at tips of
 * processes and at ends of slots that smoothing would take away (FindBuriedVoxels). In 4D interfaces are
 * moved so that labels keep their volumes (VolumeBalance). Between the voxels u_l is interpolated
 * multilinearly. Label(p) is the label with the largest u_l(p). If several labels have the largest
 * value, the smallest id wins.
 *
 * **Kernel.** The tensor product of a 1D kernel (1 + c) g - c g*g, where g is a Gaussian of about
 * sigma voxels along each axis. It is a separable form of 2G - G*G and, like it, hardly moves
 * curved interfaces, but it needs one separable pass, not two. Its second moment is slightly below
 * 0, which compensates for the remaining shrinkage and for the chords of the mesh.
 * Benchmarks/Notebook.md has the measured accuracy.
 *
 * **Border.** Where a 3D image cuts the object (LabelImage::ReachesBorder), labels continue
 * unchanged for the smoothing. Beyond the outer faces of the outermost voxels there is background
 * only: the cut is flat, its edges are sharp.
 *
 * **Time.** In 4D the last axis is time. Where the object reaches the first or the last frame, it
 * continues unchanged beyond that frame, for the smoothing and for queries: the ends are flat. If the
 * image is periodic (LabelImage::IsPeriodicInTime()), the smoothing sees the frames of the other end instead, so both ends are equal.
 *
 * **Storage.** The tiles of a TiledLattice. Tiles outside of the crop are background. A mixed tile
 * has 16-bit fixed-point samples after a count and labels of 32 bits:
 *
 *     +---+----------+-----------------------------+
 *     | k | k labels | planes of 8^D samples       |
 *     |   | ascending| k = 2: one, (u_0 - u_1) / 2 |
 *     +---+----------+ k > 2: k, u_l of each label |
 *                    +-----------------------------+
 *
 * While volumes are balanced, tiles with k > 2 have two more planes: the largest and the second
 * largest u_l.
 *
 * If all samples of a tile have one label, no other label can win in it, by the definition: the
 * tile is uniform.
 *
 * Immutable after construction: all methods are const and safe to call from any thread. A query
 * costs O(1) in a uniform tile, O(2^D k) in a mixed one.
 */
template <int D>
class LabelField : public BorderedField<D, std::int16_t, LabelField<D>>
{
public:
  using typename TiledLattice<D, std::int16_t>::Index;

  /**
   * Root finding along a line ends when the bracket, in voxels, or the margin is smaller than this.
   */
  static constexpr double RootTolerance = 0.005;
  /** Largest standard deviation of the smoothing, voxels. */
  static constexpr double MaximumSigma = 5.0;

  /**
   * @param image the labels; not referenced after construction
   * @param sigma standard deviation of the smoothing in voxels, 0 (none) to MaximumSigma
   * @param threads threads used for the construction; 0 means all cores. The result does not depend
   *   on it.
   * @param stop ends the construction early, within the time of one tile; the default never does
   * @throws InputError if sigma is out of range; Cancelled if stopped; std::bad_alloc
   */
  LabelField(const LabelImage<D>& image, double sigma, unsigned threads = 1,
    const std::stop_token& stop = {});
  LabelField(LabelField&&) noexcept = default;
  LabelField& operator=(LabelField&&) noexcept = default;

  /** LabelAt(), but labels continue beyond the cut faces. */
  LabelId ExtendedLabelAt(const Point<D>& x) const;
  /**
   * MarginAt(), but labels continue beyond the cut faces. The margin is
   * u_label(x) minus the maximum of u_l(x) over the other labels, from about -2 to about +2. It is
   * continuous in a mixed tile and across the faces of mixed tiles. In a uniform tile it is +2 or
   * -2.
   */
  double ExtendedMarginAt(const Point<D>& x, LabelId label) const;
  /** ExtendedMarginAt() of several labels. */
  template <std::size_t N>
  std::array<double, N> ExtendedMarginsAt(
    const Point<D>& x, const std::array<LabelId, N>& labels) const;

  /**
   * Gradient of ExtendedMarginAt().
   * @return false if it is unknown: the tile is uniform, or does not have `label`
   */
  bool ExtendedMarginGradientAt(const Point<D>& x, LabelId label, Point<D>& gradient) const;

private:
  using Base = TiledLattice<D, std::int16_t>;
  using Base::PlaneSize;
  using Base::TileSamples;
  using typename Base::Cell;
  using typename Base::Sample;
  static constexpr double SampleOne = 16384.0; ///< fixed-point representation of 1
  /** The least margin of a voxel's own label, in units of samples; even. */
  static constexpr int KeptMargin = 328;
  static constexpr std::size_t SamplesPerLabel = sizeof(LabelId) / sizeof(Sample);

  static float InterpolatePlane(const Sample* plane, const Cell& cell);
  ///@{
  /** A tile begins with the number of its labels, and the labels, in increasing order, each as wide as a LabelId. */
  static LabelId HeaderAt(const Sample* tile, std::size_t at)
  {
    LabelId entry;
    std::memcpy(&entry, tile + at * SamplesPerLabel, sizeof(entry));
    return entry;
  }
  static std::size_t CountOf(const Sample* tile) { return HeaderAt(tile, 0); }
  static LabelId LabelOf(const Sample* tile, std::size_t l) { return HeaderAt(tile, 1 + l); }
  /** Which of its labels this one is; their number if it is none of them. */
  static std::size_t FindLabel(const Sample* tile, LabelId label)
  {
    const std::size_t labels = CountOf(tile);
    std::size_t l = 0;
    while (l < labels && LabelOf(tile, l) != label)
    {
      ++l;
    }
    return l;
  }
  static std::size_t HeaderSize(std::size_t labels)
  {
    return ((labels + 1) * SamplesPerLabel + 7) & ~std::size_t{ 7 };
  }
  ///@}

  void Raise(const Index& sample, LabelId label);
  void BalanceVolumes(
    const LabelImage<D>& image, double sigma, unsigned threads, const std::stop_token& stop);

  class Builder;
  class Balancer;
};

// Four pairs of samples at a time, if the compiler supports vectors. The result is the same.
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
  const std::size_t labels = CountOf(cell.Tile);
  const Sample* planes = cell.Tile + HeaderSize(labels);
  if (labels == 2)
  {
    return LabelOf(cell.Tile, InterpolatePlane(planes, cell) >= 0.0f ? 0 : 1);
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
  return LabelOf(cell.Tile, best);
}

template <int D>
inline double LabelField<D>::ExtendedMarginAt(const Point<D>& x, LabelId label) const
{
  const Cell cell = this->Locate(x);
  if (!cell.Tile)
  {
    return cell.Uniform == label ? 2.0 : -2.0;
  }
  // If values are equal, the smallest id wins: the winner's margin must be positive.
  constexpr double tie = std::numeric_limits<double>::min();
  const std::size_t labels = CountOf(cell.Tile);
  const Sample* planes = cell.Tile + HeaderSize(labels);
  if (labels == 2)
  {
    const double difference =
      (2.0 / SampleOne) * static_cast<double>(InterpolatePlane(planes, cell));
    if (label == LabelOf(cell.Tile, 0))
    {
      return difference != 0.0 ? difference : tie;
    }
    return label == LabelOf(cell.Tile, 1) ? -difference : -2.0;
  }
  float own = -static_cast<float>(SampleOne); // value of a label that the tile does not have
  float other = -std::numeric_limits<float>::max();
  bool first = true; // `label` is smaller than the first id with the largest value of the others
  for (std::size_t l = 0; l < labels; ++l)
  {
    const float value = InterpolatePlane(planes + l * PlaneSize, cell);
    const LabelId id = LabelOf(cell.Tile, l);
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

// Finds the best and the next best of all labels. If values are equal, the smallest id comes first.
template <int D>
template <std::size_t N>
std::array<double, N> LabelField<D>::ExtendedMarginsAt(
  const Point<D>& x, const std::array<LabelId, N>& labels) const
{
  std::array<double, N> margins;
  const Cell cell = this->Locate(x);
  if (!cell.Tile || CountOf(cell.Tile) == 2)
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
  const std::size_t count = CountOf(cell.Tile);
  const Sample* planes = cell.Tile + HeaderSize(count);
  for (std::size_t l = 0; l < count; ++l)
  {
    const float value = InterpolatePlane(planes + l * PlaneSize, cell);
    const LabelId id = LabelOf(cell.Tile, l);
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
