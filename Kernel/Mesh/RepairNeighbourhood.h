// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RepairNeighbourhood.h
 * @brief Internal to ManifoldRepair: what is around the bad edges of a mesh, as it is or as it would be after a change.
 */
#ifndef voxplex_RepairNeighbourhood_h
#define voxplex_RepairNeighbourhood_h

#include "Mesh/InterfaceEdges.h"
#include "Mesh/SimplexMesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

namespace voxplex::repair
{

using Edge = std::array<std::uint32_t, 2>;
using Facet = std::array<std::uint32_t, 3>;

/** Some tetrahedra get another label; 0 drops them. */
struct Change
{
  std::vector<std::uint32_t> Cells;
  std::int64_t Label;

  bool Touches(std::uint32_t t) const
  {
    return std::find(this->Cells.begin(), this->Cells.end(), t) != this->Cells.end();
  }
};

/** The first of a few for which is() is true, else `added` behind them. */
template <typename T, typename Predicate>
T& FindOrAdd(std::vector<T>& few, Predicate&& is, const T& added)
{
  const auto found = std::find_if(few.begin(), few.end(), is);
  return found != few.end() ? *found : few.emplace_back(added);
}

//------------------------------------------------------------------------------------------------
/** The tetrahedra near the bad edges of a mesh, by their vertices. */
class Neighbourhood
{
public:
  Neighbourhood(const SimplexMesh<3>& mesh, const std::vector<InterfaceEdge>& edges)
    : Mesh(mesh)
  {
    std::vector<std::uint8_t> near(mesh.Points.size());
    for (const InterfaceEdge& edge : edges)
    {
      near[edge.Ends[0]] = 1;
      near[edge.Ends[1]] = 1;
    }
    // A change asks for the stars of the vertices of its tetrahedra, and these for the edges of theirs.
    for (int ring = 0; ring < 2; ++ring)
    {
      std::vector<std::uint8_t> next = near;
      this->ForCellsNear(near,
        [&](std::uint32_t t)
        {
          for (const std::uint32_t v : mesh.Simplices[t])
          {
            next[v] = 1;
          }
        });
      near = std::move(next);
    }
    this->FillStars(near);
    this->OnInterface.resize(mesh.Points.size());
    for (const Facet& facet : mesh.Facets)
    {
      for (const std::uint32_t v : facet)
      {
        this->OnInterface[v] = 1;
      }
    }
  }

  const SimplexMesh<3>& GetMesh() const { return this->Mesh; }
  bool IsOnInterface(std::uint32_t v) const { return this->OnInterface[v] != 0; }
  std::span<const std::uint32_t> StarOf(std::uint32_t v) const
  {
    return std::span(this->Cells).subspan(this->Begins[v], this->Begins[v + 1] - this->Begins[v]);
  }

  std::int64_t LabelOf(std::uint32_t t, const Change* change) const
  {
    return change && change->Touches(t) ? change->Label : this->Mesh.Labels[t];
  }

  /** Tetrahedra with both vertices. */
  std::vector<std::uint32_t> StarOf(const Edge& edge) const
  {
    std::vector<std::uint32_t> star;
    for (const std::uint32_t t : this->StarOf(edge[0]))
    {
      const auto& v = this->Mesh.Simplices[t];
      if (std::find(v.begin(), v.end(), edge[1]) != v.end())
      {
        star.push_back(t);
      }
    }
    return star;
  }

  /** The tetrahedron beside facet i of t, if any. */
  std::optional<std::uint32_t> Beside(std::uint32_t t, unsigned i) const
  {
    const auto& v = this->Mesh.Simplices[t];
    for (const std::uint32_t other : this->StarOf(v[(i + 1) % 4]))
    {
      const auto& w = this->Mesh.Simplices[other];
      const auto has = [&](std::uint32_t p) { return std::find(w.begin(), w.end(), p) != w.end(); };
      if (other != t && has(v[(i + 2) % 4]) && has(v[(i + 3) % 4]))
      {
        return other;
      }
    }
    return std::nullopt;
  }

