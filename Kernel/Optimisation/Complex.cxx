// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Complex.h"

#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"
#include "Parallel/SharedCounts.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <mutex>
#include <numeric>
#include <type_traits>
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

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
Complex<D>::Complex(const SimplexMesh<D>& mesh, const ShapeFunction& score, unsigned threads,
  const std::stop_token& stop, std::span<const ScoreValue> scores, const SpareRoom& spare,
  const Surroundings<D>& outside)
  : Shape(score)
  , FirstOutside(mesh.Points.size())
  , EndOfOutside(mesh.Points.size() + outside.Points.size())
{
  const std::size_t points = this->EndOfOutside;
  const auto fill = [&](auto& of, auto value)
  {
    of.reserve(points + spare.Vertices);
    of.assign(points, value);
  };
  this->Points.reserve(points + spare.Vertices);
  this->Points.assign(mesh.Points.begin(), mesh.Points.end());
  this->Points.insert(this->Points.end(), outside.Points.begin(), outside.Points.end());
  fill(this->Kinds, VertexRole::Free);
  fill(this->Hosts, None);
  fill(this->Degrees, 0u);
  fill(this->Changes, 0u);
  const std::size_t cells = mesh.Simplices.size() + outside.Simplices.size();
  const auto resize = [&](auto& of)
  {
    of.reserve(cells + spare.Cells);
    of.resize(cells);
  };
  resize(this->Cells);
  resize(this->Labels);
  resize(this->Scores);
  this->FindLabels(mesh, threads, stop);
  this->CopyCells(mesh, outside, threads, stop);
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
  this->Twins.resize(mesh.Twins.empty() ? 0 : points, None);
  for (const auto& [first, last] : mesh.Twins)
  {
    this->Twins[first] = last;
    this->Twins[last] = first;
  }
}

template <int D>
void Complex<D>::Protect(ComponentGuard<D>& guard, const SimplexMesh<D>& mesh, unsigned threads,
  const std::stop_token& stop)
{
  this->Guard = &guard;
  this->AreHolders = guard.FindHolders(mesh, threads, stop);
  this->AreHolders.resize(this->AreHolders.empty() ? 0 : this->Cells.size());
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
  return this->Guard->Keeps(this->LabelInImage(this->Labels[t]), before, after);
}

template <int D>
void Complex<D>::FindLabels(
  const SimplexMesh<D>& mesh, unsigned threads, const std::stop_token& stop)
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

template <int D>
void Complex<D>::CopyCells(const SimplexMesh<D>& mesh, const Surroundings<D>& outside,
  unsigned threads, const std::stop_token& stop)
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
        const bool isInMesh = t < mesh.Simplices.size();
        this->Cells[t].V =
          isInMesh ? mesh.Simplices[t] : outside.Simplices[t - mesh.Simplices.size()];
        this->Cells[t].N.fill(None);
        if (const std::int64_t value = isInMesh ? mesh.Labels[t] : 0; value != last)
        {
          last = value;
          const auto begin = this->LabelValues.begin();
          const auto found = std::lower_bound(begin + 1, this->LabelValues.end(), last);
          index = isInMesh ? static_cast<Label>(found - begin) : 0;
        }
        this->Labels[t] = index;
        for (const std::uint32_t v : this->Cells[t].V)
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

