// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/MeshExtraction.h"

#include "Base/UninitialisedVector.h"
#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>
#include <iterator>
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
    std::span<const LabelId> labels, const MeshChanges<D>& changes, unsigned threads,
    const std::stop_token& stop)
    : Source(triangulation)
    , Image(image)
    , Labels(labels)
    , Changes(changes)
    , Threads(threads)
    , Stop(stop)
    , Ids(labels.size())
    , Vertices(triangulation.VertexIdEnd())
    , IsReplaced(changes.Parts.Replaced.empty() ? 0 : Ids)
    , Inside(Ids)
    , FacetCounts(Ids)
  {
    for (const SimplexId s : changes.Parts.Replaced)
    {
      this->IsReplaced[s] = 1;
    }
    std::copy_if(changes.Parts.Pieces.begin(), changes.Parts.Pieces.end(),
      std::back_inserter(this->Pieces), [](const Piece<D>& piece) { return piece.Label != 0; });
  }

  SimplexMesh<D> Run()
  {
    this->MarkVertices();
    this->NumberPoints();
    this->WriteSimplices();
    this->WriteFacets();
    this->AddFacetsOfPieces();
    return std::move(this->Mesh);
  }

  UninitialisedVector<std::uint32_t> TakeNumbers() { return std::move(this->Numbers); }

