// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/LabelField.h"

#include "Error.h"
#include "Image/LabelSmoothing.h"
#include "Parallel/ParallelFor.h"

#include <cstring>
#include <mutex>
#include <sstream>

namespace voxplex
{
namespace
{

/**
 * By how much the own label of a voxel wins at least, and where its object is one voxel thin: there
 * the voxels beside it lose it by about as much, so that the object comes out about one voxel
 * thick. In samples (SampleOne is 1); even.
 */
constexpr int KeptMargin = 328;
constexpr int ThinMargin = 16384;

} // namespace

/** Memory for the samples of mixed tiles, taken by one thread at a time. */
template <int D>
struct LabelField<D>::Arena
{
  static constexpr std::size_t BlockSize = std::size_t{ 1 } << 18; ///< samples
  std::vector<std::unique_ptr<Sample[]>> Blocks;
  std::size_t Bytes = 0;
  Sample* Next = nullptr;
  std::size_t Left = 0;

  /** Uninitialised; 16-byte aligned, since sizes are multiples of 8 samples. */
  Sample* Allocate(std::size_t samples)
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
};

/** Makes tiles; one instance serves one thread at a time. */
template <int D>
class LabelField<D>::Builder
{
public:
  Builder(const LabelImage<D>& image, const LabelSmoothing& smoothing)
    : Image(image)
    , Smoothing(smoothing)
    , Radius(smoothing.Radius())
    , Width(TileSamples + 2 * this->Radius)
    , SlotOf(image.Values().size(), NoSlot)
    , OwnSlots(PlaneSize)
    , Margins(PlaneSize)
    , Other(PlaneSize)
  {
    this->Rows = 1;
    for (int a = 1; a < D; ++a)
    {
      this->Rows *= this->Width;
    }
    this->Halo.resize(this->Rows * this->Width);
  }

  /** The directory's entry of the tile whose first sample is at these lattice coordinates. */
  std::uintptr_t MakeTile(const Index& first)
  {
    LabelId label = 0;
    if (this->IsUniform(first, label))
    {
      return (static_cast<std::uintptr_t>(label) << 1) | 1u;
    }
    ++this->MixedTiles;
    this->GatherHalo(first);
    this->GatherLabels();
    return reinterpret_cast<std::uintptr_t>(this->Smooth());
  }

  Arena Memory;
  std::size_t MixedTiles = 0;

private:
  static constexpr std::uint16_t NoSlot = 0xffff;

  /**
   * Calls row(in, x0, x1, k) for each row of a box of `width` samples along each axis: row k of the
   * box, of which the samples x0 ... x1 - 1 lie in the crop, with ids from `in`; x0 == x1 if none
   * does. Returns early when row returns false.
   */
  template <typename Function>
  void ForEachRow(const Index& first, std::size_t width, Function&& row) const
  {
    const Index& crop = this->Image.CropDimensions();
    const auto w = static_cast<std::int64_t>(width);
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
          i = this->Image.IsCutInTime(0) ? std::max<std::int64_t>(i, 0) : i;
          i = this->Image.IsCutInTime(1) ? std::min<std::int64_t>(i, crop[a] - 1) : i;
        }
        inside = inside && i >= 0 && i < crop[a];
        at = at * crop[a] + i;
      }
      at = at * crop[0] + first[0] - 1;
      const bool goOn = inside ? row(this->Image.Ids().data() + at + low, low, high, k)
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

  /** Whether all samples of a tile have one label. */
  bool IsUniform(const Index& first, LabelId& label) const
  {
    bool started = false;
    bool uniform = true;
    label = 0;
    this->ForEachRow(first, TileSamples,
      [&](const LabelId* in, std::int64_t low, std::int64_t high, std::size_t)
      {
        if (!started)
        {
          label = low == 0 && high > 0 ? in[0] : LabelId{ 0 };
          started = true;
        }
        if (high - low == TileSamples)
        {
          const std::uint64_t wanted = label * 0x0001000100010001u;
          std::uint64_t halves[2];
          std::memcpy(halves, in, sizeof(halves));
          uniform = ((halves[0] ^ wanted) | (halves[1] ^ wanted)) == 0;
          return uniform;
        }
        uniform = label == 0;
        for (std::int64_t i = 0; i < high - low; ++i)
        {
          uniform = uniform && in[i] == 0;
        }
        return uniform;
      });
    return uniform;
  }

