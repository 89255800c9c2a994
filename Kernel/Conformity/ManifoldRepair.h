// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ManifoldRepair.h
 * @brief Makes boundaries of labels manifold by giving tetrahedra to a neighbouring label.
 */
#ifndef voxplex_ManifoldRepair_h
#define voxplex_ManifoldRepair_h

#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"
#include "Geometry/ShapeBounds.h"
#include "Quality/InterfaceEdges.h"
#include "Sizing/SizingField.h"

#include <cstddef>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** Constraints on changes of an interface. */
struct ManifoldRepairOptions
{
  ShapeBounds Shape; ///< of new interface triangles: angles only
  /** The meshed domain. Faces where its image cuts the object get no dents. Null: no such faces. */
  const Domain<3>* Surfaces = nullptr;
  /** Bounds the circumradius of tetrahedra that get another label. Null: no bound. */
  const SizingField<3>* Sizing = nullptr;
};

/** The result of RepairManifold(). */
struct ManifoldRepairResult
{
  std::size_t Before = 0;            ///< non-manifold edges before the repair
  std::vector<InterfaceEdge> Left;   ///< non-manifold edges after it; ends are vertex ids
  std::vector<SimplexId> Relabelled; ///< ascending
};

/**
 * For each non-manifold edge, tetrahedra around it are given to the label of a neighbour, or to
 * background, which drops them. A change is made only if it leaves fewer non-manifold edges; edges
 * off junctions have a larger weight. Tetrahedra are changed only if
 * - all their vertices are on interfaces already, so that no vertex off the interfaces gets onto
 *   them;
 * - a tetrahedron of the old label remains at one of the vertices;
 * - they are not larger than their new label allows.
 *
 * A tetrahedron with a facet on a face where the image cuts the object is dropped only if nothing
 * else helps, because that leaves a dent in the face. There, parts of the object meet at an edge,
 * and the dent is at the rim of the face.
 *
 * The triangulation is not changed, and no thread may change it during the call. The result does
 * not depend on the number of threads. Takes time linear in the number of tetrahedra; the repair
 * itself takes little time if few edges are bad.
 *
 * @param labels by simplex id; some are changed
 * @param threads used to find the edges; 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
ManifoldRepairResult RepairManifold(const Triangulation<3>& triangulation,
  std::span<LabelId> labels, const ManifoldRepairOptions& options = {}, unsigned threads = 1,
  const std::stop_token& stop = {});

} // namespace voxplex

#endif
