// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Walks to a simplex in conflict with a point.
#include "Delaunay/Triangulation.h"

namespace voxplex
{

//------------------------------------------------------------------------------------------------
// A visibility walk that reads one record per neighbour. The plane of the facet between two
// simplices is the radical plane of their circumspheres. So p lies beyond the facet if and only if
// its power to the neighbour's sphere is smaller. With rounding, the walk may end in the wrong
// simplex. Then a walk by exact orientations continues.
//
// Begins in s. Calls enter(next) before it goes on to the next simplex; if the result is false,
// stops and returns false. Otherwise s receives the simplex in conflict, or None if p is a vertex.
template <int D>
template <typename Enter>
bool Triangulation<D>::WalkTo(Worker& worker, const Point<D>& p, SimplexId& s, Enter&& enter) const
{
  double power = Distance2(p, this->Simplices[s].Ball.Center) - this->Simplices[s].Ball.Radius2;
  bool moved = true;
  while (moved && !(power < 0.0))
  {
    moved = false;
    SimplexId next = s;
    for (SimplexId n : this->Simplices[s].N)
    {
      if (n != None)
      {
        const Circumball<D>& ball = this->Simplices[n].Ball;
        const double other = Distance2(p, ball.Center) - ball.Radius2;
        if (other < power)
        {
          power = other;
          next = n;
          moved = true;
        }
      }
    }
    if (moved && !enter(next))
    {
      return false;
    }
    s = next;
  }
  return this->InConflict(worker, s, p) || this->WalkExactly(worker, p, s, enter);
}

//------------------------------------------------------------------------------------------------
template <int D>
template <typename Enter>
bool Triangulation<D>::WalkExactly(
  Worker& worker, const Point<D>& p, SimplexId& s, Enter&& enter) const
{
  SimplexId previous = None;
  for (unsigned turn = 0;; ++turn)
  {
    const Simplex& simplex = this->Simplices[s];
    std::array<const Point<D>*, N> points = this->Points(simplex.V);
    SimplexId next = None;
    for (unsigned k = 0; k < N && next == None; ++k)
    {
      const unsigned i = (k + turn) % N; // the first facet changes; the walk cannot cycle anyway
      if (simplex.N[i] == None || simplex.N[i] == previous)
      {
        continue;
      }
      const Point<D>* vertex = points[i];
      points[i] = &p;
      if (worker.Predicates.Orientation(points.data()) < 0)
      {
        next = simplex.N[i];
      }
      points[i] = vertex;
    }
    if (next == None)
    {
      break; // s contains p
    }
    if (!enter(next))
    {
      return false;
    }
    previous = s;
    s = next;
  }
  s = this->InConflict(worker, s, p) ? s : None;
  return true;
}

//------------------------------------------------------------------------------------------------
template <int D>
SimplexId Triangulation<D>::FindConflict(Worker& worker, const Point<D>& p, SimplexId hint) const
{
  SimplexId s = hint;
  this->WalkTo(worker, p, s, [](SimplexId) { return true; });
  return s;
}

//------------------------------------------------------------------------------------------------
// The worker owns all vertices of the simplex where the walk is. So it may read the neighbours, and
// no other worker deletes them.
template <int D>
LocationOutcome Triangulation<D>::FindConflictBesideOthers(
  Worker& worker, const Point<D>& p, VertexId near, SimplexId& conflict)
{
  const auto enter = [&](SimplexId s) { return this->TryLockAll(worker, this->Simplices[s].V); };
  if (!this->TryLock(worker, near))
  {
    return LocationOutcome::Contended;
  }
  conflict = this->Vertices[near].Incident;
  if (!enter(conflict) || !this->WalkTo(worker, p, conflict, enter))
  {
    return LocationOutcome::Contended;
  }
  return conflict != None ? LocationOutcome::Found : LocationOutcome::IsVertex;
}

template SimplexId Triangulation<3>::FindConflict(Worker&, const Point<3>&, SimplexId) const;
template SimplexId Triangulation<4>::FindConflict(Worker&, const Point<4>&, SimplexId) const;
template LocationOutcome Triangulation<3>::FindConflictBesideOthers(
  Worker&, const Point<3>&, VertexId, SimplexId&);
template LocationOutcome Triangulation<4>::FindConflictBesideOthers(
  Worker&, const Point<4>&, VertexId, SimplexId&);

} // namespace voxplex