private:
  static constexpr unsigned N = D + 1;
  using Corners = std::array<VertexId, N>;
  using Facet = std::array<std::uint32_t, static_cast<std::size_t>(D)>;

  template <typename Function>
  void ForChunks(std::size_t iterations, Function&& function)
  {
    ParallelFor(0, iterations, ChunkCounts::Grain, this->Threads, std::forward<Function>(function),
      this->Stop);
  }

  bool Replaced(SimplexId s) const { return !this->IsReplaced.empty() && this->IsReplaced[s] != 0; }

  /** Calls function(s) for all whole simplices of the mesh in a chunk of ids. */
  template <typename Function>
  void ForSimplices(std::size_t first, std::size_t last, Function&& function)
  {
    for (auto s = static_cast<SimplexId>(first); s < last; ++s)
    {
      if (this->Labels[s] != 0 && !this->Replaced(s))
      {
        function(s);
      }
    }
  }

  /**
   * Calls function(i) for each facet i between whole simplices that s has to write. Each one is
   * written once, from the side of the larger label. Ids ascend with the image's values.
   */
  template <typename Function>
  void ForFacets(SimplexId s, Function&& function)
  {
    const auto& neighbours = this->Source.GetSimplex(s).N;
    for (unsigned i = 0; i < N; ++i)
    {
      const SimplexId next = neighbours[i];
      if (next == None || (this->Labels[next] < this->Labels[s] && !this->Replaced(next)))
      {
        function(i);
      }
    }
  }

  /** Marks the vertices of the mesh, and counts its whole simplices. */
  void MarkVertices()
  {
    this->Numbers.resize(this->Vertices + this->Changes.Parts.Points.size());
    this->ForChunks(this->Numbers.size(),
      [this](std::size_t first, std::size_t last)
      { std::fill(this->Numbers.data() + first, this->Numbers.data() + last, None); });
    this->ForChunks(this->Ids,
      [this](std::size_t first, std::size_t last)
      {
        std::size_t inside = 0;
        this->ForSimplices(first, last,
          [&](SimplexId s)
          {
            ++inside;
            this->Mark(this->Source.GetSimplex(s).V);
          });
        this->Inside.OfChunk(first) = inside;
      });
    for (const Piece<D>& piece : this->Pieces)
    {
      this->Mark(piece.V);
    }
  }

  void Mark(const Corners& corners)
  {
    for (const VertexId v : corners)
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

  void NumberPoints()
  {
    ChunkCounts places(this->Numbers.size());
    this->ForChunks(this->Numbers.size(),
      [&](std::size_t first, std::size_t last)
      {
        const std::uint32_t* const numbers = this->Numbers.data();
        places.OfChunk(first) = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(last - first) -
          std::count(numbers + first, numbers + last, None));
      });
    this->Mesh.Points.resize(places.TurnIntoPlaces());
    this->ForChunks(this->Numbers.size(),
      [&](std::size_t first, std::size_t last)
      {
        std::size_t place = places.OfChunk(first);
        for (auto v = static_cast<VertexId>(first); v < last; ++v)
        {
          if (this->Numbers[v] != None)
          {
            this->Mesh.Points[place] = this->Position(v);
            this->Numbers[v] = static_cast<std::uint32_t>(place++);
          }
        }
      });
  }

  const Point<D>& Position(VertexId v) const
  {
    if (v >= this->Vertices)
    {
      return this->Changes.Parts.Points[v - this->Vertices];
    }
    return this->Changes.Positions.empty() ? this->Source.Position(v) : this->Changes.Positions[v];
  }

  /** Writes the simplices and labels, and counts the facets between whole simplices. */
  void WriteSimplices()
  {
    std::size_t next = this->Inside.TurnIntoPlaces();
    this->Mesh.Simplices.resize(next + this->Pieces.size());
    this->Mesh.Labels.resize(next + this->Pieces.size());
    this->ForChunks(this->Ids,
      [this](std::size_t first, std::size_t last)
      {
        std::size_t k = this->Inside.OfChunk(first);
        std::size_t facets = 0;
        this->ForSimplices(first, last,
          [&](SimplexId s)
          {
            this->WriteSimplex(k++, this->Source.GetSimplex(s).V, this->Labels[s]);
            this->ForFacets(s, [&facets](unsigned) { ++facets; });
          });
        this->FacetCounts.OfChunk(first) = facets;
      });
    for (const Piece<D>& piece : this->Pieces)
    {
      this->WriteSimplex(next++, piece.V, piece.Label);
    }
  }

  void WriteSimplex(std::size_t k, const Corners& corners, LabelId label)
  {
    for (unsigned i = 0; i < N; ++i)
    {
      this->Mesh.Simplices[k][i] = this->Numbers[corners[i]];
    }
    this->Mesh.Labels[k] = this->Image.LabelValue(label);
  }

  void WriteFacets()
  {
    const std::size_t facets = this->FacetCounts.TurnIntoPlaces();
    this->Mesh.Facets.resize(facets);
    this->Mesh.FacetLabels.resize(facets);
    this->ForChunks(this->Ids,
      [this](std::size_t first, std::size_t last)
      {
        std::size_t k = this->Inside.OfChunk(first);
        std::size_t f = this->FacetCounts.OfChunk(first);
        this->ForSimplices(first, last,
          [&](SimplexId s)
          {
            this->ForFacets(s,
              [&](unsigned i)
              {
                const SimplexId other = this->Source.GetSimplex(s).N[i];
                this->Mesh.Facets[f] = OutwardFacet(this->Mesh.Simplices[k], i);
                this->Mesh.FacetLabels[f] = { this->Mesh.Labels[k],
                  this->Image.LabelValue(this->LabelOrBackground(other)) };
                ++f;
              });
            ++k;
          });
      });
  }

  /** One side of a facet that a piece has. */
  struct Side
  {
    Facet Sorted;  ///< the vertices, the same on both sides
    Facet Outward; ///< as OutwardFacet() has them
    LabelId Label;
  };

  /** Adds the facets of pieces, which are found by their vertices. */
  void AddFacetsOfPieces()
  {
    std::vector<Side> sides;
    const auto add = [&sides](const Corners& corners, unsigned i, LabelId label)
    {
      const Facet outward = OutwardFacet(corners, i);
      sides.push_back({ outward, outward, label });
      std::sort(sides.back().Sorted.begin(), sides.back().Sorted.end());
    };
    for (const Piece<D>& piece : this->Changes.Parts.Pieces)
    {
      for (unsigned i = 0; i < N; ++i)
      {
        add(piece.V, i, piece.Label);
      }
    }
    for (const SimplexId s : this->Changes.Parts.Replaced)
    {
      for (const SimplexId next : this->Source.GetSimplex(s).N)
      {
        if (next != None && !this->Replaced(next))
        {
          const auto& simplex = this->Source.GetSimplex(next);
          const auto back = std::find(simplex.N.begin(), simplex.N.end(), s) - simplex.N.begin();
          add(simplex.V, static_cast<unsigned>(back), this->Labels[next]);
        }
      }
    }
    std::sort(sides.begin(), sides.end(),
      [](const Side& a, const Side& b)
      { return a.Sorted != b.Sorted ? a.Sorted < b.Sorted : a.Label > b.Label; });
    for (auto side = sides.begin(); side != sides.end();)
    {
      const auto other = std::next(side);
      const bool isPair = other != sides.end() && other->Sorted == side->Sorted;
      const LabelId beyond = isPair ? other->Label : LabelId(0); // the box ends at a flat end
      if (side->Label != beyond)
      {
        Facet facet;
        std::transform(side->Outward.begin(), side->Outward.end(), facet.begin(),
          [this](VertexId v) { return this->Numbers[v]; });
        this->Mesh.Facets.push_back(facet);
        this->Mesh.FacetLabels.push_back(
          { this->Image.LabelValue(side->Label), this->Image.LabelValue(beyond) });
      }
      side += isPair ? 2 : 1;
    }
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
  const std::span<const LabelId> Labels; ///< of each simplex id
  const MeshChanges<D>& Changes;
  const unsigned Threads;
  const std::stop_token& Stop;
  const std::size_t Ids;                ///< all simplex ids are smaller
  const std::size_t Vertices;           ///< all vertex ids of the triangulation are smaller
  std::vector<std::uint8_t> IsReplaced; ///< by simplex id; empty if none is
  std::vector<Piece<D>> Pieces;         ///< those of the mesh
  SimplexMesh<D> Mesh;
  UninitialisedVector<std::uint32_t> Numbers; ///< point of each vertex id, or None
  ChunkCounts Inside;                         ///< whole simplices, by chunks of simplex ids
  ChunkCounts FacetCounts;                    ///< facets between these, by the same chunks
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void ExtractMesh(const Triangulation<D>& triangulation, const Domain<D>& image,
  std::span<const LabelId> labels, SimplexMesh<D>& mesh, unsigned threads,
  const std::stop_token& stop, const MeshChanges<D>& changes,
  UninitialisedVector<std::uint32_t>* numbers)
{
  mesh = SimplexMesh<D>();
  Extraction<D> extraction(triangulation, image, labels, changes, threads, stop);
  mesh = extraction.Run();
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
  SimplexMesh<3>&, unsigned, const std::stop_token&, const MeshChanges<3>&,
  UninitialisedVector<std::uint32_t>*);
template void ExtractMesh<4>(const Triangulation<4>&, const Domain<4>&, std::span<const LabelId>,
  SimplexMesh<4>&, unsigned, const std::stop_token&, const MeshChanges<4>&,
  UninitialisedVector<std::uint32_t>*);
template void ExtractMesh<3>(
  const Triangulation<3>&, const Domain<3>&, SimplexMesh<3>&, unsigned, const std::stop_token&);
template void ExtractMesh<4>(
  const Triangulation<4>&, const Domain<4>&, SimplexMesh<4>&, unsigned, const std::stop_token&);

} // namespace voxplex
