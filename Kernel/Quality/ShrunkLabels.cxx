// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/ShrunkLabels.h"

#include "Geometry/SimplexQuality.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <tuple>

namespace voxplex
{

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<std::int64_t> FindLostLabels(const SimplexMesh<D>& mesh, const LabelImage<D>& image)
{
  const std::span<const std::int64_t> values = image.Values();
  std::vector<char> found(values.size(), 0);
  std::int64_t last = 0;
  for (const std::int64_t label : mesh.Labels)
  {
    if (label != last) // neighbours in the list mostly have the same label
    {
      last = label;
      found[static_cast<std::size_t>(
        std::lower_bound(values.begin(), values.end(), label) - values.begin())] = 1;
    }
  }
  std::vector<std::int64_t> lost;
  for (std::size_t id = 1; id < values.size(); ++id)
  {
    if (!found[id] && image.Counts()[id] > 0)
    {
      lost.push_back(values[id]);
    }
  }
  return lost;
}

template std::vector<std::int64_t> FindLostLabels<3>(const SimplexMesh<3>&, const LabelImage<3>&);
template std::vector<std::int64_t> FindLostLabels<4>(const SimplexMesh<4>&, const LabelImage<4>&);

//------------------------------------------------------------------------------------------------
// Volumes are summed in blocks of elements, and then over the blocks, so that the sums do not depend
// on the threads.
VolumeShares FindShrunkLabels(
  const SimplexMesh<3>& mesh, const LabelImage<3>& image, double fraction, unsigned threads)
{
  constexpr std::size_t BlockSize = 1u << 16;
  const std::span<const std::int64_t> values = image.Values();
  const std::size_t elements = mesh.Simplices.size();
  std::vector<std::vector<double>> blocks((elements + BlockSize - 1) / BlockSize);
  ParallelFor(0, blocks.size(), 1, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t b = first; b < last; ++b)
      {
        std::vector<double>& volumes = blocks[b];
        volumes.assign(values.size(), 0.0);
        std::int64_t value = values[0];
        std::size_t id = 0;
        for (std::size_t s = b * BlockSize; s < std::min(elements, (b + 1) * BlockSize); ++s)
        {
          if (mesh.Labels[s] != value) // neighbours in the list mostly have the same label
          {
            value = mesh.Labels[s];
            id = static_cast<std::size_t>(
              std::lower_bound(values.begin(), values.end(), value) - values.begin());
          }
          volumes[id] += SignedVolume<3>(mesh.PointsOf(s).data());
        }
      }
    });

  VolumeShares shares;
  double volumeOfAll = 0.0;
  double wholeOfAll = 0.0;
  for (std::size_t id = 1; id < values.size(); ++id)
  {
    double volume = 0.0;
    for (const std::vector<double>& volumes : blocks)
    {
      volume += volumes[id];
    }
    const std::int64_t voxels = image.Counts()[id];
    const double whole = static_cast<double>(voxels) * image.Grid().VoxelVolume();
    if (voxels >= FewestVoxelsOfShrunk && volume > 0.0 && volume <= fraction * whole)
    {
      shares.Shrunk.push_back({ values[id], volume / whole });
    }
    volumeOfAll += volume;
    wholeOfAll += whole;
  }
  std::sort(shares.Shrunk.begin(), shares.Shrunk.end(),
    [](const ShrunkLabel& a, const ShrunkLabel& b)
    { return std::tie(a.Fraction, a.Label) < std::tie(b.Fraction, b.Label); });
  shares.All = wholeOfAll > 0.0 ? volumeOfAll / wholeOfAll : 1.0;
  return shares;
}

} // namespace voxplex
