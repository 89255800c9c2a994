// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The union of triangulations of boxes that have faces in common.
#include "Delaunay/Triangulation.h"

#include <algorithm>
#include <map>
#include <new>
#include <stdexcept>
#include <vector>

namespace voxplex
{

namespace
{

/** A facet of a simplex on a common face. */
template <int D>
struct OpenFacet
{
  std::array<VertexId, static_cast<std::size_t>(D)> V; ///< ascending
  SimplexId Of;
  unsigned Number;

  bool operator<(const OpenFacet& other) const { return this->V < other.V; }
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void Triangulation<D>::Join(std::span<const Triangulation* const> parts)
{
  constexpr std::size_t Time = static_cast<std::size_t>(D) - 1;
  std::uint64_t vertices = this->VertexIdEnd();
  std::uint64_t simplices = this->SimplexIdEnd();
  std::uint64_t newVertices = 0;
  std::uint64_t newSimplices = 0;
  for (const Triangulation* part : parts)
  {
    newVertices += part->VertexIdEnd();
    newSimplices += part->SimplexIdEnd();
  }
  vertices = std::max(vertices, newVertices);
  simplices = std::max(simplices, newSimplices);
  if (vertices >= None || simplices >= None)
  {
    throw std::bad_alloc();
  }
  this->Vertices.Grow(static_cast<std::uint32_t>(vertices));
  this->Simplices.Grow(static_cast<std::uint32_t>(simplices));
  this->Marks.Grow(static_cast<std::uint32_t>(simplices));
  this->States.Grow(static_cast<std::uint32_t>(simplices));

  this->MeshLabels.clear();
  VertexId nextVertex = 0;
  SimplexId nextSimplex = 0;
  std::map<Point<D>, VertexId> onFace; ///< the vertices of the common face with the next part
  std::vector<OpenFacet<D>> open;      ///< the facets there, sorted
  std::vector<VertexId> vertexOf;
  std::vector<SimplexId> simplexOf;
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    const Triangulation& part = *parts[p];
    const bool isFirst = p == 0;
    const bool isLast = p + 1 == parts.size();
    std::map<Point<D>, VertexId> onNext;
    vertexOf.assign(part.VertexIdEnd(), None);
    for (VertexId v = 0; v < part.VertexIdEnd(); ++v)
    {
      const Vertex& from = part.Vertices[v];
      if (!from.Alive)
      {
        continue;
      }
      if (!isFirst && from.Position[Time] == part.Domain.Min[Time])
      {
        const auto known = onFace.find(from.Position);
        vertexOf[v] = known == onFace.end() ? None : known->second;
      }
      if (vertexOf[v] == None)
      {
        vertexOf[v] = nextVertex++;
        this->Vertices[vertexOf[v]] = from;
        this->Vertices[vertexOf[v]].Owner = 0;
      }
      if (!isLast && from.Position[Time] == part.Domain.Max[Time])
      {
        onNext.emplace(from.Position, vertexOf[v]);
      }
    }
    simplexOf.assign(part.SimplexIdEnd(), None);
    const SimplexId first = nextSimplex;
    for (SimplexId s = 0; s < part.SimplexIdEnd(); ++s)
    {
      simplexOf[s] = part.IsAlive(s) ? nextSimplex++ : None;
    }
    std::vector<OpenFacet<D>> lower;
    std::vector<OpenFacet<D>> upper;
    for (SimplexId s = 0, to = first; s < part.SimplexIdEnd(); ++s)
    {
      if (!part.IsAlive(s))
      {
        continue;
      }
      const Simplex& from = part.Simplices[s];
      Simplex& simplex = this->Simplices[to];
      simplex = from;
      for (unsigned i = 0; i < N; ++i)
      {
        simplex.V[i] = vertexOf[from.V[i]];
        simplex.N[i] = from.N[i] == None ? None : simplexOf[from.N[i]];
        this->Vertices[simplex.V[i]].Incident = to;
      }
      for (unsigned i = 0; i < N; ++i)
      {
        if (from.N[i] != None)
        {
          continue;
        }
        OpenFacet<D> facet{ {}, to, i };
        bool isLower = !isFirst;
        bool isUpper = !isLast;
        for (unsigned k = 0, m = 0; k < N; ++k)
        {
          if (k != i)
          {
            const double time = part.Position(from.V[k])[Time];
            isLower = isLower && time == part.Domain.Min[Time];
            isUpper = isUpper && time == part.Domain.Max[Time];
            facet.V[m++] = simplex.V[k];
          }
        }
        std::sort(facet.V.begin(), facet.V.end());
        if (isLower || isUpper)
        {
          (isLower ? lower : upper).push_back(facet);
        }
      }
      const std::uint32_t generation = this->States[to].Generation + 1;
      this->States[to] = part.States[s];
      this->States[to].Generation = generation;
      this->Marks[to] = SimplexMark::Alive;
      ++to;
    }
    std::sort(lower.begin(), lower.end());
    std::sort(upper.begin(), upper.end());
    bool areSame = lower.size() == open.size();
    for (std::size_t f = 0; f < lower.size() && areSame; ++f)
    {
      areSame = lower[f].V == open[f].V;
      this->Simplices[lower[f].Of].N[lower[f].Number] = open[f].Of;
      this->Simplices[open[f].Of].N[open[f].Number] = lower[f].Of;
    }
    if (!areSame)
    {
      throw std::logic_error("the triangulations on both sides of a common face differ");
    }
    open = std::move(upper);
    onFace = std::move(onNext);
  }
  for (std::uint32_t v = nextVertex; v < vertices; ++v)
  {
    this->Vertices[v].Alive = false;
  }
  for (std::uint32_t s = nextSimplex; s < simplices; ++s)
  {
    this->Marks[s] = SimplexMark::Unused;
    ++this->States[s].Generation;
  }
  this->NextVertex.store(static_cast<VertexId>(vertices), std::memory_order_relaxed);
  this->NextSimplex.store(static_cast<SimplexId>(simplices), std::memory_order_relaxed);
}

template void Triangulation<3>::Join(std::span<const Triangulation* const>);
template void Triangulation<4>::Join(std::span<const Triangulation* const>);

} // namespace voxplex
