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

/** Calls function(smaller end, larger end, facet) for the three edges of all facets. */
template <typename Function>
void ForEachEdgeOfFacets(std::span<const std::array<std::uint32_t, 3>> facets, Function&& function)
{
  for (std::uint32_t f = 0; f < facets.size(); ++f)
  {
    const auto& v = facets[f];
    for (unsigned i = 0; i < 3; ++i)
    {
      const std::uint32_t next = v[(i + 1) % 3];
      function(std::min(v[i], next), std::max(v[i], next), f);
    }
  }
}

} // namespace

InterfaceEdgeLists::InterfaceEdgeLists(std::span<const std::array<std::uint32_t, 3>> facets,
  std::size_t points, unsigned threads, const std::stop_token& stop)
  : Begins(points + 1, 0)
  , Uses(3 * facets.size())
{
  ForEachEdgeOfFacets(
    facets, [&](std::uint32_t low, std::uint32_t, std::uint32_t) { ++this->Begins[low + 1]; });
  for (std::size_t v = 1; v < this->Begins.size(); ++v)
  {
    this->Begins[v] += this->Begins[v - 1];
  }
  std::vector<std::uint32_t> ends(this->Begins.begin(), this->Begins.end() - 1);
  ForEachEdgeOfFacets(facets,
    [&](std::uint32_t low, std::uint32_t high, std::uint32_t f) {
      this->Uses[ends[low]++] = { high, f };
    });
  const auto before = [](const Use& a, const Use& b)
  { return a.High < b.High || (a.High == b.High && a.Facet < b.Facet); };
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

std::span<const LabelAtEdge> LabelsAtEdge::Count(std::span<const InterfaceEdgeLists::Use> uses)
{
  this->Sides.clear();
  for (const InterfaceEdgeLists::Use& use : uses)
  {
    const auto& sides = this->Labels[use.Facet];
    this->Sides.insert(this->Sides.end(), sides.begin(), sides.end());
  }
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

std::vector<InterfaceEdge> FindNonManifoldEdges(
  std::span<const std::array<std::uint32_t, 3>> facets,
  std::span<const std::array<std::int64_t, 2>> labels, std::size_t points, unsigned threads,
  const std::stop_token& stop)
{
  std::vector<InterfaceEdge> edges;
  LabelsAtEdge around(labels);
  const auto look = [&](const auto& ends, std::span<const InterfaceEdgeLists::Use> uses)
  {
    if (uses.size() == 2) // most edges: both facets have the same two labels
    {
      return;
    }
    const std::span<const LabelAtEdge> here = around.Count(uses);
    if (!std::all_of(here.begin(), here.end(),
          [](const LabelAtEdge& label) { return label.Label == 0 || IsManifold(label); }))
    {
      edges.push_back({ ends, IsJunction(here) });
    }
  };
  InterfaceEdgeLists(facets, points, threads, stop).ForEachEdge(look);
  return edges;
}

} // namespace voxplex
