// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/ManifoldRepair.h"

#include "Conformity/RepairNeighbourhood.h"
#include "Geometry/SimplexQuality.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace voxplex
{

namespace
{

using namespace repair;

using Facet = std::array<VertexId, 3>;

Edge MakeEdge(VertexId a, VertexId b)
{
  return { std::min(a, b), std::max(a, b) };
}

/** The facets of the interfaces of a triangulation. */
struct InterfaceFacets
{
  std::vector<Facet> Facets;
  std::vector<std::array<std::int64_t, 2>> Labels; ///< on both sides of each
};

/** The facets are in the order of the simplices on the side of the larger label. */
InterfaceFacets FindInterfaceFacets(const Triangulation<3>& triangulation,
  std::span<const LabelId> labels, unsigned threads, const std::stop_token& stop)
{
  constexpr std::size_t Grain = 8192;
  std::vector<InterfaceFacets> parts((labels.size() + Grain - 1) / Grain);
  ParallelFor(
    0, labels.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      InterfaceFacets& part = parts[first / Grain];
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        if (labels[s] == 0)
        {
          continue;
        }
        const auto& simplex = triangulation.GetSimplex(s);
        for (unsigned i = 0; i < 4; ++i)
        {
          const LabelId beside = simplex.N[i] == None ? LabelId{ 0 } : labels[simplex.N[i]];
          if (beside < labels[s])
          {
            part.Facets.push_back(
              { simplex.V[(i + 1) % 4], simplex.V[(i + 2) % 4], simplex.V[(i + 3) % 4] });
            part.Labels.push_back({ labels[s], beside });
          }
        }
      }
    },
    stop);
  InterfaceFacets all;
  for (const InterfaceFacets& part : parts)
  {
    all.Facets.insert(all.Facets.end(), part.Facets.begin(), part.Facets.end());
    all.Labels.insert(all.Labels.end(), part.Labels.begin(), part.Labels.end());
  }
  return all;
}

//------------------------------------------------------------------------------------------------
/** Finds and applies changes that leave fewer bad edges. */
class EdgeRepair
{
public:
  EdgeRepair(const Triangulation<3>& triangulation, std::span<LabelId> labels,
    std::vector<std::uint8_t> onInterface, const ManifoldRepairOptions& options)
    : Labels(labels)
    , Near(triangulation, labels, std::move(onInterface))
    , FacetCosine(std::cos(options.Shape.FacetAngle * std::numbers::pi / 180.0))
    , JunctionCosine(std::cos(options.Shape.JunctionFacetAngle * std::numbers::pi / 180.0))
    , Surfaces(options.Surfaces)
    , Sizing(options.Sizing)
  {
  }

  /** Applies the best change around an edge. @return false if none helps */
  bool Mend(const Edge& edge)
  {
    std::optional<Change> best;
    bool bestDents = true;
    int bestGain = 0;
    double bestVolume = 0.0;
    for (Change& change : this->ChangesAt(edge))
    {
      const int gain = this->GainOf(change);
      const double volume = this->VolumeOf(change);
      const bool dents = this->Dents(change);
      const bool isBetter = dents != bestDents ? bestDents
        : gain != bestGain                     ? gain > bestGain
                                               : volume < bestVolume;
      if (gain > 0 && isBetter && this->IsAllowed(change))
      {
        bestDents = dents;
        bestGain = gain;
        bestVolume = volume;
        best = std::move(change);
      }
    }
    if (!best)
    {
      return false;
    }
    for (const SimplexId t : best->Cells)
    {
      this->Labels[t] = best->Label;
      this->Changed.insert(t);
    }
    return true;
  }

  bool IsBad(const Edge& edge) const
  {
    return this->Near.CountBad(edge, this->Near.StarOf(edge).front(), nullptr) != 0;
  }

  const std::set<SimplexId>& GetChanged() const { return this->Changed; }

