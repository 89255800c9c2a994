// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TiledLattice.h
 * @brief Samples at the voxels near interfaces, stored in tiles; a query reads one tile.
 */
#ifndef voxplex_TiledLattice_h
#define voxplex_TiledLattice_h

#include "Image/LabelImage.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <mutex>
#include <stop_token>
#include <type_traits>
#include <vector>

namespace voxplex
{

/**
 * @brief The lattice and its tiles, which the fields of labels between voxel centres share.
 *
 * The lattice is the crop of a label image and one layer around it. It is cut into tiles of
 * TileCells cells along each axis. If all samples of a tile have one label, the tile is uniform:
 * every point in it has this label. The other tiles are mixed. A mixed tile stores samples on all
 * of its (TileCells + 1)^D corners, so that a query reads one tile only:
 *
 *     directory: one 64-bit word a tile
 *     +--------------------------+
 *     | label << 1 | 1   uniform |
 *     | address          mixed   | ----------> samples, as the field lays them out
 *     +--------------------------+
 *
 * A sample must depend on its neighbourhood only, not on the tile. Then two tiles agree on their
 * common face.
 *
 * Immutable after construction: all methods are const and safe to call from any thread.
 */
template <int D, typename SampleType>
class TiledLattice
{
public:
  using Index = typename GridGeometry<D>::Index;

  /** Cells of a tile along each axis. Its 8 samples along x fill one vector register. */
  static constexpr unsigned TileCells = 7;

  /** Samples of the lattice along each axis: the crop's voxels + 2. */
  const Index& LatticeDimensions() const { return this->Dimensions; }

  /** Lattice coordinates of a point of the frame: 0 is the layer before the crop. */
  Point<D> ToLattice(const Point<D>& p) const
  {
    Point<D> x;
    if (this->IsOrthogonal)
    {
      for (std::size_t a = 0; a < D; ++a)
      {
        x[a] = p[a] * this->PerSpacing[a] - this->Shift[a];
      }
      return x;
    }
    x = this->Grid.ToIndex(p);
    for (std::size_t a = 0; a < D; ++a)
    {
      x[a] -= this->Shift[a];
    }
    return x;
  }
  /** Point of the frame at lattice coordinates. */
  Point<D> ToFrame(Point<D> x) const
  {
    for (std::size_t a = 0; a < D; ++a)
    {
      x[a] += this->Shift[a];
    }
    return this->Grid.ToFrame(x);
  }

  /**
   * Lattice coordinates of the first and the last frame, if they cut the object; otherwise
   * infinite. Beyond a cut, labels are as on the cut. Only in 4D; the last axis is time.
   */
  const std::array<double, 2>& FlatEnds() const { return this->Ends; }
  /** x, or its projection onto the flat end if it lies beyond one. */
  Point<D> ClampToEnds(Point<D> x) const
  {
    double& time = x[static_cast<std::size_t>(D) - 1];
    time = time < this->Ends[0] ? this->Ends[0] : time > this->Ends[1] ? this->Ends[1] : time;
    return x;
  }

  /** Memory held in bytes. */
  std::size_t MemoryBytes() const
  {
    return this->BlockBytes + this->Directory.size() * sizeof(std::uintptr_t);
  }

protected:
  using Sample = SampleType;
  static constexpr unsigned TileSamples = TileCells + 1;
  static constexpr unsigned PlaneSize = D == 3 ? 512 : 4096;

  /** The lattice of an image, without tiles. The image is not referenced afterwards. */
  explicit TiledLattice(const LabelImage<D>& image);
  TiledLattice(TiledLattice&&) noexcept = default;
  TiledLattice& operator=(TiledLattice&&) noexcept = default;
  ~TiledLattice() = default;

  /** The cell that contains a point. */
  struct Cell
  {
    const Sample* Tile; ///< null in a uniform tile
    LabelId Uniform;
    unsigned Offset; ///< offset of the cell's first corner in a plane
    std::array<float, static_cast<std::size_t>(D)> Fraction;
  };
  Cell Locate(Point<D> x) const;

  /** Gradient of the interpolation of a plane's samples in a cell, with respect to lattice coordinates. */
  static Point<D> PlaneGradient(const Sample* plane, const Cell& cell);

