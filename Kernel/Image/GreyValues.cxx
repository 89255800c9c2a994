// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/GreyValues.h"

#include "Base/Error.h"
#include "Base/VectorClones.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

namespace voxplex
{

namespace
{

/** Adds the pairs of two rows. Sums are as wide as an id, so that the loop is vectorised well. */
VOXPLEX_VECTOR_CLONES void AddPairs(
  const LabelId* a, const LabelId* b, std::size_t length, NeighbourPairs& pairs)
{
  std::uint32_t all = 0;
  std::uint32_t different = 0;
  for (std::size_t i = 0; i < length; ++i)
  {
    const bool isPair = (a[i] != 0) & (b[i] != 0);
    all += isPair ? 1u : 0u;
    different += (isPair & (a[i] != b[i])) ? 1u : 0u;
  }
  pairs.All += all;
  pairs.Different += different;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
NeighbourPairs CountNeighbourPairs(
  const LabelImage<D>& image, unsigned threads, const std::stop_token& stop)
{
  constexpr std::size_t RowsAtOnce = 512;
  const auto& n = image.CropDimensions();
  const auto length = static_cast<std::size_t>(n[0]);
  const std::size_t rows = image.Ids().size() / length;
  std::atomic<std::int64_t> all{ 0 };
  std::atomic<std::int64_t> different{ 0 };
  ParallelFor(
    0, rows, RowsAtOnce, threads,
    [&](std::size_t begin, std::size_t end)
    {
      NeighbourPairs pairs;
      for (std::size_t row = begin; row < end; ++row)
      {
        const LabelId* const here = image.Ids().data() + row * length;
        AddPairs(here, here + 1, length - 1, pairs);
        std::size_t stride = 1;
        for (std::size_t a = 1; a < D; ++a)
        {
          const auto along = static_cast<std::size_t>(n[a]);
          if (row / stride % along + 1 < along)
          {
            AddPairs(here, here + stride * length, length, pairs);
          }
          stride *= along;
        }
      }
      all.fetch_add(pairs.All, std::memory_order_relaxed);
      different.fetch_add(pairs.Different, std::memory_order_relaxed);
    },
    stop);
  return { all.load(), different.load() };
}

//------------------------------------------------------------------------------------------------
template <int D>
void CheckSegmented(const LabelImage<D>& image, unsigned threads, const std::stop_token& stop)
{
  const auto used = [&](std::int64_t count) { return count > 0; };
  const auto labels =
    std::count_if(image.Counts().begin() + 1, image.Counts().end(), used); // without background
  if (labels < FewestGreyValues)
  {
    return;
  }
  const NeighbourPairs pairs = CountNeighbourPairs(image, threads, stop);
  const bool isLarge = pairs.All >= FewestGreyPairs || labels > ManyGreyValues;
  if (isLarge && pairs.ShareOfDifferent() > LeastGreyShare)
  {
    throw InputError("The image's " + std::to_string(labels) + " labels look like grey values: " +
      std::to_string(std::lround(100.0 * pairs.ShareOfDifferent())) +
      " % of neighbouring voxels have different ones, so it is most likely a grey-value image. "
      "Segment it first{array:, or choose the array that holds the segmentation}, or choose the "
      "labels "
      "to mesh with {labels}, or mesh an isosurface of it with {isosurface}, or go on with "
      "{force}.");
  }
}

template NeighbourPairs CountNeighbourPairs(const LabelImage<3>&, unsigned, const std::stop_token&);
template NeighbourPairs CountNeighbourPairs(const LabelImage<4>&, unsigned, const std::stop_token&);
template void CheckSegmented(const LabelImage<3>&, unsigned, const std::stop_token&);
template void CheckSegmented(const LabelImage<4>&, unsigned, const std::stop_token&);

} // namespace voxplex
