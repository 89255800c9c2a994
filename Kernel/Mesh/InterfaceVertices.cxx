// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/InterfaceVertices.h"

#include "Parallel/ParallelFor.h"
#include "Parallel/UninitialisedVector.h"

#include <atomic>
#include <cstdint>

namespace voxplex
{

std::vector<Point<3>> FindInterfaceVertices(const Triangulation<3>& triangulation,
  const Domain<3>& image, unsigned threads, const std::stop_token& stop)
{
  constexpr std::size_t Grain = 4096;
  const std::size_t ids = triangulation.SimplexIdEnd();
  UninitialisedVector<LabelId> labels(ids); // fewer bytes than states: neighbours are anywhere
  ParallelFor(
    0, ids, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        const SimplexState& state = triangulation.State(s);
        labels[s] = state.Labelled || !triangulation.IsAlive(s)
          ? state.Label
          : image.Label(triangulation.GetCircumball(s).Center);
      }
    },
    stop);
  std::vector<std::uint8_t> isOnInterface(triangulation.VertexIdEnd());
  const auto mark = [&](VertexId v)
  {
    // Relaxed: threads write the same, and the loop's end orders it before its readers.
    const std::atomic_ref<std::uint8_t> known(isOnInterface[v]);
    if (known.load(std::memory_order_relaxed) == 0)
    {
      known.store(1, std::memory_order_relaxed);
    }
  };
  // One of two tetrahedra with different labels has a ball that meets an interface: the dual edge is in their union.
  const auto look = [&](SimplexId s)
  {
    const auto& simplex = triangulation.GetSimplex(s);
    for (unsigned i = 0; i < 4; ++i)
    {
      const SimplexId n = simplex.N[i];
      if (n != None && labels[n] != labels[s])
      {
        for (unsigned m = 1; m < 4; ++m)
        {
          mark(simplex.V[(i + m) % 4]);
        }
      }
    }
  };
  ParallelFor(
    0, ids, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        if (triangulation.State(s).NearSurface && triangulation.IsAlive(s))
        {
          look(s);
        }
      }
    },
    stop);
  std::vector<Point<3>> vertices;
  for (VertexId v = 0; v < isOnInterface.size(); ++v)
  {
    if (isOnInterface[v] != 0)
    {
      vertices.push_back(triangulation.Position(v));
    }
  }
  return vertices;
}

} // namespace voxplex
