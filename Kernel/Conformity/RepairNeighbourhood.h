// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RepairNeighbourhood.h
 * @brief Internal to ManifoldRepair: the surroundings of bad interface edges, before or after a
 * proposed change.
 */
#ifndef voxplex_RepairNeighbourhood_h
#define voxplex_RepairNeighbourhood_h

#include "Delaunay/Triangulation.h"
#include "Delaunay/VertexStar.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace voxplex::repair
{

using Edge = std::array<VertexId, 2>;

/** Gives some tetrahedra another label; 0 drops them. */
struct Change
{
  std::vector<SimplexId> Cells;
  LabelId Label;

  bool Touches(SimplexId t) const
  {
    return std::find(this->Cells.begin(), this->Cells.end(), t) != this->Cells.end();
  }
};

/** The first element for which is() is true. If there is none, `added` is appended. */
template <typename T, typename Predicate>
T& FindOrAdd(std::vector<T>& few, Predicate&& is, const T& added)
{
  const auto found = std::find_if(few.begin(), few.end(), is);
  return found != few.end() ? *found : few.emplace_back(added);
}

//------------------------------------------------------------------------------------------------
/** Access to the labelled tetrahedra of a triangulation by their vertices. */
class Neighbourhood
{
public:
  /** @param onInterface for each vertex, whether it is on an interface before any change */
  Neighbourhood(const Triangulation<3>& triangulation, std::span<const LabelId> labels,
    std::vector<std::uint8_t> onInterface)
    : Source(triangulation)
    , Labels(labels)
    , OnInterface(std::move(onInterface))
  {
  }

  const std::array<VertexId, 4>& VerticesOf(SimplexId t) const
  {
    return this->Source.GetSimplex(t).V;
  }
  const Point<3>& Position(VertexId v) const { return this->Source.Position(v); }
  bool IsOnInterface(VertexId v) const { return this->OnInterface[v] != 0; }
  voxplex::Circumball<3> Circumball(SimplexId t) const { return this->Source.GetCircumball(t); }

  /** The star of a vertex. Ascending, so that results do not depend on where a search begins. */
  const std::vector<SimplexId>& StarOf(VertexId v) const
  {
    const auto [entry, isNew] = this->Stars.try_emplace(v);
    if (isNew)
    {
      entry->second = voxplex::StarOf(this->Source, v, this->Source.GetVertex(v).Incident);
      std::sort(entry->second.begin(), entry->second.end());
    }
    return entry->second;
  }

  LabelId LabelOf(SimplexId t, const Change* change) const
  {
    return change && change->Touches(t) ? change->Label : this->Labels[t];
  }

  /** The tetrahedra that have both vertices. */
  std::vector<SimplexId> StarOf(const Edge& edge) const
  {
    std::vector<SimplexId> star;
    for (const SimplexId t : this->StarOf(edge[0]))
    {
      const auto& v = this->VerticesOf(t);
      if (std::find(v.begin(), v.end(), edge[1]) != v.end())
      {
        star.push_back(t);
      }
    }
    return star;
  }

  /** The tetrahedron beside facet i of t, or None. */
  SimplexId Beside(SimplexId t, unsigned i) const { return this->Source.GetSimplex(t).N[i]; }
  LabelId LabelBeside(SimplexId t, unsigned i) const
  {
    const SimplexId beside = this->Beside(t, i);
    return beside == None ? LabelId{ 0 } : this->Labels[beside];
  }

  /** Defects at an edge. */
  struct State
  {
    int Bad; ///< labels, except background, with boundary facets at the edge, but not exactly two
    bool IsJunction; ///< three or more labels meet there
  };
  State StateOf(const Edge& edge, const Change* change) const
  {
    // The lists are short, so a linear search is enough. A Side has the labels on both sides of a
    // facet at the edge.
    struct Side
    {
      VertexId Third;
      std::array<LabelId, 2> Labels;
    };
    struct Count
    {
      LabelId Label;
      int Facets;
    };
    constexpr std::size_t Most = 16; // enough for most edges
    std::vector<Side> sides;
    std::vector<Count> facets;
    sides.reserve(Most);
    facets.reserve(Most);
    for (const SimplexId t : this->StarOf(edge[0]))
    {
      const auto& corners = this->VerticesOf(t);
      if (std::find(corners.begin(), corners.end(), edge[1]) == corners.end())
      {
        continue;
      }
      const LabelId label = this->LabelOf(t, change);
      for (const VertexId v : corners)
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
      for (const LabelId label : side.Labels)
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

  /** The weighted number of defects at an edge. A defect off junctions has a larger weight. */
  int CountBad(const Edge& edge, const Change* change) const
  {
    const State state = this->StateOf(edge, change);
    return state.Bad * (state.IsJunction ? AtJunction : OffJunction);
  }

private:
  static constexpr int AtJunction = 2;
  static constexpr int OffJunction = 3;

  const Triangulation<3>& Source;
  const std::span<const LabelId> Labels;       ///< by simplex id; the owner may change them
  const std::vector<std::uint8_t> OnInterface; ///< by vertex
  mutable std::unordered_map<VertexId, std::vector<SimplexId>>
    Stars; ///< cache of the requested stars
};

} // namespace voxplex::repair

#endif
