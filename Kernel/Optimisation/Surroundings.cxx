// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Surroundings.h"

#include <algorithm>

namespace voxplex
{

//------------------------------------------------------------------------------------------------
Surroundings<4> SurroundingsOf(const Triangulation<4>& triangulation, const SimplexLabels& labels,
  const Subdivision<4>& parts, std::span<const Point<4>> positions,
  std::span<const std::uint32_t> numbers, std::size_t points)
{
  Surroundings<4> result;
  std::vector<std::uint32_t> all(numbers.begin(), numbers.end());
  const VertexId end = triangulation.VertexIdEnd();
  const auto positionOf = [&](VertexId v)
  {
    return v >= end       ? parts.Points[v - end]
      : positions.empty() ? triangulation.Position(v)
                          : positions[v];
  };
  const auto add = [&](const std::array<VertexId, 5>& vertices)
  {
    if (std::all_of(
          vertices.begin(), vertices.end(), [&numbers](VertexId v) { return numbers[v] == None; }))
    {
      return;
    }
    auto& simplex = result.Simplices.emplace_back();
    for (std::size_t k = 0; k < 5; ++k)
    {
      const VertexId v = vertices[k];
      if (all[v] == None)
      {
        all[v] = static_cast<std::uint32_t>(points + result.Points.size());
        result.Points.push_back(positionOf(v));
      }
      simplex[k] = all[v];
    }
  };
  auto replaced = parts.Replaced.begin(); // ascending
  for (SimplexId s = 0; s < labels.size(); ++s)
  {
    if (replaced != parts.Replaced.end() && *replaced == s)
    {
      ++replaced;
    }
    else if (labels[s] == 0 && triangulation.IsAlive(s))
    {
      add(triangulation.GetSimplex(s).V);
    }
  }
  for (const Piece<4>& piece : parts.Pieces)
  {
    if (piece.Label == 0)
    {
      add(piece.V);
    }
  }
  return result;
}

} // namespace voxplex
