// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// New numbers for all records, from the points alone.
#include "Delaunay/Triangulation.h"

#include "Base/UninitialisedVector.h"
#include "Geometry/HilbertOrder.h"
#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"
#include "Parallel/ParallelSort.h"
#include "Parallel/SharedCounts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxplex
{

namespace
{

using Numbers = UninitialisedVector<std::uint32_t>;

/** Calls function(i) for all i below n, in several threads. */
template <typename Function>
void ForAll(std::size_t n, unsigned threads, Function&& function)
{
  ParallelFor(0, n, ChunkCounts::Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        function(i);
      }
    });
}

/** The vertices along a Hilbert curve; those at the same place of the curve, by their coordinates. */
template <int D>
Numbers OrderVertices(const Triangulation<D>& triangulation, unsigned threads)
{
  struct Ranked
  {
    std::uint64_t Key;
    VertexId Id;
  };
  std::vector<Ranked> all;
  all.reserve(triangulation.VertexIdEnd());
  for (VertexId v = 0; v < triangulation.VertexIdEnd(); ++v)
  {
    if (triangulation.GetVertex(v).Alive)
    {
      all.push_back({ 0, v });
    }
  }
  ForAll(all.size(), threads,
    [&](std::size_t i)
    { all[i].Key = HilbertIndex<D>(triangulation.Position(all[i].Id), triangulation.GetBox()); });
  std::vector<Ranked> scratch(all.size());
  const std::span<Ranked> sorted = ParallelRadixSort<Ranked>(
    all, scratch, 63, [](const Ranked& ranked) { return ranked.Key; }, threads);

  for (auto begin = sorted.begin(); begin != sorted.end();)
  {
    const auto end = std::find_if(
      begin, sorted.end(), [begin](const Ranked& ranked) { return ranked.Key != begin->Key; });
    std::sort(begin, end,
      [&](const Ranked& a, const Ranked& b)
      { return triangulation.Position(a.Id) < triangulation.Position(b.Id); });
    begin = end;
  }
  Numbers order(sorted.size());
  ForAll(order.size(), threads, [&](std::size_t i) { order[i] = sorted[i].Id; });
  return order;
}

/**
 * The simplices by their smallest vertex. Those with the same one are ordered by their other
 * vertices.
 */
template <int D>
Numbers OrderSimplices(const Triangulation<D>& triangulation, const Numbers& newVertices,
  std::size_t vertices, unsigned threads)
{
  using Vertices = std::array<VertexId, static_cast<std::size_t>(D + 1)>;
  const auto verticesOf = [&](SimplexId s) // ascending
  {
    Vertices v = triangulation.GetSimplex(s).V;
    std::transform(v.begin(), v.end(), v.begin(), [&](VertexId old) { return newVertices[old]; });
    std::sort(v.begin(), v.end());
    return v;
  };
  struct Ranked
  {
    std::uint64_t Key; ///< differs between nearly all simplices with the same smallest vertex
    SimplexId Id;
  };
  const std::size_t ids = triangulation.SimplexIdEnd();
  Numbers smallest(ids);
  SharedCounts lists(vertices, threads, {});
  ForAll(ids, threads,
    [&](std::size_t i)
    {
      const auto s = static_cast<SimplexId>(i);
      if (triangulation.IsAlive(s))
      {
        const auto& v = triangulation.GetSimplex(s).V;
        smallest[s] = newVertices[v[0]];
        for (const VertexId old : v)
        {
          smallest[s] = std::min(smallest[s], newVertices[old]);
        }
        lists.Add(smallest[s]);
      }
    });
  UninitialisedVector<Ranked> sorted(lists.TurnIntoPlaces());
  ForAll(ids, threads,
    [&](std::size_t i)
    {
      const auto s = static_cast<SimplexId>(i);
      if (triangulation.IsAlive(s))
      {
        const auto& v = triangulation.GetSimplex(s).V;
        std::uint32_t largest = 0;
        std::uint32_t sum = 0;
        for (const VertexId old : v)
        {
          largest = std::max(largest, newVertices[old]);
          sum += newVertices[old];
        }
        sorted[lists.Next(smallest[s])] = { std::uint64_t{ largest } << 32 | sum, s };
      }
    });
  Numbers order(sorted.size());
  ForAll(vertices, threads,
    [&](std::size_t v)
    {
      std::sort(sorted.data() + lists.BeginOf(v), sorted.data() + lists.EndOf(v),
        [&](const Ranked& a, const Ranked& b)
        { return a.Key != b.Key ? a.Key < b.Key : verticesOf(a.Id) < verticesOf(b.Id); });
      for (std::uint32_t i = lists.BeginOf(v); i < lists.EndOf(v); ++i)
      {
        order[i] = sorted[i].Id;
      }
    });
  return order;
}

/** The new number of each old one that is in use. */
Numbers Inverse(const Numbers& order, std::uint32_t end, unsigned threads)
{
  Numbers inverse(end);
  ForAll(order.size(), threads,
    [&](std::size_t i) { inverse[order[i]] = static_cast<std::uint32_t>(i); });
  return inverse;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void Triangulation<D>::Renumber(unsigned threads)
{
  const Numbers vertices = OrderVertices(*this, threads);
  const Numbers newVertices = Inverse(vertices, this->VertexIdEnd(), threads);
  const Numbers simplices = OrderSimplices(*this, newVertices, vertices.size(), threads);
  const Numbers newSimplices = Inverse(simplices, this->SimplexIdEnd(), threads);

  this->Vertices.Reorder(vertices, threads);
  this->Simplices.Reorder(simplices, threads);
  this->States.Reorder(simplices, threads);
  this->Marks.Reorder(simplices, threads);
  if (!this->MeshLabels.empty())
  {
    this->MeshLabels.resize(this->SimplexIdEnd(), 0);
    UninitialisedVector<LabelId> labels(simplices.size());
    ForAll(
      labels.size(), threads, [&](std::size_t i) { labels[i] = this->MeshLabels[simplices[i]]; });
    this->MeshLabels.swap(labels);
  }
  this->NextVertex.store(static_cast<VertexId>(vertices.size()), std::memory_order_relaxed);
  this->NextSimplex.store(static_cast<SimplexId>(simplices.size()), std::memory_order_relaxed);

  ForAll(simplices.size(), threads,
    [&](std::size_t i)
    {
      Simplex& simplex = this->Simplices[static_cast<SimplexId>(i)];
      for (unsigned k = 0; k < N; ++k)
      {
        simplex.V[k] = newVertices[simplex.V[k]];
        simplex.N[k] = simplex.N[k] == None ? None : newSimplices[simplex.N[k]];
      }
    });
  ForAll(vertices.size(), threads,
    [&](std::size_t i)
    {
      Vertex& vertex = this->Vertices[static_cast<VertexId>(i)];
      vertex.Incident = newSimplices[vertex.Incident];
    });
}

template void Triangulation<3>::Renumber(unsigned);
template void Triangulation<4>::Renumber(unsigned);

} // namespace voxplex
