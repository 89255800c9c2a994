// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Domain/LabelField.h"

#include "Base/Error.h"
#include "Base/VectorClones.h"
#include "Domain/BuriedVoxels.h"
#include "Image/LabelSmoothing.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

namespace voxplex
{
namespace
{

/**
 * The least margin of a voxel's own label where its object is one voxel thin. The label loses by about as
 * much at the voxels beside it, so that the object becomes about one voxel thick. Even, and in
 * units of samples (SampleOne is 1).
 */
constexpr int ThinMargin = 16384;
/** If a voxel's label wins by less, its interface may be missed: the voxel is weak. */
constexpr int SolidMargin = 4916;

using Eight = std::array<LabelId, 8>; // a vector register

/** Finds which of eight voxels of a block lie between two voxels of other labels along an axis, if any does. */
VOXPLEX_VECTOR_CLONES bool FindThin(const LabelId* in, std::size_t width, int axes, Eight& thin)
{
  const auto eightAt = [](const LabelId* at)
  {
    Eight eight;
    std::memcpy(eight.data(), at, sizeof(eight));
    return eight;
  };
  const Eight own = eightAt(in);
  Eight found{};
  std::size_t stride = 1;
  for (int a = 0; a < axes; ++a, stride *= width)
  {
    const Eight before = eightAt(in - stride);
    const Eight behind = eightAt(in + stride);
    for (std::size_t i = 0; i < 8; ++i)
    {
      found[i] |= static_cast<LabelId>((before[i] != own[i]) & (behind[i] != own[i]));
    }
  }
  thin = found;
  std::array<std::uint64_t, 4> words;
  static_assert(sizeof(words) == sizeof(found));
  std::memcpy(words.data(), found.data(), sizeof(words));
  return (words[0] | words[1] | words[2] | words[3]) != 0;
}

} // namespace

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

  /** The samples of the tile whose first sample is at these lattice coordinates. */
  const Sample* MakeTile(const Index& first)
  {
    this->GatherHalo(first);
    this->GatherLabels();
    const Sample* tile = this->Smooth();
    if (D == 3 && this->Radius > 0)
    {
      this->NoteWeak(first, tile);
    }
    return tile;
  }

  typename Base::Arena Memory;
  std::vector<WeakVoxel> Weak; ///< of all tiles made so far

private:
  static constexpr std::uint32_t NoSlot = 0xffffffff;

  /** Copies the ids of the tile and of all voxels within reach of the smoothing kernel. */
  void GatherHalo(Index first)
  {
    for (std::int64_t& i : first)
    {
      i -= static_cast<std::int64_t>(this->Radius);
    }
    const std::size_t width = this->Width;
    Base::ForEachRow(this->Image, first, width,
      [&](const LabelId* in, std::int64_t low, std::int64_t high, std::size_t k)
      {
        LabelId* out = this->Halo.data() + k * width;
        if (high - low == static_cast<std::int64_t>(width))
        {
          this->CopyRow(in, out);
          return true;
        }
        const auto [before, after] = Base::RowEnds(this->Image, in, low, high);
        std::fill(out, out + low, before);
        if (low < high)
        {
          std::memcpy(out + low, in, static_cast<std::size_t>(high - low) * sizeof(LabelId));
        }
        std::fill(out + high, out + width, after);
        return true;
      });
  }