  /** Copies the ids within reach of the kernel. */
  void GatherHalo(Index first)
  {
    for (std::int64_t& i : first)
    {
      i -= static_cast<std::int64_t>(this->Radius);
    }
    const std::size_t width = this->Width;
    this->ForEachRow(first, width,
      [&](const LabelId* in, std::int64_t low, std::int64_t high, std::size_t k)
      {
        LabelId* out = this->Halo.data() + k * width;
        std::fill(out, out + low, LabelId{ 0 });
        if (low < high)
        {
          std::memcpy(out + low, in, static_cast<std::size_t>(high - low) * sizeof(LabelId));
        }
        std::fill(out + high, out + width, LabelId{ 0 });
        return true;
      });
  }

  /** Finds the labels of the halo and their rows of bits. */
  void GatherLabels()
  {
    for (const LabelId label : this->Labels)
    {
      this->SlotOf[label] = NoSlot;
    }
    this->Labels.clear();
    const LabelId* in = this->Halo.data();
    const std::uint64_t all = ~std::uint64_t{ 0 } >> (64 - this->Width);
    for (std::size_t row = 0; row < this->Rows; ++row, in += this->Width)
    {
      if (std::memcmp(in, in + 1, (this->Width - 1) * sizeof(LabelId)) == 0)
      {
        this->WordsOf(in[0])[row] = all; // most rows
        continue;
      }
      for (std::size_t x = 0; x < this->Width;)
      {
        const LabelId label = in[x];
        const std::size_t begin = x;
        while (++x < this->Width && in[x] == label)
        {
        }
        this->WordsOf(label)[row] |= (all << begin) & (all >> (this->Width - x));
      }
    }
  }

  /** The rows of bits of a label; all 0 when it is first met. */
  std::uint64_t* WordsOf(LabelId label)
  {
    std::uint16_t slot = this->SlotOf[label];
    if (slot == NoSlot)
    {
      slot = static_cast<std::uint16_t>(this->Labels.size());
      this->SlotOf[label] = slot;
      this->Labels.push_back(label);
      if (this->Words.size() < this->Labels.size() * this->Rows)
      {
        this->Words.resize(this->Labels.size() * this->Rows);
      }
      std::fill_n(this->Words.begin() + static_cast<std::ptrdiff_t>(slot * this->Rows), this->Rows,
        std::uint64_t{ 0 });
    }
    return this->Words.data() + slot * this->Rows;
  }

  /** Samples of one label, before the own label is kept. */
  void SmoothLabel(LabelId label, Sample* plane)
  {
    const std::size_t slot = this->SlotOf[label];
    this->Smoothing.Smooth(this->Words.data() + slot * this->Rows, this->Buffers, plane);
  }

  /** All planes of the tile whose labels have been gathered. */
  const Sample* Smooth()
  {
    std::sort(this->Labels.begin(), this->Labels.end());
    const std::size_t labels = this->Labels.size();
    const std::size_t header = HeaderSize(labels);
    const std::size_t planes = labels == 2 ? 1 : labels;
    Sample* tile = this->Memory.Allocate(header + planes * PlaneSize);
    tile[0] = static_cast<Sample>(labels);
    for (std::size_t l = 0; l < labels; ++l)
    {
      tile[1 + l] = static_cast<Sample>(this->Labels[l]);
    }
    for (std::size_t l = 0; l < planes; ++l)
    {
      this->SmoothLabel(this->Labels[l], tile + header + l * PlaneSize);
    }
    this->GatherOwn();
    this->GatherMargins();
    KeepOwnLabels(this->OwnSlots.data(), this->Margins.data(), labels, PlaneSize, tile + header,
      this->Other.data());
    return tile;
  }

