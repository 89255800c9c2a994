// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Subdivision.h
 * @brief Replaces tetrahedra of a triangulation by smaller pieces in the mesh.
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

/** A part of a tetrahedron. */
struct Piece
{
  std::array<VertexId, 4> V; ///< positively oriented
  LabelId Label;             ///< 0 for background
};

/**
 * The pieces that replace some tetrahedra of a triangulation. The triangulation itself stays
 * unchanged, and Delaunay. The pieces of a tetrahedron fill it. The pieces of two adjacent
 * tetrahedra have the same facets between them.
 */
struct Subdivision
{
  std::vector<Point<3>> Points;    ///< their ids begin at the triangulation's VertexIdEnd()
  std::vector<SimplexId> Replaced; ///< ascending; some may not be in the mesh
  std::vector<Piece> Pieces;
};

/**
 * Replaces whole tetrahedra by their pieces. Points stay sorted along the Hilbert curve, and
 * tetrahedra by their smallest point. If nothing is replaced, this returns at once. Otherwise it
 * passes through the mesh a few times: O(n log k) for k replaced tetrahedra.
 *
 * @param domain has the values of labels
 * @param mesh from ExtractMesh() and the same triangulation; invalid if this throws
 * @param threads used for a part of the work; 0 means all cores. The result does not depend on it.
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
void Subdivide(const Triangulation<3>& triangulation, const Domain<3>& domain,
  const Subdivision& subdivision, SimplexMesh<3>& mesh, unsigned threads = 1,
  const std::stop_token& stop = {});

} // namespace voxplex

#endif