  /** Memory for the samples of mixed tiles. One thread at a time may use an arena. */
  class Arena
  {
  public:
    /** Returns uninitialised memory; 16-byte aligned, because sizes are multiples of 8 samples. */
    Sample* Allocate(std::size_t samples);

    std::vector<std::unique_ptr<Sample[]>> Blocks;
    std::size_t Bytes = 0;

  private:
    static constexpr std::size_t BlockSize = std::size_t{ 1 } << 18; ///< samples
    Sample* Next = nullptr;
    std::size_t Left = 0;
  };

  /**
   * Calls row(in, x0, x1, k) for each row k of a box of `width` samples along each axis. The
   * samples x0 ... x1 - 1 of the row lie in the crop; their ids begin at `in`. If no sample lies in
   * the crop, x0 == x1. Rows repeat beyond a flat end and where the image cuts the object; beyond the ends of
   * a periodic image they are those of the other end. See also
   * RowEnds(). If row returns false, the function returns early.
   */
  template <typename Function>
  static void ForEachRow(
    const LabelImage<D>& image, const Index& first, std::size_t width, Function&& row);
  /** Whether a box as above lies in the crop. */
  static bool IsInCrop(const Index& crop, const Index& first, std::int64_t width)
  {
    bool inside = true;
    for (std::size_t a = 0; a < D; ++a)
    {
      inside = inside && first[a] >= 1 && first[a] - 1 + width <= crop[a];
    }
    return inside;
  }
  /** ForEachRow() of a box in the crop. */
  template <typename Function>
  static void ForEachRowInCrop(
    const LabelId* ids, const Index& crop, const Index& first, std::int64_t width, Function&& row);
  /**
   * The ids of a row's samples before and after the crop: background, or the id at the cut if the
   * object is cut.
   */
  static std::array<LabelId, 2> RowEnds(
    const LabelImage<D>& image, const LabelId* in, std::int64_t low, std::int64_t high)
  {
    if (low >= high)
    {
      return {};
    }
    return { image.ReachesBorder(0, 0) ? in[0] : LabelId{ 0 },
      image.ReachesBorder(0, 1) ? in[high - low - 1] : LabelId{ 0 } };
  }
  /**
   * Whether all samples of the tile that begins at `first` have one label. If so, `label` receives
   * it.
   */
  static bool IsUniform(const LabelImage<D>& image, const Index& first, LabelId& label);

  /**
   * Makes all tiles. make() returns a std::unique_ptr to a builder, which serves one thread at a
   * time. The builder's MakeTile(first) returns the samples of the mixed tile that begins at these
   * lattice coordinates, in memory of its member Memory, an Arena. In the end done(builder) is
   * called for each builder, by the calling thread, in no particular order.
   * @throws Cancelled if a stop was requested before the end, within the time of one tile
   */
  template <typename Make, typename Done>
  void MakeTiles(const LabelImage<D>& image, unsigned threads, const std::stop_token& stop,
    Make&& make, Done&& done);
  /**
   * Replaces the mixed tiles, by builders as above. RemakeTile(first, samples) gets the samples of the
   * tile and returns others of the same layout. Until all tiles are made, the lattice is as it was.
   */
  template <typename Make>
  void RemakeTiles(unsigned threads, const std::stop_token& stop, Make&& make);

  /**
   * Calls run(tile, label, offset, count, place) for runs of samples along x in one tile.
   * @param samples lattice coordinates along each axis; -1 is outside of the lattice. A run ends
   *   where they do not ascend by 1.
   * tile: null if all of its samples have the label, or if the run is outside. offset: of the first
   * sample in a plane. place: its number in the box of these coordinates, x fastest.
   */
  template <typename Function>
  void ForEachRun(const std::array<std::vector<std::int64_t>, static_cast<std::size_t>(D)>& samples,
    Function&& run) const;

  /**
   * Calls change(samples, i) for each mixed tile that has the sample at these lattice coordinates:
   * the tile's samples, and the number of this sample in a plane. Not thread safe.
   */
  template <typename Function>
  void ChangeSample(const Index& sample, Function&& change);

private:
  /** Sets each entry of the directory to entry(builder, first, number), and keeps the builders' memory. */
  template <typename Make, typename Entry, typename Done>
  void FillDirectory(
    unsigned threads, const std::stop_token& stop, Make&& make, Entry&& entry, Done&& done);