  /** Which of the sorted labels each sample has. */
  void GatherOwn()
  {
    for (std::size_t l = 0; l < this->Labels.size(); ++l)
    {
      this->SlotOf[this->Labels[l]] = static_cast<std::uint16_t>(l);
    }
    for (std::size_t row = 0; row < PlaneSize / 8; ++row)
    {
      std::size_t at = 0;
      for (std::size_t a = D; a-- > 1;)
      {
        at = at * this->Width + ((row >> (3 * (a - 1))) & 7) + this->Radius;
      }
      const LabelId* in = this->Halo.data() + at * this->Width + this->Radius;
      for (std::size_t i = 0; i < 8; ++i)
      {
        this->OwnSlots[row * 8 + i] = this->SlotOf[in[i]];
      }
    }
  }

  /** By how much each sample's own label has to win. */
  void GatherMargins()
  {
    std::fill(this->Margins.begin(), this->Margins.end(), Sample{ KeptMargin });
    if (this->Radius == 0)
    {
      return; // nothing is smoothed
    }
    for (std::size_t row = 0; row < PlaneSize / 8; ++row)
    {
      std::size_t at = 0;
      for (std::size_t a = D; a-- > 1;)
      {
        at = at * this->Width + ((row >> (3 * (a - 1))) & 7) + this->Radius;
      }
      const LabelId* in = this->Halo.data() + at * this->Width + this->Radius;
      std::array<LabelId, 8> thin{};
      std::size_t stride = 1;
      for (int a = 0; a < D; ++a, stride *= this->Width)
      {
        for (std::size_t i = 0; i < 8; ++i)
        {
          const LabelId before = *(in + i - stride);
          thin[i] |= static_cast<LabelId>((before != in[i]) & (in[i + stride] != in[i]));
        }
      }
      for (std::size_t i = 0; i < 8; ++i)
      {
        if (thin[i] && in[i] != 0 && this->IsThinObject(in + i))
        {
          this->Margins[row * 8 + i] = ThinMargin;
        }
      }
    }
  }

  /**
   * Whether a voxel between two others along some axis belongs to something one voxel thin, not to
   * a bump on something thicker: no face neighbour with its label is thick itself.
   */
  bool IsThinObject(const LabelId* voxel) const
  {
    if (this->Radius < 2)
    {
      return true;
    }
    std::size_t stride = 1;
    for (int a = 0; a < D; ++a, stride *= this->Width)
    {
      for (const LabelId* neighbour : { voxel - stride, voxel + stride })
      {
        if (*neighbour == *voxel && !this->IsBetweenOthers(neighbour))
        {
          return false;
        }
      }
    }
    return true;
  }

  bool IsBetweenOthers(const LabelId* voxel) const
  {
    std::size_t stride = 1;
    for (int a = 0; a < D; ++a, stride *= this->Width)
    {
      if (*(voxel - stride) != *voxel && voxel[stride] != *voxel)
      {
        return true;
      }
    }
    return false;
  }

  const LabelImage<D>& Image;
  const LabelSmoothing& Smoothing;
  std::size_t Radius;
  std::size_t Width; ///< samples of the halo along each axis
  std::size_t Rows;  ///< of the halo
  std::vector<LabelId> Halo;
  std::vector<LabelId> Labels; ///< of the halo
  std::vector<std::uint16_t> SlotOf;
  std::vector<std::uint64_t> Words;
  LabelSmoothing::Buffers Buffers;
  std::vector<std::uint16_t> OwnSlots;
  std::vector<Sample> Margins;
  std::vector<Sample> Other;
};

