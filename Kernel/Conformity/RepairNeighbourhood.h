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
  State StateOf(const Ridge<D>& ridge, SimplexId t) const
  {
    FacetCounts counts;
    this->ForEachFacetAround(ridge, t,
      [&](SimplexId a, SimplexId b) { counts.Add(this->Labels[a], this->LabelOrBackground(b)); });
    return counts.Evaluate();
  }

  /**
   * The weighted number of defects at a ridge, before a change less after it. A defect off
   * junctions has a larger weight.
   * @param t a simplex at the ridge
   */
  int GainAt(const Ridge<D>& ridge, SimplexId t, const Change& change) const
  {
    FacetCounts before;
    FacetCounts after;
    LabelId here = this->LabelOf(t, &change);
    SimplexId last = t;
    this->ForEachFacetAround(ridge, t,
      [&](SimplexId a, SimplexId b)
      {
        here = a == last ? here : this->LabelOf(a, &change); // the second turn begins at t again
        const LabelId next = b == None ? LabelId{ 0 } : this->LabelOf(b, &change);
        before.Add(this->Labels[a], this->LabelOrBackground(b));
        after.Add(here, next);
        here = next;
        last = b;
      });
    const auto weightOf = [](const State& state)
    { return state.Bad * (state.IsJunction ? AtJunction : OffJunction); };
    return weightOf(before.Evaluate()) - weightOf(after.Evaluate());
  }

private:
  /** Counts the facets at a ridge that each label has on one side. */
  class FacetCounts
  {
  public:
    /** A facet between two labels, or inside of one. */
    void Add(LabelId a, LabelId b)
    {
      if (a != b)
      {
        this->Add(a);
        this->Add(b);
      }
    }

    State Evaluate() const
    {
      const auto bad = std::count_if(this->Counts.begin(), this->Counts.end(),
        [](const Count& count) { return count.Label != 0 && count.Facets != 2; });
      return { static_cast<int>(bad), this->Counts.size() > 2 };
    }

  private:
    struct Count
    {
      LabelId Label;
      int Facets;
    };
    static constexpr std::size_t Most = 8; ///< enough for nearly all; the list is searched linearly

    void Add(LabelId label)
    {
      const auto known = std::find_if(this->Counts.begin(), this->Counts.end(),
        [&](const Count& count) { return count.Label == label; });
      ++(known != this->Counts.end() ? *known : this->Counts.emplace_back(Count{ label, 0 }))
          .Facets;
    }

    boost::container::small_vector<Count, Most> Counts;
  };

  LabelId LabelOrBackground(SimplexId t) const
  {
    return t == None ? LabelId{ 0 } : this->Labels[t];
  }

  /** Calls visit with the simplices on both sides of each facet at a ridge of t; the second may be None. */
  template <typename Visit>
  void ForEachFacetAround(const Ridge<D>& ridge, SimplexId t, Visit&& visit) const
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
      VertexId behind = others[turn]; // the next facet is opposite to it
      VertexId ahead = others[1 - turn];
      do
      {
        const auto& v = this->VerticesOf(here);
        const SimplexId before = here;
        here = this->Beside(
          here, static_cast<unsigned>(std::find(v.begin(), v.end(), behind) - v.begin()));
        visit(before, here);
        if (here == None)
        {
          break;
        }
        const auto& w = this->VerticesOf(here);
        behind = std::exchange(ahead,
          *std::find_if(w.begin(), w.end(), [&](VertexId x) { return !isOf(x) && x != ahead; }));
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
