// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Subdivision.h
 * @brief Smaller pieces that replace simplices of a triangulation in the mesh.
 */
#ifndef voxplex_Subdivision_h
#define voxplex_Subdivision_h

#include "Delaunay/Triangulation.h"

#include <array>
#include <cstddef>
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

} // namespace voxplex

#endif
