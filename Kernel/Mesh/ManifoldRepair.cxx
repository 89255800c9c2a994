// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/ManifoldRepair.h"

#include "Geometry/SimplexQuality.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <vector>

namespace voxplex
{

namespace
{

using Edge = std::array<std::uint32_t, 2>;
using Facet = std::array<std::uint32_t, 3>;

/** Facet i of a positively oriented tetrahedron, its normal outwards. */
constexpr std::array<std::array<unsigned, 3>, 4> Outward{ { { 1, 2, 3 }, { 2, 0, 3 }, { 0, 1, 3 },
  { 1, 0, 2 } } };

constexpr int AtJunction = 2;
constexpr int OffJunction = 3;

Edge MakeEdge(std::uint32_t a, std::uint32_t b)
{
  return { std::min(a, b), std::max(a, b) };
}

Facet Sorted(Facet facet)
{
  std::sort(facet.begin(), facet.end());
  return facet;
}

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

//------------------------------------------------------------------------------------------------
/** The tetrahedra near the bad edges of a mesh, by their vertices. */
class Neighbourhood
{
public:
  Neighbourhood(const SimplexMesh<3>& mesh, const std::vector<InterfaceEdge>& edges)
    : Mesh(mesh)
  {
    std::vector<bool> near(mesh.Points.size());
    for (const InterfaceEdge& edge : edges)
    {
      near[edge.Ends[0]] = true;
      near[edge.Ends[1]] = true;
    }
    // A change asks for the stars of the vertices of its tetrahedra, and these for the edges of theirs.
    for (int ring = 0; ring < 2; ++ring)
    {
      std::vector<bool> next = near;
      this->ForCellsNear(near,
        [&](std::uint32_t t)
        {
          for (const std::uint32_t v : mesh.Simplices[t])
          {
            next[v] = true;
          }
        });
      near = std::move(next);
    }
    this->ForCellsNear(near,
      [&](std::uint32_t t)
      {
        for (const std::uint32_t v : mesh.Simplices[t])
        {
          if (near[v])
          {
            this->Stars[v].push_back(t);
          }
        }
      });
    this->OnInterface.resize(mesh.Points.size());
    for (const Facet& facet : mesh.Facets)
    {
      for (const std::uint32_t v : facet)
      {
        this->OnInterface[v] = true;
      }
    }
  }

  const SimplexMesh<3>& GetMesh() const { return this->Mesh; }
  bool IsOnInterface(std::uint32_t v) const { return this->OnInterface[v]; }
  const std::vector<std::uint32_t>& StarOf(std::uint32_t v) const { return this->Stars.at(v); }

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

  /**
   * Labels with a number of boundary facets other than two or none at an edge, background left out; each counts
   * more off junctions, where there is no excuse.
   */
  int CountBad(const Edge& edge, const Change* change) const
  {
    // Of each facet with the edge, by its third vertex: the label on its sides.
    std::map<std::uint32_t, std::array<std::int64_t, 2>> sides;
    for (const std::uint32_t t : this->StarOf(edge))
    {
      for (const std::uint32_t v : this->Mesh.Simplices[t])
      {
        if (v != edge[0] && v != edge[1])
        {
          auto& labels = sides.try_emplace(v, std::array<std::int64_t, 2>{ 0, 0 }).first->second;
          labels[1] = labels[0];
          labels[0] = this->LabelOf(t, change);
        }
      }
    }
    std::map<std::int64_t, int> facets;
    for (const auto& [vertex, labels] : sides)
    {
      if (labels[0] != labels[1])
      {
        ++facets[labels[0]];
        ++facets[labels[1]];
      }
    }
    const auto bad = std::count_if(facets.begin(), facets.end(),
      [](const auto& entry) { return entry.first != 0 && entry.second != 2; });
    return static_cast<int>(bad) * (facets.size() > 2 ? AtJunction : OffJunction);
  }

private:
  template <typename Function>
  void ForCellsNear(const std::vector<bool>& near, Function&& function) const
  {
    for (std::uint32_t t = 0; t < this->Mesh.Simplices.size(); ++t)
    {
      const auto& v = this->Mesh.Simplices[t];
      if (near[v[0]] || near[v[1]] || near[v[2]] || near[v[3]])
      {
        function(t);
      }
    }
  }

  const SimplexMesh<3>& Mesh;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> Stars; ///< complete
  std::vector<bool> OnInterface;
};

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
    , JunctionCosine(std::cos(options.JunctionFacetAngle * std::numbers::pi / 180.0))
  {
  }

  /** Applies the best change around an edge. @return false if none helps */
  bool Mend(const Edge& edge)
  {
    std::optional<Change> best;
    int bestGain = 0;
    double bestVolume = 0.0;
    for (Change& change : this->ChangesAt(edge))
    {
      const int gain = this->GainOf(change);
      const double volume = this->VolumeOf(change);
      if (gain > 0 && (gain > bestGain || (gain == bestGain && volume < bestVolume)) &&
        this->IsAllowed(change))
      {
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

  /** Brings the mesh's facets in line with the labels, and takes out what was dropped. */
  void Finish()
  {
    std::set<Facet> around; // facets of what has changed
    for (const std::uint32_t t : this->Changed)
    {
      for (unsigned i = 0; i < 4; ++i)
      {
        around.insert(this->FacetOf(t, i));
      }
    }
    std::size_t kept = 0;
    for (std::size_t f = 0; f < this->Mesh.Facets.size(); ++f)
    {
      if (!around.contains(Sorted(this->Mesh.Facets[f])))
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
    this->DropBackground();
  }

private:
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

  /** By how much CountBad() becomes less, over all edges. */
  int GainOf(const Change& change) const
  {
    std::set<Edge> edges;
    for (const std::uint32_t t : change.Cells)
    {
      const auto& v = this->Mesh.Simplices[t];
      for (unsigned i = 0; i < 4; ++i)
      {
        for (unsigned j = 0; j < i; ++j)
        {
          edges.insert(MakeEdge(v[i], v[j]));
        }
      }
    }
    int gain = 0;
    for (const Edge& edge : edges)
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
          leavesSome |= this->Mesh.Labels[other] == own && !change.Touches(other);
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

  bool HasGoodAngles(std::uint32_t t, unsigned i) const
  {
    const Facet facet = this->FacetOf(t, i);
    double bound = this->FacetCosine;
    for (const std::uint32_t v : facet)
    {
      bound = this->IsAtJunction(v) ? std::max(bound, this->JunctionCosine) : bound;
    }
    for (unsigned k = 0; k < 3; ++k)
    {
      const Point<3>& p = this->Mesh.Points[facet[k]];
      const Point<3> a = Subtract(this->Mesh.Points[facet[(k + 1) % 3]], p);
      const Point<3> b = Subtract(this->Mesh.Points[facet[(k + 2) % 3]], p);
      if (Dot(a, b) > bound * std::sqrt(Dot(a, a) * Dot(b, b)))
      {
        return false;
      }
    }
    return true;
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

  void DropBackground()
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
  }

  SimplexMesh<3>& Mesh;
  const Neighbourhood Near;
  const double FacetCosine;
  const double JunctionCosine;
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
    mender.Finish();
    counts.Left = FindNonManifoldEdges(mesh);
    counts.After = counts.Left.size();
  }
  return counts;
}

} // namespace voxplex