  GridGeometry<D> Grid;
  bool IsOrthogonal = true;
  Point<D> PerSpacing{};
  Point<D> Shift{};
  Index Dimensions{};
  std::array<double, 2> Ends{ -std::numeric_limits<double>::infinity(),
    std::numeric_limits<double>::infinity() };
  std::array<std::uint32_t, static_cast<std::size_t>(D)> LastCell{};
  std::array<std::uint32_t, static_cast<std::size_t>(D)> TileStride{};
  std::vector<std::uintptr_t> Directory;
  std::vector<std::unique_ptr<Sample[]>> Blocks;
  std::size_t BlockBytes = 0;
};

//------------------------------------------------------------------------------------------------
template <int D, typename SampleType>
TiledLattice<D, SampleType>::TiledLattice(const LabelImage<D>& image)
  : Grid(image.Grid())
{
  std::size_t numberOfTiles = 1;
  for (std::size_t a = 0; a < D; ++a)
  {
    this->Dimensions[a] = image.CropDimensions()[a] + 2;
    this->Shift[a] = static_cast<double>(image.CropOrigin()[a] - 1);
    this->PerSpacing[a] = 1.0 / this->Grid.IndexToFrame[a][a];
    for (std::size_t c = a + 1; c < D; ++c)
    {
      this->IsOrthogonal = this->IsOrthogonal && this->Grid.IndexToFrame[a][c] == 0.0;
    }
    this->LastCell[a] = static_cast<std::uint32_t>(this->Dimensions[a] - 2);
    this->TileStride[a] = static_cast<std::uint32_t>(numberOfTiles);
    numberOfTiles *= static_cast<std::size_t>(this->LastCell[a] / TileCells) + 1;
  }
  this->Directory.resize(numberOfTiles);
  if (image.ReachesBorderInTime(0))
  {
    this->Ends[0] = 1.0;
  }
  if (image.ReachesBorderInTime(1))
  {
    this->Ends[1] = static_cast<double>(image.CropDimensions()[D - 1]);
  }
}

template <int D, typename SampleType>
inline typename TiledLattice<D, SampleType>::Cell TiledLattice<D, SampleType>::Locate(
  Point<D> x) const
{
  if constexpr (D == 4)
  {
    x = this->ClampToEnds(x);
  }
  Cell cell;
  cell.Tile = nullptr;
  cell.Uniform = 0;
  cell.Offset = 0;
  std::uint32_t tile = 0;
  for (std::size_t a = 0; a < D; ++a)
  {
    const double last = static_cast<double>(this->LastCell[a]);
    if (!(x[a] >= 0.0 && x[a] <= last + 1.0)) // NaN is outside, too
    {
      return cell;
    }
    const auto c =
      std::min(static_cast<std::uint32_t>(static_cast<std::int64_t>(x[a])), this->LastCell[a]);
    cell.Fraction[a] = static_cast<float>(x[a] - static_cast<double>(c));
    const std::uint32_t t = c / TileCells;
    tile += t * this->TileStride[a];
    cell.Offset += (c - t * TileCells) << (3 * a);
  }
  const std::uintptr_t entry = this->Directory[tile];
  if (entry & 1)
  {
    cell.Uniform = static_cast<LabelId>(entry >> 1);
  }
  else
  {
    cell.Tile = reinterpret_cast<const Sample*>(entry); // NOLINT(performance-no-int-to-ptr): tagged
  }
  return cell;
}

/** Interpolates along one axis after the other, values and derivatives together. */
template <int D, typename SampleType>
Point<D> TiledLattice<D, SampleType>::PlaneGradient(const Sample* plane, const Cell& cell)
{
  constexpr unsigned corners = 1u << D;
  const Sample* s = plane + cell.Offset;
  std::array<std::array<float, corners>, D + 1> v; // the value, then the derivatives
  for (unsigned c = 0; c < corners; ++c)
  {
    unsigned at = 0;
    for (unsigned a = 0; a < static_cast<unsigned>(D); ++a)
    {
      at += ((c >> a) & 1u) << (3 * a);
    }
    v[0][c] = s[at];
  }
  for (unsigned a = 0; a < static_cast<unsigned>(D); ++a)
  {
    for (unsigned c = 0; c < (corners >> (a + 1)); ++c)
    {
      v[a + 1][c] = v[0][2 * c + 1] - v[0][2 * c];
      for (unsigned k = 0; k <= a; ++k)
      {
        v[k][c] = v[k][2 * c] + cell.Fraction[a] * (v[k][2 * c + 1] - v[k][2 * c]);
      }
    }
  }
  Point<D> gradient;
  for (std::size_t a = 0; a < D; ++a)
  {
    gradient[a] = static_cast<double>(v[a + 1][0]);
  }
  return gradient;
}

//------------------------------------------------------------------------------------------------
template <int D, typename SampleType>
SampleType* TiledLattice<D, SampleType>::Arena::Allocate(std::size_t samples)
{
  if (samples > this->Left)
  {
    const std::size_t size = std::max(BlockSize, samples);
    this->Blocks.push_back(std::make_unique_for_overwrite<Sample[]>(size));
    this->Bytes += size * sizeof(Sample);
    this->Next = this->Blocks.back().get();
    this->Left = size;
  }
  Sample* result = this->Next;
  this->Next += samples;
  this->Left -= samples;
  return result;
}

template <int D, typename SampleType>
template <typename Function>
void TiledLattice<D, SampleType>::ForEachRowInCrop(
  const LabelId* ids, const Index& crop, const Index& first, std::int64_t width, Function&& row)
{
  Index skip{}; // from behind the last row along an axis to the first one of the next
  std::int64_t stride = 1;
  std::int64_t at = 0;
  for (std::size_t a = 0; a < D; ++a)
  {
    at += (first[a] - 1) * stride;
    const std::int64_t next = stride * crop[a];
    skip[a] = next - width * stride;
    stride = next;
  }
  const std::int64_t rowStride = crop[0];
  Index offset{};
  for (std::size_t k = 0; row(ids + at, std::int64_t{ 0 }, width, k); ++k)
  {
    at += rowStride;
    std::size_t a = 1;
    while (a < D && ++offset[a] == width)
    {
      offset[a] = 0;
      at += skip[a];
      ++a;
    }
    if (a == D)
    {
      return;
    }
  }
}

template <int D, typename SampleType>
template <typename Function>
void TiledLattice<D, SampleType>::ForEachRow(
  const LabelImage<D>& image, const Index& begin, std::size_t width, Function&& row)
{
  const Index crop = image.CropDimensions(); // copies that the compiler can keep in registers
  const Index first = begin;
  const LabelId* const ids = image.Ids().data();
  const auto w = static_cast<std::int64_t>(width);
  if (IsInCrop(crop, first, w))
  {
    ForEachRowInCrop(ids, crop, first, w, row);
    return;
  }
  Index offset{};
  const std::int64_t low = std::clamp<std::int64_t>(-(first[0] - 1), 0, w);
  const std::int64_t high = std::clamp<std::int64_t>(crop[0] - (first[0] - 1), low, w);
  for (std::size_t k = 0;; ++k)
  {
    bool inside = low < high;
    std::int64_t at = 0;
    for (std::size_t a = D; a-- > 1;)
    {
      std::int64_t i = first[a] - 1 + offset[a];
      if (D == 4 && a == 3)
      {
        if (image.IsPeriodicInTime() && image.ReachesBorderInTime(0))
        {
          const std::int64_t period = crop[a] - 1; // the last frame is the first one
          i = (i % period + period) % period;
        }
        i = image.ReachesBorderInTime(0) ? std::max<std::int64_t>(i, 0) : i;
        i = image.ReachesBorderInTime(1) ? std::min<std::int64_t>(i, crop[a] - 1) : i;
      }
      i = image.ReachesBorder(a, 0) ? std::max<std::int64_t>(i, 0) : i;
      i = image.ReachesBorder(a, 1) ? std::min<std::int64_t>(i, crop[a] - 1) : i;
      inside = inside && i >= 0 && i < crop[a];
      at = at * crop[a] + i;
    }
    at = at * crop[0] + first[0] - 1;
    const bool goOn = inside ? row(ids + at + low, low, high, k)
                             : row(static_cast<const LabelId*>(nullptr), low, low, k);
    std::size_t a = 1;
    while (a < D && ++offset[a] == w)
    {
      offset[a++] = 0;
    }
    if (!goOn || a == D)
    {
      return;
    }
  }
}

template <int D, typename SampleType>
bool TiledLattice<D, SampleType>::IsUniform(
  const LabelImage<D>& image, const Index& first, LabelId& label)
{
  bool started = false;
  bool uniform = true;
  label = 0;
  ForEachRow(image, first, TileSamples,
    [&](const LabelId* in, std::int64_t low, std::int64_t high, std::size_t)
    {
      if (!started)
      {
        label = low == 0 && high > 0 ? in[0] : RowEnds(image, in, low, high)[0];
        started = true;
      }
      if (high - low == TileSamples)
      {
        LabelId difference = 0;
        for (unsigned i = 0; i < TileSamples; ++i)
        {
          difference |= in[i] ^ label;
        }
        uniform = difference == 0;
        return uniform;
      }
      const auto [before, after] = RowEnds(image, in, low, high);
      uniform = (low == 0 || before == label) && (high == TileSamples || after == label);
      for (std::int64_t i = 0; i < high - low; ++i)
      {
        uniform = uniform && in[i] == label;
      }
      return uniform;
    });
  return uniform;
}

template <int D, typename SampleType>
template <typename Make, typename Done>
void TiledLattice<D, SampleType>::MakeTiles(const LabelImage<D>& image, unsigned threads,
  const std::stop_token& stop, Make&& make, Done&& done)
{
  this->FillDirectory(
    threads, stop, make,
    [&image](auto& builder, const Index& first, std::size_t)
    {
      LabelId label = 0;
      return IsUniform(image, first, label)
        ? (static_cast<std::uintptr_t>(label) << 1) | 1u
        : reinterpret_cast<std::uintptr_t>(builder.MakeTile(first));
    },
    done);
}

template <int D, typename SampleType>
template <typename Make>
void TiledLattice<D, SampleType>::RemakeTiles(
  unsigned threads, const std::stop_token& stop, Make&& make)
{
  this->FillDirectory(
    threads, stop, make,
    [this](auto& builder, const Index& first, std::size_t number)
    {
      const std::uintptr_t old = this->Directory[number];
      return old & 1
        ? old
        : reinterpret_cast<std::uintptr_t>(builder.RemakeTile(first,
            reinterpret_cast<const Sample*>(old))); // NOLINT(performance-no-int-to-ptr): tagged
    },
    [](const auto&) {});
}

template <int D, typename SampleType>
template <typename Make, typename Entry, typename Done>
void TiledLattice<D, SampleType>::FillDirectory(
  unsigned threads, const std::stop_token& stop, Make&& make, Entry&& entry, Done&& done)
{
  std::vector<std::invoke_result_t<Make>> builders;
  using Builder = typename std::invoke_result_t<Make>::element_type;
  std::vector<Builder*> idle;
  std::mutex mutex;
  std::vector<std::uintptr_t> entries(this->Directory.size());
  ParallelFor(
    0, entries.size(), 128, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Builder* builder = nullptr;
      {
        const std::scoped_lock lock(mutex);
        if (idle.empty())
        {
          builders.push_back(make());
          idle.push_back(builders.back().get());
        }
        builder = idle.back();
        idle.pop_back();
      }
      for (std::size_t tile = begin; tile < end; ++tile)
      {
        ThrowIfStopped(stop); // a 4D tile with many labels and strong smoothing takes a while
        Index first{};
        std::size_t rest = tile;
        for (std::size_t a = 0; a < D; ++a)
        {
          const std::size_t n = static_cast<std::size_t>(this->LastCell[a] / TileCells) + 1;
          first[a] = static_cast<std::int64_t>(rest % n * TileCells);
          rest /= n;
        }
        entries[tile] = entry(*builder, first, tile);
      }
      const std::scoped_lock lock(mutex);
      idle.push_back(builder);
    },
    stop);
  this->Directory.swap(entries);
  this->Blocks.clear();
  this->BlockBytes = 0;
  for (const auto& builder : builders)
  {
    this->BlockBytes += builder->Memory.Bytes;
    for (auto& block : builder->Memory.Blocks)
    {
      this->Blocks.push_back(std::move(block));
    }
    done(*builder);
  }
}

