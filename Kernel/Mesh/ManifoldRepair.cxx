// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/ManifoldRepair.h"

#include "Geometry/SimplexQuality.h"
#include "Mesh/RepairNeighbourhood.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <vector>

namespace voxplex
{

namespace
{

using namespace repair;

/** Facet i of a positively oriented tetrahedron, its normal outwards. */
constexpr std::array<std::array<unsigned, 3>, 4> Outward{ { { 1, 2, 3 }, { 2, 0, 3 }, { 0, 1, 3 },
  { 1, 0, 2 } } };

Edge MakeEdge(std::uint32_t a, std::uint32_t b)
{
  return { std::min(a, b), std::max(a, b) };
}

Facet Sorted(Facet facet)
{
  std::sort(facet.begin(), facet.end());
  return facet;
}

//------------------------------------------------------------------------------------------------
/** Looks for changes that leave fewer bad edges. */
class Mender
{
public:
  Mender(SimplexMesh<3>& mesh, const std::vector<InterfaceEdge>& edges,
    const ManifoldRepairOptions& options)
    : Mesh(mesh)
    , Near(mesh, edges)
    , FacetCosine(std::cos(options.FacetAngle * std::numbers::pi / 180.0))
    , JunctionCosine(std::cos(
        std::min(options.JunctionFacetAngle, options.FacetAngle) * std::numbers::pi / 180.0))
    , Cut(options.Cut)
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
    for (const std::uint32_t t : best->Cells)
    {
      this->Mesh.Labels[t] = best->Label;
      this->Changed.insert(t);
    }
    return true;
  }

  bool IsBad(const Edge& edge) const { return this->Near.CountBad(edge, nullptr) != 0; }

  /**
   * Brings the mesh's facets in line with the labels, and takes out what was dropped.
   * @param before bad edges before any change, in the order of their ends
   * @return those that there are now, in the same order
   */
  std::vector<InterfaceEdge> Finish(const std::vector<InterfaceEdge>& before)
  {
    std::vector<InterfaceEdge> left = this->FindLeft(before);
    std::vector<std::uint8_t> touched(this->Mesh.Points.size());
    std::set<Facet> around; // facets of what has changed
    for (const std::uint32_t t : this->Changed)
    {
      for (unsigned i = 0; i < 4; ++i)
      {
        around.insert(this->FacetOf(t, i));
        touched[this->Mesh.Simplices[t][i]] = 1;
      }
    }
    std::size_t kept = 0;
    for (std::size_t f = 0; f < this->Mesh.Facets.size(); ++f)
    {
      const Facet& v = this->Mesh.Facets[f];
      if ((touched[v[0]] & touched[v[1]] & touched[v[2]]) == 0 || !around.contains(Sorted(v)))
      {
        this->Mesh.Facets[kept] = this->Mesh.Facets[f];
        this->Mesh.FacetLabels[kept++] = this->Mesh.FacetLabels[f];
      }
    }
    this->Mesh.Facets.resize(kept);
    this->Mesh.FacetLabels.resize(kept);
    for (const std::uint32_t t : this->Changed)
    {
      for (unsigned i = 0; i < 4; ++i)
      {
        if (around.erase(this->FacetOf(t, i)) != 0)
        {
          this->AddFacet(t, i);
        }
      }
    }
    this->DropBackground(left);
    return left;
  }

private:
  /** The bad edges now: of what has changed, and what was bad elsewhere. */
  std::vector<InterfaceEdge> FindLeft(const std::vector<InterfaceEdge>& before) const
  {
    std::vector<InterfaceEdge> left;
    const std::vector<Edge> changed = this->EdgesOf(this->Changed);
    for (const InterfaceEdge& edge : before)
    {
      if (!std::binary_search(changed.begin(), changed.end(), edge.Ends))
      {
        left.push_back(edge);
      }
    }
    for (const Edge& edge : changed)
    {
      const Neighbourhood::State state = this->Near.StateOf(edge, nullptr);
      if (state.Bad > 0)
      {
        left.push_back({ edge, state.IsJunction });
      }
    }
    std::sort(left.begin(), left.end(),
      [](const InterfaceEdge& a, const InterfaceEdge& b) { return a.Ends < b.Ends; });
    return left;
  }

  Facet FacetOf(std::uint32_t t, unsigned i) const
  {
    const auto& v = this->Mesh.Simplices[t];
    return Sorted({ v[Outward[i][0]], v[Outward[i][1]], v[Outward[i][2]] });
  }

