// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Complex.h"

#include "Mesh/InterfaceFacets.h"
#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>
#include <utility>

namespace voxplex
{

namespace
{

constexpr std::size_t Grain = 16384;

/** Cells around the mesh keep at least this part of their volume. */
constexpr double VolumeKeptOutside = 0.1;

/** Raises a number, or None, that other threads may raise, too. */
void Raise(std::uint32_t& number, std::uint32_t to)
{
  // Relaxed: the end of the loop orders it before its readers.
  const std::atomic_ref<std::uint32_t> shared(number);
  std::uint32_t old = shared.load(std::memory_order_relaxed);
  while (
    (old == None || old < to) && !shared.compare_exchange_weak(old, to, std::memory_order_relaxed))
  {
  }
}

/** Marks of what a complex takes. What has none is left out. */
constexpr std::uint32_t OfObject = 0;
constexpr std::uint32_t AroundIt = 1;

/** Replaces the marks by numbers, those of the object first. @return the number of marks */
std::size_t TurnIntoNumbers(
  UninitialisedVector<std::uint32_t>& marks, unsigned threads, const std::stop_token& stop)
{
  std::array<ChunkCounts, 2> counts{ ChunkCounts(marks.size()), ChunkCounts(marks.size()) };
  ParallelFor(
    0, marks.size(), ChunkCounts::Grain, threads,
    [&](std::size_t first, std::size_t end)
    {
      std::array<std::size_t, 2> found{}; // counts of several chunks share a cache line
      for (std::size_t k = first; k < end; ++k)
      {
        found[OfObject] += marks[k] == OfObject ? 1 : 0;
        found[AroundIt] += marks[k] == AroundIt ? 1 : 0;
      }
      counts[OfObject].OfChunk(first) = found[OfObject];
      counts[AroundIt].OfChunk(first) = found[AroundIt];
    },
    stop);
  const std::size_t ofObject = counts[OfObject].TurnIntoPlaces();
  const std::size_t all = ofObject + counts[AroundIt].TurnIntoPlaces();
  ParallelFor(
    0, marks.size(), ChunkCounts::Grain, threads,
    [&](std::size_t first, std::size_t end)
    {
      std::array<std::size_t, 2> next{ counts[OfObject].OfChunk(first),
        ofObject + counts[AroundIt].OfChunk(first) };
      for (std::size_t k = first; k < end; ++k)
      {
        if (marks[k] != None)
        {
          marks[k] = static_cast<std::uint32_t>(next[marks[k]]++);
        }
      }
    },
    stop);
  return all;
}

//------------------------------------------------------------------------------------------------
/** What a complex is made from: a triangulation. */
template <int D>
struct LabelledSimplices
{
  const Triangulation<D>& Mesh;
  std::span<const LabelId> Labels;
  std::span<const std::array<VertexId, 2>> Twins;

  std::size_t NumberOfCells() const { return this->Labels.size(); }
  std::size_t NumberOfVertices() const { return this->Mesh.VertexIdEnd(); }
  bool IsAlive(std::uint32_t t) const { return this->Mesh.IsAlive(t); }
  LabelId LabelOf(std::uint32_t t) const { return this->Labels[t]; }
  const auto& CellAt(std::uint32_t t) const { return this->Mesh.GetSimplex(t); }
  const Point<D>& Position(std::uint32_t v) const { return this->Mesh.Position(v); }
};

/** What a complex is made from: another one. */
template <int D>
struct OldComplex
{
  Complex<D> Old;
  std::vector<std::array<VertexId, 2>> Twins;

