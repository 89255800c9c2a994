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
#include <tuple>
#include <type_traits>
#include <utility>
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

/** The new number of each old one; None if it is not in use. */
Numbers Inverse(const Numbers& order, std::uint32_t end, unsigned threads)
{
  Numbers inverse(end);
  ForAll(inverse.size(), threads, [&](std::size_t i) { inverse[i] = None; });
  ForAll(order.size(), threads,
    [&](std::size_t i) { inverse[order[i]] = static_cast<std::uint32_t>(i); });
  return inverse;
}

/**
 * Moves element order[i] of some arrays to place i, within the arrays, block by block: what is in the way
 * of a block moves to where the elements of the block have been. On average each element is once in the
 * way.
 * @param places the order; of no use afterwards
 * @param targets its inverse; of no use afterwards
 */
template <typename... Arrays>
void Permute(Numbers& places, Numbers& targets, unsigned threads, Arrays&... arrays)
{
  constexpr std::size_t ElementsOfBlock = std::size_t{ 1 } << 16;
  const std::size_t most = std::min(places.size(), ElementsOfBlock);
  std::tuple<std::vector<std::remove_reference_t<decltype(arrays[0])>>...> block{
    std::vector<std::remove_reference_t<decltype(arrays[0])>>(most)...
  };
  Numbers from(most);
  Numbers to(most);
  const auto forArrays = [&](const auto& function)
  { std::apply([&](auto&... parts) { (function(arrays, parts), ...); }, block); };
  for (std::size_t begin = 0; begin < places.size(); begin += most)
  {
    const std::size_t end = std::min(begin + most, places.size());
    std::size_t inTheWay = 0;
    std::size_t left = 0; // places that elements of the block leave: as many, or more
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i)
    {
      if (targets[i] != None && targets[i] >= end)
      {
        from[inTheWay++] = i;
      }
      if (places[i] >= end)
      {
        to[left++] = places[i];
      }
    }
    ForAll(end - begin, threads,
      [&](std::size_t k)
      { forArrays([&](auto& array, auto& part) { part[k] = array[places[begin + k]]; }); });
    ForAll(inTheWay, threads,
      [&](std::size_t k)
      {
        forArrays([&](auto& array, auto&) { array[to[k]] = array[from[k]]; });
        places[targets[from[k]]] = to[k];
        targets[to[k]] = targets[from[k]];
      });
    for (std::size_t k = inTheWay; k < left; ++k)
    {
      targets[to[k]] = None;
    }
    ForAll(end - begin, threads,
      [&](std::size_t k)
      {
        forArrays(
          [&](auto& array, auto& part) { array[static_cast<std::uint32_t>(begin + k)] = part[k]; });
      });
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void Triangulation<D>::Renumber(unsigned threads)
{
  Numbers vertices = OrderVertices(*this, threads);
  Numbers newVertices = Inverse(vertices, this->VertexIdEnd(), threads);
  Numbers simplices = OrderSimplices(*this, newVertices, vertices.size(), threads);
  Numbers newSimplices = Inverse(simplices, this->SimplexIdEnd(), threads);
  const auto vertexEnd = static_cast<VertexId>(vertices.size());
  const auto simplexEnd = static_cast<SimplexId>(simplices.size());

  ForAll(newSimplices.size(), threads,
    [&](std::size_t i)
    {
      Simplex& simplex = this->Simplices[static_cast<SimplexId>(i)];
      for (unsigned k = 0; k < N && newSimplices[i] != None; ++k)
      {
        simplex.V[k] = newVertices[simplex.V[k]];
        simplex.N[k] = simplex.N[k] == None ? None : newSimplices[simplex.N[k]];
      }
    });
  ForAll(vertices.size(), threads,
    [&](std::size_t i)
    {
      Vertex& vertex = this->Vertices[vertices[i]];
      vertex.Incident = newSimplices[vertex.Incident];
    });
  if (!this->MeshLabels.empty())
  {
    this->MeshLabels.resize(newSimplices.size(), 0);
    UninitialisedVector<LabelId> labels(simplices.size());
    ForAll(
      labels.size(), threads, [&](std::size_t i) { labels[i] = this->MeshLabels[simplices[i]]; });
    this->MeshLabels.swap(labels);
  }
  Permute(vertices, newVertices, threads, this->Vertices);
  Permute(simplices, newSimplices, threads, this->Simplices, this->States, this->Marks);
  this->Vertices.Shrink(vertexEnd);
  this->Simplices.Shrink(simplexEnd);
  this->States.Shrink(simplexEnd);
  this->Marks.Shrink(simplexEnd);
  this->NextVertex.store(vertexEnd, std::memory_order_relaxed);
  this->NextSimplex.store(simplexEnd, std::memory_order_relaxed);
}

template void Triangulation<3>::Renumber(unsigned);
template void Triangulation<4>::Renumber(unsigned);

} // namespace voxplex
