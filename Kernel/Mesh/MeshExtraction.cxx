// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/MeshExtraction.h"

#include "Base/UninitialisedVector.h"
#include "Geometry/HilbertOrder.h"
#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"
#include "Parallel/ParallelSort.h"
#include "Parallel/SharedCounts.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <utility>

namespace voxplex
{

namespace
{

/** The steps of an extraction, and the data that one step passes to the next. */
template <int D>
class Extraction
{
public:
  Extraction(const Triangulation<D>& triangulation, const Domain<D>& image,
    std::span<const LabelId> labels, std::span<const Point<D>> positions, std::size_t spare,
    unsigned threads, const std::stop_token& stop)
    : Source(triangulation)
    , Image(image)
    , Labels(labels)
    , Positions(positions)
    , Spare(spare)
    , Threads(threads)
    , Stop(stop)
    , Ids(labels.size())
    , Vertices(triangulation.VertexIdEnd())
    , Inside(Ids)
  {
  }

  /** @param keepsNumbers for TakeNumbers() */
  SimplexMesh<D> Run(bool keepsNumbers)
  {
    this->MarkVertices();
    this->NumberPoints();
    this->SortSimplices();
    this->WriteSimplices();
    if (!keepsNumbers)
    {
      this->Numbers = UninitialisedVector<std::uint32_t>();
    }
    this->WriteFacets();
    return std::move(this->Mesh);
  }

  UninitialisedVector<std::uint32_t> TakeNumbers() { return std::move(this->Numbers); }

private:
  static constexpr unsigned N = D + 1;
  using Facet = std::array<std::uint32_t, static_cast<std::size_t>(D)>;

  /** A sort key and its vertex. */
  struct Ranked
  {
    std::uint64_t Key;
    VertexId Id;
  };

  template <typename Function>
  void ForChunks(std::size_t iterations, Function&& function)
  {
    ParallelFor(0, iterations, ChunkCounts::Grain, this->Threads, std::forward<Function>(function),
      this->Stop);
  }

  /** Marks the vertices of the simplices inside, and counts these simplices. */
  void MarkVertices()
  {
    this->Numbers.resize(this->Vertices);
    this->ForChunks(this->Vertices,
      [this](std::size_t first, std::size_t last)
      { std::fill(this->Numbers.data() + first, this->Numbers.data() + last, None); });
    this->ForChunks(this->Ids,
      [this](std::size_t first, std::size_t last)
      {
        std::size_t inside = 0;
        for (auto s = static_cast<SimplexId>(first); s < last; ++s)
        {
          if (this->Labels[s] != 0)
          {
            ++inside;
            this->MarkVerticesOf(s);
          }
        }
        this->Inside.OfChunk(first) = inside;
      });
    this->NumberOfSimplices = this->Inside.TurnIntoPlaces();
  }

  void MarkVerticesOf(SimplexId s)
  {
    for (const VertexId v : this->Source.GetSimplex(s).V)
    {
      // Relaxed: threads write the same number, and the end of the loop orders it before its
      // readers. Most vertices are marked already. Reading first leaves the cache line with the
      // other threads.
      const std::atomic_ref<std::uint32_t> number(this->Numbers[v]);
      if (number.load(std::memory_order_relaxed) == None)
      {
        number.store(0, std::memory_order_relaxed);
      }
    }
  }

  /**
   * Numbers points along a Hilbert curve. Points at the same place of the curve are sorted by their
   * ids.
   */
  void NumberPoints()
  {
    ChunkCounts places(this->Vertices);
    this->ForChunks(this->Vertices,
      [&](std::size_t first, std::size_t last)
      {
        const std::uint32_t* const numbers = this->Numbers.data();
        places.OfChunk(first) = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(last - first) -
          std::count(numbers + first, numbers + last, None));
      });
    const std::size_t points = places.TurnIntoPlaces();

    UninitialisedVector<Ranked> memory(2 * points);
    const std::span<Ranked> records(memory);
    this->ForChunks(this->Vertices,
      [&](std::size_t first, std::size_t last)
      {
        std::size_t place = places.OfChunk(first);
        for (auto v = static_cast<VertexId>(first); v < last; ++v)
        {
          if (this->Numbers[v] != None)
          {
            records[place++] = { HilbertIndex<D>(this->Source.Position(v), this->Source.GetBox()),
              v };
          }
        }
      });
    const std::span<Ranked> sorted = ParallelRadixSort(
      records.first(points), records.last(points), 63,
      [](const Ranked& record) { return record.Key; }, this->Threads, this->Stop);

