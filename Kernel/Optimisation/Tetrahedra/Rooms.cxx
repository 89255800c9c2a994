// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Tetrahedra/Rooms.h"

#include "Base/DisjointSets.h"

#include <algorithm>

namespace voxplex
{

//------------------------------------------------------------------------------------------------
Rooms RoomsAround(
  const TetrahedralComplex& complex, std::span<const std::uint32_t> cells, unsigned edges)
{
  const std::size_t vertices = complex.Points.size();
  DisjointSets sets(vertices);
  std::vector<bool> isInRoom(vertices);
  const auto add = [&](std::uint32_t t)
  {
    for (const std::uint32_t v : complex.Cells[t].V)
    {
      isInRoom[v] = true;
      sets.Join(v, complex.Cells[t].V[0]);
    }
  };
  std::for_each(cells.begin(), cells.end(), add);
  std::vector<std::uint32_t> reached;
  for (; edges > 0; --edges)
  {
    reached.clear();
    for (std::uint32_t t = 0; t < complex.Cells.size(); ++t)
    {
      const auto& v = complex.Cells[t].V;
      if (complex.IsAlive(t) &&
        (isInRoom[v[0]] || isInRoom[v[1]] || isInRoom[v[2]] || isInRoom[v[3]]))
      {
        reached.push_back(t);
      }
    }
    std::for_each(reached.begin(), reached.end(), add);
  }

  Rooms rooms;
  rooms.OfVertex.resize(vertices);
  for (std::uint32_t v = 0; v < vertices; ++v)
  {
    if (isInRoom[v])
    {
      const std::uint32_t first = sets.Find(v);
      rooms.OfVertex[v] = first == v ? rooms.Number++ : rooms.OfVertex[first];
    }
  }
  for (std::uint32_t v = 0; v < vertices; ++v)
  {
    rooms.OfVertex[v] = isInRoom[v] ? rooms.OfVertex[v] : rooms.Number;
  }
  return rooms;
}

} // namespace voxplex
