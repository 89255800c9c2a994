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
#include "Geometry/SimplexQuality.h"
#include "Mesh/RidgeRing.h"

#include <boost/container/small_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
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

  bool operator==(const Change&) const = default;
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
  /** @param labels by simplex id; the owner may change them */
  Neighbourhood(const Triangulation<D>& triangulation, std::span<const LabelId> labels)
    : Source(triangulation)
    , Labels(labels)
  {
  }

  const std::array<VertexId, static_cast<std::size_t>(D + 1)>& VerticesOf(SimplexId t) const
  {
    return this->Source.GetSimplex(t).V;
  }
  const Point<D>& Position(VertexId v) const { return this->Source.Position(v); }
  template <std::size_t N>
  std::array<const Point<D>*, N> Points(const std::array<VertexId, N>& v) const
  {
    return this->Source.Points(v);
  }
  /** Whether a vertex had simplices of different labels before any change. */
  bool IsOnInterface(VertexId v) const { return this->Source.GetVertex(v).OnInterface; }
  voxplex::Circumball<D> Circumball(SimplexId t) const { return this->Source.GetCircumball(t); }
  double VolumeOf(const std::vector<SimplexId>& cells) const
  {
    double volume = 0.0;
    for (const SimplexId t : cells)
    {
      volume += std::abs(SignedVolume<D>(this->Points(this->VerticesOf(t)).data()));
    }
    return volume;
  }

  /** The star of a vertex. Ascending, so that results do not depend on where a search begins. */
  const std::vector<SimplexId>& StarOf(VertexId v) const
  {
    Star& star = this->Find(v);
    if (star.SeenIn != this->Search)
    {
      star.SeenIn = this->Search;
      this->SeenVertices.push_back(v);
    }
    return star.Cells;
  }

  /** Tells that simplices around some vertices were looked at. */
  void See(const std::vector<VertexId>& vertices) const
  {
    this->SeenVertices.insert(this->SeenVertices.end(), vertices.begin(), vertices.end());
  }

  /** The vertices whose stars were asked for, or told of, since ForgetSeen(). */
  const std::vector<VertexId>& Seen() const { return this->SeenVertices; }
  void ForgetSeen() const
  {
    ++this->Search;
    this->SeenVertices.clear();
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

  static constexpr std::size_t UsualLength = 16; ///< of a ring, at most
  using RingLabels = boost::container::small_vector<LabelId, UsualLength>;

  /** What lies around a ridge. */
  struct Ring
  {
    Ridge<D> Vertices;
    /**
     * The simplices that have it, each beside the next. The last is the first again; or both are None, which is
     * what lies outside of the hull.
     */
    boost::container::small_vector<SimplexId, UsualLength> Cells;
    RingLabels Labels; ///< of these
    State Now;
  };

  /** @param t a simplex at the ridge; the time is linear in the number of those */
  Ring RingOf(const Ridge<D>& ridge, SimplexId t) const
  {
    RidgeRing& found = this->Found;
    const std::array<VertexId, 2> others = this->OthersOf(t, ridge);
    GatherRing(
      t, others[0],
      others[1], [this](SimplexId s) -> const auto& { return this->Source.GetSimplex(s); },
      [](SimplexId) { return true; }, found);
    Ring ring;
    ring.Vertices = ridge;
    ring.Cells.assign(found.Closed ? 0 : 1, None);
    ring.Cells.insert(ring.Cells.end(), found.Cells.begin(), found.Cells.end());
    ring.Cells.push_back(found.Closed ? t : None);
    for (const SimplexId cell : ring.Cells)
    {
      ring.Labels.push_back(cell == None ? LabelId{ 0 } : this->Labels[cell]);
    }
    ring.Now = StateOf(ring.Labels);
    return ring;
  }

  /**
   * The weighted number of defects at a ridge, before a change less after it. A defect off
   * junctions has a larger weight.
   */
  static int GainAt(const Ring& ring, const Change& change)
  {
    RingLabels labels = ring.Labels;
    for (const SimplexId t : change.Cells)
    {
      for (std::size_t k = 0; k < labels.size(); ++k)
      {
        labels[k] = ring.Cells[k] == t ? change.Label : labels[k];
      }
    }
    const auto weightOf = [](const State& state)
    { return state.Bad * (state.IsJunction ? AtJunction : OffJunction); };
    return weightOf(ring.Now) - weightOf(StateOf(labels));
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

  static State StateOf(const RingLabels& labels)
  {
    FacetCounts counts;
    for (std::size_t k = 1; k < labels.size(); ++k)
    {
      counts.Add(labels[k - 1], labels[k]);
    }
    return counts.Evaluate();
  }

  /** The vertices of a simplex that are not in a ridge of it. */
  std::array<VertexId, 2> OthersOf(SimplexId t, const Ridge<D>& ridge) const
  {
    std::array<VertexId, 2> others;
    unsigned found = 0;
    for (const VertexId v : this->VerticesOf(t))
    {
      if (std::find(ridge.begin(), ridge.end(), v) == ridge.end())
      {
        others[found++] = v;
      }
    }
    return others;
  }

  static constexpr int AtJunction = 2;
  static constexpr int OffJunction = 3;

  struct Star
  {
    std::vector<SimplexId> Cells;
    std::size_t SeenIn = 0;
  };

  Star& Find(VertexId v) const
  {
    const auto [entry, isNew] = this->Stars.try_emplace(v);
    Star& star = entry->second;
    if (isNew)
    {
      star.Cells = voxplex::StarOf(this->Source, v, this->Source.GetVertex(v).Incident);
      std::sort(star.Cells.begin(), star.Cells.end());
    }
    return star;
  }

  const Triangulation<D>& Source;
  const std::span<const LabelId> Labels;
  mutable std::unordered_map<VertexId, Star> Stars; ///< cache of the requested ones
  mutable RidgeRing Found; ///< keeps its memory
  mutable std::vector<VertexId> SeenVertices;
  mutable std::size_t Search = 1;
};

} // namespace voxplex::repair

#endif