  /**
   * The bad edges now, in the order of their ends. Only edges that were bad before, and edges of
   * changed tetrahedra, need to be checked.
   * @param before the bad edges before any change
   */
  std::vector<InterfaceEdge> FindLeft(const std::vector<InterfaceEdge>& before) const
  {
    std::vector<InterfaceEdge> left;
    const std::vector<CellEdge> changed = this->EdgesOf(this->Changed);
    for (const InterfaceEdge& edge : before)
    {
      const auto at = std::lower_bound(changed.begin(), changed.end(), edge.Ends,
        [](const CellEdge& e, const Edge& ends) { return e.Ends < ends; });
      if (at == changed.end() || at->Ends != edge.Ends)
      {
        left.push_back(edge);
      }
    }
    for (const CellEdge& edge : changed)
    {
      const Neighbourhood::State state = this->Near.StateOf(edge.Ends, edge.Cell, nullptr);
      if (state.Bad > 0)
      {
        left.push_back({ edge.Ends, state.IsJunction });
      }
    }
    std::sort(left.begin(), left.end(),
      [](const InterfaceEdge& a, const InterfaceEdge& b) { return a.Ends < b.Ends; });
    return left;
  }

private:
  Facet FacetOf(SimplexId t, unsigned i) const
  {
    const auto& v = this->Near.VerticesOf(t);
    return { v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4] };
  }

  /**
   * All candidate changes: each tetrahedron around the edge, and each run of a label, gets a label
   * beside it.
   */
  std::vector<Change> ChangesAt(const Edge& edge) const
  {
    const std::vector<SimplexId> star = this->Near.StarOf(edge);
    std::vector<std::vector<SimplexId>> groups;
    std::set<SimplexId> grouped;
    for (const SimplexId t : star)
    {
      if (this->Labels[t] == 0) // is not in the mesh
      {
        continue;
      }
      groups.push_back({ t });
      if (!grouped.insert(t).second)
      {
        continue;
      }
      std::vector<SimplexId> run{ t };
      for (std::size_t k = 0; k < run.size(); ++k)
      {
        for (unsigned i = 0; i < 4; ++i)
        {
          const SimplexId other = this->Near.Beside(run[k], i);
          if (std::binary_search(star.begin(), star.end(), other) &&
            this->Labels[other] == this->Labels[t] && grouped.insert(other).second)
          {
            run.push_back(other);
          }
        }
      }
      if (run.size() > 1)
      {
        groups.push_back(std::move(run));
      }
    }
    std::vector<Change> changes;
    for (const std::vector<SimplexId>& group : groups)
    {
      std::set<LabelId> labels;
      for (const SimplexId t : group)
      {
        for (unsigned i = 0; i < 4; ++i)
        {
          labels.insert(this->Near.LabelBeside(t, i));
        }
      }
      labels.erase(this->Labels[group.front()]);
      for (const LabelId label : labels)
      {
        changes.push_back({ group, label });
      }
    }
    return changes;
  }

  /** An edge, and a tetrahedron that has it. */
  struct CellEdge
  {
    Edge Ends;
    SimplexId Cell;
  };

  /** The edges of some tetrahedra, ascending. */
  template <typename Cells>
  std::vector<CellEdge> EdgesOf(const Cells& cells) const
  {
    std::vector<CellEdge> edges;
    for (const SimplexId t : cells)
    {
      const auto& v = this->Near.VerticesOf(t);
      for (unsigned i = 0; i < 4; ++i)
      {
        for (unsigned j = 0; j < i; ++j)
        {
          edges.push_back({ MakeEdge(v[i], v[j]), t });
        }
      }
    }
    std::sort(edges.begin(), edges.end(),
      [](const CellEdge& a, const CellEdge& b) { return a.Ends < b.Ends; });
    edges.erase(std::unique(edges.begin(), edges.end(),
                  [](const CellEdge& a, const CellEdge& b) { return a.Ends == b.Ends; }),
      edges.end());
    return edges;
  }

  /** The decrease of CountBad(), summed over all edges. */
  int GainOf(const Change& change) const
  {
    int gain = 0;
    for (const CellEdge& edge : this->EdgesOf(change.Cells))
    {
      gain += this->Near.CountBad(edge.Ends, edge.Cell, nullptr) -
        this->Near.CountBad(edge.Ends, edge.Cell, &change);
    }
    return gain;
  }

  double VolumeOf(const Change& change) const
  {
    double volume = 0.0;
    for (const SimplexId t : change.Cells)
    {
      std::array<const Point<3>*, 4> points;
      for (unsigned i = 0; i < 4; ++i)
      {
        points[i] = &this->Near.Position(this->Near.VerticesOf(t)[i]);
      }
      volume += std::abs(SignedVolume<3>(points.data()));
    }
    return volume;
  }

  bool IsAllowed(const Change& change) const
  {
    bool leavesSome = false;
    for (const SimplexId t : change.Cells)
    {
      if (this->IsTooLarge(t, change.Label))
      {
        return false;
      }
      const LabelId own = this->Labels[t];
      for (const VertexId v : this->Near.VerticesOf(t))
      {
        if (!this->Near.IsOnInterface(v))
        {
          return false;
        }
        for (const SimplexId other : this->Near.StarOf(v))
        {
          if (leavesSome)
          {
            break;
          }
          leavesSome = this->Labels[other] == own && !change.Touches(other);
        }
      }
      for (unsigned i = 0; i < 4; ++i)
      {
        const bool isNew = this->Near.LabelBeside(t, i) == own &&
          !change.Touches(this->Near.Beside(t, i)); // the facet becomes an interface facet
        if (isNew && !this->HasGoodAngles(t, i, change))
        {
          return false;
        }
      }
    }
    return leavesSome && !this->UncoversSharpFacet(change);
  }

  /**
   * Whether a change takes a junction away from an interface facet whose angles are allowed at
   * junctions only.
   */
  bool UncoversSharpFacet(const Change& change) const
  {
    for (const SimplexId t : change.Cells)
    {
      for (const VertexId v : this->Near.VerticesOf(t))
      {
        if (!this->IsAtJunction(v, nullptr) || this->IsAtJunction(v, &change))
        {
          continue;
        }
        for (const SimplexId s : this->Near.StarOf(v))
        {
          for (unsigned i = 0; i < 4; ++i)
          {
            const SimplexId beside = this->Near.Beside(s, i);
            const LabelId other =
              beside == None ? LabelId{ 0 } : this->Near.LabelOf(beside, &change);
            if (this->Near.VerticesOf(s)[i] != v && other < this->Near.LabelOf(s, &change) &&
              this->SharpnessOf(s, i) == Sharpness::AtJunctionsOnly &&
              !this->HasJunction(s, i, change))
            {
              return true;
            }
          }
        }
      }
    }
    return false;
  }

  /** Whether a tetrahedron is larger than the elements of a label may be. */
  bool IsTooLarge(SimplexId t, LabelId label) const
  {
    if (!this->Sizing || label == 0)
    {
      return false;
    }
    const Circumball<3> ball = this->Near.Circumball(t);
    const double size = this->Sizing->ElementSize(ball.Center, label);
    return ball.Radius2 > size * size;
  }

  /**
   * Whether a change drops a tetrahedron with a facet on a flat face where the image cuts the
   * object.
   */
  bool Dents(const Change& change) const
  {
    const ImageBorder<3>* const border = this->Surfaces ? this->Surfaces->Border() : nullptr;
    if (!border || change.Label != 0)
    {
      return false;
    }
    for (const SimplexId t : change.Cells)
    {
      for (unsigned i = 0; i < 4; ++i)
      {
        unsigned faces = ~0u;
        for (const VertexId v : this->FacetOf(t, i))
        {
          faces &= border->FacesAt(this->Near.Position(v));
        }
        if (faces != 0)
        {
          return true;
        }
      }
    }
    return false;
  }

  /** Where a facet with these angles may be. */
  enum class Sharpness
  {
    Anywhere,
    AtJunctionsOnly,
    Nowhere
  };
  Sharpness SharpnessOf(SimplexId t, unsigned i) const
  {
    const Facet facet = this->FacetOf(t, i);
    Sharpness sharpness = Sharpness::Anywhere;
    for (unsigned k = 0; k < 3; ++k)
    {
      const Point<3>& p = this->Near.Position(facet[k]);
      const Point<3> a = Subtract(this->Near.Position(facet[(k + 1) % 3]), p);
      const Point<3> b = Subtract(this->Near.Position(facet[(k + 2) % 3]), p);
      const double lengths = std::sqrt(Dot(a, a) * Dot(b, b));
      if (Dot(a, b) > this->JunctionCosine * lengths)
      {
        return Sharpness::Nowhere;
      }
      sharpness = Dot(a, b) > this->FacetCosine * lengths ? Sharpness::AtJunctionsOnly : sharpness;
    }
    return sharpness;
  }

  bool HasGoodAngles(SimplexId t, unsigned i, const Change& change) const
  {
    const Sharpness sharpness = this->SharpnessOf(t, i);
    return sharpness == Sharpness::Anywhere ||
      (sharpness == Sharpness::AtJunctionsOnly && this->HasJunction(t, i, change));
  }

  /** Whether a vertex of a facet is at a junction after a change. */
  bool HasJunction(SimplexId t, unsigned i, const Change& change) const
  {
    const Facet facet = this->FacetOf(t, i);
    return std::any_of(
      facet.begin(), facet.end(), [&](VertexId v) { return this->IsAtJunction(v, &change); });
  }

  /** Whether three or more labels, including background, meet at a vertex. */
  bool IsAtJunction(VertexId v, const Change* change) const
  {
    std::array<LabelId, 2> known{};
    unsigned count = 0;
    for (const SimplexId t : this->Near.StarOf(v))
    {
      const LabelId label = this->Near.LabelOf(t, change);
      if (std::find(known.begin(), known.begin() + count, label) == known.begin() + count)
      {
        if (count == known.size())
        {
          return true;
        }
        known[count++] = label;
      }
    }
    return false;
  }

  const std::span<LabelId> Labels; ///< by simplex id
  const Neighbourhood Near;
  const double FacetCosine;
  const double JunctionCosine; ///< at least FacetCosine
  const Domain<3>* const Surfaces;
  const SizingField<3>* const Sizing;
  std::set<SimplexId> Changed;
};

} // namespace

