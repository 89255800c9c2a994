// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/InterfaceEdges.h"

#include <algorithm>
#include <span>

namespace voxplex
{

namespace
{

/** An edge in the list of its smaller end, and a facet that has it. */
struct Use
{
  std::uint32_t High;
  std::uint32_t Facet;
};

/** The edges of all facets, by their smaller end; in each list those with the same other end follow each other. */
class EdgeLists
{
public:
  explicit EdgeLists(const SimplexMesh<3>& mesh)
    : Begins(mesh.Points.size() + 1, 0)
    , Uses(3 * mesh.Facets.size())
  {
    const auto forEach = [&](auto&& function)
    {
      for (std::uint32_t f = 0; f < mesh.Facets.size(); ++f)
      {
        const auto& v = mesh.Facets[f];
        for (unsigned i = 0; i < 3; ++i)
        {
          const std::uint32_t next = v[(i + 1) % 3];
          function(std::min(v[i], next), std::max(v[i], next), f);
        }
      }
    };
    forEach([&](std::uint32_t low, std::uint32_t, std::uint32_t) { ++this->Begins[low + 1]; });
    for (std::size_t v = 1; v < this->Begins.size(); ++v)
    {
      this->Begins[v] += this->Begins[v - 1];
    }
    std::vector<std::uint32_t> ends(this->Begins.begin(), this->Begins.end() - 1);
    forEach(
      [&](std::uint32_t low, std::uint32_t high, std::uint32_t f) {
        this->Uses[ends[low]++] = { high, f };
      });
    for (std::size_t v = 0; v + 1 < this->Begins.size(); ++v)
    {
      std::sort(this->Uses.begin() + this->Begins[v], this->Uses.begin() + this->Begins[v + 1],
        [](const Use& a, const Use& b)
        { return a.High < b.High || (a.High == b.High && a.Facet < b.Facet); });
    }
  }

  /** Calls function(low, uses of one edge) for all edges in the order of their ends. */
  template <typename Function>
  void ForEachEdge(Function&& function) const
  {
    for (std::uint32_t low = 0; low + 1 < this->Begins.size(); ++low)
    {
      for (std::uint32_t first = this->Begins[low], last = first; first < this->Begins[low + 1];
           first = last)
      {
        while (last < this->Begins[low + 1] && this->Uses[last].High == this->Uses[first].High)
        {
          ++last;
        }
        function(low, std::span<const Use>(this->Uses.data() + first, last - first));
      }
    }
  }

private:
  std::vector<std::uint32_t> Begins;
  std::vector<Use> Uses;
};

} // namespace

std::vector<InterfaceEdge> FindNonManifoldEdges(const SimplexMesh<3>& mesh)
{
  std::vector<InterfaceEdge> edges;
  std::vector<std::int64_t> labels;
  const auto look = [&](std::uint32_t low, std::span<const Use> uses)
  {
    if (uses.size() == 2)
    {
      return;
    }
    labels.clear();
    for (const Use& use : uses)
    {
      const auto& sides = mesh.FacetLabels[use.Facet];
      labels.insert(labels.end(), sides.begin(), sides.end());
    }
    std::sort(labels.begin(), labels.end());
    unsigned distinct = 0;
    bool isManifold = true;
    for (std::size_t begin = 0, end = 0; begin < labels.size(); begin = end)
    {
      while (end < labels.size() && labels[end] == labels[begin])
      {
        ++end;
      }
      ++distinct;
      isManifold &= labels[begin] == 0 || end - begin == 2;
    }
    if (!isManifold)
    {
      edges.push_back({ { low, uses.front().High }, distinct > 2 });
    }
  };
  EdgeLists(mesh).ForEachEdge(look);
  return edges;
}

} // namespace voxplex