template <int D>
LabelField<D>::LabelField(
  const LabelImage<D>& image, double sigma, unsigned threads, const std::stop_token& stop)
  : Grid(image.Grid())
{
  if (!(sigma >= 0.0 && sigma <= MaximumSigma))
  {
    std::ostringstream s;
    s << "The smoothing's standard deviation is " << sigma << " voxels; it must be between 0 (no "
      << "smoothing) and " << MaximumSigma << ".";
    throw InputError(s.str());
  }
  Index tiles{};
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
    tiles[a] = static_cast<std::int64_t>(this->LastCell[a] / TileCells) + 1;
    this->TileStride[a] = static_cast<std::uint32_t>(numberOfTiles);
    numberOfTiles *= static_cast<std::size_t>(tiles[a]);
  }
  this->Directory.resize(numberOfTiles);
  if (image.IsCutInTime(0))
  {
    this->Ends[0] = 1.0;
  }
  if (image.IsCutInTime(1))
  {
    this->Ends[1] = static_cast<double>(image.CropDimensions()[D - 1]);
  }

  const LabelSmoothing smoothing(D, sigma);
  std::vector<std::unique_ptr<Builder>> builders;
  std::vector<Builder*> idle;
  std::mutex mutex;
  ParallelFor(
    0, numberOfTiles, 128, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Builder* builder = nullptr;
      {
        const std::scoped_lock lock(mutex);
        if (idle.empty())
        {
          builders.push_back(std::make_unique<Builder>(image, smoothing));
          idle.push_back(builders.back().get());
        }
        builder = idle.back();
        idle.pop_back();
      }
      for (std::size_t tile = begin; tile < end; ++tile)
      {
        ThrowIfStopped(stop); // a tile in 4D with many labels and much smoothing takes a while
        Index first{};
        std::size_t rest = tile;
        for (std::size_t a = 0; a < D; ++a)
        {
          const auto n = static_cast<std::size_t>(tiles[a]);
          first[a] = static_cast<std::int64_t>(rest % n * TileCells);
          rest /= n;
        }
        this->Directory[tile] = builder->MakeTile(first);
      }
      const std::scoped_lock lock(mutex);
      idle.push_back(builder);
    },
    stop);
  for (const auto& builder : builders)
  {
    this->MixedTiles += builder->MixedTiles;
    this->BlockBytes += builder->Memory.Bytes;
    for (auto& block : builder->Memory.Blocks)
    {
      this->Blocks.push_back(std::move(block));
    }
  }
}

/** Gradient of the interpolation: one axis after the other, values and derivatives together. */
template <int D>
Point<D> LabelField<D>::PlaneGradient(const Sample* plane, const Cell& cell)
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

template <int D>
bool LabelField<D>::MarginGradientAt(const Point<D>& x, LabelId label, Point<D>& gradient) const
{
  const Cell cell = this->Locate(x);
  if (!cell.Tile)
  {
    return false;
  }
  const auto labels = static_cast<std::size_t>(cell.Tile[0]);
  const Sample* planes = cell.Tile + HeaderSize(labels);
  double scale = 1.0 / SampleOne;
  if (labels == 2)
  {
    if (label != static_cast<LabelId>(cell.Tile[1]))
    {
      scale = -scale;
    }
    gradient = PlaneGradient(planes, cell);
    for (double& g : gradient)
    {
      g *= 2.0 * scale;
    }
    return label == static_cast<LabelId>(cell.Tile[1]) ||
      label == static_cast<LabelId>(cell.Tile[2]);
  }
  std::size_t own = labels;
  std::size_t other = labels;
  float otherValue = -std::numeric_limits<float>::max();
  for (std::size_t l = 0; l < labels; ++l)
  {
    if (static_cast<LabelId>(cell.Tile[1 + l]) == label)
    {
      own = l;
      continue;
    }
    const float value = InterpolatePlane(planes + l * PlaneSize, cell);
    if (value > otherValue)
    {
      other = l;
      otherValue = value;
    }
  }
  if (own == labels)
  {
    return false;
  }
  gradient = PlaneGradient(planes + own * PlaneSize, cell);
  const Point<D> minus = PlaneGradient(planes + other * PlaneSize, cell);
  for (std::size_t a = 0; a < D; ++a)
  {
    gradient[a] = scale * (gradient[a] - minus[a]);
  }
  return true;
}

template <int D>
std::size_t LabelField<D>::MemoryBytes() const
{
  return this->BlockBytes + this->Directory.size() * sizeof(std::uintptr_t);
}

template class LabelField<3>;
template class LabelField<4>;

} // namespace voxplex
