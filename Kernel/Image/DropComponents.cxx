// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/DropComponents.h"

#include "Base/Error.h"
#include "Image/Components.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <map>

namespace voxplex
{

namespace
{

template <int D>
LabelId MostFrequentNeighbour(
  const LabelImage<D>& image, const Components<D>& components, std::uint32_t component)
{
  const LabelId own = components.All()[component].Label;
  std::map<LabelId, std::int64_t> faces;
  components.ForEachRun(component,
    [&](const auto& first, std::int64_t length)
    {
      for (auto voxel = first; voxel[0] < first[0] + length; ++voxel[0])
      {
        for (std::size_t a = 0; a < D; ++a)
        {
          for (const std::int64_t step : { -1, 1 })
          {
            auto neighbour = voxel;
            neighbour[a] += step;
            if (components.At(neighbour) != component)
            {
              ++faces[image.At(neighbour)];
            }
          }
        }
      }
    });
  // A neighbour that was dropped before may now have the same label as this component. Then both
  // are one component in the next round.
  const auto most = std::max_element(
    faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == faces.end() ? own : most->first;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<ComponentReport> DropComponents(
  LabelImage<D>& image, double volume, unsigned threads, const std::stop_token& stop)
{
  std::vector<ComponentReport> dropped;
  if (!(volume > 0.0))
  {
    return dropped;
  }
  for (bool any = true; any;)
  {
    any = false;
    const Components<D> components(image, threads, stop);
    std::vector<std::uint32_t> small;
    for (std::uint32_t c = 0; c < components.All().size(); ++c)
    {
      if (static_cast<double>(components.All()[c].Voxels) * image.Grid().VoxelVolume() < volume)
      {
        small.push_back(c);
      }
    }
    std::stable_sort(small.begin(), small.end(),
      [&](std::uint32_t a, std::uint32_t b)
      { return components.All()[a].Voxels < components.All()[b].Voxels; });
    for (const std::uint32_t c : small)
    {
      ThrowIfStopped(stop);
      const Component<D>& component = components.All()[c];
      const LabelId label = MostFrequentNeighbour(image, components, c);
      if (label == component.Label)
      {
        continue;
      }
      components.ForEachRun(
        c, [&](const auto& first, std::int64_t length) { image.Relabel(first, length, label); });
      dropped.push_back(MakeReport(component, image));
      any = true;
    }
  }
  if (std::all_of(image.Counts().begin() + 1, image.Counts().end(),
        [](std::int64_t count) { return count == 0; }))
  {
    throw InputError("every component of the image is smaller than the smallest volume to keep; "
                     "choose a smaller volume");
  }
  return dropped;
}

template std::vector<ComponentReport> DropComponents<3>(
  LabelImage<3>&, double, unsigned, const std::stop_token&);
template std::vector<ComponentReport> DropComponents<4>(
  LabelImage<4>&, double, unsigned, const std::stop_token&);

} // namespace voxplex
