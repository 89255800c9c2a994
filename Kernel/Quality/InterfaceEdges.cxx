// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/InterfaceEdges.h"

#include "Parallel/ParallelCollect.h"

#include <algorithm>

namespace voxplex
{

namespace
{

/** The number of points whose lists a thread sorts at a time. */
constexpr std::size_t Grain = 4096;

template <std::size_t N>
std::array<std::uint32_t, N> Sorted(std::array<std::uint32_t, N> points)
{
  std::sort(points.begin(), points.end());
  return points;
}

} // namespace

template <int D>
InterfaceRidgeLists<D>::InterfaceRidgeLists(
  std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> facets,
  std::size_t points, unsigned threads, const std::stop_token& stop)
  : Facets(facets)
  , Points(points)
  , Lists(points, threads, stop)
{
  const auto forEachEntry = [&](auto&& function)
  {
    // Neighbouring facets share points, and so the counts of points.
    ParallelFor(
      0, facets.size(), Grain, threads,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t f = first; f < last; ++f)
        {
          const auto v = Sorted(facets[f]);
          function(v[0], static_cast<std::uint32_t>(f));
          function(v[1], static_cast<std::uint32_t>(f));
        }
      },
      stop);
  };
  forEachEntry([&](std::uint32_t point, std::uint32_t) { this->Lists.Add(point); });
  this->Listed.resize(this->Lists.TurnIntoPlaces());
  forEachEntry([&](std::uint32_t point, std::uint32_t facet)
    { this->Listed[this->Lists.Next(point)] = facet; });
}

template <int D>
void InterfaceRidgeLists<D>::FindUsesAt(std::uint32_t point, std::vector<RidgeUse<D>>& uses) const
{
  uses.clear();
  for (std::uint32_t i = this->Lists.BeginOf(point); i < this->Lists.EndOf(point); ++i)
  {
    const std::uint32_t facet = this->Listed[i];
    const auto v = Sorted(this->Facets[facet]);
    // A ridge lacks one of the facet's points. The ridge without the smallest begins at the second.
    const std::size_t begin = v[0] == point ? 0 : 1;
    const std::size_t firstLeft = begin == 0 ? 1 : 0;
    const std::size_t lastLeft = begin == 0 ? v.size() - 1 : 0;
    for (std::size_t left = firstLeft; left <= lastLeft; ++left)
    {
      RidgeUse<D>& use = uses.emplace_back(RidgeUse<D>{ {}, facet });
      std::size_t n = 0;
      for (std::size_t k = begin + 1; k < v.size(); ++k)
      {
        if (k != left)
        {
          use.Others[n++] = v[k];
        }
      }
    }
  }
  std::sort(uses.begin(), uses.end(),
    [](const RidgeUse<D>& a, const RidgeUse<D>& b)
    { return a.Others < b.Others || (a.Others == b.Others && a.Facet < b.Facet); });
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
  return ParallelCollect<InterfaceRidge<D>>(
    points, Grain, threads,
    [&](std::size_t first, std::size_t last, std::vector<InterfaceRidge<D>>& ridges)
    {
      LabelsAtRidge<Label> around(labels);
      lists.ForEachRidge(first, last,
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
            ridges.push_back({ vertices, IsJunction(here) });
          }
        });
    },
    stop);
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