  std::size_t NumberOfCells() const { return this->Old.Cells.size(); }
  std::size_t NumberOfVertices() const { return this->Old.Points.size(); }
  bool IsAlive(std::uint32_t t) const { return this->Old.IsAlive(t); }
  LabelId LabelOf(std::uint32_t t) const { return this->IsAlive(t) ? this->Old.Labels[t] : 0; }
  const auto& CellAt(std::uint32_t t) const { return this->Old.Cells[t]; }
  const Point<D>& Position(std::uint32_t v) const { return this->Old.Points[v]; }
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
Complex<D>::Complex(const Triangulation<D>& triangulation, std::span<const LabelId> labels,
  std::span<const std::array<VertexId, 2>> twins, UninitialisedVector<std::uint32_t>& numbers,
  unsigned threads, const std::stop_token& stop)
{
  numbers = this->Copy(LabelledSimplices<D>{ triangulation, labels, twins }, true, threads, stop);
}

template <int D>
Complex<D>::Complex(UninitialisedVector<Point<D>> points, UninitialisedVector<Cell> cells,
  UninitialisedVector<Label> labels, unsigned threads, const std::stop_token& stop)
  : Points(std::move(points))
  , Cells(std::move(cells))
  , Labels(std::move(labels))
{
  this->FindHosts(threads, stop);
}

template <int D>
void Complex<D>::Compact(bool keepsOutside, unsigned threads, const std::stop_token& stop)
{
  OldComplex<D> source;
  for (std::uint32_t v = 0; v < this->Twins.size(); ++v)
  {
    if (v < this->Twins[v] && this->Twins[v] != None)
    {
      source.Twins.push_back({ v, this->Twins[v] });
    }
  }
  source.Old = std::exchange(*this, Complex());
  this->Shape = source.Old.Shape;
  this->Goal = source.Old.Goal;
  this->Copy(source, keepsOutside, threads, stop);
}

/** Copies what the complex is to have. @return the number of each vertex of the source, or None */
template <int D>
template <typename Source>
UninitialisedVector<std::uint32_t> Complex<D>::Copy(
  const Source& source, bool withOutside, unsigned threads, const std::stop_token& stop)
{
  const auto forAll = [&](std::size_t number, const auto& function)
  {
    ParallelFor(
      0, number, Grain, threads,
      [&](std::size_t first, std::size_t end)
      {
        for (auto k = static_cast<std::uint32_t>(first); k < end; ++k)
        {
          function(k);
        }
      },
      stop);
  };
  UninitialisedVector<std::uint32_t> vertices(source.NumberOfVertices());
  UninitialisedVector<std::uint32_t> cells(source.NumberOfCells());
  // Relaxed: threads write the same mark, and the end of the loop orders it before its readers. Reading first
  // leaves the cache line with the other threads.
  const auto markOf = [&](std::uint32_t v)
  { return std::atomic_ref<std::uint32_t>(vertices[v]).load(std::memory_order_relaxed); };
  const auto mark = [&](std::uint32_t t, std::uint32_t as)
  {
    cells[t] = as;
    for (const std::uint32_t v : source.CellAt(t).V)
    {
      if (markOf(v) == None)
      {
        std::atomic_ref<std::uint32_t>(vertices[v]).store(as, std::memory_order_relaxed);
      }
    }
  };
  forAll(vertices.size(), [&](std::uint32_t v) { vertices[v] = None; });
  forAll(cells.size(),
    [&](std::uint32_t t)
    {
      cells[t] = None;
      if (source.LabelOf(t) != 0)
      {
        mark(t, OfObject);
      }
    });
  if (withOutside)
  {
    forAll(cells.size(),
      [&](std::uint32_t t)
      {
        if (cells[t] == None && source.IsAlive(t) &&
          std::any_of(source.CellAt(t).V.begin(), source.CellAt(t).V.end(),
            [&](std::uint32_t v) { return markOf(v) == OfObject; }))
        {
          mark(t, AroundIt);
        }
      });
  }
  for (const auto& [first, last] : source.Twins)
  {
    if (vertices[first] == OfObject && vertices[last] == OfObject)
    {
      this->Twins.resize(vertices.size(), None);
      this->Twins[first] = last;
      this->Twins[last] = first;
    }
  }
  this->Points.resize(TurnIntoNumbers(vertices, threads, stop));
  forAll(vertices.size(),
    [&](std::uint32_t v)
    {
      if (vertices[v] != None)
      {
        this->Points[vertices[v]] = source.Position(v);
      }
    });
  if (!this->Twins.empty())
  {
    std::vector<std::uint32_t> twins(this->Points.size(), None);
    for (std::uint32_t v = 0; v < vertices.size(); ++v)
    {
      if (this->Twins[v] != None)
      {
        twins[vertices[v]] = vertices[this->Twins[v]];
      }
    }
    this->Twins = std::move(twins);
  }
  this->Cells.resize(TurnIntoNumbers(cells, threads, stop));
  this->Labels.resize(this->Cells.size());
  forAll(cells.size(),
    [&](std::uint32_t t)
    {
      if (cells[t] == None)
      {
        return;
      }
      Cell& cell = this->Cells[cells[t]];
      const auto& old = source.CellAt(t);
      for (unsigned i = 0; i < Corners; ++i)
      {
        cell.V[i] = vertices[old.V[i]];
        cell.N[i] = old.N[i] == None ? None : cells[old.N[i]];
      }
      this->Labels[cells[t]] = source.LabelOf(t);
    });
  this->FindHosts(threads, stop);
  return vertices;
}

/** Finds the last cell of each vertex, and their number. Allocates what vertices and cells have besides. */
template <int D>
void Complex<D>::FindHosts(unsigned threads, const std::stop_token& stop)
{
  const std::size_t points = this->Points.size();
  this->Kinds.assign(points, VertexRole::Free);
  this->Hosts.assign(points, None);
  this->Degrees.assign(points, 0);
  this->Changes.assign(points, 0);
  this->Scores.resize(this->Cells.size());
  const bool isAlone = NumberOfThreads(threads) == 1;
  ParallelFor(
    0, this->Cells.size(), Grain, threads,
    [&](std::size_t first, std::size_t end)
    {
      for (auto t = static_cast<std::uint32_t>(first); t < end; ++t)
      {
        for (const std::uint32_t v : this->Cells[t].V)
        {
          if (isAlone)
          {
            this->Hosts[v] = t;
            ++this->Degrees[v];
          }
          else
          {
            Raise(this->Hosts[v], t);
            std::atomic_ref<std::uint32_t>(this->Degrees[v])
              .fetch_add(1, std::memory_order_relaxed);
          }
        }
      }
    },
    stop);
}

template <int D>
void Complex<D>::Protect(ComponentGuard<D>* guard, unsigned threads, const std::stop_token& stop)
{
  this->Guard = guard;
  this->AreHolders.clear();
  if (guard)
  {
    this->AreHolders = guard->FindHolders(this->Elements(), threads, stop);
  }
}

template <int D>
bool Complex<D>::KeepsComponents(std::uint32_t t, std::uint32_t v, const Point<D>& to) const
{
  if (!this->IsHolder(t))
  {
    return true;
  }
  const auto before = this->PointsOf(this->Cells[t].V);
  auto after = before;
  after[this->IndexOf(t, v)] = &to;
  return this->Guard->Keeps(this->Labels[t], before, after);
}

template <int D>
void Complex<D>::ScoreCells(unsigned threads, const std::stop_token& stop)
{
  ParallelFor(
    0, this->Cells.size(), Grain, threads,
    [this](std::size_t first, std::size_t end)
    {
      for (std::size_t t = first; t < end; ++t)
      {
        const Vertices& v = this->Cells[t].V;
        this->Scores[t] = static_cast<ScoreValue>(this->Labels[t] != 0
            ? this->Score(v)
            : VolumeKeptOutside * SignedVolume<D>(this->PointsOf(v).data()));
      }
    },
    stop);
}

template <int D>
void Complex<D>::AddCells(std::size_t number)
{
  const std::size_t old = this->Cells.size();
  this->Cells.resize(old + number);
  this->Labels.resize(old + number);
  this->Scores.resize(old + number);
  this->AreHolders.resize(this->AreHolders.empty() ? 0 : old + number);
  for (std::size_t t = old; t < this->Cells.size(); ++t)
  {
    this->Cells[t].V[0] = None;
    this->Scores[t] = 1;
  }
}

template <int D>
void Complex<D>::AddVertices(std::size_t number)
{
  const std::size_t size = this->Points.size() + number;
  this->Points.resize(size);
  this->Kinds.resize(size, VertexRole::Free);
  this->BorderFaces.resize(this->BorderFaces.empty() ? 0 : size, 0);
  this->Hosts.resize(size, None);
  this->Degrees.resize(size, 0);
  this->Changes.resize(size, 0);
  this->Twins.resize(this->Twins.empty() ? 0 : size, None);
}

template <int D>
void Complex<D>::Join(std::uint32_t t, unsigned i, std::vector<OpenFacet>& open)
{
  const Facet f = SortedFacet(this->Cells[t].V, i);
  // The last vertex is compared first: it tells most facets apart.
  const auto same = std::find_if(open.begin(), open.end(),
    [&f](const OpenFacet& other) { return other.V.back() == f.back() && other.V == f; });
  if (same == open.end())
  {
    open.push_back({ f, t, i });
    return;
  }
  this->Cells[t].N[i] = same->Cell;
  this->Cells[same->Cell].N[same->Index] = t;
  *same = open.back();
  open.pop_back();
}

/**
 * If all interface facets of a vertex separate the same two labels, it is on a surface of two
 * labels.
 */
template <int D>
void Complex<D>::FindKinds(unsigned threads, const std::stop_token& stop)
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
        ForEachInterface(this->Cells[t].N, this->Labels[t], this->Labels, BeyondEnd::Background,
          [&](unsigned i, LabelId beside)
          {
            for (const std::uint32_t v : OutwardFacet(this->Cells[t].V, i))
            {
              note(v, (std::uint64_t{ this->Labels[t] } << 32) | beside);
            }
          });
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
template <int D>
void Complex<D>::FindBorderFaces(const Domain<D>& domain)
{
  const ImageBorder<D>* const border = domain.Border();
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
  for (const Cell& cell : this->Cells)
  {
    for (unsigned i = 0; i < Corners; ++i)
    {
      if (cell.N[i] != None)
      {
        continue;
      }
      const Facet f = SortedFacet(cell.V, i);
      unsigned common = ~0u;
      for (const std::uint32_t v : f)
      {
        common &= this->BorderFaces[v];
      }
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
template <int D>
void Complex<D>::Write(std::span<const std::int64_t> values, SimplexMesh<D>& mesh, unsigned threads,
  const std::stop_token& stop)
{
  mesh = SimplexMesh<D>(); // and stays empty if this throws
  SimplexMesh<D> whole;
  whole.Simplices.resize(this->Cells.size());
  whole.Labels.resize(this->Cells.size());
  ParallelFor(
    0, this->Cells.size(), Grain, threads,
    [&](std::size_t first, std::size_t end)
    {
      for (std::size_t t = first; t < end; ++t)
      {
        whole.Simplices[t] = this->Cells[t].V;
        whole.Labels[t] = values[this->Labels[t]];
      }
    },
    stop);
  ListInterfaces(
    this->Labels, [this](std::uint32_t t) -> const auto& { return this->Cells[t].N; },
    BeyondEnd::Background,
    [&](std::size_t number)
    {
      whole.Facets.resize(number);
      whole.FacetLabels.resize(number);
    },
    [&](std::size_t place, std::uint32_t t, unsigned i, LabelId beside)
    {
      whole.Facets[place] = OutwardFacet(this->Cells[t].V, i);
      whole.FacetLabels[place] = { whole.Labels[t], values[beside] };
    },
    threads, stop);
  for (std::uint32_t v = 0; v < this->Twins.size(); ++v)
  {
    const std::uint32_t twin = this->Twins[v];
    if (twin != None && this->Points[v][D - 1] < this->Points[twin][D - 1])
    {
      whole.Twins.push_back({ v, twin });
    }
  }
  whole.Points = std::move(this->Points);
  mesh = std::move(whole);
  *this = Complex();
}

template class Complex<3>;
template class Complex<4>;

} // namespace voxplex
