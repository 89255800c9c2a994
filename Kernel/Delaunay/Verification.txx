// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Checks the invariants of the triangulation with exact predicates.
#ifndef voxplex_Verification_txx
#define voxplex_Verification_txx

#include "Delaunay/Triangulation.h"

#include <sstream>

namespace voxplex
{

namespace
{
constexpr std::size_t MostComplaints = 100;

template <typename... Args>
void Complain(std::vector<std::string>& complaints, const Args&... args)
{
  if (complaints.size() < MostComplaints)
  {
    std::ostringstream text;
    (text << ... << args);
    complaints.push_back(text.str());
  }
}
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<std::string> Triangulation<D>::Verify(Worker& worker) const
{
  std::vector<std::string> complaints;
  for (SimplexId s = 0; s < this->SimplexIdEnd(); ++s)
  {
    if (!this->IsAlive(s))
    {
      continue;
    }
    if (this->Marks[s] != SimplexMark::Alive)
    {
      Complain(complaints, "simplex ", s, " kept a mark of an operation");
    }
    this->VerifySimplex(worker, s, complaints);
  }
  for (VertexId v = 0; v < this->VertexIdEnd(); ++v)
  {
    const Vertex& vertex = this->Vertices[v];
    if (!vertex.Alive)
    {
      continue;
    }
    const SimplexId s = vertex.Incident;
    bool found = false;
    if (s != None && this->IsAlive(s))
    {
      for (VertexId w : this->Simplices[s].V)
      {
        found |= w == v;
      }
    }
    if (!found)
    {
      Complain(complaints, "vertex ", v, " has an incident simplex that does not contain it");
    }
  }
  return complaints;
}

//------------------------------------------------------------------------------------------------
template <int D>
void Triangulation<D>::VerifySimplex(
  Worker& worker, SimplexId s, std::vector<std::string>& complaints) const
{
  const Simplex& simplex = this->Simplices[s];
  for (VertexId v : simplex.V)
  {
    if (v >= this->VertexIdEnd() || !this->Vertices[v].Alive)
    {
      Complain(complaints, "simplex ", s, " has the dead vertex ", v);
      return;
    }
  }
  const std::array<const Point<D>*, N> points = this->Points(simplex.V);
  if (worker.Predicates.Orientation(points.data()) <= 0)
  {
    Complain(complaints, "simplex ", s, " is flat or inverted");
    return;
  }
  for (unsigned i = 0; i < N; ++i)
  {
    const SimplexId n = simplex.N[i];
    if (n == None)
    {
      if (!this->OnPlane(simplex.V, i, (1u << (2 * D)) - 1))
      {
        Complain(complaints, "facet ", i, " of simplex ", s, " has no neighbour off the box");
      }
      continue;
    }
    if (!this->IsAlive(n))
    {
      Complain(complaints, "simplex ", s, " has the dead neighbour ", n);
      continue;
    }
    const Simplex& other = this->Simplices[n];
    unsigned back = 0;
    while (back < N && other.N[back] != s)
    {
      ++back;
    }
    if (back == N)
    {
      Complain(complaints, "simplex ", n, " does not know its neighbour ", s);
      continue;
    }
    for (unsigned j = 0; j < N; ++j)
    {
      bool shared = false;
      for (unsigned k = 0; k < N; ++k)
      {
        shared |= k != back && other.V[k] == simplex.V[j];
      }
      if (j != i && !shared)
      {
        Complain(complaints, "simplices ", s, " and ", n, " do not share their common facet");
      }
    }
    if (worker.Predicates.InSpherePerturbed(points.data(), this->Position(other.V[back])))
    {
      Complain(complaints, "facet ", i, " of simplex ", s, " is not locally Delaunay");
    }
  }
}

} // namespace voxplex

#endif
