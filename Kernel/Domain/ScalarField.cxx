// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Domain/ScalarField.h"

#include "Image/SurfaceVoxels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

namespace voxplex
{

namespace
{

/**
 * A sample is at least this factor times the largest sample of its face neighbours. So the
 * isosurface stays about a thousandth of a voxel away from voxel centres. Otherwise rounding could
 * put a centre on the wrong side.
 */
constexpr float KeptMargin = 0.001f;

/** The least sample, if the face neighbours give none. */
constexpr float SmallestSample = std::numeric_limits<float>::min();

} // namespace

/** Makes tiles; one instance serves one thread at a time. */
template <int D>
class ScalarField<D>::Builder
{
public:
  explicit Builder(const IsosurfaceImage<D>& image)
    : Image(image)
    , Labels(image.Labels())
  {
    std::size_t size = 1;
    for (std::size_t a = 0; a < D; ++a)
    {
      this->Strides[a] = static_cast<std::ptrdiff_t>(size);
      size *= Width;
    }
    this->Margins.resize(size);
    this->Ids.resize(size);
    for (std::size_t i = 0; i < Steps.size(); ++i)
    {
      std::size_t rest = i;
      for (std::size_t a = 0; a < D; ++a, rest /= 3)
      {
        const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(rest % 3) - 1;
        this->Steps[i] += step * this->Strides[a];
        this->Axes[i] += step != 0;
      }
    }
  }

  /** The samples of the tile whose first sample is at these lattice coordinates. */
  const Sample* MakeTile(const Index& first)
  {
    this->GatherHalo(first);
    Sample* const tile = this->Memory.Allocate(PlaneSize);
    for (std::size_t row = 0; row < PlaneSize / TileSamples; ++row)
    {
      std::ptrdiff_t at = 1;
      for (std::size_t a = 1; a < D; ++a)
      {
        at += static_cast<std::ptrdiff_t>(((row >> (3 * (a - 1))) & 7) + 1) * this->Strides[a];
      }
      for (std::size_t i = 0; i < TileSamples; ++i)
      {
        tile[row * TileSamples + i] = this->SampleAt(at + static_cast<std::ptrdiff_t>(i));
      }
    }
    return tile;
  }

  typename Base::Arena Memory;

private:
  static constexpr std::size_t Width = TileSamples + 2; ///< samples of the halo along each axis

  /**
   * Gathers margins and ids of the tile and one sample around it; NaN and background beyond the
   * image.
   */
  void GatherHalo(Index first)
  {
    for (std::int64_t& i : first)
    {
      --i;
    }
    Base::ForEachRow(this->Labels, first, Width,
      [&](const LabelId* in, std::int64_t low, std::int64_t high, std::size_t row)
      {
        LabelId* const ids = this->Ids.data() + row * Width;
        const auto [before, after] = Base::RowEnds(this->Labels, in, low, high);
        std::fill(ids, ids + low, before);
        std::copy(in, in + (high - low), ids + low);
        std::fill(ids + high, ids + Width, after);
        Index index = first;
        std::size_t rest = row;
        for (std::size_t a = 1; a < D; ++a, rest /= Width)
        {
          index[a] += static_cast<std::int64_t>(rest % Width);
        }
        this->ReadMargins(index, this->Margins.data() + row * Width);
        return true;
      });
  }

  /**
   * Reads margins of a row of the halo from a lattice point on. Where the image cuts the object,
   * they continue.
   */
  void ReadMargins(Index lattice, Sample* margins) const
  {
    this->Wrap(lattice);
    ClampToCut(this->Labels, lattice);
    for (std::size_t a = 1; a < D; ++a)
    {
      const std::int64_t last = this->Labels.CropDimensions()[a];
      lattice[a] =
        this->Labels.ReachesBorder(a, 0) ? std::max<std::int64_t>(lattice[a], 1) : lattice[a];
      lattice[a] = this->Labels.ReachesBorder(a, 1) ? std::min(lattice[a], last) : lattice[a];
    }
    std::fill_n(margins, Width, std::numeric_limits<Sample>::quiet_NaN());
    Index voxel;
    bool inside = true;
    for (std::size_t a = 0; a < D; ++a)
    {
      voxel[a] = this->Labels.CropOrigin()[a] + lattice[a] - 1;
      inside =
        inside && (a == 0 || (voxel[a] >= 0 && voxel[a] < this->Labels.Grid().Dimensions[a]));
    }
    const std::int64_t begin = std::max<std::int64_t>(voxel[0], 0);
    const std::int64_t end = std::min<std::int64_t>(
      voxel[0] + static_cast<std::int64_t>(Width), this->Labels.Grid().Dimensions[0]);
    if (inside && begin < end)
    {
      Sample* const to = margins + (begin - voxel[0]);
      voxel[0] = begin;
      this->Image.ReadMargins(voxel, static_cast<std::size_t>(end - begin), to);
      if (this->Labels.ReachesBorder(0, 0))
      {
        std::fill(margins, to, *to);
      }
      if (this->Labels.ReachesBorder(0, 1))
      {
        std::fill(to + (end - begin), margins + Width, to[end - begin - 1]);
      }
    }
  }

