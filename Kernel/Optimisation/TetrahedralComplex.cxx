// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/TetrahedralComplex.h"

#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"
#include "Parallel/SharedCounts.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <type_traits>
#include <utility>

namespace voxplex
{

namespace
{

constexpr std::size_t Grain = 16384;

/** The vertices of facet i, sorted. */
std::array<std::uint32_t, 3> SortedFacet(const TetrahedralComplex::Vertices& v, unsigned i)
{
  std::array<std::uint32_t, 3> f = { v[(i + 1) & 3], v[(i + 2) & 3], v[(i + 3) & 3] };
  if (f[0] > f[1])
  {
    std::swap(f[0], f[1]);
  }
  if (f[1] > f[2])
  {
    std::swap(f[1], f[2]);
  }
  if (f[0] > f[1])
  {
    std::swap(f[0], f[1]);
  }
  return f;
}

/** Raises a number, or None, that other threads may raise, too. */
void Raise(std::uint32_t& number, std::uint32_t to)
{
  // Relaxed: the end of the loop orders it before its readers.
  const std::atomic_ref<std::uint32_t> shared(number);
  std::uint32_t old = shared.load(std::memory_order_relaxed);
  while ((old == TetrahedralComplex::None || old < to) &&
    !shared.compare_exchange_weak(old, to, std::memory_order_relaxed))
  {
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
TetrahedralComplex::TetrahedralComplex(const SimplexMesh<3>& mesh, const ShapeScore& score,
  unsigned threads, const std::stop_token& stop, std::span<const float> scores,
  const SpareRoom& spare)
  : Shape(score)
{
  const std::size_t points = mesh.Points.size();
  const auto fill = [&](auto& of, auto value)
  {
    of.reserve(points + spare.Vertices);
    of.assign(points, value);
  };
  this->Points.reserve(points + spare.Vertices);
  this->Points.assign(mesh.Points.begin(), mesh.Points.end());
  fill(this->Kinds, VertexRole::Free);
  fill(this->Hosts, None);
  fill(this->Degrees, 0u);
  fill(this->Changes, 0u);
  const std::size_t cells = mesh.Simplices.size();
  const auto resize = [&](auto& of)
  {
    of.reserve(cells + spare.Cells);
    of.resize(cells);
  };
  resize(this->Cells);
  resize(this->Labels);
  resize(this->Scores);
  this->FindLabels(mesh, threads, stop);
  this->CopyCells(mesh, threads, stop);
  if (scores.empty())
  {
    this->ScoreCells(threads, stop);
  }
  else
  {
    std::copy(scores.begin(), scores.end(), this->Scores.begin());
  }
  this->Connect(threads, stop);
  this->FindKinds(threads, stop);
}

void TetrahedralComplex::FindLabels(
  const SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop)
{
  const auto sort = [](std::vector<std::int64_t>& values)
  {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
  };
  std::vector<std::int64_t> all;
  std::mutex mutex; // guards `all`
  ParallelFor(
    0, mesh.Labels.size(), Grain, threads,
    [&](std::size_t first, std::size_t end)
    {
      std::vector<std::int64_t> some{ mesh.Labels[first] };
      for (std::size_t t = first + 1; t < end; ++t)
      {
        if (mesh.Labels[t] != mesh.Labels[t - 1])
        {
          some.push_back(mesh.Labels[t]);
        }
      }
      sort(some);
      const std::scoped_lock lock(mutex);
      all.insert(all.end(), some.begin(), some.end());
    },
    stop);
  sort(all);
  this->LabelValues = { 0 };
  this->LabelValues.insert(this->LabelValues.end(), all.begin(), all.end());
}

void TetrahedralComplex::CopyCells(
  const SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop)
{
  const bool isAlone = NumberOfThreads(threads) == 1;
  ParallelFor(
    0, this->Cells.size(), Grain, threads,
    [&](std::size_t first, std::size_t end)
    {
      std::int64_t last = 0;
      Label index = 0;
      for (std::size_t t = first; t < end; ++t)
      {
        this->Cells[t] = { mesh.Simplices[t], { None, None, None, None } };
        if (mesh.Labels[t] != last)
        {
          last = mesh.Labels[t];
          index = static_cast<Label>(
            std::lower_bound(this->LabelValues.begin() + 1, this->LabelValues.end(), last) -
            this->LabelValues.begin());
        }
        this->Labels[t] = index;
        for (const std::uint32_t v : mesh.Simplices[t])
        {
          if (isAlone)
          {
            this->Hosts[v] = static_cast<std::uint32_t>(t);
            ++this->Degrees[v];
          }
          else
          {
            Raise(this->Hosts[v], static_cast<std::uint32_t>(t));
            std::atomic_ref<std::uint32_t>(this->Degrees[v])
              .fetch_add(1, std::memory_order_relaxed);
          }
        }
      }
    },
    stop);
}

void TetrahedralComplex::ScoreCells(unsigned threads, const std::stop_token& stop)
{
  ParallelFor(
    0, this->Cells.size(), Grain, threads,
    [this](std::size_t first, std::size_t end)
    {
      for (std::size_t t = first; t < end; ++t)
      {
        this->Scores[t] = static_cast<float>(this->Score(this->Cells[t].V));
      }
    },
    stop);
}

void TetrahedralComplex::AddCells(std::size_t number)
{
  const std::size_t old = this->Cells.size();
  this->Cells.resize(old + number);
  this->Labels.resize(old + number);
  this->Scores.resize(old + number);
  this->AreHolders.resize(this->AreHolders.empty() ? 0 : old + number);
  for (std::size_t t = old; t < this->Cells.size(); ++t)
  {
    this->Cells[t].V[0] = None;
    this->Scores[t] = 1.0f;
  }
}

void TetrahedralComplex::AddVertices(std::size_t number)
{
  const std::size_t size = this->Points.size() + number;
  this->Points.resize(size);
  this->Kinds.resize(size, VertexRole::Free);
  this->BorderFaces.resize(this->BorderFaces.empty() ? 0 : size, 0);
  this->Hosts.resize(size, None);
  this->Degrees.resize(size, 0);
  this->Changes.resize(size, 0);
}

/**
 * Facets are listed at their smallest vertex. Two facets of a list are the same if their other
 * vertices are equal.
 */
void TetrahedralComplex::Connect(unsigned threads, const std::stop_token& stop)
{
  const std::size_t points = this->Points.size();
  SharedCounts places(points, threads, stop);
  const auto forEachFacet = [&](auto&& visit)
  {
    ParallelFor(
      0, this->Cells.size(), Grain, threads,
      [&](std::size_t first, std::size_t end)
      {
        for (auto t = static_cast<std::uint32_t>(first); t < end; ++t)
        {
          for (unsigned i = 0; i < 4; ++i)
          {
            visit(SortedFacet(this->Cells[t].V, i)[0], 4 * t + i);
          }
        }
      },
      stop);
  };
  forEachFacet([&](std::uint32_t smallest, std::uint32_t) { places.Add(smallest); });
  UninitialisedVector<std::uint32_t> facets(places.TurnIntoPlaces()); // 4 cell + index
  forEachFacet(
    [&](std::uint32_t smallest, std::uint32_t facet) { facets[places.Next(smallest)] = facet; });
  ParallelFor(
    0, points, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      std::vector<std::uint64_t> others; // of each facet of a list, the larger one in the high half
      for (std::size_t v = first; v < last; ++v)
      {
        const std::uint32_t* const list = facets.data() + places.BeginOf(v);
        others.resize(places.EndOf(v) - places.BeginOf(v));
        for (std::size_t i = 0; i < others.size(); ++i)
        {
          const auto f = SortedFacet(this->Cells[list[i] / 4].V, list[i] % 4);
          others[i] = (std::uint64_t{ f[2] } << 32) | f[1];
          const auto same =
            std::find(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(i), others[i]);
          const auto j = static_cast<std::size_t>(same - others.begin());
          if (j != i)
          {
            this->Cells[list[i] / 4].N[list[i] % 4] = list[j] / 4;
            this->Cells[list[j] / 4].N[list[j] % 4] = list[i] / 4;
          }
        }
      }
    },
    stop);
}

/**
 * If all interface facets of a vertex separate the same two labels, it is on a surface of two
 * labels.
 */
void TetrahedralComplex::FindKinds(unsigned threads, const std::stop_token& stop)
{
  constexpr std::uint64_t NoPair = 0;
  std::vector<std::uint64_t> sides(this->Points.size(), NoPair);
  // Relaxed: a vertex gets one of its pairs first, and differs from it for the rest, whatever the
  // order. The end of the loop orders this before its readers.
  const auto note = [&](std::uint32_t v, std::uint64_t pair)
  {
    const std::atomic_ref<std::uint64_t> own(sides[v]);
    std::uint64_t known = own.load(std::memory_order_relaxed);
    if (known == NoPair && own.compare_exchange_strong(known, pair, std::memory_order_relaxed))
    {
      return;
    }
    if (known != pair)
    {
      std::atomic_ref<VertexRole>(this->Kinds[v])
        .store(VertexRole::Fixed, std::memory_order_relaxed);
    }
  };
  ParallelFor(
    0, this->Cells.size(), Grain, threads,
    [&](std::size_t first, std::size_t end)
    {
      for (std::size_t t = first; t < end; ++t)
      {
        for (unsigned i = 0; i < 4; ++i)
        {
          const Label beside = this->LabelOf(this->Cells[t].N[i]);
          if (this->Labels[t] <= beside) // no interface, or counted from the other side
          {
            continue;
          }
          for (unsigned k = 1; k < 4; ++k)
          {
            note(this->Cells[t].V[(i + k) & 3], (std::uint64_t{ this->Labels[t] } << 32) | beside);
          }
        }
      }
    },
    stop);
  for (std::size_t v = 0; v < sides.size(); ++v)
  {
    if (sides[v] != NoPair && this->Kinds[v] == VertexRole::Free)
    {
      this->Kinds[v] = VertexRole::Surface;
    }
  }
}

//------------------------------------------------------------------------------------------------
/**
 * A vertex is on an edge of a face if it lies on the face, but some of its triangles towards
 * background do not.
 */
void TetrahedralComplex::FindBorderFaces(const Domain<3>& domain)
{
  const ImageBorder<3>* const border = domain.Border();
  if (!border)
  {
    return;
  }
  this->BorderFaces.assign(this->Points.size(), 0);
  for (std::size_t v = 0; v < this->Points.size(); ++v)
  {
    if (this->Kinds[v] != VertexRole::Free)
    {
      this->BorderFaces[v] = static_cast<std::uint8_t>(border->FacesAt(this->Points[v]));
    }
  }
  for (const Tetrahedron& cell : this->Cells)
  {
    for (unsigned i = 0; i < 4; ++i)
    {
      if (cell.N[i] != None)
      {
        continue;
      }
      const std::array<std::uint32_t, 3> f = SortedFacet(cell.V, i);
      const unsigned common =
        this->BorderFaces[f[0]] & this->BorderFaces[f[1]] & this->BorderFaces[f[2]];
      for (const std::uint32_t v : f)
      {
        if (this->BorderFaces[v] != common && this->Kinds[v] == VertexRole::Surface)
        {
          this->Kinds[v] = VertexRole::Crease;
        }
      }
    }
  }
}

//------------------------------------------------------------------------------------------------
/** Writes the points that tetrahedra use. @return the number of each vertex in the mesh */
UninitialisedVector<std::uint32_t> TetrahedralComplex::WritePoints(
  SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop) const
{
  UninitialisedVector<std::uint32_t> numbers(this->Points.size());
  ChunkCounts counts(numbers.size());
  const auto forChunks = [&](auto&& function)
  { ParallelFor(0, numbers.size(), ChunkCounts::Grain, threads, function, stop); };
  forChunks(
    [&](std::size_t first, std::size_t end)
    {
      counts.OfChunk(first) = static_cast<std::size_t>(
        std::count_if(this->Degrees.begin() + static_cast<std::ptrdiff_t>(first),
          this->Degrees.begin() + static_cast<std::ptrdiff_t>(end),
          [](std::uint32_t degree) { return degree != 0; }));
    });
  mesh.Points.resize(counts.TurnIntoPlaces());
  forChunks(
    [&](std::size_t first, std::size_t end)
    {
      std::size_t place = counts.OfChunk(first);
      for (std::size_t v = first; v < end; ++v)
      {
        numbers[v] = None;
        if (this->Degrees[v] != 0)
        {
          numbers[v] = static_cast<std::uint32_t>(place);
          mesh.Points[place++] = this->Points[v];
        }
      }
    });
  return numbers;
}

void TetrahedralComplex::Write(SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop)
{
  const auto release = [](auto&... arrays)
  { ((arrays = std::remove_reference_t<decltype(arrays)>()), ...); }; // {} would keep the memory
  mesh = SimplexMesh<3>();
  release(this->Scores, this->Kinds, this->BorderFaces, this->Hosts, this->Changes);
  const UninitialisedVector<std::uint32_t> numbers = this->WritePoints(mesh, threads, stop);
  release(this->Points, this->Degrees);

  ChunkCounts cells(this->Cells.size());
  ChunkCounts facets(this->Cells.size());
  const auto forChunks = [&](auto&& function)
  { ParallelFor(0, this->Cells.size(), ChunkCounts::Grain, threads, function, stop); };
  const auto forAlive = [this](std::size_t first, std::size_t end, auto&& function)
  {
    for (auto t = static_cast<std::uint32_t>(first); t < end; ++t)
    {
      if (this->IsAlive(t))
      {
        function(t);
      }
    }
  };
  const auto isInterface = [this](std::uint32_t t, unsigned i)
  { return this->LabelOf(this->Cells[t].N[i]) < this->Labels[t]; };
  forChunks(
    [&](std::size_t first, std::size_t end)
    {
      // Not in the counts themselves: those of several chunks share a cache line.
      std::size_t alive = 0;
      std::size_t interfaces = 0;
      forAlive(first, end,
        [&](std::uint32_t t)
        {
          ++alive;
          for (unsigned i = 0; i < 4; ++i)
          {
            interfaces += isInterface(t, i) ? 1 : 0;
          }
        });
      cells.OfChunk(first) = alive;
      facets.OfChunk(first) = interfaces;
    });
  const std::size_t tetrahedra = cells.TurnIntoPlaces();
  mesh.Labels.resize(tetrahedra);
  mesh.Facets.resize(facets.TurnIntoPlaces());
  mesh.FacetLabels.resize(mesh.Facets.size());
  // Facet i of a positively oriented tetrahedron, its normal outwards.
  constexpr unsigned outward[4][3] = { { 1, 2, 3 }, { 2, 0, 3 }, { 0, 1, 3 }, { 1, 0, 2 } };
  forChunks(
    [&](std::size_t first, std::size_t end)
    {
      std::size_t cell = cells.OfChunk(first);
      std::size_t facet = facets.OfChunk(first);
      forAlive(first, end,
        [&](std::uint32_t t)
        {
          const std::int64_t label = this->LabelValues[this->Labels[t]];
          mesh.Labels[cell++] = label;
          const Vertices& v = this->Cells[t].V;
          for (unsigned i = 0; i < 4; ++i)
          {
            if (isInterface(t, i))
            {
              mesh.Facets[facet] = { numbers[v[outward[i][0]]], numbers[v[outward[i][1]]],
                numbers[v[outward[i][2]]] };
              mesh.FacetLabels[facet] = { label,
                this->LabelValues[this->LabelOf(this->Cells[t].N[i])] };
              ++facet;
            }
          }
        });
    });
  release(this->Labels);
  mesh.Simplices.resize(tetrahedra);
  forChunks(
    [&](std::size_t first, std::size_t end)
    {
      std::size_t cell = cells.OfChunk(first);
      forAlive(first, end,
        [&](std::uint32_t t)
        {
          const Vertices& v = this->Cells[t].V;
          mesh.Simplices[cell++] = { numbers[v[0]], numbers[v[1]], numbers[v[2]], numbers[v[3]] };
        });
    });
  release(this->Cells);
}

} // namespace voxplex
