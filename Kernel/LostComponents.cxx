// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "LostComponents.h"

#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>

namespace voxplex
{

template <int D>
std::vector<std::uint32_t> FindLostComponents(const Components<D>& components,
  const LabelImage<D>& image, const SimplexMesh<D>& mesh, std::int64_t fewestVoxels,
  unsigned threads, const std::stop_token& stop)
{
  using Index = typename GridGeometry<D>::Index;
  const std::vector<Component<D>>& all = components.All();
  const auto found = std::make_unique<std::atomic<bool>[]>(all.size());
  const auto voxelOf = [&](std::size_t simplex)
  {
    Point<D> centroid{};
    for (const std::uint32_t v : mesh.Simplices[simplex])
    {
      for (std::size_t a = 0; a < D; ++a)
      {
        centroid[a] += mesh.Points[v][a] / (D + 1);
      }
    }
    const Point<D> index = image.Grid().ToIndex(centroid);
    Index voxel;
    for (std::size_t a = 0; a < D; ++a)
    {
      voxel[a] = std::llround(index[a]) - image.CropOrigin()[a];
    }
    return voxel;
  };
  const auto mark = [&](const Index& voxel, std::int64_t label)
  {
    const std::uint32_t c = components.At(voxel);
    if (c != Components<D>::None && image.Values()[all[c].Label] == label &&
      !found[c].load(std::memory_order_relaxed))
    {
      found[c].store(true, std::memory_order_relaxed);
    }
  };
  constexpr std::size_t SimplicesAtOnce = 4096;
  ParallelFor(
    0, mesh.Simplices.size(), SimplicesAtOnce, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t s = begin; s < end; ++s)
      {
        mark(voxelOf(s), mesh.Labels[s]);
      }
    },
    stop);

  const auto isLost = [&](std::size_t c)
  { return all[c].Voxels >= fewestVoxels && !found[c].load(std::memory_order_relaxed); };
  std::vector<std::int64_t> labels; // of components that seem lost
  for (std::size_t c = 0; c < all.size(); ++c)
  {
    if (isLost(c))
    {
      labels.push_back(image.Values()[all[c].Label]);
    }
  }
  std::sort(labels.begin(), labels.end());
  ParallelFor(
    0, labels.empty() ? 0 : mesh.Simplices.size(), SimplicesAtOnce, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t s = begin; s < end; ++s)
      {
        if (!std::binary_search(labels.begin(), labels.end(), mesh.Labels[s]))
        {
          continue;
        }
        const Index centre = voxelOf(s);
        Index voxel;
        for (std::size_t a = 0; a < D; ++a)
        {
          voxel[a] = centre[a] - 1;
        }
        while (voxel[D - 1] <= centre[D - 1] + 1)
        {
          mark(voxel, mesh.Labels[s]);
          for (std::size_t a = 0; a < D && ++voxel[a] > centre[a] + 1 && a + 1 < D; ++a)
          {
            voxel[a] = centre[a] - 1;
          }
        }
      }
    },
    stop);
  std::vector<std::uint32_t> lost;
  for (std::size_t c = 0; c < all.size(); ++c)
  {
    if (isLost(c))
    {
      lost.push_back(static_cast<std::uint32_t>(c));
    }
  }
  return lost;
}

template std::vector<std::uint32_t> FindLostComponents<3>(const Components<3>&,
  const LabelImage<3>&, const SimplexMesh<3>&, std::int64_t, unsigned, const std::stop_token&);
template std::vector<std::uint32_t> FindLostComponents<4>(const Components<4>&,
  const LabelImage<4>&, const SimplexMesh<4>&, std::int64_t, unsigned, const std::stop_token&);

} // namespace voxplex
