// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EdgeSpindles.h
 * @brief Makes boundaries of labels manifold at edges where giving whole tetrahedra to another
 * label does not help.
 */
#ifndef voxplex_EdgeSpindles_h
#define voxplex_EdgeSpindles_h

#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"
#include "Mesh/Subdivision.h"
#include "Quality/InterfaceEdges.h"

#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** The result of MakeSpindles(). */
struct SpindleResult
{
  Subdivision Parts;
  std::vector<InterfaceEdge> Left; ///< only where tetrahedra are flat within rounding
};

/**
 * At a non-manifold edge ab, the tetrahedra of some label form more than one run around the edge.
 * The tetrahedra of some runs are cut in pieces. The pieces at ab form a spindle from a to b, or a
 * sector of one, and get another label that occurs around the edge. After that, each label except
 * background has one run. This is always possible, because the whole spindle can get a single
 * label.
 *
 *           s                   a, b   ends of the edge, seen along the edge
 *          /|\                  r, s   vertices around it
 *         / | \                 p, q   new ones on the facets abr, abs
 *        /  q  \                abpq   part of the spindle
 *       / /   \ \               aprs, bprs, apqs, bpqs keep their label
 *      ab----p---r
 *
 * Each spindle removes one non-manifold edge and makes no new one (Documentation/Algorithm.md,
 * "Looking at the interfaces", has the proof): edges at ab's tetrahedra keep their runs, and no new
 * edge has more than one run of a label. Each tetrahedron keeps pieces with its own label, so no
 * element is lost. New vertices lie at one of a few fixed positions in their facet or tetrahedron,
 * so the shapes of the tetrahedra bound the shapes of the pieces. Of all possible cuts, the one
 * with the best shapes in the mesh is taken. A cut that makes dents or bulges in faces where the
 * image cuts the object is taken only if there is no other.
 *
 * The triangulation is not changed, and no thread may change it during the call. Takes time linear
 * in the number of edges, if few tetrahedra share an edge. Edges with many runs around them take
 * longer.
 *
 * @param labels by simplex id
 * @param edges the non-manifold edges, with vertex ids
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
SpindleResult MakeSpindles(const Triangulation<3>& triangulation, const Domain<3>& domain,
  std::span<const LabelId> labels, std::span<const InterfaceEdge> edges,
  const std::stop_token& stop = {});

} // namespace voxplex

#endif