    this->Mesh.Points.reserve(points + this->Spare);
    this->Mesh.Points.resize(points);
    this->ForChunks(points,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t i = first; i < last; ++i)
        {
          this->Numbers[sorted[i].Id] = static_cast<std::uint32_t>(i);
          this->Mesh.Points[i] = this->Positions.empty() ? this->Source.Position(sorted[i].Id)
                                                         : this->Positions[sorted[i].Id];
        }
      });
  }

  /**
   * Sorts the ids of the simplices inside by their smallest point, then by themselves. Counts the
   * simplices of each point, and writes their ids into lists. Threads write in any order, so each
   * list, of a few ids, is sorted in the end.
   */
  void SortSimplices()
  {
    const std::size_t points = this->Mesh.Points.size();
    SharedCounts places(points, this->Threads, this->Stop);
    UninitialisedVector<std::uint32_t> smallest(this->NumberOfSimplices);
    this->ForSimplices(
      [&](std::size_t k, SimplexId s)
      {
        smallest[k] = this->SmallestPoint(s);
        places.Add(smallest[k]);
      });
    places.TurnIntoPlaces();
    this->Sorted.resize(this->NumberOfSimplices);
    this->ForSimplices(
      [&](std::size_t k, SimplexId s) { this->Sorted[places.Next(smallest[k])] = s; });
    if (!places.IsInOrder())
    {
      this->ForChunks(points,
        [&](std::size_t first, std::size_t last)
        {
          for (std::size_t p = first; p < last; ++p)
          {
            std::sort(
              this->Sorted.data() + places.BeginOf(p), this->Sorted.data() + places.EndOf(p));
          }
        });
    }
  }

  /**
   * Calls function(number of the simplex, id) for all simplices inside, ascending in each chunk.
   * Neighbours may write to the counts of the same points.
   */
  template <typename Function>
  void ForSimplices(Function&& function)
  {
    ParallelFor(
      0, this->Ids, ChunkCounts::Grain, this->Threads,
      [&](std::size_t first, std::size_t last)
      {
        std::size_t k = this->Inside.OfChunk(first);
        for (auto s = static_cast<SimplexId>(first); s < last; ++s)
        {
          if (this->Labels[s] != 0)
          {
            function(k++, s);
          }
        }
      },
      this->Stop);
  }

  std::uint32_t SmallestPoint(SimplexId s) const
  {
    std::uint32_t smallest = None;
    for (const VertexId v : this->Source.GetSimplex(s).V)
    {
      smallest = std::min(smallest, this->Numbers[v]);
    }
    return smallest;
  }

  /** Writes the simplices and labels, and notes which facets are interfaces. */
  void WriteSimplices()
  {
    const std::size_t n = this->NumberOfSimplices;
    this->Mesh.Simplices.reserve(n + this->Spare);
    this->Mesh.Simplices.resize(n);
    this->Mesh.Labels.reserve(n + this->Spare);
    this->Mesh.Labels.resize(n);
    this->Interfaces.resize(n);
    this->FacetCounts = ChunkCounts(n);
    this->ForChunks(n,
      [this, n](std::size_t first, std::size_t last)
      {
        // Neighbours in the mesh are at any places in the triangulation.
        constexpr std::size_t Ahead = 16;
        std::size_t facets = 0;
        for (std::size_t k = first; k < last; ++k)
        {
          __builtin_prefetch(&this->Source.GetSimplex(this->Sorted[std::min(k + Ahead, n - 1)]));
          facets += this->WriteSimplex(k);
        }
        this->FacetCounts.OfChunk(first) = facets;
      });
  }

  /** Returns the number of the simplex' facets to write. */
  unsigned WriteSimplex(std::size_t k)
  {
    const SimplexId s = this->Sorted[k];
    const auto& simplex = this->Source.GetSimplex(s);
    unsigned interfaces = 0;
    for (unsigned i = 0; i < N; ++i)
    {
      this->Mesh.Simplices[k][i] = this->Numbers[simplex.V[i]];
      // Each facet is written once, from the side of the larger label. Ids ascend with the image's
      // values.
      interfaces |= (this->LabelOrBackground(simplex.N[i]) < this->Labels[s] ? 1u : 0u) << i;
    }
    this->Mesh.Labels[k] = this->Image.LabelValue(this->Labels[s]);
    this->Interfaces[k] = static_cast<std::uint8_t>(interfaces);
    return static_cast<unsigned>(std::popcount(interfaces));
  }

  void WriteFacets()
  {
    const std::size_t facets = this->FacetCounts.TurnIntoPlaces();
    this->Mesh.Facets.reserve(facets + N * this->Spare);
    this->Mesh.FacetLabels.reserve(facets + N * this->Spare);
    this->Mesh.Facets.resize(facets);
    this->Mesh.FacetLabels.resize(facets);
    this->ForChunks(this->NumberOfSimplices,
      [this](std::size_t first, std::size_t last)
      {
        std::size_t f = this->FacetCounts.OfChunk(first);
        for (std::size_t k = first; k < last; ++k)
        {
          for (unsigned rest = this->Interfaces[k]; rest != 0; rest &= rest - 1)
          {
            const auto i = static_cast<unsigned>(std::countr_zero(rest));
            const SimplexId other = this->Source.GetSimplex(this->Sorted[k]).N[i];
            this->Mesh.Facets[f] = OutwardFacet(this->Mesh.Simplices[k], i);
            this->Mesh.FacetLabels[f] = { this->Mesh.Labels[k],
              this->Image.LabelValue(this->LabelOrBackground(other)) };
            ++f;
          }
        }
      });
  }

  LabelId LabelOrBackground(SimplexId s) const { return s == None ? LabelId(0) : this->Labels[s]; }

  /** Facet i of a positively oriented simplex; in 3D its right-hand normal points outwards. */
  static Facet OutwardFacet(const std::array<std::uint32_t, N>& simplex, unsigned i)
  {
    static constexpr std::array<Facet, N> corners = OutwardCorners();
    Facet facet;
    for (unsigned m = 0; m < facet.size(); ++m)
    {
      facet[m] = simplex[corners[i][m]];
    }
    return facet;
  }

  /** The vertices of each facet of a simplex. */
  static constexpr std::array<Facet, N> OutwardCorners()
  {
    std::array<Facet, N> corners{};
    for (unsigned i = 0; i < N; ++i)
    {
      for (unsigned m = 0; m < D; ++m)
      {
        corners[i][m] = m + (m < i ? 0 : 1);
      }
      if (i % 2 == 1)
      {
        std::swap(corners[i][0], corners[i][1]);
      }
    }
    return corners;
  }

  const Triangulation<D>& Source;
  const Domain<D>& Image;
  const std::span<const LabelId> Labels;     ///< of each simplex id
  const std::span<const Point<D>> Positions; ///< of each vertex id, or empty
  const std::size_t Spare;                   ///< simplices to be added later
  const unsigned Threads;
  const std::stop_token& Stop;
  const std::size_t Ids;      ///< all simplex ids are smaller
  const std::size_t Vertices; ///< all vertex ids are smaller
  SimplexMesh<D> Mesh;
  ChunkCounts Inside;                         ///< simplices inside, by chunks of simplex ids
  std::size_t NumberOfSimplices = 0;          ///< number of simplices inside
  UninitialisedVector<std::uint32_t> Numbers; ///< number of each vertex in the mesh, or None
  UninitialisedVector<SimplexId> Sorted;      ///< the simplices inside, as the mesh has them
  /** For each simplex of the mesh, a bit for each facet. */
  UninitialisedVector<std::uint8_t> Interfaces;
  ChunkCounts FacetCounts; ///< by chunks of simplices of the mesh
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void ExtractMesh(const Triangulation<D>& triangulation, const Domain<D>& image,
  std::span<const LabelId> labels, SimplexMesh<D>& mesh, unsigned threads,
  const std::stop_token& stop, std::span<const Point<D>> positions,
  UninitialisedVector<std::uint32_t>* numbers, std::size_t spare)
{
  mesh = SimplexMesh<D>();
  Extraction<D> extraction(triangulation, image, labels, positions, spare, threads, stop);
  mesh = extraction.Run(numbers != nullptr);
  if (numbers)
  {
    *numbers = extraction.TakeNumbers();
  }
}

template <int D>
void ExtractMesh(const Triangulation<D>& triangulation, const Domain<D>& image,
  SimplexMesh<D>& mesh, unsigned threads, const std::stop_token& stop)
{
  mesh = SimplexMesh<D>();
  ExtractMesh<D>(
    triangulation, image, LabelSimplices(triangulation, image, threads, stop), mesh, threads, stop);
}

template void ExtractMesh<3>(const Triangulation<3>&, const Domain<3>&, std::span<const LabelId>,
  SimplexMesh<3>&, unsigned, const std::stop_token&, std::span<const Point<3>>,
  UninitialisedVector<std::uint32_t>*, std::size_t);
template void ExtractMesh<4>(const Triangulation<4>&, const Domain<4>&, std::span<const LabelId>,
  SimplexMesh<4>&, unsigned, const std::stop_token&, std::span<const Point<4>>,
  UninitialisedVector<std::uint32_t>*, std::size_t);
template void ExtractMesh<3>(
  const Triangulation<3>&, const Domain<3>&, SimplexMesh<3>&, unsigned, const std::stop_token&);
template void ExtractMesh<4>(
  const Triangulation<4>&, const Domain<4>&, SimplexMesh<4>&, unsigned, const std::stop_token&);

} // namespace voxplex
