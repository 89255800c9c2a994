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
template <int D>
SimplexId Triangulation<D>::FindConflict(Worker& worker, const Point<D>& p, SimplexId hint) const
{
  SimplexId s = hint;
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
    s = next;
  }
  return this->InConflict(worker, s, p) ? s : this->WalkExactly(worker, p, s);
}

//------------------------------------------------------------------------------------------------
template <int D>
SimplexId Triangulation<D>::WalkExactly(Worker& worker, const Point<D>& p, SimplexId s) const
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
    if (next == None) // s contains p
    {
      return this->InConflict(worker, s, p) ? s : None;
    }
    previous = s;
    s = next;
  }
}

template SimplexId Triangulation<3>::FindConflict(Worker&, const Point<3>&, SimplexId) const;
template SimplexId Triangulation<3>::WalkExactly(Worker&, const Point<3>&, SimplexId) const;
template SimplexId Triangulation<4>::FindConflict(Worker&, const Point<4>&, SimplexId) const;
template SimplexId Triangulation<4>::WalkExactly(Worker&, const Point<4>&, SimplexId) const;

} // namespace voxplex
