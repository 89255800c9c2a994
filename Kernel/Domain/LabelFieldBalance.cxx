// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Domain/LabelField.h"

#include "Image/LabelSmoothing.h"
#include "Image/VolumeBalance.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace voxplex
{

/** Makes tiles whose labels have the volumes of their voxels; one instance serves one thread at a time. */
template <int D>
class LabelField<D>::Balancer
{
public:
  Balancer(const LabelField& field, const LabelImage<D>& image, const VolumeBalance& balance)
    : Field(field)
    , Image(image)
    , Balance(balance)
    , Shifts(PlaneSize)
    , OwnSlots(PlaneSize)
    , KeptMargins(PlaneSize, Sample{ KeptMargin })
    , Other(PlaneSize)
  {
    std::size_t size = 1;
    for (int a = 0; a < D; ++a)
    {
      size *= TileSamples + 2 * balance.Radius();
    }
    this->Margins.resize(size);
  }

  const Sample* RemakeTile(const Index& first, const Sample* tile)
  {
    this->FindBox(first);
    const std::size_t labels = CountOf(tile);
    const std::size_t planes = labels == 2 ? 1 : labels;
    const std::size_t size = HeaderSize(labels) + planes * PlaneSize;
    Sample* made = this->Memory.Allocate(size);
    std::copy_n(tile, size, made);
    for (std::size_t l = 0; l < planes; ++l)
    {
      this->GatherMargins(LabelOf(tile, l));
      this->Balance.Find(this->Margins.data(), this->Buffers, this->Shifts.data());
      Sample* plane = made + HeaderSize(labels) + l * PlaneSize;
      for (std::size_t i = 0; i < PlaneSize; ++i)
      {
        const int shift =
          static_cast<int>(std::lround(this->Shifts[i] * static_cast<float>(SampleOne)));
        plane[i] = static_cast<Sample>(std::clamp<int>(plane[i] - shift,
          std::numeric_limits<Sample>::min(), std::numeric_limits<Sample>::max()));
      }
    }
    KeepLabels(tile, made);
    return made;
  }

  typename Base::Arena Memory;

private:
  using Row = std::array<float, TileSamples>;
  static constexpr auto PerSample = static_cast<float>(1.0 / SampleOne);

  /** The coordinates of the box around a tile. Beyond a flat end they are those of the end. */
  void FindBox(const Index& first)
  {
    const auto radius = static_cast<std::int64_t>(this->Balance.Radius());
    for (std::size_t a = 0; a < D; ++a)
    {
      std::vector<std::int64_t>& samples = this->Box[a];
      samples.clear();
      const std::int64_t crop = this->Image.CropDimensions()[a];
      for (std::int64_t i = first[a] - radius; i < first[a] + TileSamples + radius; ++i)
      {
        std::int64_t sample = i;
        if (a == 3)
        {
          const bool begins = this->Image.ReachesBorderInTime(0);
          const bool ends = this->Image.ReachesBorderInTime(1);
          if (this->Image.IsPeriodicInTime() && begins)
          {
            const std::int64_t period = crop - 1; // the last frame is the first one
            sample = 1 + ((i - 1) % period + period) % period;
          }
          sample = begins ? std::max<std::int64_t>(sample, 1) : sample;
          sample = ends ? std::min(sample, crop) : sample;
        }
        samples.push_back(sample >= 0 && sample < crop + 2 ? sample : -1);
      }
    }
  }

  /** Half the margin of a label at each sample of the box, as VolumeBalance asks for it. */
  void GatherMargins(LabelId label)
  {
    this->Field.ForEachRun(this->Box,
      [&](const Sample* tile, LabelId uniform, unsigned offset, unsigned count, std::size_t place)
      {
        float* const to = this->Margins.data() + place;
        if (!tile)
        {
          std::fill_n(to, count, uniform == label ? 1.0f : -1.0f);
          return;
        }
        const std::size_t labels = CountOf(tile);
        const std::size_t own = FindLabel(tile, label);
        if (own == labels)
        {
          std::fill_n(to, count, -1.0f);
          return;
        }
        const unsigned begin = offset % TileSamples; // rows are made as a whole: in vectors
        const Sample* const planes = tile + HeaderSize(labels) + (offset - begin);
        Row row;
        if (labels == 2)
        {
          MarginsOfTwo(planes, own == 0, row);
        }
        else
        {
          const Sample* const largest = planes + labels * PlaneSize;
          MarginsOfMany(planes + own * PlaneSize, largest, largest + PlaneSize, row);
        }
        for (unsigned i = 0; i < count; ++i)
        {
          to[i] = row[begin + i];
        }
      });
  }

  static void MarginsOfTwo(const Sample* plane, bool isFirst, Row& margins)
  {
    const float scale = isFirst ? PerSample : -PerSample;
    for (std::size_t i = 0; i < TileSamples; ++i)
    {
      margins[i] = scale * static_cast<float>(plane[i]);
    }
  }

  static void MarginsOfMany(
    const Sample* plane, const Sample* largest, const Sample* second, Row& margins)
  {
    for (std::size_t i = 0; i < TileSamples; ++i)
    {
      const Sample value = plane[i];
      const Sample other = value == largest[i] ? second[i] : largest[i];
      const float margin = 0.5f * PerSample * static_cast<float>(value - other);
      // A label that is out of the kernel's reach has exactly -1.
      margins[i] = value <= static_cast<Sample>(-SampleOne) ? -1.0f : margin < 1.0f ? margin : 1.0f;
    }
  }

  /** Makes the label of each voxel centre win in `made` as it did in `tile`. */
  void KeepLabels(const Sample* tile, Sample* made)
  {
    const std::size_t labels = CountOf(tile);
    const Sample* const before = tile + HeaderSize(labels);
    if (labels == 2)
    {
      for (std::size_t i = 0; i < PlaneSize; ++i)
      {
        this->OwnSlots[i] = before[i] > 0 ? 0 : 1;
      }
    }
    else
    {
      const Sample* const largest = before + labels * PlaneSize;
      for (std::size_t l = labels; l-- > 0;) // of equal ones, the first
      {
        const Sample* const plane = before + l * PlaneSize;
        for (std::size_t i = 0; i < PlaneSize; ++i)
        {
          this->OwnSlots[i] =
            plane[i] == largest[i] ? static_cast<std::uint16_t>(l) : this->OwnSlots[i];
        }
      }
    }
    KeepOwnLabels(this->OwnSlots.data(), this->KeptMargins.data(), labels, PlaneSize,
      made + HeaderSize(labels), this->Other.data());
  }

  const LabelField& Field;
  const LabelImage<D>& Image;
  const VolumeBalance& Balance;
  std::array<std::vector<std::int64_t>, static_cast<std::size_t>(D)> Box;
  std::vector<float> Margins;
  std::vector<float> Shifts;
  VolumeBalance::Buffers Buffers;
  std::vector<std::uint16_t> OwnSlots;
  std::vector<Sample> KeptMargins;
  std::vector<Sample> Other;
};

/** Moves interfaces so that labels have the volumes of their voxels (VolumeBalance). */
template <int D>
void LabelField<D>::BalanceVolumes(
  const LabelImage<D>& image, double sigma, unsigned threads, const std::stop_token& stop)
{
  const VolumeBalance balance(sigma, LabelSmoothing(D, sigma).Kernel());
  this->RemakeTiles(
    threads, stop, [&] { return std::make_unique<Balancer>(*this, image, balance); });
}

template void LabelField<4>::BalanceVolumes(
  const LabelImage<4>&, double, unsigned, const std::stop_token&);

} // namespace voxplex
