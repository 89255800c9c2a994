// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Removal of a vertex: the simplices of its star are deleted, and the hole is filled by gift
// wrapping from its boundary.
//
// In the Delaunay triangulation without the vertex, consider the simplex on the inner side of a
// facet of the hole. Its apex is in the link, and no other point of the link is in its circumball.
// With the symbolic perturbation this simplex is unique. So in-sphere tests alone find the apex of
// each open facet among the link's vertices, and the filling fits the simplices outside the hole.
#ifndef voxplex_Removal_txx
#define voxplex_Removal_txx

#include "Delaunay/Triangulation.h"

#include <new>
#include <utility>

namespace voxplex
{

//------------------------------------------------------------------------------------------------
template <int D>
RemovalOutcome Triangulation<D>::Remove(Worker& worker, VertexId v)
{
  assert(this->Owns(worker, v));
  if (this->Vertices[v].Kind == VertexKind::Box || this->Vertices[v].Kind == VertexKind::Shared)
  {
    return RemovalOutcome::OnBox;
  }
  try
  {
    if (!this->CollectStar(worker, v))
    {
      this->RestoreMarks(worker);
      return RemovalOutcome::Contended;
    }
    if (!this->FillStar(worker, this->PlanesOfPoint(this->Position(v))))
    {
      this->RestoreMarks(worker);
      return RemovalOutcome::Failed;
    }
    this->ReserveSimplices(worker, worker.Filling.Size());
    worker.FreeVertices.MakeRoom(1);
  }
  catch (...)
  {
    this->RestoreMarks(worker);
    throw;
  }
  this->CommitFilling(worker);
  this->Vertices[v].Alive = false;
  worker.FreeVertices.Push(v);
  return RemovalOutcome::Removed;
}

//------------------------------------------------------------------------------------------------
// Takes the vertices of each simplex before its neighbours are read. Returns false if a vertex
// belongs to another worker.
template <int D>
bool Triangulation<D>::CollectStar(Worker& worker, VertexId v)
{
  worker.Deleted.Clear();
  worker.Touched.Clear();
  worker.Boundary.Clear();
  worker.Link.Clear();
  const SimplexId first = this->Vertices[v].Incident;
  if (!this->TryLockAll(worker, this->Simplices[first].V))
  {
    return false;
  }
  worker.Deleted.MakeRoom(1);
  worker.Deleted.Push(first);
  this->Marks[first] = SimplexMark::Cavity;
  for (std::size_t k = 0; k < worker.Deleted.Size(); ++k)
  {
    const SimplexId s = worker.Deleted[k];
    const Simplex& simplex = this->Simplices[s];
    worker.Deleted.MakeRoom(N);
    worker.Boundary.MakeRoom(1);
    worker.Link.MakeRoom(N);
    if (!this->TryLockAll(worker, simplex.V))
    {
      return false;
    }
    for (unsigned i = 0; i < N; ++i)
    {
      const SimplexId n = simplex.N[i];
      if (simplex.V[i] != v)
      {
        if (n != None && this->Marks[n] == SimplexMark::Alive)
        {
          assert(this->OwnsFacet(worker, n));
          this->Marks[n] = SimplexMark::Cavity;
          worker.Deleted.Push(n);
        }
        continue;
      }
      BoundaryFacet& facet = worker.Boundary.PushUninitialised();
      facet.V = simplex.V;
      facet.V[i] = None;
      facet.Apex = i;
      facet.Outer = n;
      facet.OuterIndex = n == None ? 0 : IndexOfNeighbour(this->Simplices[n], s);
      facet.OuterInFilling = false;
      for (unsigned j = 0; j < N; ++j)
      {
        if (j != i)
        {
          facet.Local[j] = this->NumberVertex(worker, simplex.V[j]);
        }
      }
    }
  }
  return true;
}

//------------------------------------------------------------------------------------------------
// worker.Boundary is the list of facets. The first facets bound the star. Then each simplex of the
// filling adds its facets that have no partner yet. If the vertex is on the box, the filling's
// facets on the same planes cover the area of the star's facets there.
template <int D>
bool Triangulation<D>::FillStar(Worker& worker, unsigned planes)
{
  const std::size_t limit = 64 * (worker.Deleted.Size() + worker.Link.Size()) + 1024;
  worker.Filling.Clear();
  if (worker.Link.Size() > FacetTable<D>::MostVertices)
  {
    throw std::bad_alloc();
  }
  worker.Front.Begin(2 * worker.Boundary.Size());
  for (std::size_t k = 0; k < worker.Boundary.Size(); ++k)
  {
    worker.Front.Match(this->LocalFacet(worker.Boundary[k]), static_cast<std::uint32_t>(k));
  }
  for (std::size_t k = 0; k < worker.Boundary.Size(); ++k)
  {
    BoundaryFacet facet = worker.Boundary[k];
    const typename FacetTable<D>::Face key = this->LocalFacet(facet);
    if (!worker.Front.IsOpen(key))
    {
      continue;
    }
    worker.Front.Match(key, 0); // closed from here on
    const VertexId apex = this->BestApex(worker, facet);
    if (apex == None || worker.Filling.Size() >= limit)
    {
      return false;
    }
    facet.V[facet.Apex] = apex;
    const std::uint32_t number = static_cast<std::uint32_t>(worker.Filling.Size());
    worker.Filling.MakeRoom(1);
    worker.Boundary.MakeRoom(N);
    FillingSimplex& filling = worker.Filling.PushUninitialised();
    filling.V = facet.V;
    filling.Neighbours[facet.Apex] = { facet.Outer, facet.OuterIndex, facet.OuterInFilling };
    if (facet.OuterInFilling)
    {
      worker.Filling[facet.Outer].Neighbours[facet.OuterIndex] = { number, facet.Apex, true };
    }
    for (unsigned i = 0; i < N; ++i)
    {
      if (i == facet.Apex)
      {
        continue;
      }
      if (planes != 0 && this->OnPlane(facet.V, i, planes))
      {
        filling.Neighbours[i] = { None, 0, false }; // on the box, as the removed facets were
        continue;
      }
      // The same facet seen from the other side: an odd permutation, and vertex i is still unknown.
      BoundaryFacet next;
      next.V = facet.V;
      next.V[i] = None;
      const unsigned a = i == 0 ? 1 : 0;
      const unsigned b = i <= 1 ? 2 : 1;
      std::swap(next.V[a], next.V[b]);
      next.Apex = i;
      next.Outer = number;
      next.OuterIndex = i;
      next.OuterInFilling = true;
      const std::uint32_t partner = worker.Front.Match(
        this->LocalFacet(next), static_cast<std::uint32_t>(worker.Boundary.Size()));
      if (partner == FacetTable<D>::Nothing)
      {
        worker.Boundary.Push(next);
        continue;
      }
      // The partner is an open facet in the list. Now both sides of the facet are known.
      const BoundaryFacet& met = worker.Boundary[partner];
      worker.Filling[number].Neighbours[i] = { met.Outer, met.OuterIndex, met.OuterInFilling };
      if (met.OuterInFilling)
      {
        worker.Filling[met.Outer].Neighbours[met.OuterIndex] = { number, i, true };
      }
    }
  }
  return true;
}

//------------------------------------------------------------------------------------------------
// Finds the link's vertex on the inner side of the facet that spans an empty circumball with it.
template <int D>
VertexId Triangulation<D>::BestApex(Worker& worker, const BoundaryFacet& facet)
{
  VertexId best = None;
  std::array<const Point<D>*, N> points;
  for (unsigned i = 0; i < N; ++i)
  {
    points[i] = i == facet.Apex ? nullptr : &this->Position(facet.V[i]);
  }
  Circumball<D> ball;
  bool reliable = false;
  for (VertexId v : worker.Link)
  {
    bool onFacet = false;
    for (VertexId w : facet.V)
    {
      onFacet |= w == v;
    }
    if (onFacet)
    {
      continue;
    }
    const Point<D>& x = this->Position(v);
    if (best != None)
    {
      const int side = reliable ? SideOfCircumball(ball, x) : 0;
      if (side < 0 || (side == 0 && !worker.Predicates.InSpherePerturbed(points.data(), x)))
      {
        continue;
      }
    }
    const Point<D>* previous = points[facet.Apex];
    points[facet.Apex] = &x;
    if (worker.Predicates.Orientation(points.data()) <= 0)
    {
      points[facet.Apex] = previous;
      continue;
    }
    best = v;
    reliable = ComputeCircumball<D>(points.data(), ball);
  }
  return best;
}

//------------------------------------------------------------------------------------------------
template <int D>
typename FacetTable<D>::Face Triangulation<D>::LocalFacet(const BoundaryFacet& facet) const
{
  typename FacetTable<D>::Face face{};
  unsigned m = 0;
  for (unsigned i = 0; i < N; ++i)
  {
    if (i != facet.Apex)
    {
      face[m++] = this->Vertices[facet.V[i]].Local;
    }
  }
  return face;
}

//------------------------------------------------------------------------------------------------
template <int D>
void Triangulation<D>::CommitFilling(Worker& worker)
{
  for (SimplexId s : worker.Deleted)
  {
    this->Kill(worker, s);
  }
  for (SimplexId& s : worker.Created)
  {
    s = this->NewSimplex(worker);
  }
  for (std::size_t k = 0; k < worker.Filling.Size(); ++k)
  {
    const FillingSimplex& filling = worker.Filling[k];
    const SimplexId s = worker.Created[k];
    this->WriteSimplex(worker, s, filling.V);
    for (unsigned i = 0; i < N; ++i)
    {
      const typename FillingSimplex::Neighbour& n = filling.Neighbours[i];
      this->Simplices[s].N[i] = n.InFilling ? worker.Created[n.Id] : n.Id;
      if (!n.InFilling && n.Id != None)
      {
        assert(this->OwnsFacet(worker, n.Id));
        this->Simplices[n.Id].N[n.Index] = s;
      }
    }
  }
  worker.NumberOfCreated += worker.Filling.Size();
}

} // namespace voxplex

#endif