/** Facets are listed by the sum of their vertices, so that lists are short. */
template <int D>
void Complex<D>::Connect(unsigned threads, const std::stop_token& stop)
{
  const std::size_t lists = std::bit_ceil(this->Points.size());
  const auto listOf = [lists](const Vertices& v, unsigned i)
  {
    const std::size_t sum = std::accumulate(v.begin(), v.end(), std::size_t{ 0 }) - v[i];
    return static_cast<std::uint32_t>(sum & (lists - 1));
  };
  SharedCounts places(lists, threads, stop);
  const auto forEachFacet = [&](auto&& visit)
  {
    ParallelFor(
      0, this->Cells.size(), Grain, threads,
      [&](std::size_t first, std::size_t end)
      {
        for (auto t = static_cast<std::uint32_t>(first); t < end; ++t)
        {
          for (unsigned i = 0; i < Corners; ++i)
          {
            visit(listOf(this->Cells[t].V, i), Corners * t + i);
          }
        }
      },
      stop);
  };
  forEachFacet([&](std::uint32_t list, std::uint32_t) { places.Add(list); });
  UninitialisedVector<std::uint32_t> facets(places.TurnIntoPlaces()); // Corners * cell + index
  forEachFacet([&](std::uint32_t list, std::uint32_t facet) { facets[places.Next(list)] = facet; });
  ParallelFor(
    0, lists, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      std::vector<OpenFacet> open;
      for (std::size_t list = first; list < last; ++list)
      {
        open.clear();
        for (std::size_t k = places.BeginOf(list); k < places.EndOf(list); ++k)
        {
          this->Join(facets[k] / Corners, facets[k] % Corners, open);
        }
      }
    },
    stop);
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
        for (unsigned i = 0; i < Corners; ++i)
        {
          const Label beside = this->LabelOf(this->Cells[t].N[i]);
          if (this->Labels[t] <= beside) // no interface, or counted from the other side
          {
            continue;
          }
          for (unsigned k = 1; k < Corners; ++k)
          {
            note(this->Cells[t].V[(i + k) % Corners],
              (std::uint64_t{ this->Labels[t] } << 32) | beside);
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
/** Writes the points that cells of the mesh use. @return the number of each vertex in the mesh */
template <int D>
UninitialisedVector<std::uint32_t> Complex<D>::WritePoints(
  SimplexMesh<D>& mesh, unsigned threads, const std::stop_token& stop) const
{
  UninitialisedVector<std::uint32_t> numbers(this->Points.size());
  ChunkCounts counts(numbers.size());
  const auto forChunks = [&](auto&& function)
  { ParallelFor(0, numbers.size(), ChunkCounts::Grain, threads, function, stop); };
  const auto isUsed = [this](std::size_t v)
  { return this->Degrees[v] != 0 && (v < this->FirstOutside || v >= this->EndOfOutside); };
  forChunks(
    [&](std::size_t first, std::size_t end)
    {
      std::size_t used = 0;
      for (std::size_t v = first; v < end; ++v)
      {
        used += isUsed(v) ? 1 : 0;
      }
      counts.OfChunk(first) = used;
    });
  mesh.Points.resize(counts.TurnIntoPlaces());
  forChunks(
    [&](std::size_t first, std::size_t end)
    {
      std::size_t place = counts.OfChunk(first);
      for (std::size_t v = first; v < end; ++v)
      {
        numbers[v] = None;
        if (isUsed(v))
        {
          numbers[v] = static_cast<std::uint32_t>(place);
          mesh.Points[place++] = this->Points[v];
        }
      }
    });
  return numbers;
}

template <int D>
void Complex<D>::Write(SimplexMesh<D>& mesh, unsigned threads, const std::stop_token& stop)
{
  const auto release = [](auto&... arrays)
  { ((arrays = std::remove_reference_t<decltype(arrays)>()), ...); }; // {} would keep the memory
  release(mesh.Points, mesh.Simplices, mesh.Labels);
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
      if (this->IsAlive(t) && this->Labels[t] != 0)
      {
        function(t);
      }
    }
  };
  const auto isInterface = [this](std::uint32_t t, unsigned i)
  { return D == 3 && this->LabelOf(this->Cells[t].N[i]) < this->Labels[t]; };
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
          for (unsigned i = 0; i < Corners; ++i)
          {
            interfaces += isInterface(t, i) ? 1 : 0;
          }
        });
      cells.OfChunk(first) = alive;
      facets.OfChunk(first) = interfaces;
    });
  const std::size_t number = cells.TurnIntoPlaces();
  mesh.Labels.resize(number);
  if constexpr (D == 3)
  {
    mesh.Facets.resize(facets.TurnIntoPlaces());
    mesh.FacetLabels.resize(mesh.Facets.size());
  }
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
          if constexpr (D == 3)
          {
            const Vertices& v = this->Cells[t].V;
            for (unsigned i = 0; i < Corners; ++i)
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
          }
        });
    });
  mesh.Simplices.resize(number);
  forChunks(
    [&](std::size_t first, std::size_t end)
    {
      std::size_t cell = cells.OfChunk(first);
      forAlive(first, end,
        [&](std::uint32_t t)
        {
          const Vertices& v = this->Cells[t].V;
          for (unsigned i = 0; i < Corners; ++i)
          {
            mesh.Simplices[cell][i] = numbers[v[i]];
          }
          ++cell;
        });
    });
  release(this->Cells, this->Labels);
}

template class Complex<3>;
template class Complex<4>;

} // namespace voxplex