  /** Beyond the ends of a periodic object values are those of the other end, as ids are in ForEachRow(). */
  void Wrap(Index& lattice) const
  {
    constexpr std::size_t Time = static_cast<std::size_t>(D) - 1;
    if (this->Labels.IsPeriodicInTime() && this->Labels.ReachesBorderInTime(0))
    {
      const std::int64_t period = this->Labels.CropDimensions()[Time] - 1;
      lattice[Time] = ((lattice[Time] - 1) % period + period) % period + 1;
    }
  }

  /** The sample at a position inside the halo, not at its rim. */
  Sample SampleAt(std::ptrdiff_t at) const
  {
    const Sample margin = std::abs(this->Margins[static_cast<std::size_t>(at)]);
    if (std::isnan(margin))
    {
      return -this->MarginBeside(at);
    }
    Sample largest = margin;
    for (const std::ptrdiff_t stride : this->Strides)
    {
      for (const std::ptrdiff_t step : { -stride, stride })
      {
        const Sample beside = std::abs(this->Margins[static_cast<std::size_t>(at + step)]);
        largest = beside > largest ? beside : largest; // false for NaN
      }
    }
    const Sample kept = std::max({ margin, KeptMargin * largest, SmallestSample });
    return this->Ids[static_cast<std::size_t>(at)] != 0 ? kept : -kept;
  }

  /**
   * The mean margin of the nearest inside voxels around a position, which closes an object there.
   */
  Sample MarginBeside(std::ptrdiff_t at) const
  {
    std::array<Sample, D + 1> sum{}; // by the number of axes along which the neighbour is offset
    std::array<int, D + 1> count{};
    for (std::size_t i = 0; i < this->Steps.size(); ++i)
    {
      const auto neighbour = static_cast<std::size_t>(at + this->Steps[i]);
      if (this->Ids[neighbour] != 0)
      {
        sum[this->Axes[i]] += std::abs(this->Margins[neighbour]);
        ++count[this->Axes[i]];
      }
    }
    for (std::size_t axes = 1; axes <= D; ++axes)
    {
      if (count[axes] > 0)
      {
        return std::max(sum[axes] / static_cast<Sample>(count[axes]), SmallestSample);
      }
    }
    return SmallestSample; // no neighbour is inside
  }

  const IsosurfaceImage<D>& Image;
  const LabelImage<D>& Labels;
  std::vector<Sample> Margins;
  std::vector<LabelId> Ids;
  std::array<std::ptrdiff_t, static_cast<std::size_t>(D)> Strides{}; ///< of the halo
  /**
   * Offsets to a position's 3^D - 1 neighbours and to itself, and the number of axes along which
   * each is offset.
   */
  std::array<std::ptrdiff_t, D == 3 ? 27 : 81> Steps{};
  std::array<std::size_t, D == 3 ? 27 : 81> Axes{};
};

template <int D>
ScalarField<D>::ScalarField(
  const IsosurfaceImage<D>& image, unsigned threads, const std::stop_token& stop)
  : ScalarField::BorderedField(image.Labels())
{
  this->MakeTiles(
    image.Labels(), threads, stop, [&] { return std::make_unique<Builder>(image); },
    [](const Builder&) {});
}

template <int D>
bool ScalarField<D>::ExtendedMarginGradientAt(
  const Point<D>& x, LabelId label, Point<D>& gradient) const
{
  const Cell cell = this->Locate(x);
  if (!cell.Tile)
  {
    return false;
  }
  gradient = Base::PlaneGradient(cell.Tile, cell);
  for (double& g : gradient)
  {
    g = label != 0 ? g : -g;
  }
  return true;
}

template class ScalarField<3>;
template class ScalarField<4>;

} // namespace voxplex
