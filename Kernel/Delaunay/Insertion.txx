// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Insertion of a point (Bowyer, Watson): the cavity, the simplices in conflict with the point, is
// collected from a seed. Its simplices are deleted. Then it is filled with the cone from the point
// over the cavity's boundary.
#ifndef voxplex_Insertion_txx
#define voxplex_Insertion_txx

#include "Delaunay/Triangulation.h"

#include <new>

namespace voxplex
{

//------------------------------------------------------------------------------------------------
template <int D>
InsertionOutcome Triangulation<D>::Insert(Worker& worker, const Point<D>& p, VertexKind kind,
  SimplexId seed, double clearance, InsertionVeto* veto)
{
  assert(this->OwnsFacet(worker, seed));
  if (!this->InConflict(worker, seed, p))
  {
    for (VertexId v : this->Simplices[seed].V)
    {
      if (this->Position(v) == p)
      {
        return InsertionOutcome::Duplicate;
      }
    }
    return InsertionOutcome::NoConflict;
  }
  try
  {
    if (!this->CollectCavity(worker, p, seed))
    {
      this->RestoreMarks(worker);
      return InsertionOutcome::Contended;
    }
    if (clearance > 0.0 && !this->IsClear(worker, p, kind, clearance))
    {
      this->RestoreMarks(worker);
      return InsertionOutcome::TooClose;
    }
    if (veto && !veto->Accepts(worker))
    {
      this->RestoreMarks(worker);
      return InsertionOutcome::Rejected;
    }
    this->ReserveSimplices(worker, worker.Boundary.Size());
    this->ReserveVertex(worker);
    // Each facet has D ridges. Two facets share a ridge, except on the cavity's rim at the box.
    const std::size_t ridges = worker.Boundary.Size() * static_cast<std::size_t>(D);
    worker.Ridges.Begin(this->PlanesOfPoint(p) == 0 ? ridges / 2 : ridges);
    if (worker.Link.Size() > RidgeTable<D>::MostVertices)
    {
      throw std::bad_alloc(); // tens of millions of simplices in one cavity
    }
  }
  catch (...)
  {
    this->RestoreMarks(worker);
    throw;
  }
  worker.NewVertex = this->NewVertex(worker, p, kind);
  this->FillCavity(worker, worker.NewVertex);
  return InsertionOutcome::Inserted;
}

//------------------------------------------------------------------------------------------------
// Breadth-first search over neighbours. Simplices in conflict are marked Cavity. A simplex that joins
// the cavity adds at most one new vertex. The vertices of a simplex are taken before its neighbours
// are tested. Returns false if a vertex belongs to another worker.
//
// A simplex without conflict is tested again from each of its neighbours in the cavity: a test costs
// less than a mark that has to be restored. Only if exact arithmetic has decided, it is marked Outside.
template <int D>
bool Triangulation<D>::CollectCavity(Worker& worker, const Point<D>& p, SimplexId seed)
{
  worker.Deleted.Clear();
  worker.Touched.Clear();
  worker.Boundary.Clear();
  worker.Link.Clear();
  worker.LinkOffsets.Clear();
  worker.LinkNorms2.Clear();
  const unsigned planes = this->PlanesOfPoint(p);

  if (!this->TryLockAll(worker, this->Simplices[seed].V))
  {
    return false;
  }
  worker.Deleted.ReserveMore(1);
  worker.Deleted.Push(seed);
  this->Marks[seed] = SimplexMark::Cavity;
  worker.Joined.Clear();
  worker.Joined.ReserveMore(N);
  for (VertexId v : this->Simplices[seed].V)
  {
    worker.Joined.Push(v);
  }
  if (worker.Help.Offered())
  {
    return this->ExpandWithHelp(worker, p, planes);
  }
  for (std::size_t k = 0; k < worker.Deleted.Size(); ++k)
  {
    const SimplexId s = worker.Deleted[k];
    const Simplex& simplex = this->Simplices[s];
    worker.Deleted.ReserveMore(N);
    worker.Touched.ReserveMore(N);
    worker.Boundary.ReserveMore(N);
    worker.Joined.ReserveMore(N);
    worker.Owned.ReserveMore(1);
    if (k > 0 && !this->TryOwn(worker, worker.Joined[k + N - 1])) // the vertex that s added
    {
      return false;
    }
    for (unsigned i = 0; i < N; ++i)
    {
      const SimplexId n = simplex.N[i];
      std::uint32_t back = 0;
      if (n != None)
      {
        assert(this->OwnsFacet(worker, n));
        SimplexMark& mark = this->Marks[n];
        if (mark == SimplexMark::Cavity)
        {
          continue;
        }
        const Simplex& neighbour = this->Simplices[n];
        back = IndexOfNeighbour(neighbour, s);
        ++worker.BallTests;
        const int side = SideOfCircumball(neighbour.Ball, p);
        bool inConflict = side > 0;
        if (side == 0 && mark == SimplexMark::Alive) [[unlikely]]
        {
          inConflict = this->InConflictExactly(worker, n, p);
          if (!inConflict)
          {
            worker.Touched.Push(n);
            mark = SimplexMark::Outside;
          }
        }
        if (inConflict)
        {
          worker.Deleted.Push(n);
          mark = SimplexMark::Cavity;
          worker.Joined.Push(neighbour.V[back]);
          this->Prefetch(n, neighbour, neighbour.V[back]);
          continue;
        }
      }
      else if (planes != 0 && this->OnPlane(simplex.V, i, planes))
      {
        continue; // the point lies in this facet's plane on the box: the cone would be flat
      }
      BoundaryFacet& facet = worker.Boundary.PushUninitialised();
      facet.V = simplex.V;
      facet.Apex = i;
      facet.Outer = n;
      facet.OuterIndex = back;
    }
  }
  this->NumberLink(worker, p);
  return true;
}

//------------------------------------------------------------------------------------------------
// Numbers the link's vertices, and stores their offsets from the apex for the circumballs. Every
// vertex of the cavity is on its boundary (no vertex disappears). Joined has all of them, some more
// than once. There is no branch, since it would be unpredictable: the data of a vertex that already
// has a number are computed again, and written beyond the end.
template <int D>
inline void Triangulation<D>::NumberLink(Worker& worker, const Point<D>& apex)
{
  const std::size_t most = worker.Joined.Size();
  worker.Link.Resize(most);
  worker.LinkOffsets.Resize(most);
  worker.LinkNorms2.Resize(most);
  std::uint32_t count = 0;
  for (const VertexId v : worker.Joined)
  {
    assert(this->Owns(worker, v));
    Vertex& vertex = this->Vertices[v];
    const bool isNew = vertex.Local >= count || worker.Link[vertex.Local] != v;
    vertex.Local = isNew ? count : vertex.Local;
    worker.Link[count] = v;
    worker.LinkOffsets[count] = Subtract(vertex.Position, apex);
    worker.LinkNorms2[count] = SquaredNorm(worker.LinkOffsets[count]);
    count += isNew ? 1 : 0;
  }
  worker.Link.Resize(count);
}

//------------------------------------------------------------------------------------------------
// The search is bound by memory latency. When a simplex joins the cavity, this prefetches the data
// that the search will read next.
template <int D>
inline void Triangulation<D>::Prefetch([[maybe_unused]] SimplexId s,
  [[maybe_unused]] const Simplex& simplex, [[maybe_unused]] VertexId newVertex) const
{
#if defined(__GNUC__)
  __builtin_prefetch(&this->States[s], 1);
  __builtin_prefetch(&this->Vertices[newVertex], 1);
  for (const SimplexId n : simplex.N)
  {
    if (n != None)
    {
      __builtin_prefetch(&this->Marks[n], 1);
      __builtin_prefetch(&this->Simplices[n]);
    }
  }
#endif
}

//------------------------------------------------------------------------------------------------
// It suffices to test the link: the vertex nearest to p is on the boundary of the cavity.
template <int D>
bool Triangulation<D>::IsClear(
  Worker& worker, const Point<D>& p, VertexKind kind, double clearance) const
{
  for (const VertexId v : worker.Link)
  {
    const Vertex& vertex = this->Vertices[v];
    const bool givesWay = kind == VertexKind::Feature &&
      (vertex.Kind == VertexKind::Free || vertex.Kind == VertexKind::Shared);
    if (!givesWay && Distance2(vertex.Position, p) < clearance * clearance)
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------------------------
// Nothing here throws, since all memory has been reserved.
template <int D>
void Triangulation<D>::FillCavity(Worker& worker, VertexId apex)
{
  for (SimplexId s : worker.Deleted)
  {
    this->Kill(worker, s);
  }
  for (SimplexId s : worker.Touched)
  {
    assert(this->OwnsFacet(worker, s));
    this->Marks[s] = SimplexMark::Alive;
  }

  const Point<D> p = this->Position(apex);
  const std::uint32_t count = static_cast<std::uint32_t>(worker.Boundary.Size());
  if (count >= worker.Help.FewestBalls && worker.Help.Offered())
  {
    this->FillWithHelp(worker, apex);
    return;
  }
  for (std::uint32_t k = 0; k < count; ++k)
  {
    BoundaryFacet& facet = worker.Boundary[k];
    const SimplexId s = this->NewSimplex(worker);
    worker.Created[k] = s;
    Simplex& simplex = this->Simplices[s];
    this->PlaceSimplex(worker, s, simplex, facet, apex);
    this->SetBall(worker, simplex, facet, p);
  }
  this->Vertices[apex].Incident = worker.Created[0];
  this->LinkRidges(worker);
  worker.NumberOfCreated += count;
}

//------------------------------------------------------------------------------------------------
// Writes the new simplex on a facet of the boundary, without its ball and its new neighbours.
template <int D>
inline void Triangulation<D>::PlaceSimplex([[maybe_unused]] const Worker& worker, SimplexId s,
  Simplex& simplex, BoundaryFacet& facet, VertexId apex)
{
  facet.V[facet.Apex] = apex;
  assert(this->OwnsAll(worker, facet.V));
  this->SetVertices(simplex, facet.V);
  for (unsigned m = 0; m < static_cast<unsigned>(D); ++m)
  {
    const unsigned i = m + (m >= facet.Apex ? 1 : 0);
    Vertex& vertex = this->Vertices[facet.V[i]];
    vertex.Incident = s;
    facet.Local[i] = vertex.Local;
  }
  simplex.N[facet.Apex] = facet.Outer;
  if (facet.Outer != None)
  {
    assert(this->OwnsFacet(worker, facet.Outer));
    this->Simplices[facet.Outer].N[facet.OuterIndex] = s;
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
inline void Triangulation<D>::SetBall(
  const Worker& worker, Simplex& simplex, const BoundaryFacet& facet, const Point<D>& apex)
{
  std::array<Point<D>, static_cast<std::size_t>(D)> edges;
  Point<D> norms2;
  for (unsigned m = 0; m < static_cast<unsigned>(D); ++m)
  {
    const std::uint32_t local = facet.Local[m + (m >= facet.Apex ? 1 : 0)];
    edges[m] = worker.LinkOffsets[local];
    norms2[m] = worker.LinkNorms2[local];
  }
  if (!ComputeCircumball<D>(apex, edges, norms2, simplex.Ball))
  {
    simplex.Ball.Radius2 = std::numeric_limits<double>::quiet_NaN();
  }
}

//------------------------------------------------------------------------------------------------
// If two new simplices share a ridge, they are neighbours. Their common facet is the ridge with the
// apex.
template <int D>
inline void Triangulation<D>::LinkRidges(Worker& worker)
{
  if constexpr (D == 3)
  {
    if (worker.Link.Size() <= EdgeTable::MostVertices)
    {
      this->LinkEdges(worker, this->PlanesOfPoint(this->Position(worker.NewVertex)) == 0);
      return;
    }
  }
  for (std::uint32_t k = 0; k < worker.Boundary.Size(); ++k)
  {
    const BoundaryFacet& facet = worker.Boundary[k];
    const SimplexId s = worker.Created[k];
    Simplex& simplex = this->Simplices[s];
    for (unsigned i = 0; i < N; ++i)
    {
      if (i == facet.Apex)
      {
        continue;
      }
      typename RidgeTable<D>::Face ridge;
      unsigned m = 0;
      for (unsigned j = 0; j < N; ++j)
      {
        if (j != i && j != facet.Apex)
        {
          ridge[m++] = facet.Local[j];
        }
      }
      const std::uint32_t partner = worker.Ridges.Match(ridge, k * N + i);
      if (partner == RidgeTable<D>::Nothing)
      {
        simplex.N[i] = None; // until the partner is found; on the box there is none
        continue;
      }
      const SimplexId t = worker.Created[partner / N];
      simplex.N[i] = t;
      this->Simplices[t].N[partner % N] = s;
    }
  }
}

//------------------------------------------------------------------------------------------------
// (apex, i, From, To) is an even permutation of the tetrahedron's vertices. So, seen from the apex,
// the edge opposite i has opposite directions in this tetrahedron and in its neighbour.
template <int D>
inline void Triangulation<D>::LinkEdges(Worker& worker, bool closed) requires(D == 3)
{
  // clang-format off
  static constexpr std::uint8_t From[4][4] = { { 0, 2, 3, 1 }, { 3, 0, 0, 2 }, { 1, 3, 0, 0 }, { 2, 0, 1, 0 } };
  static constexpr std::uint8_t To[4][4]   = { { 0, 3, 1, 2 }, { 2, 0, 3, 0 }, { 3, 0, 0, 1 }, { 1, 2, 0, 0 } };
  // clang-format on
  EdgeTable& edges = worker.Edges;
  edges.Begin(worker.Link.Size(), closed);
  const std::uint32_t count = static_cast<std::uint32_t>(worker.Boundary.Size());
  for (std::uint32_t k = 0; k < count; ++k)
  {
    const BoundaryFacet& facet = worker.Boundary[k];
    for (unsigned m = 0; m < 3; ++m)
    {
      const unsigned i = m + (m >= facet.Apex ? 1 : 0);
      edges.Store(
        facet.Local[From[facet.Apex][i]], facet.Local[To[facet.Apex][i]], worker.Created[k]);
    }
  }
  for (std::uint32_t k = 0; k < count; ++k)
  {
    const BoundaryFacet& facet = worker.Boundary[k];
    Simplex& simplex = this->Simplices[worker.Created[k]];
    for (unsigned m = 0; m < 3; ++m)
    {
      const unsigned i = m + (m >= facet.Apex ? 1 : 0);
      simplex.N[i] = edges.Find(facet.Local[To[facet.Apex][i]], facet.Local[From[facet.Apex][i]]);
    }
  }
}

//------------------------------------------------------------------------------------------------
// Bit 2a is 1 if p is on the lower face of axis a, bit 2a+1 if p is on the upper face.
template <int D>
unsigned Triangulation<D>::PlanesOfPoint(const Point<D>& p) const
{
  unsigned planes = 0;
  for (unsigned a = 0; a < static_cast<unsigned>(D); ++a)
  {
    planes |= (p[a] == this->Domain.Min[a] ? 1u : 0u) << (2 * a);
    planes |= (p[a] == this->Domain.Max[a] ? 1u : 0u) << (2 * a + 1);
  }
  return planes;
}

//------------------------------------------------------------------------------------------------
template <int D>
bool Triangulation<D>::OnPlane(
  const std::array<VertexId, N>& v, unsigned except, unsigned planes) const
{
  for (unsigned i = 0; i < N && planes != 0; ++i)
  {
    if (i != except)
    {
      planes &= this->PlanesOfPoint(this->Position(v[i]));
    }
  }
  return planes != 0;
}

//------------------------------------------------------------------------------------------------
template <int D>
void Triangulation<D>::RestoreMarks(Worker& worker)
{
  for (SimplexId s : worker.Deleted)
  {
    assert(this->OwnsFacet(worker, s));
    this->Marks[s] = SimplexMark::Alive;
  }
  for (SimplexId s : worker.Touched)
  {
    assert(this->OwnsFacet(worker, s));
    this->Marks[s] = SimplexMark::Alive;
  }
}

} // namespace voxplex

#endif
