// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EdgeSpindles.h
 * @brief Makes boundaries of labels manifold at edges where whole tetrahedra cannot change sides.
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

/** What was done. */
struct SpindleResult
{
  Subdivision Parts;
  std::vector<InterfaceEdge> Left; ///< only where tetrahedra are flat to rounding
};

/**
 * At an edge ab where other than two boundary facets of a label meet, tetrahedra of some label come in more than one run
 * around it. Those of some runs are cut in pieces, so that the parts at ab, which form a spindle or a sector of one from a to
 * b, go over to another label around the edge; then each label, but background, has one run. It always can: the whole
 * spindle may get one label.
 *
 *           s                   a, b   ends of the edge, here seen along it
 *          /|\                  r, s   vertices around it
 *         / | \                 p, q   new ones on the facets abr, abs
 *        /  q  \                abpq   is part of the spindle
 *       / /   \ \               aprs, bprs, apqs, bpqs keep their label
 *      ab----p---r
 *
 * There is no such edge more afterwards, and one less for each spindle (Documentation/Algorithm.md, "Looking at the
 * interfaces", has the proof): edges at ab's tetrahedra keep their runs, and of new edges none has more than one run of a
 * label. Each tetrahedron keeps pieces with its label, so that none is lost. New vertices lie at one of a few fixed places in
 * their facet or tetrahedron, so that shapes of pieces are bounded by those of tetrahedra; of all ways to do it the one
 * with the best shapes in the mesh is taken, but faces where the image cuts the object get neither dents nor bulges if there is
 * any other.
 *
 * The triangulation stays what it is, and nobody may change it meanwhile. Takes time linear in the number of edges, if few
 * tetrahedra share one; edges with many runs around them take more.
 *
 * @param labels of each simplex id
 * @param edges those that are not manifold, with vertex ids
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
SpindleResult MakeSpindles(const Triangulation<3>& triangulation, const Domain<3>& domain,
  std::span<const LabelId> labels, std::span<const InterfaceEdge> edges,
  const std::stop_token& stop = {});

} // namespace voxplex

#endif