  /** Each tetrahedron around the edge, and each run of a label, to the labels beside them. */
  std::vector<Change> ChangesAt(const Edge& edge) const
  {
    const std::vector<std::uint32_t> star = this->Near.StarOf(edge);
    std::vector<std::vector<std::uint32_t>> groups;
    std::set<std::uint32_t> grouped;
    for (const std::uint32_t t : star)
    {
      groups.push_back({ t });
      if (!grouped.insert(t).second)
      {
        continue;
      }
      std::vector<std::uint32_t> run{ t };
      for (std::size_t k = 0; k < run.size(); ++k)
      {
        for (const std::uint32_t other : star)
        {
          if (this->Mesh.Labels[other] == this->Mesh.Labels[t] &&
            this->AreNeighbours(run[k], other) && grouped.insert(other).second)
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
    for (const std::vector<std::uint32_t>& group : groups)
    {
      if (this->Mesh.Labels[group.front()] == 0) // dropped already
      {
        continue;
      }
      std::set<std::int64_t> labels;
      for (const std::uint32_t t : group)
      {
        for (unsigned i = 0; i < 4; ++i)
        {
          const std::optional<std::uint32_t> beside = this->Near.Beside(t, i);
          labels.insert(beside ? this->Mesh.Labels[*beside] : 0);
        }
      }
      labels.erase(this->Mesh.Labels[group.front()]);
      for (const std::int64_t label : labels)
      {
        changes.push_back({ group, label });
      }
    }
    return changes;
  }

  bool AreNeighbours(std::uint32_t t, std::uint32_t other) const
  {
    const auto& v = this->Mesh.Simplices[t];
    const auto& w = this->Mesh.Simplices[other];
    return std::count_if(v.begin(), v.end(),
             [&](std::uint32_t p) { return std::find(w.begin(), w.end(), p) != w.end(); }) == 3;
  }

  /** Those of some tetrahedra, ascending. */
  template <typename Cells>
  std::vector<Edge> EdgesOf(const Cells& cells) const
  {
    std::vector<Edge> edges;
    for (const std::uint32_t t : cells)
    {
      const auto& v = this->Mesh.Simplices[t];
      for (unsigned i = 0; i < 4; ++i)
      {
        for (unsigned j = 0; j < i; ++j)
        {
          edges.push_back(MakeEdge(v[i], v[j]));
        }
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
  }

  /** By how much CountBad() becomes less, over all edges. */
  int GainOf(const Change& change) const
  {
    int gain = 0;
    for (const Edge& edge : this->EdgesOf(change.Cells))
    {
      gain += this->Near.CountBad(edge, nullptr) - this->Near.CountBad(edge, &change);
    }
    return gain;
  }

  double VolumeOf(const Change& change) const
  {
    double volume = 0.0;
    for (const std::uint32_t t : change.Cells)
    {
      std::array<const Point<3>*, 4> points;
      for (unsigned i = 0; i < 4; ++i)
      {
        points[i] = &this->Mesh.Points[this->Mesh.Simplices[t][i]];
      }
      volume += std::abs(SignedVolume<3>(points.data()));
    }
    return volume;
  }

  bool IsAllowed(const Change& change) const
  {
    bool leavesSome = false;
    for (const std::uint32_t t : change.Cells)
    {
      const std::int64_t own = this->Mesh.Labels[t];
      for (const std::uint32_t v : this->Mesh.Simplices[t])
      {
        if (!this->Near.IsOnInterface(v))
        {
          return false;
        }
        for (const std::uint32_t other : this->Near.StarOf(v))
        {
          if (leavesSome)
          {
            break;
          }
          leavesSome = this->Mesh.Labels[other] == own && !change.Touches(other);
        }
      }
      for (unsigned i = 0; i < 4; ++i)
      {
        const std::optional<std::uint32_t> beside = this->Near.Beside(t, i);
        const bool changes = beside && change.Touches(*beside);
        const std::int64_t other = beside ? this->Mesh.Labels[*beside] : 0;
        const bool isNew = !changes && other == own; // it becomes an interface now
        if (isNew && !this->HasGoodAngles(t, i))
        {
          return false;
        }
      }
    }
    return leavesSome;
  }

  /** Whether it drops what has a facet on a face where the image cuts the object, which is flat. */
  bool Dents(const Change& change) const
  {
    if (!this->Cut || change.Label != 0)
    {
      return false;
    }
    for (const std::uint32_t t : change.Cells)
    {
      for (unsigned i = 0; i < 4; ++i)
      {
        unsigned faces = ~0u;
        for (const std::uint32_t v : this->FacetOf(t, i))
        {
          faces &= this->Cut->CutFaces(this->Mesh.Points[v]);
        }
        if (faces != 0)
        {
          return true;
        }
      }
    }
    return false;
  }

  bool HasGoodAngles(std::uint32_t t, unsigned i) const
  {
    const Facet facet = this->FacetOf(t, i);
    bool isSharp = false; // good enough at junctions only
    for (unsigned k = 0; k < 3; ++k)
    {
      const Point<3>& p = this->Mesh.Points[facet[k]];
      const Point<3> a = Subtract(this->Mesh.Points[facet[(k + 1) % 3]], p);
      const Point<3> b = Subtract(this->Mesh.Points[facet[(k + 2) % 3]], p);
      const double lengths = std::sqrt(Dot(a, a) * Dot(b, b));
      if (Dot(a, b) > this->JunctionCosine * lengths)
      {
        return false;
      }
      isSharp |= Dot(a, b) > this->FacetCosine * lengths;
    }
    return !isSharp ||
      std::any_of(
        facet.begin(), facet.end(), [this](std::uint32_t v) { return this->IsAtJunction(v); });
  }

  /** Whether three labels or more meet at a vertex; background counts where the mesh ends. */
  bool IsAtJunction(std::uint32_t v) const
  {
    std::set<std::int64_t> labels;
    for (const std::uint32_t t : this->Near.StarOf(v))
    {
      labels.insert(this->Mesh.Labels[t]);
      for (unsigned i = 0; i < 4; ++i)
      {
        if (this->Mesh.Simplices[t][i] != v && !this->Near.Beside(t, i))
        {
          labels.insert(0);
        }
      }
    }
    return labels.size() > 2;
  }

  /** If it is an interface, from the side of the larger label. */
  void AddFacet(std::uint32_t t, unsigned i)
  {
    const std::optional<std::uint32_t> beside = this->Near.Beside(t, i);
    const std::int64_t own = this->Mesh.Labels[t];
    const std::int64_t other = beside ? this->Mesh.Labels[*beside] : 0;
    if (own == other)
    {
      return;
    }
    const auto& v = this->Mesh.Simplices[t];
    Facet facet{ v[Outward[i][0]], v[Outward[i][1]], v[Outward[i][2]] };
    if (own < other)
    {
      std::swap(facet[0], facet[1]);
    }
    this->Mesh.Facets.push_back(facet);
    this->Mesh.FacetLabels.push_back({ std::max(own, other), std::min(own, other) });
  }

  /** @param left edges, whose ends follow the numbers of the points */
  void DropBackground(std::vector<InterfaceEdge>& left)
  {
    SimplexMesh<3>& mesh = this->Mesh;
    if (std::find(mesh.Labels.begin(), mesh.Labels.end(), 0) == mesh.Labels.end())
    {
      return;
    }
    std::size_t kept = 0;
    std::vector<std::uint32_t> numbers(mesh.Points.size(), 0);
    for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
    {
      if (mesh.Labels[t] != 0)
      {
        mesh.Simplices[kept] = mesh.Simplices[t];
        mesh.Labels[kept++] = mesh.Labels[t];
        for (const std::uint32_t v : mesh.Simplices[t])
        {
          numbers[v] = 1;
        }
      }
    }
    mesh.Simplices.resize(kept);
    mesh.Labels.resize(kept);
    std::uint32_t points = 0;
    for (std::size_t v = 0; v < numbers.size(); ++v)
    {
      if (numbers[v] != 0)
      {
        mesh.Points[points] = mesh.Points[v];
        numbers[v] = points++;
      }
    }
    mesh.Points.resize(points);
    const auto renumber = [&](auto& cells)
    {
      for (auto& cell : cells)
      {
        for (std::uint32_t& v : cell)
        {
          v = numbers[v];
        }
      }
    };
    renumber(mesh.Simplices);
    renumber(mesh.Facets);
    for (InterfaceEdge& edge : left)
    {
      edge.Ends = { numbers[edge.Ends[0]], numbers[edge.Ends[1]] };
    }
  }

  SimplexMesh<3>& Mesh;
  const Neighbourhood Near;
  const double FacetCosine;
  const double JunctionCosine; ///< not smaller
  const Domain<3>* const Cut;
  std::set<std::uint32_t> Changed;
};

} // namespace

//------------------------------------------------------------------------------------------------
ManifoldRepairCounts RepairManifold(
  SimplexMesh<3>& mesh, const ManifoldRepairOptions& options, const std::stop_token& stop)
{
  const std::vector<InterfaceEdge> edges = FindNonManifoldEdges(mesh);
  ManifoldRepairCounts counts{ edges.size(), edges.size(), edges };
  if (edges.empty())
  {
    return counts;
  }
  Mender mender(mesh, edges, options);
  bool changed = false;
  for (bool again = true; again;)
  {
    again = false;
    for (const InterfaceEdge& edge : edges)
    {
      ThrowIfStopped(stop);
      again |= mender.IsBad(edge.Ends) && mender.Mend(edge.Ends);
    }
    changed |= again;
  }
  if (changed)
  {
    counts.Left = mender.Finish(edges);
    counts.After = counts.Left.size();
  }
  return counts;
}

} // namespace voxplex
