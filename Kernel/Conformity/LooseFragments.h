// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LooseFragments.h
 * @brief Finds the few tetrahedra that hang on the rest of their label without a common face (3D).
 */
#ifndef voxplex_LooseFragments_h
#define voxplex_LooseFragments_h

#include "Conformity/ManifoldRepair.h"
#include "Mesh/SimplexLabels.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * Finds the tetrahedra of small fragments, where a search for loose fragments may begin. A fragment
 * is a maximal set of tetrahedra of one label that are connected through faces. It is small if it
 * has at most five. A search begins at tetrahedra with at most one neighbour of their label.
 *
 * For threads and exceptions, see RelabelLooseFragments(). Takes time linear in the number of
 * simplices.
 * @return ascending
 */
std::vector<SimplexId> FindSmallFragments(const Triangulation<3>& triangulation,
  const SimplexLabels& labels, unsigned threads, const std::stop_token& stop);

/**
 * Finds those of fragments that have one of some simplices, or one beside it. Takes time linear in
 * their number.
 */
std::vector<SimplexId> FindSmallFragmentsAt(const Triangulation<3>& triangulation,
  const SimplexLabels& labels, const std::vector<SimplexId>& changed, unsigned threads,
  const std::stop_token& stop);

/**
 * @brief Gives loose fragments the label beside them, so that the elements of a label hang
 *   together.
 *
 * A loose fragment is a small one that shares a vertex or an edge, but no face, with a larger
 * fragment of its label. Where a part of a label is thin compared with delta, circumcentres of some
 * tetrahedra of its rim lie in it, and those of the tetrahedra that would connect them do not. In a
 * finite-element model such loose fragments move freely.
 *
 * A loose fragment gets the label with which it shares the largest area, among tetrahedra that are
 * not of loose fragments, if RepairManifold() may make the change, too: no bound of shape or size
 * breaks, and flat faces where the image cuts the object get no dents. If it may not, the next
 * label is tried. No label is lost, since a larger fragment stays. Loose fragments whose tetrahedra
 * all have two neighbours of their label or more, such as rings around an edge, are not looked for.
 *
 * The thesis keeps all loose fragments.
 *
 * No thread may change the triangulation during the call. The result does not depend on the number
 * of threads. Takes time linear in the number of small fragments, and in that of simplices if there
 * is a loose fragment, but little for each of these.
 *
 * @param labels of each simplex id; those of loose fragments are changed
 * @param small the result of FindSmallFragments() for these labels
 * @param options of the repair that comes next
 * @param threads 0 means all cores
 * @return the simplices whose label was changed, ascending
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
std::vector<SimplexId> RelabelLooseFragments(const Triangulation<3>& triangulation,
  SimplexLabels& labels, const std::vector<SimplexId>& small,
  const ManifoldRepairOptions<3>& options, unsigned threads, const std::stop_token& stop);

} // namespace voxplex

#endif
