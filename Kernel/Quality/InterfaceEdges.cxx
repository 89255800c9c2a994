// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/InterfaceEdges.h"

#include "Parallel/ParallelFor.h"

#include <algorithm>

namespace voxplex
{

namespace
{

/** The number of points whose lists a thread sorts at a time. */
constexpr std::size_t Grain = 4096;

/** Calls function(smallest vertex, the other vertices, facet) for the ridges of all facets. */
template <int D, typename Function>
void ForEachRidgeOfFacets(
  std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> facets,
  Function&& function)
{
  for (std::uint32_t f = 0; f < facets.size(); ++f)
  {
    const auto& v = facets[f];
    for (std::size_t i = 0; i < v.size(); ++i)
    {
      std::array<std::uint32_t, static_cast<std::size_t>(D - 1)> ridge;
      for (std::size_t k = 0; k < ridge.size(); ++k)
      {
        ridge[k] = v[(i + k) % v.size()];
      }
      std::sort(ridge.begin(), ridge.end());
      RidgeUse<D> use{ {}, f };
      std::copy(ridge.begin() + 1, ridge.end(), use.Others.begin());
      function(ridge[0], use);
    }
  }
}

} // namespace

template <int D>
InterfaceRidgeLists<D>::InterfaceRidgeLists(
  std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> facets,
  std::size_t points, unsigned threads, const std::stop_token& stop)
  : Begins(points + 1, 0)
  , Uses(static_cast<std::size_t>(D) * facets.size())
{
  ForEachRidgeOfFacets<D>(
    facets, [&](std::uint32_t low, const RidgeUse<D>&) { ++this->Begins[low + 1]; });
  for (std::size_t v = 1; v < this->Begins.size(); ++v)
  {
    this->Begins[v] += this->Begins[v - 1];
  }
  std::vector<std::uint32_t> ends(this->Begins.begin(), this->Begins.end() - 1);
  ForEachRidgeOfFacets<D>(
    facets, [&](std::uint32_t low, const RidgeUse<D>& use) { this->Uses[ends[low]++] = use; });
  const auto before = [](const RidgeUse<D>& a, const RidgeUse<D>& b)
  { return a.Others < b.Others || (a.Others == b.Others && a.Facet < b.Facet); };
  ParallelFor(
    0, points, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t v = first; v < last; ++v)
      {
        std::sort(
          this->Uses.begin() + this->Begins[v], this->Uses.begin() + this->Begins[v + 1], before);
      }
    },
    stop);
}

template class InterfaceRidgeLists<3>;
template class InterfaceRidgeLists<4>;

std::span<const LabelAtRidge> LabelsAtRidge::CountSides()
{
  std::sort(this->Sides.begin(), this->Sides.end());
  this->Counts.clear();
  for (const std::int64_t label : this->Sides)
  {
    if (this->Counts.empty() || this->Counts.back().Label != label)
    {
      this->Counts.push_back({ label, 0 });
    }
    ++this->Counts.back().Facets;
  }
  return this->Counts;
}

template <int D>
std::vector<InterfaceRidge<D>> FindNonManifoldRidges(
  std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> facets,
  std::span<const std::array<std::int64_t, 2>> labels, std::size_t points, unsigned threads,
  const std::stop_token& stop)
{
  std::vector<InterfaceRidge<D>> ridges;
  LabelsAtRidge around(labels);
  const auto look = [&](const auto& vertices, std::span<const RidgeUse<D>> uses)
  {
    if (uses.size() == 2) // most ridges: both facets have the same two labels
    {
      return;
    }
    const std::span<const LabelAtRidge> here = around.Count(uses);
    if (!std::all_of(here.begin(), here.end(),
          [](const LabelAtRidge& label) { return label.Label == 0 || IsManifold(label); }))
    {
      ridges.push_back({ vertices, IsJunction(here) });
    }
  };
  InterfaceRidgeLists<D>(facets, points, threads, stop).ForEachRidge(look);
  return ridges;
}

template std::vector<InterfaceRidge<3>> FindNonManifoldRidges<3>(
  std::span<const std::array<std::uint32_t, 3>>, std::span<const std::array<std::int64_t, 2>>,
  std::size_t, unsigned, const std::stop_token&);
template std::vector<InterfaceRidge<4>> FindNonManifoldRidges<4>(
  std::span<const std::array<std::uint32_t, 4>>, std::span<const std::array<std::int64_t, 2>>,
  std::size_t, unsigned, const std::stop_token&);

} // namespace voxplex
