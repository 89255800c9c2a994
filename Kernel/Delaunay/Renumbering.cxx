// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// New numbers for all records, from the points alone.
#include "Delaunay/Triangulation.h"

#include "Geometry/HilbertOrder.h"
#include "Parallel/ParallelFor.h"
#include "Parallel/ParallelSort.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <utility>
#include <vector>

namespace voxplex
{

namespace
{

constexpr std::size_t Grain = 8192;

struct Keyed
{
  std::uint64_t Key;
  std::uint32_t Id;
};

/** Calls function(i) for all i below n, in several threads. */
template <typename Function>
void ForAll(std::size_t n, unsigned threads, Function&& function)
{
  ParallelFor(0, n, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        function(i);
      }
    });
}

/**
 * Sorts by the upper bits of the key in linear time, then the records that have them in common by
 * `less`.
 * @param first the number of the lowest bit that is sorted in linear time
 * @param last all keys are below 2^last
 */
template <typename Less>
void Sort(std::vector<Keyed>& records, unsigned first, unsigned last, unsigned threads, Less&& less)
{
  std::vector<Keyed> scratch(records.size());
  const std::span<Keyed> sorted = ParallelRadixSort<Keyed>(
    records, scratch, last - first, [first](const Keyed& k) { return k.Key >> first; }, threads);
  std::vector<std::uint8_t> begins(sorted.size() + 1, 1); // whether a group begins
  ForAll(sorted.size(), threads,
    [&](std::size_t i)
    { begins[i] = i == 0 || sorted[i].Key >> first != sorted[i - 1].Key >> first ? 1 : 0; });
  ForAll(sorted.size(), threads,
    [&](std::size_t i)
    {
      if (begins[i] != 0)
      {
        const auto end =
          std::find(begins.begin() + static_cast<std::ptrdiff_t>(i) + 1, begins.end(), 1);
        std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(i),
          sorted.begin() + (end - begins.begin()), less);
      }
    });
  if (sorted.data() == scratch.data())
  {
    records.swap(scratch);
  }
}

/** The old number of each new one: first the sorted records, then all that are not in use. */
std::vector<std::uint32_t> OldNumbers(const std::vector<Keyed>& sorted, std::uint32_t end)
{
  std::vector<std::uint32_t> old;
  old.reserve(end);
  std::vector<bool> isUsed(end);
  for (const Keyed& record : sorted)
  {
    old.push_back(record.Id);
    isUsed[record.Id] = true;
  }
  for (std::uint32_t id = 0; id < end; ++id)
  {
    if (!isUsed[id])
    {
      old.push_back(id);
    }
  }
  return old;
}

std::vector<std::uint32_t> Inverse(const std::vector<std::uint32_t>& old, unsigned threads)
{
  std::vector<std::uint32_t> inverse(old.size());
  ForAll(
    old.size(), threads, [&](std::size_t i) { inverse[old[i]] = static_cast<std::uint32_t>(i); });
  return inverse;
}

/**
 * Moves record old[i] to i, for all i, cycle by cycle. Needs no second array.
 */
template <typename Record, unsigned ChunkBits>
void Permute(ChunkedArray<Record, ChunkBits>& records, std::vector<std::uint32_t> old)
{
  for (std::uint32_t first = 0; first < old.size(); ++first)
  {
    if (old[first] == first)
    {
      continue;
    }
    const Record kept = records[first];
    std::uint32_t to = first;
    for (std::uint32_t from = old[to]; from != first; from = old[to])
    {
      __builtin_prefetch(&records[old[from]]);
      records[to] = records[from];
      old[to] = to;
      to = from;
    }
    records[to] = kept;
    old[to] = to;
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void Triangulation<D>::Renumber(unsigned threads)
{
  std::vector<Keyed> vertices;
  for (VertexId v = 0; v < this->VertexIdEnd(); ++v)
  {
    if (this->Vertices[v].Alive)
    {
      vertices.push_back({ 0, v });
    }
  }
  ForAll(vertices.size(), threads,
    [&](std::size_t i)
    { vertices[i].Key = HilbertIndex<D>(this->Position(vertices[i].Id), this->Domain); });
  Sort(vertices, 0, 63, threads,
    [this](const Keyed& a, const Keyed& b) { return this->Position(a.Id) < this->Position(b.Id); });
  const std::vector<VertexId> oldVertices = OldNumbers(vertices, this->VertexIdEnd());
  const std::vector<VertexId> newVertices = Inverse(oldVertices, threads);

  std::vector<Keyed> simplices;
  std::uint32_t latest = 0;
  for (SimplexId s = 0; s < this->SimplexIdEnd(); ++s)
  {
    latest = std::max(latest, this->States[s].Generation);
    if (this->IsAlive(s))
    {
      simplices.push_back({ 0, s });
    }
  }
  const auto newVerticesOf = [&](SimplexId s) // ascending
  {
    std::array<VertexId, N> v = this->Simplices[s].V;
    for (VertexId& w : v)
    {
      w = newVertices[w];
    }
    std::sort(v.begin(), v.end());
    return v;
  };
  ForAll(simplices.size(), threads,
    [&](std::size_t i)
    {
      const std::array<VertexId, N> v = newVerticesOf(simplices[i].Id);
      simplices[i].Key = std::uint64_t{ v[0] } << 32 | v[1];
    });
  Sort(simplices, 32, 32 + static_cast<unsigned>(std::bit_width(vertices.size())), threads,
    [&](const Keyed& a, const Keyed& b)
    { return a.Key != b.Key ? a.Key < b.Key : newVerticesOf(a.Id) < newVerticesOf(b.Id); });
  const std::vector<SimplexId> oldSimplices = OldNumbers(simplices, this->SimplexIdEnd());
  const std::vector<SimplexId> newSimplices = Inverse(oldSimplices, threads);

  ForAll(simplices.size(), threads,
    [&](std::size_t i)
    {
      Simplex& simplex = this->Simplices[simplices[i].Id];
      for (unsigned k = 0; k < N; ++k)
      {
        simplex.V[k] = newVertices[simplex.V[k]];
        simplex.N[k] = simplex.N[k] == None ? None : newSimplices[simplex.N[k]];
      }
      // No simplex has a generation that a caller may have seen at its new number.
      this->States[simplices[i].Id].Generation = latest + 1;
    });
  ForAll(vertices.size(), threads,
    [&](std::size_t i)
    {
      Vertex& vertex = this->Vertices[vertices[i].Id];
      vertex.Incident = newSimplices[vertex.Incident];
    });
  const std::array<std::function<void()>, 4> moves = {
    [&] { Permute(this->Simplices, oldSimplices); },
    [&] { Permute(this->States, oldSimplices); },
    [&] { Permute(this->Marks, oldSimplices); },
    [&] { Permute(this->Vertices, oldVertices); },
  };
  ParallelFor(0, moves.size(), 1, threads, [&](std::size_t i, std::size_t) { moves[i](); });
  this->NextVertex.store(static_cast<VertexId>(vertices.size()), std::memory_order_relaxed);
  this->NextSimplex.store(static_cast<SimplexId>(simplices.size()), std::memory_order_relaxed);
}

template void Triangulation<3>::Renumber(unsigned);
template void Triangulation<4>::Renumber(unsigned);

} // namespace voxplex