//------------------------------------------------------------------------------------------------
ManifoldRepairResult RepairManifold(const Triangulation<3>& triangulation,
  std::span<LabelId> labels, const ManifoldRepairOptions& options, unsigned threads,
  const std::stop_token& stop)
{
  const InterfaceFacets interfaces = FindInterfaceFacets(triangulation, labels, threads, stop);
  const std::vector<InterfaceEdge> edges = FindNonManifoldEdges(
    interfaces.Facets, interfaces.Labels, triangulation.VertexIdEnd(), threads, stop);
  if (edges.empty())
  {
    return {};
  }
  std::vector<std::uint8_t> onInterface(triangulation.VertexIdEnd());
  for (const Facet& facet : interfaces.Facets)
  {
    for (const VertexId v : facet)
    {
      onInterface[v] = 1;
    }
  }
  EdgeRepair repair(triangulation, labels, std::move(onInterface), options);
  for (bool again = true; again;)
  {
    again = false;
    for (const InterfaceEdge& edge : edges)
    {
      ThrowIfStopped(stop);
      again |= repair.IsBad(edge.Ends) && repair.Mend(edge.Ends);
    }
  }
  const std::set<SimplexId>& changed = repair.GetChanged();
  return { edges.size(), repair.FindLeft(edges), { changed.begin(), changed.end() } };
}

} // namespace voxplex
