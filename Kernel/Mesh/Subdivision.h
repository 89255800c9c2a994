// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Subdivision.h
 * @brief Tetrahedra of a triangulation that a mesh has in pieces.
 */
#ifndef voxplex_Subdivision_h
#define voxplex_Subdivision_h

#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"
#include "Mesh/SimplexMesh.h"

#include <array>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** Part of a tetrahedron. */
struct Piece
{
  std::array<VertexId, 4> V; ///< positively oriented
  LabelId Label;             ///< 0 for background
};

/**
 * What takes the place of some tetrahedra of a triangulation, which itself stays as it is, and Delaunay. The pieces of one
 * fill it, and those of two beside each other have the same facets between them.
 */
struct Subdivision
{
  std::vector<Point<3>> Points; ///< vertex VertexIdEnd() of the triangulation, and those after it
  std::vector<SimplexId> Replaced; ///< ascending; also such that the mesh does not have
  std::vector<Piece> Pieces;
};

/**
 * Puts pieces in the place of whole tetrahedra. Points stay sorted along the Hilbert curve, and tetrahedra by their smallest
 * point. Does nothing, in no time, if nothing is replaced; else goes through the mesh a few times, O(n log k) for k tetrahedra that
 * are replaced.
 *
 * @param domain has the values of labels
 * @param mesh as ExtractMesh() has made it from the triangulation; of no use if this throws
 * @param threads used for some of it; 0 means all cores. The result does not depend on it.
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
void Subdivide(const Triangulation<3>& triangulation, const Domain<3>& domain,
  const Subdivision& subdivision, SimplexMesh<3>& mesh, unsigned threads = 1,
  const std::stop_token& stop = {});

} // namespace voxplex

#endif
