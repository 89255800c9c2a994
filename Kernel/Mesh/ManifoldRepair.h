// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ManifoldRepair.h
 * @brief Makes boundaries of labels manifold by giving single tetrahedra to a neighbouring label.
 */
#ifndef voxplex_ManifoldRepair_h
#define voxplex_ManifoldRepair_h

#include "Image/Domain.h"
#include "Mesh/InterfaceEdges.h"
#include "Mesh/SimplexMesh.h"

#include <cstddef>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** What a change of an interface has to keep. */
struct ManifoldRepairOptions
{
  double FacetAngle = 30.0;         ///< smallest planar angle of new facets, degrees
  double JunctionFacetAngle = 20.0; ///< the same where three labels or more meet at a vertex
  const Domain<3>* Cut =
    nullptr; ///< of the mesh, if its image cuts the object: these faces get no dents
};

/** Edges that were not manifold on the boundary of some label. */
struct ManifoldRepairCounts
{
  std::size_t Before = 0;
  std::size_t After = 0;
  std::vector<InterfaceEdge> Left; ///< those after; FindNonManifoldEdges()
};

/**
 * For each edge where other than two boundary facets of a label meet, tetrahedra around it are given to the
 * label of a neighbour, or to background, which drops them, if there are fewer such edges afterwards; those off
 * junctions count more. Tetrahedra are touched only if all their vertices are on interfaces already, so that these
 * get no vertex that is not on them; and something of the label stays at one of the vertices. What has a facet on a face
 * where the image cuts the object is dropped only where nothing else helps, since that leaves a dent in the face: there
 * parts of the object meet at an edge, and the dent is at the rim of the face.
 *
 * Elements stay what they are but for their labels. The mesh is the same in every run.
 * Takes time linear in the number of tetrahedra, little where few edges are bad.
 *
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
ManifoldRepairCounts RepairManifold(SimplexMesh<3>& mesh, const ManifoldRepairOptions& options = {},
  const std::stop_token& stop = {});

} // namespace voxplex

#endif
