// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Subdivision.h
 * @brief Replaces simplices of a triangulation by smaller pieces in the mesh.
 */
#ifndef voxplex_Subdivision_h
#define voxplex_Subdivision_h

#include "Base/UninitialisedVector.h"
#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"
#include "Mesh/SimplexMesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** A part of a simplex. */
template <int D>
struct Piece
{
  std::array<VertexId, static_cast<std::size_t>(D + 1)> V; ///< positively oriented
  LabelId Label;                                           ///< 0 for background
};

/**
 * The pieces that replace some simplices of a triangulation. The triangulation itself stays
 * unchanged, and Delaunay. The pieces of a simplex fill it. The pieces of two adjacent simplices
 * have the same facets between them.
 */
template <int D>
struct Subdivision
{
  std::vector<Point<D>> Points;    ///< their ids begin at the triangulation's VertexIdEnd()
  std::vector<SimplexId> Replaced; ///< ascending; some may not be in the mesh
  std::vector<Piece<D>> Pieces;
};

/** The vertices of a triangulation in a mesh in which some of them have been moved. */
template <int D>
struct MovedVertices
{
  std::span<const Point<D>> Positions; ///< of each vertex id; empty: those of the triangulation
  /**
   * The point of each vertex id, None if it is not in the mesh, as ExtractMesh() tells it. Receives
   * the new numbers, followed by those of the subdivision's points. Needed if there are positions.
   */
  UninitialisedVector<std::uint32_t>* Numbers = nullptr;
};

/**
 * Replaces whole simplices by their pieces. Points stay sorted along the Hilbert curve, and
 * simplices by their smallest point. If nothing is replaced, this returns at once. Otherwise it
 * passes through the mesh a few times: O(n log k) for k replaced simplices.
 *
 * @param domain has the values of labels
 * @param mesh from ExtractMesh() and the same triangulation; invalid if this throws
 * @param threads used for a part of the work; 0 means all cores. The result does not depend on it.
 * @param moved where the mesh has the vertices of the triangulation, if not where that has them
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
void Subdivide(const Triangulation<D>& triangulation, const Domain<D>& domain,
  const Subdivision<D>& subdivision, SimplexMesh<D>& mesh, unsigned threads = 1,
  const std::stop_token& stop = {}, const MovedVertices<D>& moved = {});

extern template void Subdivide<3>(const Triangulation<3>&, const Domain<3>&, const Subdivision<3>&,
  SimplexMesh<3>&, unsigned, const std::stop_token&, const MovedVertices<3>&);
extern template void Subdivide<4>(const Triangulation<4>&, const Domain<4>&, const Subdivision<4>&,
  SimplexMesh<4>&, unsigned, const std::stop_token&, const MovedVertices<4>&);

} // namespace voxplex

#endif