  /** A row is too short for memcpy() to pay. */
  void CopyRow(const LabelId* in, LabelId* out) const
  {
    constexpr std::size_t four = 4; // labels in a vector register
    std::size_t x = 0;
    for (; x + four <= this->Width; x += four)
    {
      std::memcpy(out + x, in + x, four * sizeof(LabelId));
    }
    for (; x < this->Width; ++x)
    {
      out[x] = in[x];
    }
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
    LabelId last = in[0];
    std::uint64_t* words = this->WordsOf(last); // of the last row that has one label
    for (std::size_t row = 0; row < this->Rows; ++row, in += this->Width)
    {
      if (this->HasOneLabel(in)) // most rows
      {
        if (in[0] != last)
        {
          last = in[0];
          words = this->WordsOf(last);
        }
        words[row] = all;
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
      words = this->WordsOf(last); // a new label may have moved it
    }
  }

  /** Whether all voxels of a row of the halo have the same label. */
  bool HasOneLabel(const LabelId* in) const
  {
    const auto differences = [in](std::size_t width)
    {
      LabelId all = 0;
      for (std::size_t x = 0; x < width; ++x)
      {
        all |= in[x] ^ in[0];
      }
      return all;
    };
    constexpr std::size_t usual = 16; // by default: the compiler knows how often
    return (this->Width == usual ? differences(usual) : differences(this->Width)) == 0;
  }

  /** The rows of bits of a label. They are 0 at the first call for this label. */
  std::uint64_t* WordsOf(LabelId label)
  {
    std::uint32_t slot = this->SlotOf[label];
    if (slot == NoSlot)
    {
      slot = static_cast<std::uint32_t>(this->Labels.size());
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

  /** Makes the samples of one label, before KeepOwnLabels() corrects them. */
  void SmoothLabel(LabelId label, Sample* plane)
  {
    const std::size_t slot = this->SlotOf[label];
    this->Smoothing.Smooth(this->Words.data() + slot * this->Rows, this->Buffers, plane);
  }

  /** Makes all planes of the tile. The labels must have been gathered. */
  const Sample* Smooth()
  {
    std::sort(this->Labels.begin(), this->Labels.end());
    const std::size_t labels = this->Labels.size();
    const std::size_t header = HeaderSize(labels);
    const std::size_t planes = labels == 2 ? 1 : labels;
    const bool isBalanced = D == 4 && this->Radius > 0 && labels > 2;
    Sample* tile = this->Memory.Allocate(header + (planes + (isBalanced ? 2 : 0)) * PlaneSize);
    const auto count = static_cast<LabelId>(labels);
    std::memcpy(tile, &count, sizeof(count));
    std::memcpy(tile + SamplesPerLabel, this->Labels.data(), labels * sizeof(LabelId));
    for (std::size_t l = 0; l < planes; ++l)
    {
      this->SmoothLabel(this->Labels[l], tile + header + l * PlaneSize);
    }
    this->GatherOwn();
    this->GatherMargins();
    KeepOwnLabels(this->OwnSlots.data(), this->Margins.data(), labels, PlaneSize, tile + header,
      this->Other.data());
    if (isBalanced)
    {
      FindTwoLargest(tile + header, labels);
    }
    return tile;
  }

  /** Writes, behind a tile's planes, the largest and the second largest value of all labels. */
  static void FindTwoLargest(Sample* planes, std::size_t labels)
  {
    Sample* const largest = planes + labels * PlaneSize;
    Sample* const second = largest + PlaneSize;
    std::copy_n(planes, PlaneSize, largest);
    std::fill_n(second, PlaneSize, std::numeric_limits<Sample>::min());
    for (std::size_t l = 1; l < labels; ++l)
    {
      const Sample* const plane = planes + l * PlaneSize;
      for (std::size_t i = 0; i < PlaneSize; ++i)
      {
        const Sample value = plane[i];
        const Sample most = largest[i];
        const Sample next = second[i];
        const Sample smaller = value < most ? value : most;
        largest[i] = value < most ? most : value;
        second[i] = smaller < next ? next : smaller;
      }
    }
  }

  /** Notes the weak voxels of a tile that Smooth() has made. */
  void NoteWeak(const Index& first, const Sample* tile)
  {
    const std::size_t labels = this->Labels.size();
    const Sample* planes = tile + HeaderSize(labels);
    for (std::size_t i = 0; i < PlaneSize; ++i)
    {
      const std::size_t own = this->OwnSlots[i];
      const int margin = labels == 2 ? 2 * (own == 0 ? planes[i] : -planes[i])
                                     : planes[own * PlaneSize + i] - this->Other[i];
      std::uint64_t sample = 0;
      bool isInLattice = true; // the last tile along an axis may go beyond
      for (std::size_t a = D; a-- > 0;)
      {
        const auto n = static_cast<std::uint64_t>(this->Image.CropDimensions()[a] + 2);
        const std::uint64_t x = static_cast<std::uint64_t>(first[a]) + ((i >> (3 * a)) & 7);
        sample = sample * n + x;
        isInLattice = isInLattice && x < n;
      }
      if (margin < SolidMargin && isInLattice)
      {
        this->Weak.push_back({ sample, margin <= KeptMargin });
      }
    }
  }

  /** The labels of the samples in a row of the tile. */
  const LabelId* HaloOf(std::size_t row) const
  {
    std::size_t at = 0;
    for (std::size_t a = D; a-- > 1;)
    {
      at = at * this->Width + ((row >> (3 * (a - 1))) & 7) + this->Radius;
    }
    return this->Halo.data() + at * this->Width + this->Radius;
  }

  /** Finds for each sample which of the sorted labels it has. */
  void GatherOwn()
  {
    for (std::size_t l = 0; l < this->Labels.size(); ++l)
    {
      this->SlotOf[this->Labels[l]] = static_cast<std::uint32_t>(l);
    }
    for (std::size_t row = 0; row < PlaneSize / 8; ++row)
    {
      const LabelId* in = this->HaloOf(row);
      for (std::size_t i = 0; i < 8; ++i)
      {
        this->OwnSlots[row * 8 + i] = static_cast<std::uint16_t>(this->SlotOf[in[i]]);
      }
    }
  }

  /** Finds for each sample the margin by which its own label must win. */
  void GatherMargins()
  {
    std::fill(this->Margins.begin(), this->Margins.end(), Sample{ KeptMargin });
    if (this->Radius == 0)
    {
      return; // nothing is smoothed
    }
    for (std::size_t row = 0; row < PlaneSize / 8; ++row)
    {
      const LabelId* in = this->HaloOf(row);
      Eight thin;
      if (!FindThin(in, this->Width, D, thin))
      {
        continue;
      }
      for (std::size_t i = 0; i < 8; ++i)
      {
        if (thin[i] && this->IsThinObject(in + i))
        {
          this->Margins[row * 8 + i] = ThinMargin;
        }
      }
    }
  }

  /**
   * For a voxel that lies between two voxels of other labels along some axis. Tells whether it
   * belongs to an object that is one voxel thin, not to a bump on a thicker object: no face
   * neighbour with its label is thick. An object that is too small to contain a block of two voxels
   * along each axis is thin everywhere, even where its legs meet. This does not hold for
   * background, which need not be in the mesh.
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
          return *voxel != 0 && this->IsSpeck(voxel);
        }
      }
    }
    return true;
  }

  /**
   * Whether the connected component of a voxel, within the reach of the kernel, has fewer voxels
   * than a block of 2^D.
   */
  bool IsSpeck(const LabelId* voxel) const
  {
    struct Member
    {
      const LabelId* Voxel;
      std::array<int, static_cast<std::size_t>(D)> Offset; ///< from the given voxel
    };
    std::array<Member, std::size_t{ 1 } << D> members;
    std::size_t count = 0;
    members[count++] = { voxel, {} };
    for (std::size_t next = 0; next < count; ++next)
    {
      const Member from = members[next];
      std::ptrdiff_t stride = 1;
      for (std::size_t a = 0; a < D; ++a, stride *= static_cast<std::ptrdiff_t>(this->Width))
      {
        for (const int step : { -1, 1 })
        {
          Member to = from;
          to.Offset[a] += step;
          if (static_cast<std::size_t>(std::abs(to.Offset[a])) > this->Radius)
          {
            continue;
          }
          to.Voxel += step * stride;
          if (*to.Voxel != *voxel ||
            std::any_of(members.begin(), members.begin() + count,
              [&](const Member& known) { return known.Voxel == to.Voxel; }))
          {
            continue;
          }
          members[count++] = to;
          if (count == members.size())
          {
            return false;
          }
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
  std::size_t Rows;  ///< number of rows of the halo
  std::vector<LabelId> Halo;
  std::vector<LabelId> Labels; ///< labels that occur in the halo
  std::vector<std::uint32_t> SlotOf;
  std::vector<std::uint64_t> Words;
  LabelSmoothing::Buffers Buffers;
  std::vector<std::uint16_t> OwnSlots;
  std::vector<Sample> Margins;
  std::vector<Sample> Other;
};

template <int D>
LabelField<D>::LabelField(
  const LabelImage<D>& image, double sigma, unsigned threads, const std::stop_token& stop)
  : LabelField::BorderedField(image)
{
  if (!(sigma >= 0.0 && sigma <= MaximumSigma))
  {
    std::ostringstream s;
    s << "The smoothing's standard deviation is " << sigma << " voxels; it must be between 0 (no "
      << "smoothing) and " << MaximumSigma << ".";
    throw InputError(s.str());
  }
  const LabelSmoothing smoothing(D, sigma);
  std::vector<WeakVoxel> weak;
  this->MakeTiles(
    image, threads, stop, [&] { return std::make_unique<Builder>(image, smoothing); },
    [&](const Builder& builder)
    { weak.insert(weak.end(), builder.Weak.begin(), builder.Weak.end()); });
  if constexpr (D == 4)
  {
    if (smoothing.Radius() > 0)
    {
      this->BalanceVolumes(image, sigma, threads, stop);
    }
  }
  else
  {
    for (const Index& sample : FindBuriedVoxels(image, weak, threads, stop))
    {
      this->Raise(sample, image.At({ sample[0] - 1, sample[1] - 1, sample[2] - 1 }));
    }
  }
}

/** Makes a label win at a sample, as on objects that are one voxel thin. */
template <int D>
void LabelField<D>::Raise(const Index& sample, LabelId label)
{
  this->ChangeSample(sample,
    [label](Sample* tile, std::size_t i)
    {
      const std::size_t labels = CountOf(tile);
      Sample* planes = tile + HeaderSize(labels);
      const std::size_t own = FindLabel(tile, label);
      if (labels == 2)
      {
        constexpr Sample half = ThinMargin / 2;
        planes[i] =
          own == 0 ? std::max(planes[i], half) : std::min(planes[i], static_cast<Sample>(-half));
        return;
      }
      int other = std::numeric_limits<Sample>::min();
      for (std::size_t l = 0; l < labels; ++l)
      {
        other = l == own ? other : std::max<int>(other, planes[l * PlaneSize + i]);
      }
      Sample& value = planes[own * PlaneSize + i];
      value = static_cast<Sample>(
        std::clamp<int>(other + ThinMargin, value, std::numeric_limits<Sample>::max()));
    });
}

template <int D>
bool LabelField<D>::ExtendedMarginGradientAt(
  const Point<D>& x, LabelId label, Point<D>& gradient) const
{
  const Cell cell = this->Locate(x);
  if (!cell.Tile)
  {
    return false;
  }
  const std::size_t labels = CountOf(cell.Tile);
  const Sample* planes = cell.Tile + HeaderSize(labels);
  double scale = 1.0 / SampleOne;
  if (labels == 2)
  {
    if (label != LabelOf(cell.Tile, 0))
    {
      scale = -scale;
    }
    gradient = Base::PlaneGradient(planes, cell);
    for (double& g : gradient)
    {
      g *= 2.0 * scale;
    }
    return label == LabelOf(cell.Tile, 0) || label == LabelOf(cell.Tile, 1);
  }
  std::size_t own = labels;
  std::size_t other = labels;
  float otherValue = -std::numeric_limits<float>::max();
  for (std::size_t l = 0; l < labels; ++l)
  {
    if (LabelOf(cell.Tile, l) == label)
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
  gradient = Base::PlaneGradient(planes + own * PlaneSize, cell);
  const Point<D> minus = Base::PlaneGradient(planes + other * PlaneSize, cell);
  for (std::size_t a = 0; a < D; ++a)
  {
    gradient[a] = scale * (gradient[a] - minus[a]);
  }
  return true;
}

template class LabelField<3>;
template class LabelField<4>;

} // namespace voxplex
