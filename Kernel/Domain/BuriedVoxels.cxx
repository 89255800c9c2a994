// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Domain/BuriedVoxels.h"

#include "Image/BitMask.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <mutex>

namespace voxplex
{

namespace
{

using Index = GridGeometry<3>::Index;

constexpr std::size_t Grain = 1024;

Index IndexOf(std::uint64_t sample, const Index& dimensions)
{
  const auto nx = static_cast<std::uint64_t>(dimensions[0]);
  const auto ny = static_cast<std::uint64_t>(dimensions[1]);
  return { static_cast<std::int64_t>(sample % nx), static_cast<std::int64_t>(sample / nx % ny),
    static_cast<std::int64_t>(sample / nx / ny) };
}

/** The label of a sample of the lattice. */
LabelId LabelAt(const LabelImage<3>& image, const Index& sample)
{
  return image.At({ sample[0] - 1, sample[1] - 1, sample[2] - 1 });
}

/**
 * The samples with the label of `centre` around it, and itself. Empty if one of them is not weak:
 * then the label's interface is near.
 */
std::vector<Index> BuriedAround(
  const Index& centre, const LabelImage<3>& image, const BitMask<3>& weak)
{
  const LabelId label = LabelAt(image, centre);
  std::vector<Index> around;
  for (std::int64_t k = 0; k < 27; ++k)
  {
    const Index sample = { centre[0] + k % 3 - 1, centre[1] + k / 3 % 3 - 1,
      centre[2] + k / 9 - 1 };
    if (LabelAt(image, sample) != label)
    {
      continue;
    }
    const Index& n = weak.Dimensions();
    const bool isInside = sample[0] >= 0 && sample[0] < n[0] && sample[1] >= 0 &&
      sample[1] < n[1] && sample[2] >= 0 && sample[2] < n[2];
    if (!isInside || !weak.Test(sample))
    {
      return {};
    }
    around.push_back(sample);
  }
  return around;
}

} // namespace

std::vector<Index> FindBuriedVoxels(const LabelImage<3>& image, std::span<const WeakVoxel> weak,
  unsigned threads, const std::stop_token& stop)
{
  Index dimensions = image.CropDimensions();
  for (std::int64_t& n : dimensions)
  {
    n += 2;
  }
  BitMask<3> isWeak(dimensions);
  for (const WeakVoxel& voxel : weak)
  {
    isWeak.Set(IndexOf(voxel.Sample, dimensions));
  }
  std::vector<Index> buried;
  std::mutex mutex; // guards buried
  ParallelFor(
    0, weak.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      std::vector<Index> found;
      for (std::size_t i = first; i < last; ++i)
      {
        if (weak[i].IsLost)
        {
          const auto more = BuriedAround(IndexOf(weak[i].Sample, dimensions), image, isWeak);
          found.insert(found.end(), more.begin(), more.end());
        }
      }
      const std::scoped_lock lock(mutex);
      buried.insert(buried.end(), found.begin(), found.end());
    },
    stop);
  std::sort(buried.begin(), buried.end());
  buried.erase(std::unique(buried.begin(), buried.end()), buried.end());
  return buried;
}

} // namespace voxplex
