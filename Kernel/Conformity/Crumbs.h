// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Crumbs.h
 * @brief Finds the few tetrahedra that hang on the rest of their label without a common face (3D).
 */
#ifndef voxplex_Crumbs_h
#define voxplex_Crumbs_h

#include "Conformity/ManifoldRepair.h"
#include "Mesh/SimplexLabels.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Gives crumbs the label beside them, so that the elements of a label hang together.
 *
 * A fragment is a maximal set of tetrahedra of one label that are connected through faces. A crumb is
 * a fragment of at most five tetrahedra that shares a vertex or an edge, but no face, with a larger
 * fragment of its label. Where a part of a label is thin compared with delta, circumcentres of some
 * tetrahedra of its rim lie in it, and those of the tetrahedra that would connect them do not. In a
 * finite-element model such crumbs move freely.
 *
 * A crumb gets the label with which it shares the largest area, among tetrahedra that are not of
 * crumbs, if RepairManifold() may make the change, too: no bound of shape or size breaks, and flat
 * faces where the image cuts the object get no dents. If it may not, the next label is tried. No label
 * is lost, since a larger fragment stays. Crumbs whose tetrahedra all have two neighbours of their
 * label or more, such as rings around an edge, are not looked for.
 *
 * The thesis keeps all crumbs.
 *
 * No thread may change the triangulation during the call. The result does not depend on the number of
 * threads. Takes time linear in the number of simplices.
 *
 * @param labels of each simplex id; those of crumbs are changed
 * @param options of the repair that comes next
 * @param threads 0 means all cores
 * @return the simplices whose label was changed, ascending
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
std::vector<SimplexId> RelabelCrumbs(const Triangulation<3>& triangulation, SimplexLabels& labels,
  const ManifoldRepairOptions<3>& options, unsigned threads, const std::stop_token& stop);

} // namespace voxplex

#endif
