// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RepairNeighbourhood.h
 * @brief Internal to ManifoldRepair: the surroundings of bad interface ridges, before or after a
 * proposed change.
 */
#ifndef voxplex_RepairNeighbourhood_h
#define voxplex_RepairNeighbourhood_h

#include "Delaunay/Triangulation.h"
#include "Delaunay/VertexStar.h"

#include <boost/container/small_vector.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace voxplex::repair
{

/** The vertices of a ridge, ascending: an edge in 3D, a triangle in 4D. */
template <int D>
using Ridge = std::array<VertexId, static_cast<std::size_t>(D - 1)>;

/** Gives some simplices another label; 0 drops them. */
struct Change
{
  std::vector<SimplexId> Cells;
  LabelId Label;

  bool Touches(SimplexId t) const
  {
    return std::find(this->Cells.begin(), this->Cells.end(), t) != this->Cells.end();
  }
};

//------------------------------------------------------------------------------------------------
/** Access to the labelled simplices of a triangulation by their vertices. */
template <int D>
class Neighbourhood
{
public:
  /** @param onInterface for each vertex, whether it is on an interface before any change */
  Neighbourhood(const Triangulation<D>& triangulation, std::span<const LabelId> labels,
    std::vector<std::uint8_t> onInterface)
    : Source(triangulation)
    , Labels(labels)
    , OnInterface(std::move(onInterface))
  {
  }

  const std::array<VertexId, static_cast<std::size_t>(D + 1)>& VerticesOf(SimplexId t) const
  {
    return this->Source.GetSimplex(t).V;
  }
  const Point<D>& Position(VertexId v) const { return this->Source.Position(v); }
  bool IsOnInterface(VertexId v) const { return this->OnInterface[v] != 0; }
  voxplex::Circumball<D> Circumball(SimplexId t) const { return this->Source.GetCircumball(t); }

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

  /** The simplices that have all vertices of a ridge. */
  std::vector<SimplexId> StarOf(const Ridge<D>& ridge) const
  {
    std::vector<SimplexId> star;
    for (const SimplexId t : this->StarOf(ridge[0]))
    {
      const auto& v = this->VerticesOf(t);
      if (std::all_of(ridge.begin() + 1, ridge.end(),
            [&v](VertexId x) { return std::find(v.begin(), v.end(), x) != v.end(); }))
      {
        star.push_back(t);
      }
    }
    return star;
  }

  /** The simplex beside facet i of t, or None. */
  SimplexId Beside(SimplexId t, unsigned i) const { return this->Source.GetSimplex(t).N[i]; }
  LabelId LabelBeside(SimplexId t, unsigned i) const
  {
    const SimplexId beside = this->Beside(t, i);
    return beside == None ? LabelId{ 0 } : this->Labels[beside];
  }

  /** Defects at a ridge. */
  struct State
  {
    int Bad; ///< labels, except background, with boundary facets at the ridge, but not exactly two
    bool IsJunction; ///< three or more labels meet there
  };
  /** @param t a simplex at the ridge; the time is linear in the number of those */
  State StateOf(const Ridge<D>& ridge, SimplexId t, const Change* change) const
  {
    struct Count
    {
      LabelId Label;
      int Facets;
    };
    constexpr std::size_t most = 8; // enough for nearly all ridges; the list is searched linearly
    boost::container::small_vector<Count, most> counts;
    this->ForEachFacetAround(ridge, t, change,
      [&](LabelId a, LabelId b)
      {
        if (a == b)
        {
          return;
        }
        for (const LabelId label : { a, b })
        {
          const auto known = std::find_if(
            counts.begin(), counts.end(), [&](const Count& count) { return count.Label == label; });
          ++(known != counts.end() ? *known : counts.emplace_back(Count{ label, 0 })).Facets;
        }
      });
    const auto bad = std::count_if(counts.begin(), counts.end(),
      [](const Count& count) { return count.Label != 0 && count.Facets != 2; });
    return { static_cast<int>(bad), counts.size() > 2 };
  }

  /** The weighted number of defects at a ridge. A defect off junctions has a larger weight. */
  int CountBad(const Ridge<D>& ridge, SimplexId t, const Change* change) const
  {
    const State state = this->StateOf(ridge, t, change);
    return state.Bad * (state.IsJunction ? AtJunction : OffJunction);
  }

private:
  /** Calls visit with the labels on both sides of each facet at a ridge of t. */
  template <typename Visit>
  void ForEachFacetAround(
    const Ridge<D>& ridge, SimplexId t, const Change* change, Visit&& visit) const
  {
    const auto isOf = [&](VertexId v)
    { return std::find(ridge.begin(), ridge.end(), v) != ridge.end(); };
    std::array<VertexId, 2> others;
    unsigned found = 0;
    for (const VertexId v : this->VerticesOf(t))
    {
      if (!isOf(v))
      {
        others[found++] = v;
      }
    }
    // If one turn ends at the hull, the other one begins at t as well.
    for (unsigned turn = 0; turn < 2; ++turn)
    {
      SimplexId here = t;
      LabelId label = this->LabelOf(here, change);
      VertexId behind = others[turn]; // the next facet is opposite to it
      VertexId ahead = others[1 - turn];
      do
      {
        const auto& v = this->VerticesOf(here);
        here = this->Beside(
          here, static_cast<unsigned>(std::find(v.begin(), v.end(), behind) - v.begin()));
        const LabelId next = here == None ? LabelId{ 0 } : this->LabelOf(here, change);
        visit(label, next);
        if (here == None)
        {
          break;
        }
        const auto& w = this->VerticesOf(here);
        behind = std::exchange(ahead,
          *std::find_if(w.begin(), w.end(), [&](VertexId x) { return !isOf(x) && x != ahead; }));
        label = next;
      } while (here != t);
      if (here == t)
      {
        return;
      }
    }
  }

  static constexpr int AtJunction = 2;
  static constexpr int OffJunction = 3;

  const Triangulation<D>& Source;
  const std::span<const LabelId> Labels;       ///< by simplex id; the owner may change them
  const std::vector<std::uint8_t> OnInterface; ///< by vertex
  mutable std::unordered_map<VertexId, std::vector<SimplexId>>
    Stars; ///< cache of the requested stars
};

} // namespace voxplex::repair

#endif
