// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangulationVerifier.h
 * @brief Checks the invariants of a triangulation with exact predicates.
 */
#ifndef voxplex_checks_TriangulationVerifier_h
#define voxplex_checks_TriangulationVerifier_h

#include "Delaunay/Triangulation.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

namespace voxplex
{

/** A friend of the triangulation, since marks are private. */
template <int D>
class TriangulationVerifier
{
public:
  explicit TriangulationVerifier(const Triangulation<D>& mesh)
    : Mesh(mesh)
    , Exact(mesh.GetBox().Min, mesh.GetBox().Max)
  {
  }

  /**
   * Checks orientations, mutual neighbours, shared facets, the hull on the box, the local
   * (perturbed) Delaunay property, and incidence.
   * @return the violations; empty if there are none
   */
  std::vector<std::string> Verify()
  {
    for (SimplexId s = 0; s < this->Mesh.SimplexIdEnd(); ++s)
    {
      if (this->Mesh.IsAlive(s))
      {
        if (this->Mesh.Marks[s] != SimplexMark::Alive)
        {
          this->Complain("simplex ", s, " kept a mark of an operation");
        }
        this->VerifySimplex(s);
      }
    }
    for (VertexId v = 0; v < this->Mesh.VertexIdEnd(); ++v)
    {
      const auto& vertex = this->Mesh.GetVertex(v);
      if (vertex.Alive && !this->Contains(vertex.Incident, v))
      {
        this->Complain("vertex ", v, " has an incident simplex that does not contain it");
      }
    }
    return this->Complaints;
  }

private:
  static constexpr unsigned N = D + 1;
  static constexpr std::size_t MostComplaints = 100;

  template <typename... Args>
  void Complain(const Args&... args)
  {
    if (this->Complaints.size() < MostComplaints)
    {
      std::ostringstream text;
      (text << ... << args);
      this->Complaints.push_back(text.str());
    }
  }

  bool Contains(SimplexId s, VertexId v) const
  {
    const auto& vertices = this->Mesh.GetSimplex(s == None ? 0 : s).V;
    return s != None && this->Mesh.IsAlive(s) &&
      std::find(vertices.begin(), vertices.end(), v) != vertices.end();
  }

  void VerifySimplex(SimplexId s)
  {
    const auto& simplex = this->Mesh.GetSimplex(s);
    std::array<const Point<D>*, N> points;
    for (unsigned i = 0; i < N; ++i)
    {
      const VertexId v = simplex.V[i];
      if (v >= this->Mesh.VertexIdEnd() || !this->Mesh.GetVertex(v).Alive)
      {
        this->Complain("simplex ", s, " has the dead vertex ", v);
        return;
      }
      points[i] = &this->Mesh.Position(v);
    }
    if (this->Exact.Orientation(points.data()) <= 0)
    {
      this->Complain("simplex ", s, " is flat or inverted");
      return;
    }
    for (unsigned i = 0; i < N; ++i)
    {
      this->VerifyFacet(s, i, points);
    }
  }

  void VerifyFacet(SimplexId s, unsigned i, const std::array<const Point<D>*, N>& points)
  {
    const auto& simplex = this->Mesh.GetSimplex(s);
    const SimplexId n = simplex.N[i];
    if (n == None)
    {
      if (!this->Mesh.OnPlane(simplex.V, i, (1u << (2 * D)) - 1))
      {
        this->Complain("facet ", i, " of simplex ", s, " has no neighbour off the box");
      }
      return;
    }
    if (!this->Mesh.IsAlive(n))
    {
      this->Complain("simplex ", s, " has the dead neighbour ", n);
      return;
    }
    const auto& other = this->Mesh.GetSimplex(n);
    unsigned back = 0;
    while (back < N && other.N[back] != s)
    {
      ++back;
    }
    if (back == N)
    {
      this->Complain("simplex ", n, " does not know its neighbour ", s);
      return;
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
        this->Complain("simplices ", s, " and ", n, " do not share their common facet");
      }
    }
    if (this->Exact.InSpherePerturbed(points.data(), this->Mesh.Position(other.V[back])))
    {
      this->Complain("facet ", i, " of simplex ", s, " is not locally Delaunay");
    }
  }

  const Triangulation<D>& Mesh;
  Predicates<D> Exact;
  std::vector<std::string> Complaints;
};

namespace checks
{

/** See TriangulationVerifier::Verify(). */
template <int D>
std::vector<std::string> Verify(const Triangulation<D>& mesh)
{
  return TriangulationVerifier<D>(mesh).Verify();
}

} // namespace checks

} // namespace voxplex

#endif