  /** What is wrong at an edge. */
  struct State
  {
    int
      Bad; ///< labels with a number of boundary facets other than two or none, background left out
    bool IsJunction; ///< three labels or more meet there
  };
  State StateOf(const Edge& edge, const Change* change) const
  {
    // Few: lists that are searched from end to end. Of each facet with the edge the label on its sides.
    struct Side
    {
      std::uint32_t Third; ///< vertex
      std::array<std::int64_t, 2> Labels;
    };
    struct Count
    {
      std::int64_t Label;
      int Facets;
    };
    constexpr std::size_t Most = 16; // mostly
    std::vector<Side> sides;
    std::vector<Count> facets;
    sides.reserve(Most);
    facets.reserve(Most);
    for (const std::uint32_t t : this->StarOf(edge[0]))
    {
      const auto& corners = this->Mesh.Simplices[t];
      if (std::find(corners.begin(), corners.end(), edge[1]) == corners.end())
      {
        continue;
      }
      const std::int64_t label = this->LabelOf(t, change);
      for (const std::uint32_t v : corners)
      {
        if (v != edge[0] && v != edge[1])
        {
          Side& side = FindOrAdd(
            sides, [&](const Side& known) { return known.Third == v; }, Side{ v, { 0, 0 } });
          side.Labels = { label, side.Labels[0] };
        }
      }
    }
    for (const Side& side : sides)
    {
      for (const std::int64_t label : side.Labels)
      {
        if (side.Labels[0] != side.Labels[1])
        {
          const auto hasLabel = [&](const Count& known) { return known.Label == label; };
          ++FindOrAdd(facets, hasLabel, Count{ label, 0 }).Facets;
        }
      }
    }
    const auto bad = std::count_if(facets.begin(), facets.end(),
      [](const Count& count) { return count.Label != 0 && count.Facets != 2; });
    return { static_cast<int>(bad), facets.size() > 2 };
  }

  /** What is wrong at an edge counts more off junctions, where there is no excuse. */
  int CountBad(const Edge& edge, const Change* change) const
  {
    const State state = this->StateOf(edge, change);
    return state.Bad * (state.IsJunction ? AtJunction : OffJunction);
  }

private:
  static constexpr int AtJunction = 2;
  static constexpr int OffJunction = 3;

  void FillStars(const std::vector<std::uint8_t>& near)
  {
    this->Begins.resize(this->Mesh.Points.size() + 1);
    std::vector<std::uint32_t> cells;
    this->ForCellsNear(near,
      [&](std::uint32_t t)
      {
        cells.push_back(t);
        for (const std::uint32_t v : this->Mesh.Simplices[t])
        {
          this->Begins[v + 1] += near[v];
        }
      });
    std::partial_sum(this->Begins.begin(), this->Begins.end(), this->Begins.begin());
    this->Cells.resize(this->Begins.back());
    std::vector<std::uint32_t> ends = this->Begins;
    for (const std::uint32_t t : cells)
    {
      for (const std::uint32_t v : this->Mesh.Simplices[t])
      {
        if (near[v] != 0)
        {
          this->Cells[ends[v]++] = t;
        }
      }
    }
  }

  template <typename Function>
  void ForCellsNear(const std::vector<std::uint8_t>& near, Function&& function) const
  {
    for (std::uint32_t t = 0; t < this->Mesh.Simplices.size(); ++t)
    {
      const auto& v = this->Mesh.Simplices[t];
      if ((near[v[0]] | near[v[1]] | near[v[2]] | near[v[3]]) != 0)
      {
        function(t);
      }
    }
  }

  const SimplexMesh<3>& Mesh;
  std::vector<std::uint32_t> Begins;     ///< of each vertex' star in Cells; of most an empty one
  std::vector<std::uint32_t> Cells;      ///< of complete stars, ascending
  std::vector<std::uint8_t> OnInterface; ///< by vertex
};

} // namespace voxplex::repair

#endif
