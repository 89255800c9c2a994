// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Removal of a vertex: the simplices of its star are deleted, and the hole is filled by gift
// wrapping from its boundary.
//
// In the Delaunay triangulation without the vertex, consider the simplex on the inner side of a
// facet of the hole. Its apex is in the link, and no other point of the link is in its circumball.
// With the symbolic perturbation this simplex is unique. So in-sphere tests alone find the apex of
// each open facet among the link's vertices, and the filling fits the simplices outside the hole.
// Floating-point numbers guess the apex first, and nearly always one look at the link certifies it.
#ifndef voxplex_Removal_txx
#define voxplex_Removal_txx

#include "Delaunay/Triangulation.h"
#include "Geometry/SimplexQuality.h"

#include <algorithm>
#include <limits>
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
    this->NumberStar(worker);
    if (!this->FillStar(worker, this->PlanesOfPoint(this->Position(v))))
    {
      this->RestoreMarks(worker);
      return RemovalOutcome::Failed;
    }
    this->ReserveSimplices(worker, worker.Star.Simplices.Size());
    worker.FreeVertices.ReserveMore(1);
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
// belongs to another worker. Each deleted simplex has one facet on the boundary, with the same
// number. What lies outside is only prefetched here (see NumberStar).
template <int D>
bool Triangulation<D>::CollectStar(Worker& worker, VertexId v)
{
  worker.Deleted.Clear();
  worker.Touched.Clear();
  worker.Boundary.Clear();
  const SimplexId first = this->Vertices[v].Incident;
  if (!this->TryLockAll(worker, this->Simplices[first].V))
  {
    return false;
  }
  worker.Deleted.ReserveMore(1);
  worker.Deleted.Push(first);
  this->Marks[first] = SimplexMark::Cavity;
  for (std::size_t k = 0; k < worker.Deleted.Size(); ++k)
  {
    const SimplexId s = worker.Deleted[k];
    const Simplex& simplex = this->Simplices[s];
    worker.Deleted.ReserveMore(N);
    worker.Boundary.ReserveMore(1);
    if (!this->TryLockAll(worker, simplex.V))
    {
      return false;
    }
    this->PrefetchStar(s, simplex);
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
      facet.OuterInFilling = false;
      facet.Closed = false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------------------------
template <int D>
inline void Triangulation<D>::PrefetchStar(
  [[maybe_unused]] SimplexId s, [[maybe_unused]] const Simplex& simplex) const
{
#if defined(__GNUC__)
  __builtin_prefetch(&this->States[s], 1);
  for (unsigned i = 0; i < N; ++i)
  {
    __builtin_prefetch(&this->Vertices[simplex.V[i]], 1);
    if (simplex.N[i] != None)
    {
      __builtin_prefetch(&this->Marks[simplex.N[i]], 1);
      __builtin_prefetch(&this->Simplices[simplex.N[i]], 1);
    }
  }
#endif
}

//------------------------------------------------------------------------------------------------
// Numbers the vertices of the link, and finds the facets among those of the simplices outside.
template <int D>
void Triangulation<D>::NumberStar(Worker& worker)
{
  worker.Link.Clear();
  worker.Link.ReserveMore(worker.Boundary.Size() * static_cast<std::size_t>(D));
  for (std::size_t k = 0; k < worker.Boundary.Size(); ++k)
  {
    BoundaryFacet& facet = worker.Boundary[k];
    for (unsigned j = 0; j < N; ++j)
    {
      if (j != facet.Apex)
      {
        facet.Local[j] = this->NumberVertex(worker, facet.V[j]);
      }
    }
    facet.OuterIndex =
      facet.Outer == None ? 0 : IndexOfNeighbour(this->Simplices[facet.Outer], worker.Deleted[k]);
  }
  worker.Star.Coordinates.Resize(worker.Link.Size());
  for (std::size_t k = 0; k < worker.Link.Size(); ++k)
  {
    worker.Star.Coordinates.Set(k, this->Position(worker.Link[k]));
  }
}

//------------------------------------------------------------------------------------------------
// worker.Boundary is the list of facets. The first facets bound the star. Then each simplex of the
// filling adds its facets that have no partner yet. If the vertex is on the box, the filling's
// facets on the same planes cover the area of the star's facets there.
template <int D>
bool Triangulation<D>::FillStar(Worker& worker, unsigned planes)
{
  StarFilling<D>& star = worker.Star;
  const std::size_t limit = 64 * (worker.Deleted.Size() + worker.Link.Size()) + 1024;
  star.Simplices.Clear();
  if (worker.Link.Size() > FacetTable<D>::MostVertices)
  {
    throw std::bad_alloc();
  }
  star.Front.Begin(2 * worker.Boundary.Size());
  for (std::size_t k = 0; k < worker.Boundary.Size(); ++k)
  {
    const BoundaryFacet& facet = worker.Boundary[k];
    star.Front.Match(FaceOf(facet.Local, facet.Apex), static_cast<std::uint32_t>(k));
  }
  for (std::size_t k = 0; k < worker.Boundary.Size(); ++k)
  {
    if (worker.Boundary[k].Closed)
    {
      continue;
    }
    worker.Boundary[k].Closed = true;
    BoundaryFacet facet = worker.Boundary[k];
    star.Simplices.ReserveMore(1);
    worker.Boundary.ReserveMore(N);
    FillingSimplex<D>& filling = star.Simplices.PushUninitialised();
    if (!this->FindApex(worker, facet, this->GuessApex(worker, k), filling.Ball) ||
      !this->FillFacet(worker, facet, planes) || star.Simplices.Size() > limit)
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------------------------
// The new simplex on a facet is the last of the filling. Connects it with the simplices at its facets,
// and adds those of its facets that are new.
template <int D>
bool Triangulation<D>::FillFacet(Worker& worker, const BoundaryFacet& facet, unsigned planes)
{
  StarFilling<D>& star = worker.Star;
  const std::uint32_t number = static_cast<std::uint32_t>(star.Simplices.Size() - 1);
  FillingSimplex<D>& filling = star.Simplices[number];
  const auto join = [&](unsigned i, const BoundaryFacet& met)
  {
    filling.Neighbours[i] = { met.Outer, met.OuterIndex, met.OuterInFilling };
    if (met.OuterInFilling)
    {
      star.Simplices[met.Outer].Neighbours[met.OuterIndex] = { number, i, true };
    }
  };
  filling.V = facet.V;
  join(facet.Apex, facet);
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
    const std::uint32_t partner =
      star.Front.Match(FaceOf(facet.Local, i), static_cast<std::uint32_t>(worker.Boundary.Size()));
    if (partner != FacetTable<D>::Nothing)
    {
      BoundaryFacet& met = worker.Boundary[partner];
      if (met.Closed)
      {
        return false; // a third simplex at this facet
      }
      met.Closed = true;
      join(i, met);
      continue;
    }
    // The same facet seen from the other side: an odd permutation, and vertex i is still unknown.
    BoundaryFacet& next = worker.Boundary.PushUninitialised();
    const unsigned a = i == 0 ? 1 : 0;
    const unsigned b = i <= 1 ? 2 : 1;
    next.V = facet.V;
    next.V[i] = None;
    std::swap(next.V[a], next.V[b]);
    next.Local = facet.Local;
    std::swap(next.Local[a], next.Local[b]);
    next.Apex = i;
    next.Outer = number;
    next.OuterIndex = i;
    next.OuterInFilling = true;
    next.Closed = false;
  }
  return true;
}

//------------------------------------------------------------------------------------------------
// The pencil of balls through a facet starts with that of the simplex beyond it: a deleted one inside
// the star's boundary, one of the filling inside the star. Both are empty of the link's vertices.
// Returns a number in worker.Link, or Nothing.
template <int D>
std::uint32_t Triangulation<D>::GuessApex(Worker& worker, std::size_t k) const
{
  const BoundaryFacet& facet = worker.Boundary[k];
  const bool inside = facet.OuterInFilling;
  const SimplexId known = inside ? facet.Outer : worker.Deleted[k];
  const Circumball<D>& ball =
    inside ? worker.Star.Simplices[known].Ball : this->Simplices[known].Ball;
  const VertexId opposite = inside ? worker.Star.Simplices[known].V[facet.OuterIndex]
                                   : this->Simplices[known].V[facet.Apex];
  std::array<Point<D>, static_cast<std::size_t>(D)> points;
  unsigned m = 0;
  for (unsigned i = 0; i < N; ++i)
  {
    if (i != facet.Apex)
    {
      points[m++] = this->Position(facet.V[i]);
    }
  }
  Point<D> normal = FacetNormal(points);
  // A deleted simplex is on the side of the star, and one of the filling on the other.
  const double side = Dot(normal, Subtract(this->Position(opposite), points[0]));
  if ((side < 0.0) != inside)
  {
    for (double& x : normal)
    {
      x = -x;
    }
  }
  return worker.Star.Coordinates.FirstOfPencil(ball, points[0], normal, facet.Local, facet.Apex);
}

//------------------------------------------------------------------------------------------------
// Finds the link's vertex on the inner side of the facet that spans an empty circumball with it, and
// this ball. Starts with the guess, if there is one. Returns false if no vertex is on this side.
template <int D>
bool Triangulation<D>::FindApex(
  Worker& worker, BoundaryFacet& facet, std::uint32_t guess, Circumball<D>& ball)
{
  std::array<const Point<D>*, N> points;
  for (unsigned i = 0; i < N; ++i)
  {
    points[i] = i == facet.Apex ? nullptr : &this->Position(facet.V[i]);
  }
  bool found = false;
  bool reliable = false;
  const auto becomeApex = [&](std::uint32_t local)
  {
    const Point<D>* previous = points[facet.Apex];
    points[facet.Apex] = &this->Position(worker.Link[local]);
    if (worker.Predicates.Orientation(points.data()) <= 0)
    {
      points[facet.Apex] = previous;
      return;
    }
    found = true;
    facet.V[facet.Apex] = worker.Link[local];
    facet.Local[facet.Apex] = local;
    reliable = ComputeCircumball<D>(points.data(), ball);
  };
  if (guess != LinkCoordinates<D>::Nothing)
  {
    becomeApex(guess);
    if (reliable && worker.Star.Coordinates.IsCertainlyEmpty(ball))
    {
      return true;
    }
  }
  for (std::uint32_t k = 0; k < worker.Link.Size(); ++k)
  {
    const VertexId v = worker.Link[k];
    if (std::find(facet.V.begin(), facet.V.end(), v) != facet.V.end())
    {
      continue;
    }
    if (found)
    {
      const Point<D>& x = this->Position(v);
      const int side = reliable ? SideOfCircumball(ball, x) : 0;
      if (side < 0 || (side == 0 && !worker.Predicates.InSpherePerturbed(points.data(), x)))
      {
        continue;
      }
    }
    becomeApex(k);
  }
  if (!reliable)
  {
    ball.Radius2 = std::numeric_limits<double>::quiet_NaN();
  }
  return found;
}

//------------------------------------------------------------------------------------------------
// The vertices of a facet, without that at position `apex`.
template <int D>
inline typename FacetTable<D>::Face Triangulation<D>::FaceOf(
  const std::array<std::uint32_t, N>& local, unsigned apex)
{
  typename FacetTable<D>::Face face;
  for (unsigned m = 0; m < face.size(); ++m)
  {
    face[m] = local[m + (m >= apex ? 1 : 0)];
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
  for (std::size_t k = 0; k < worker.Star.Simplices.Size(); ++k)
  {
    const FillingSimplex<D>& filling = worker.Star.Simplices[k];
    const SimplexId s = worker.Created[k];
    Simplex& simplex = this->Simplices[s];
    assert(this->OwnsAll(worker, filling.V));
    this->SetVertices(simplex, filling.V);
    simplex.Ball = filling.Ball;
    for (unsigned i = 0; i < N; ++i)
    {
      this->Vertices[filling.V[i]].Incident = s;
      const typename FillingSimplex<D>::Neighbour& n = filling.Neighbours[i];
      simplex.N[i] = n.InFilling ? worker.Created[n.Id] : n.Id;
      if (!n.InFilling && n.Id != None)
      {
        assert(this->OwnsFacet(worker, n.Id));
        this->Simplices[n.Id].N[n.Index] = s;
      }
    }
  }
  worker.NumberOfCreated += worker.Star.Simplices.Size();
}

} // namespace voxplex

#endif
