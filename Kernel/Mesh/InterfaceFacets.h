// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceFacets.h
 * @brief The facets between labels, of simplices that know their neighbours.
 */
#ifndef voxplex_InterfaceFacets_h
#define voxplex_InterfaceFacets_h

#include "Delaunay/Stores.h"
#include "Image/LabelImage.h"
#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>

namespace voxplex
{

/** What lies beyond the end of a triangulation. */
enum class BeyondEnd
{
  Background, ///< facets there separate labels from background
  Nothing     ///< there are no facets
};

/**
 * The vertices of a positively oriented simplex without vertex i. In 3D the right-hand normal points
 * outwards.
 */
template <std::size_t N>
std::array<std::uint32_t, N - 1> OutwardFacet(const std::array<std::uint32_t, N>& v, unsigned i)
{
  std::array<std::uint32_t, N - 1> facet;
  for (unsigned m = 0; m + 1 < N; ++m)
  {
    facet[m] = v[m + (m < i ? 0 : 1)];
  }
  if (i % 2 == 1)
  {
    std::swap(facet[0], facet[1]);
  }
  return facet;
}

/**
 * Calls visit(i, beside) for the facets i of a simplex where the label `beside` is smaller than its own.
 * So each facet between two labels is met once.
 * @param neighbours of the simplex, across its facets; or None
 * @param labels by number of a simplex
 */
template <std::size_t N, typename Visit>
void ForEachInterface(const std::array<std::uint32_t, N>& neighbours, LabelId label,
  std::span<const LabelId> labels, BeyondEnd beyond, const Visit& visit)
{
  for (unsigned i = 0; i < N; ++i)
  {
    const bool isEnd = neighbours[i] == None;
    const LabelId beside = isEnd ? LabelId{ 0 } : labels[neighbours[i]];
    if (beside < label && (!isEnd || beyond == BeyondEnd::Background))
    {
      visit(i, beside);
    }
  }
}

/**
 * Lists these facets in the order of their simplices, whatever the number of threads.
 * @param neighboursOf gives the neighbours of simplex s; asked if s has a label
 * @param resize called once, with the number of facets
 * @param write write(place, s, i, beside), from several threads
 * @throws Cancelled if a stop was requested before the end
 */
template <typename NeighboursOf, typename Resize, typename Write>
void ListInterfaces(std::span<const LabelId> labels, const NeighboursOf& neighboursOf,
  BeyondEnd beyond, const Resize& resize, const Write& write, unsigned threads,
  const std::stop_token& stop)
{
  const auto forEach = [&](std::size_t first, std::size_t end, const auto& visit)
  {
    for (auto s = static_cast<std::uint32_t>(first); s < end; ++s)
    {
      if (labels[s] != 0)
      {
        ForEachInterface(neighboursOf(s), labels[s], labels, beyond,
          [&](unsigned i, LabelId beside) { visit(s, i, beside); });
      }
    }
  };
  const auto forChunks = [&](const auto& function)
  { ParallelFor(0, labels.size(), ChunkCounts::Grain, threads, function, stop); };
  ChunkCounts places(labels.size());
  forChunks(
    [&](std::size_t first, std::size_t end)
    {
      std::size_t number = 0; // counts of several chunks share a cache line
      forEach(first, end, [&](std::uint32_t, unsigned, LabelId) { ++number; });
      places.OfChunk(first) = number;
    });
  resize(places.TurnIntoPlaces());
  forChunks(
    [&](std::size_t first, std::size_t end)
    {
      std::size_t place = places.OfChunk(first);
      forEach(first, end,
        [&](std::uint32_t s, unsigned i, LabelId beside) { write(place++, s, i, beside); });
    });
}

} // namespace voxplex

#endif
