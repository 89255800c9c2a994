// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Construction, pools and walking. Insertion, removal and verification have separate files, which
// are included and instantiated here.
#include "Delaunay/Triangulation.h"

#include "Delaunay/Insertion.txx"
#include "Delaunay/Removal.txx"

#include <algorithm>
#include <new>
#include <utility>

namespace voxplex
{

namespace
{
// Number of ids that a worker takes from the common counter at once.
constexpr std::uint32_t SimplexBlock = 256;
constexpr std::uint32_t VertexBlock = 64;
}

//------------------------------------------------------------------------------------------------
template <int D>
Triangulation<D>::Triangulation(const Box<D>& box)
  : Domain(box)
  , Vertices(Vertex{ {}, None, 0, 0, VertexKind::Box, false, false })
  , Marks(SimplexMark::Unused)
  , States(SimplexState{ 0, 0, false, false, false })
{
  this->BuildCorners();
}

//------------------------------------------------------------------------------------------------
// The corners are co-spherical. The perturbed predicates define their triangulation: it has the
// simplices of corners whose perturbed circumball is empty.
template <int D>
void Triangulation<D>::BuildCorners()
{
  Worker worker(*this);
  constexpr std::uint32_t corners = 1u << D;
  std::array<VertexId, corners> v;
  for (std::uint32_t c = 0; c < corners; ++c)
  {
    Point<D> p;
    for (unsigned a = 0; a < static_cast<unsigned>(D); ++a)
    {
      p[a] = (c >> a) & 1u ? this->Domain.Max[a] : this->Domain.Min[a];
    }
    this->ReserveVertex(worker);
    v[c] = this->NewVertex(worker, p, VertexKind::Box);
    worker.Link.ReserveMore(1);
    this->NumberVertex(worker, v[c]);
  }

  FacetTable<D> facets;
  facets.Begin(64);
  std::vector<SimplexId> made;
  for (std::uint32_t set = 0; set < (1u << corners); ++set)
  {
    if (std::popcount(set) != D + 1)
    {
      continue;
    }
    std::array<VertexId, N> simplex;
    unsigned m = 0;
    for (std::uint32_t c = 0; c < corners; ++c)
    {
      if ((set >> c) & 1u)
      {
        simplex[m++] = v[c];
      }
    }
    std::array<const Point<D>*, N> points = this->Points(simplex);
    const int orientation = worker.Predicates.Orientation(points.data());
    if (orientation == 0)
    {
      continue;
    }
    if (orientation < 0)
    {
      std::swap(simplex[0], simplex[1]);
      std::swap(points[0], points[1]);
    }
    bool empty = true;
    for (std::uint32_t c = 0; c < corners && empty; ++c)
    {
      empty = ((set >> c) & 1u) ||
        !worker.Predicates.InSpherePerturbed(points.data(), this->Position(v[c]));
    }
    if (!empty)
    {
      continue;
    }
    this->ReserveSimplices(worker, 1);
    const SimplexId s = this->NewSimplex(worker);
    this->WriteSimplex(worker, s, simplex);
    const std::uint32_t number = static_cast<std::uint32_t>(made.size());
    made.push_back(s);
    std::array<std::uint32_t, N> local;
    for (unsigned i = 0; i < N; ++i)
    {
      local[i] = this->Vertices[simplex[i]].Local;
    }
    for (unsigned i = 0; i < N; ++i)
    {
      const std::uint32_t partner = facets.Match(FaceOf(local, i), number * N + i);
      this->Simplices[s].N[i] = None;
      if (partner != FacetTable<D>::Nothing)
      {
        this->Simplices[s].N[i] = made[partner / N];
        this->Simplices[made[partner / N]].N[partner % N] = s;
      }
    }
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
bool Triangulation<D>::InConflictExactly(Worker& worker, SimplexId s, const Point<D>& p) const
{
  ++worker.BallFailures;
  const Simplex& simplex = this->Simplices[s];
  for (VertexId v : simplex.V)
  {
    if (this->Position(v) == p)
    {
      return false; // p is on the sphere, and the perturbation needs distinct points
    }
  }
  return worker.Predicates.InSpherePerturbed(this->Points(simplex.V).data(), p);
}

//------------------------------------------------------------------------------------------------
template <int D>
Circumball<D> Triangulation<D>::ComputeBallExactly(SimplexId s) const
{
  const Simplex& simplex = this->Simplices[s];
  Circumball<D> ball = simplex.Ball;
  ComputeCircumballExactly<D>(this->Points(simplex.V).data(), ball);
  return ball;
}

//------------------------------------------------------------------------------------------------
// Afterwards the free list has at least n ids, and room for the ids that the operation will free.
template <int D>
void Triangulation<D>::ReserveSimplices(Worker& worker, std::size_t n)
{
  Stack<SimplexId>& free = worker.FreeSimplices;
  worker.Created.Resize(n);
  free.ReserveMore(n + SimplexBlock + worker.Deleted.Size());
  while (free.Size() < n)
  {
    // Ids are handed out only when their records exist. So a loop over all ids finds only records
    // that exist.
    SimplexId first = this->NextSimplex.load(std::memory_order_relaxed);
    do
    {
      if (first > None - 2 * SimplexBlock)
      {
        throw std::bad_alloc();
      }
      this->Simplices.Grow(first + SimplexBlock);
      this->Marks.Grow(first + SimplexBlock);
      this->States.Grow(first + SimplexBlock);
    } while (!this->NextSimplex.compare_exchange_weak(
      first, first + SimplexBlock, std::memory_order_relaxed));
    for (std::uint32_t i = SimplexBlock; i-- > 0;)
    {
      free.Push(first + i);
    }
  }
}

//------------------------------------------------------------------------------------------------
// Afterwards the worker owns the vertex on top of its free list. Another worker may own this vertex
// for a moment, after a wrong guess in Lock(). Then this worker takes a new block: no other worker
// can guess its vertices.
template <int D>
void Triangulation<D>::ReserveVertex(Worker& worker)
{
  Stack<VertexId>& free = worker.FreeVertices;
  if (!free.Empty() && (worker.Id == 0 || this->TryLock(worker, free.Back())))
  {
    return;
  }
  free.ReserveMore(VertexBlock);
  VertexId first = this->NextVertex.load(std::memory_order_relaxed);
  do
  {
    if (first > None - 2 * VertexBlock)
    {
      throw std::bad_alloc();
    }
    this->Vertices.Grow(first + VertexBlock);
  } while (
    !this->NextVertex.compare_exchange_weak(first, first + VertexBlock, std::memory_order_relaxed));
  for (std::uint32_t i = VertexBlock; i-- > 0;)
  {
    free.Push(first + i);
  }
  if (worker.Id != 0)
  {
    this->TryLock(worker, free.Back());
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
std::uint64_t Triangulation<D>::MemoryBytes() const
{
  return this->SimplexIdEnd() * (sizeof(Simplex) + sizeof(SimplexMark) + sizeof(SimplexState)) +
    this->VertexIdEnd() * sizeof(Vertex);
}

template class Triangulation<3>;
template class Triangulation<4>;

} // namespace voxplex
