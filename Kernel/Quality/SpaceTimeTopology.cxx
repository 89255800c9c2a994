// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/SpaceTimeTopology.h"

#include "Base/DisjointSets.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace voxplex
{

namespace
{

/** A facet of a pentatope. */
struct Facet
{
  std::array<std::uint32_t, 4> Points; ///< increasing
  std::uint32_t Simplex;
};

/** The facets of all pentatopes; equal ones follow each other. */
std::vector<Facet> SortedFacets(const SimplexMesh<4>& mesh)
{
  std::vector<Facet> facets;
  facets.reserve(5 * mesh.Simplices.size());
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    std::array<std::uint32_t, 5> points = mesh.Simplices[s];
    std::sort(points.begin(), points.end());
    for (std::size_t left = 0; left < 5; ++left)
    {
      Facet facet{ {}, static_cast<std::uint32_t>(s) };
      std::copy(points.begin() + static_cast<std::ptrdiff_t>(left) + 1, points.end(),
        std::copy(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(left),
          facet.Points.begin()));
      facets.push_back(facet);
    }
  }
  std::sort(facets.begin(), facets.end(),
    [](const Facet& a, const Facet& b) { return a.Points < b.Points; });
  return facets;
}

} // namespace

//------------------------------------------------------------------------------------------------
SpaceTimeTopology MeasureTopology(const SimplexMesh<4>& mesh, const std::stop_token& stop)
{
  SpaceTimeTopology topology;
  const std::vector<Facet> facets = SortedFacets(mesh);
  ThrowIfStopped(stop);
  DisjointSets sets(mesh.Simplices.size());
  for (auto first = facets.begin(); first != facets.end();)
  {
    const auto last = std::find_if_not(
      first, facets.end(), [first](const Facet& facet) { return facet.Points == first->Points; });
    const auto count = last - first;
    topology.FacetsOfThreeElements += count > 2 ? 1 : 0;
    const bool isInside =
      count == 2 && mesh.Labels[first[0].Simplex] == mesh.Labels[first[1].Simplex];
    if (isInside)
    {
      sets.Join(first[0].Simplex, first[1].Simplex);
    }
    topology.InterfaceFacets += count <= 2 && !isInside ? 1 : 0;
    first = last;
  }
  for (std::uint32_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    topology.Components[mesh.Labels[s]] += sets.Find(s) == s ? 1 : 0;
  }
  return topology;
}

} // namespace voxplex
