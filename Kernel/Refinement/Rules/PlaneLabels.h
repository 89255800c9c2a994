// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PlaneLabels.h
 * @brief The labels of pentatopes beside time planes.
 */
#ifndef voxplex_PlaneLabels_h
#define voxplex_PlaneLabels_h

#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"

#include <array>
#include <optional>

namespace voxplex
{

/** The vertices of a facet. */
using FacetVertices = std::array<VertexId, 4>;

/**
 * The facet of a pentatope that lies in one time, if this is the time of a plane. A pentatope has one
 * such facet at most.
 * @param timeOf gives the time of a vertex
 * @param isPlane tells whether a time is that of a plane
 */
template <typename TimeOf, typename IsPlane>
std::optional<FacetVertices> FacetOnPlane(
  const std::array<VertexId, 5>& v, const TimeOf& timeOf, const IsPlane& isPlane)
{
  // A facet has one of the first two vertices at least.
  for (unsigned i = 0; i < 2; ++i)
  {
    const double time = timeOf(v[i]);
    FacetVertices facet{};
    unsigned vertices = 0;
    for (const VertexId vertex : v)
    {
      if (timeOf(vertex) == time && vertices++ < 4)
      {
        facet[vertices - 1] = vertex;
      }
    }
    if (vertices == 4 && isPlane(time))
    {
      return facet;
    }
  }
  return std::nullopt;
}

template <typename IsPlane>
std::optional<FacetVertices> FacetOnPlane(
  const Triangulation<4>& mesh, SimplexId s, const IsPlane& isPlane)
{
  return FacetOnPlane(
    mesh.GetSimplex(s).V, [&mesh](VertexId v) { return mesh.Position(v)[3]; }, isPlane);
}

/**
 * The centre of the circumball of a facet of constant time. It is the same for all orders of the corners, and
 * so from both sides of a plane.
 */
Point<4> CentreOnPlane(const Triangulation<4>& mesh, const FacetVertices& facet);

} // namespace voxplex

#endif
