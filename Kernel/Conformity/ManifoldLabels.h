// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ManifoldLabels.h
 * @brief The labels of the simplices of a refined triangulation, with manifold boundaries as far as
 * labels alone can make them so.
 */
#ifndef voxplex_ManifoldLabels_h
#define voxplex_ManifoldLabels_h

#include "Conformity/InterfaceSampling.h"
#include "Conformity/InterfaceStatistics.h"
#include "Conformity/ManifoldRepair.h"
#include "Mesh/SimplexLabels.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/** The result of MakeManifoldLabels(). */
template <int D>
struct ManifoldLabels
{
  SimplexLabels Labels;                       ///< of each simplex id
  std::vector<InterfaceRidge<D>> NonManifold; ///< ridges that are not manifold with these labels
  std::vector<NonManifoldPlace<D>> Places;    ///< of these ridges
  std::vector<Point<D>> Gone; ///< vertices that relabelling has left inside of a label
};

/**
 * Each simplex gets the label at its circumcentre. Then RelabelCrumbs() (3D) and RepairManifold() give
 * some of them another label, if that is requested.
 *
 * No thread may change the triangulation during the call. The result does not depend on the number
 * of threads. Takes time linear in the number of simplices, if few are repaired.
 *
 * @param repair whether labels are repaired; if not, no crumb and no ridge is looked for
 * @param options of the repair. Surfaces must not be null.
 * @param statistics receives the numbers of ridges that were repaired and are left
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
ManifoldLabels<D> MakeManifoldLabels(const Triangulation<D>& triangulation, bool repair,
  const ManifoldRepairOptions<D>& options, InterfaceStatistics& statistics, unsigned threads,
  const std::stop_token& stop);

extern template ManifoldLabels<3> MakeManifoldLabels<3>(const Triangulation<3>&, bool,
  const ManifoldRepairOptions<3>&, InterfaceStatistics&, unsigned, const std::stop_token&);
extern template ManifoldLabels<4> MakeManifoldLabels<4>(const Triangulation<4>&, bool,
  const ManifoldRepairOptions<4>&, InterfaceStatistics&, unsigned, const std::stop_token&);

} // namespace voxplex

#endif
