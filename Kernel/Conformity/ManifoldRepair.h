// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ManifoldRepair.h
 * @brief Makes boundaries of labels manifold by giving single tetrahedra to a neighbouring label.
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

/** What a change of an interface has to keep. */
struct ManifoldRepairOptions
{
  ShapeBounds Shape; ///< of new interface triangles: angles only
  /** What was meshed: faces where its image cuts the object get no dents. Without it there are none. */
  const Domain<3>* Surfaces = nullptr;
  /** Bounds the circumradius of a tetrahedron that gets another label. Null: no bound. */
  const SizingField<3>* Sizing = nullptr;
};

/** What was done. */
struct ManifoldRepairResult
{
  std::size_t Before = 0;            ///< edges that were not manifold on the boundary of some label
  std::vector<InterfaceEdge> Left;   ///< those that are not now; ends are vertex ids
  std::vector<SimplexId> Relabelled; ///< ascending
};

/**
 * For each edge where other than two boundary facets of a label meet, tetrahedra around it are given to the
 * label of a neighbour, or to background, which drops them, if there are fewer such edges afterwards; those off
 * junctions count more. Tetrahedra are touched only if all their vertices are on interfaces already, so that these
 * get no vertex that is not on them; something of the label stays at one of the vertices; and they are not larger than
 * their new label allows. What has a facet on a face
 * where the image cuts the object is dropped only where nothing else helps, since that leaves a dent in the face: there
 * parts of the object meet at an edge, and the dent is at the rim of the face.
 *
 * The triangulation stays what it is, and nobody may change it meanwhile. The result does not depend on the number of
 * threads. Takes time linear in the number of tetrahedra, little where few edges are bad.
 *
 * @param labels of each simplex id; some change
 * @param threads used to find the edges; 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
ManifoldRepairResult RepairManifold(const Triangulation<3>& triangulation,
  std::span<LabelId> labels, const ManifoldRepairOptions& options = {}, unsigned threads = 1,
  const std::stop_token& stop = {});

} // namespace voxplex

#endif