template <int D, typename SampleType>
template <typename Function>
void TiledLattice<D, SampleType>::ForEachRun(
  const std::array<std::vector<std::int64_t>, static_cast<std::size_t>(D)>& samples,
  Function&& run) const
{
  // Where the samples of an axis are in tiles. A sample on the common face of two tiles is the first of
  // one and the last of the other. The last tile has no next one.
  struct Part
  {
    bool Exists = false;
    std::size_t Number = 0; // of the tile
    unsigned Offset = 0;
  };
  std::array<std::vector<Part>, static_cast<std::size_t>(D)> parts;
  std::size_t rows = 1;
  for (std::size_t a = 0; a < D; ++a)
  {
    for (const std::int64_t sample : samples[a])
    {
      Part& part = parts[a].emplace_back();
      if (sample >= 0)
      {
        const std::uint32_t tile =
          std::min(static_cast<std::uint32_t>(sample) / TileCells, this->LastCell[a] / TileCells);
        part = { true, std::size_t{ tile } * this->TileStride[a],
          (static_cast<unsigned>(sample) - tile * TileCells) << (3 * a) };
      }
    }
    rows *= a == 0 ? 1 : samples[a].size();
  }
  const std::vector<Part>& x = parts[0];
  std::vector<std::size_t> ends; // of the runs of a row
  for (std::size_t k = 1; k <= x.size(); ++k)
  {
    const bool goesOn = k < x.size() && x[k].Exists == x[k - 1].Exists &&
      (!x[k].Exists || (x[k].Number == x[k - 1].Number && samples[0][k] == samples[0][k - 1] + 1));
    if (!goesOn)
    {
      ends.push_back(k);
    }
  }

  std::array<std::size_t, static_cast<std::size_t>(D)> at{};
  for (std::size_t row = 0; row < rows; ++row)
  {
    Part other{ true };
    for (std::size_t a = 1; a < D; ++a)
    {
      const Part& part = parts[a][at[a]];
      other.Exists = other.Exists && part.Exists;
      other.Number += part.Number;
      other.Offset += part.Offset;
    }
    for (std::size_t a = 1; a < D && ++at[a] == parts[a].size(); ++a)
    {
      at[a] = 0;
    }
    std::size_t begin = 0;
    for (const std::size_t end : ends)
    {
      const std::size_t place = row * x.size() + begin;
      const auto count = static_cast<unsigned>(end - begin);
      const Part& first = x[begin];
      begin = end;
      if (!other.Exists || !first.Exists)
      {
        run(static_cast<const Sample*>(nullptr), LabelId{ 0 }, 0u, count, place);
        continue;
      }
      const std::uintptr_t entry = this->Directory[other.Number + first.Number];
      const bool isUniform = (entry & 1) != 0;
      run(isUniform
          ? nullptr
          : reinterpret_cast<const Sample*>(entry), // NOLINT(performance-no-int-to-ptr): tagged
        static_cast<LabelId>(isUniform ? entry >> 1 : 0), other.Offset + first.Offset, count,
        place);
    }
  }
}

//------------------------------------------------------------------------------------------------
template <int D, typename SampleType>
template <typename Function>
void TiledLattice<D, SampleType>::ChangeSample(const Index& sample, Function&& change)
{
  // A sample on the common face of two tiles is the first of one and the last of the other.
  for (unsigned last = 0; last < (1u << D); ++last)
  {
    bool exists = true;
    std::size_t number = 0;
    std::size_t at = 0;
    for (std::size_t a = 0; a < D; ++a)
    {
      auto tile = static_cast<std::uint32_t>(sample[a]) / TileCells;
      auto i = static_cast<std::uint32_t>(sample[a]) % TileCells;
      if ((last >> a) & 1u)
      {
        exists = exists && i == 0 && tile > 0;
        --tile;
        i = TileCells;
      }
      exists = exists && tile <= this->LastCell[a] / TileCells;
      number += std::size_t{ tile } * this->TileStride[a];
      at += std::size_t{ i } << (3 * a);
    }
    if (exists && !(this->Directory[number] & 1))
    {
      change(reinterpret_cast<Sample*>(
               this->Directory[number]), // NOLINT(performance-no-int-to-ptr): tagged
        at);
    }
  }
}

} // namespace voxplex

#endif
