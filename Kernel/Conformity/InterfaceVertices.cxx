// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/InterfaceVertices.h"

#include "Delaunay/VertexStar.h"
#include "Mesh/InterfaceFacets.h"
#include "Parallel/ParallelFor.h"

#include <cstddef>

namespace voxplex
{

namespace
{

constexpr std::size_t Grain = 4096;
constexpr std::size_t StarGrain = 256;

} // namespace

template <int D>
void MarkInterfaceVertices(Triangulation<D>& triangulation, std::span<const LabelId> labels,
  unsigned threads, const std::stop_token& stop)
{
  ParallelFor(
    0, triangulation.VertexIdEnd(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (auto v = static_cast<VertexId>(first); v < last; ++v)
      {
        triangulation.SetOnInterface(v, false);
      }
    },
    stop);
  ParallelFor(
    0, labels.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        if (labels[s] != 0)
        {
          const auto& simplex = triangulation.GetSimplex(s);
          ForEachInterface(simplex.N, labels[s], labels, BeyondEnd::Nothing,
            [&](unsigned i, LabelId)
            {
              for (const VertexId v : OutwardFacet(simplex.V, i))
              {
                triangulation.SetOnInterface(v, true);
              }
            });
        }
      }
    },
    stop);
}

template <int D>
void MarkInterfaceVerticesOf(Triangulation<D>& triangulation, std::span<const LabelId> labels,
  const std::vector<SimplexId>& changed, unsigned threads, const std::stop_token& stop)
{
  const std::vector<VertexId> vertices = VerticesOf(triangulation, changed);
  ParallelFor(
    0, vertices.size(), StarGrain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        const SimplexId incident = triangulation.GetVertex(vertices[k]).Incident;
        triangulation.SetOnInterface(vertices[k],
          AnyInStar(triangulation, vertices[k], incident,
            [&, label = labels[incident]](SimplexId s) { return labels[s] != label; }));
      }
    },
    stop);
}

template void MarkInterfaceVertices<3>(
  Triangulation<3>&, std::span<const LabelId>, unsigned, const std::stop_token&);
template void MarkInterfaceVertices<4>(
  Triangulation<4>&, std::span<const LabelId>, unsigned, const std::stop_token&);
template void MarkInterfaceVerticesOf<3>(Triangulation<3>&, std::span<const LabelId>,
  const std::vector<SimplexId>&, unsigned, const std::stop_token&);
template void MarkInterfaceVerticesOf<4>(Triangulation<4>&, std::span<const LabelId>,
  const std::vector<SimplexId>&, unsigned, const std::stop_token&);

} // namespace voxplex
