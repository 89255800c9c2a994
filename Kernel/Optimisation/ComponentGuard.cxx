// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/ComponentGuard.h"

#include "Quality/LostComponents.h"

#include <algorithm>
#include <cstddef>

namespace voxplex
{

namespace
{

/**
 * Components are guarded if about this number of elements or fewer are expected in them, from their
 * share of the voxels of their label.
 */
constexpr double MostElements = 100.0;

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<std::uint8_t> ComponentGuard<D>::FindHolders(
  const LabelledCells<D>& elements, unsigned threads, const std::stop_token& stop)
{
  std::vector<std::uint8_t> holders;
  if (this->Sets.empty())
  {
    return holders;
  }
  std::vector<double> numbers(this->Image.Values().size()); // of elements, by label
  for (const LabelId label : elements.GetLabels())
  {
    ++numbers[label];
  }
  for (Set& set : this->Sets)
  {
    const std::vector<Component<D>>& all = set.All.All();
    std::vector<double> voxels(numbers.size());
    for (const Component<D>& component : all)
    {
      voxels[component.Label] += static_cast<double>(component.Voxels);
    }
    set.Guarded = set.Wanted;
    for (std::size_t c = 0; c < all.size(); ++c)
    {
      const double expected =
        numbers[all[c].Label] * static_cast<double>(all[c].Voxels) / voxels[all[c].Label];
      set.Guarded[c] = set.Guarded[c] && expected <= MostElements;
    }
    const std::vector<std::uint32_t> witnesses =
      FindFirstWitnesses<D>(set.All, this->Image, elements, set.Guarded, threads, stop);
    set.IsBeside.assign(all.size(), false);
    for (std::uint32_t c = 0; c < all.size(); ++c)
    {
      set.Guarded[c] = witnesses[c] != None;
      if (set.Guarded[c])
      {
        holders.resize(elements.Size());
        holders[witnesses[c]] = 1;
        bool isIn = false;
        set.Voxels.ForEachVoxel(elements.PointsOf(witnesses[c]),
          [&](const auto& voxel) { isIn = isIn || set.All.At(voxel) == c; });
        set.IsBeside[c] = !isIn;
      }
    }
  }
  return holders;
}

//------------------------------------------------------------------------------------------------
template <int D>
bool ComponentGuard<D>::Keeps(LabelId label, const Corners& before, std::span<const Corners> after,
  std::span<std::uint8_t> areHolders) const
{
  for (const Set& set : this->Sets)
  {
    const auto guardedAt = [&](const auto& voxel)
    {
      const std::uint32_t c = set.All.At(voxel);
      return c != None && set.Guarded[c] && set.All.All()[c].Label == label ? c : None;
    };
    // An element may be beside many components. If it is in one, it holds no other, unless nothing is in
    // that other one.
    const auto componentsOf = [&](const Corners& element)
    {
      std::vector<std::uint32_t> found;
      set.Voxels.ForEachVoxel(element,
        [&](const auto& centre)
        {
          const std::uint32_t own = guardedAt(centre);
          set.Voxels.ForEachAround(centre,
            [&](const auto& voxel)
            {
              const std::uint32_t c = guardedAt(voxel);
              if (c != None && (own == None || c == own || set.IsBeside[c]) &&
                std::find(found.begin(), found.end(), c) == found.end())
              {
                found.push_back(c);
              }
            });
        });
      return found;
    };
    std::vector<std::uint32_t> missing = componentsOf(before);
    for (std::size_t k = 0; k < after.size() && !missing.empty(); ++k)
    {
      const std::vector<std::uint32_t> held = componentsOf(after[k]);
      if (std::erase_if(missing,
            [&held](std::uint32_t c)
            { return std::find(held.begin(), held.end(), c) != held.end(); }) > 0)
      {
        areHolders[k] = 1;
      }
    }
    if (!missing.empty())
    {
      return false;
    }
  }
  return true;
}

template class ComponentGuard<3>;
template class ComponentGuard<4>;

} // namespace voxplex
