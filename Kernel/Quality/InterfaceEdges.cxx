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

/** Calls function(smallest vertex, the other vertices and the facet) for the ridges of all facets. */
template <int D, typename Function>
void ForEachRidgeOfFacets(
  std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> facets, unsigned threads,
  const std::stop_token& stop, Function&& function)
{
  ParallelFor(
    0, facets.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (auto f = static_cast<std::uint32_t>(first); f < last; ++f)
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
    },
    stop);
}

} // namespace

template <int D>
InterfaceRidgeLists<D>::InterfaceRidgeLists(
  std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> facets,
  std::size_t points, unsigned threads, const std::stop_token& stop)
  : Points(points)
  , Lists(points, threads, stop)
{
  ForEachRidgeOfFacets<D>(facets, threads, stop,
    [&](std::uint32_t low, const RidgeUse<D>&) { this->Lists.Add(low); });
  this->Uses.resize(this->Lists.TurnIntoPlaces());
  ForEachRidgeOfFacets<D>(facets, threads, stop,
    [&](std::uint32_t low, const RidgeUse<D>& use) { this->Uses[this->Lists.Next(low)] = use; });
  const auto before = [](const RidgeUse<D>& a, const RidgeUse<D>& b)
  { return a.Others < b.Others || (a.Others == b.Others && a.Facet < b.Facet); };
  ParallelFor(
    0, points, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t v = first; v < last; ++v)
      {
        std::sort(this->Uses.data() + this->Lists.BeginOf(v),
          this->Uses.data() + this->Lists.EndOf(v), before);
      }
    },
    stop);
}

template class InterfaceRidgeLists<3>;
template class InterfaceRidgeLists<4>;

namespace
{

template <int D, typename Label>
std::vector<InterfaceRidge<D>> FindNonManifold(
  std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> facets,
  std::span<const std::array<Label, 2>> labels, std::size_t points, unsigned threads,
  const std::stop_token& stop)
{
  const InterfaceRidgeLists<D> lists(facets, points, threads, stop);
  std::vector<std::vector<InterfaceRidge<D>>> parts(points / Grain + 1);
  ParallelFor(
    0, points, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      LabelsAtRidge<Label> around(labels);
      lists.ForRidgesOf(first, last,
        [&](const auto& vertices, std::span<const RidgeUse<D>> uses)
        {
          if (uses.size() == 2) // most ridges: both facets have the same two labels
          {
            return;
          }
          const std::span<const LabelAtRidge> here = around.Count(uses);
          if (!std::all_of(here.begin(), here.end(),
                [](const LabelAtRidge& label) { return label.Label == 0 || IsManifold(label); }))
          {
            parts[first / Grain].push_back({ vertices, IsJunction(here) });
          }
        });
    },
    stop);
  std::vector<InterfaceRidge<D>> ridges;
  for (const std::vector<InterfaceRidge<D>>& part : parts)
  {
    ridges.insert(ridges.end(), part.begin(), part.end());
  }
  return ridges;
}

} // namespace

template <int D>
std::vector<InterfaceRidge<D>> FindNonManifoldRidges(
  std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> facets,
  std::span<const std::array<std::int64_t, 2>> labels, std::size_t points, unsigned threads,
  const std::stop_token& stop)
{
  return FindNonManifold<D>(facets, labels, points, threads, stop);
}

template <int D>
std::vector<InterfaceRidge<D>> FindNonManifoldRidges(
  std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> facets,
  std::span<const std::array<LabelId, 2>> labels, std::size_t points, unsigned threads,
  const std::stop_token& stop)
{
  return FindNonManifold<D>(facets, labels, points, threads, stop);
}

template std::vector<InterfaceRidge<3>> FindNonManifoldRidges<3>(
  std::span<const std::array<std::uint32_t, 3>>, std::span<const std::array<std::int64_t, 2>>,
  std::size_t, unsigned, const std::stop_token&);
template std::vector<InterfaceRidge<3>> FindNonManifoldRidges<3>(
  std::span<const std::array<std::uint32_t, 3>>, std::span<const std::array<LabelId, 2>>,
  std::size_t, unsigned, const std::stop_token&);
template std::vector<InterfaceRidge<4>> FindNonManifoldRidges<4>(
  std::span<const std::array<std::uint32_t, 4>>, std::span<const std::array<std::int64_t, 2>>,
  std::size_t, unsigned, const std::stop_token&);
template std::vector<InterfaceRidge<4>> FindNonManifoldRidges<4>(
  std::span<const std::array<std::uint32_t, 4>>, std::span<const std::array<LabelId, 2>>,
  std::size_t, unsigned, const std::stop_token&);

} // namespace voxplex
