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
#include "Conformity/RepairMemory.h"
#include "Conformity/SeenSimplices.h"
#include "Mesh/SimplexLabels.h"

#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

namespace voxplex
{

/** The result of ManifoldLabeller::Make(). */
template <int D>
struct ManifoldLabels
{
  SimplexLabels Labels;                       ///< of each simplex id
  std::vector<InterfaceRidge<D>> NonManifold; ///< ridges that are not manifold with these labels
  std::vector<NonManifoldPlace<D>> Places;    ///< of these ridges
  std::vector<Point<D>> Gone; ///< vertices that relabelling has left inside of a label
};

/**
 * @brief Labels the simplices of a triangulation so that boundaries of labels are manifold.
 *
 * Each simplex gets the label at its circumcentre. Then RelabelCrumbs() (3D) and RepairManifold() give
 * some of them another label.
 *
 * After further refinement, the labels can be made again. The result is that of a new object, but
 * defects are looked for and repaired only where simplices are new. For this, two bytes for each
 * simplex id are kept, and some hundred for each defect.
 *
 * Not thread safe; uses threads of its own.
 */
template <int D>
class ManifoldLabeller
{
public:
  /**
   * @param triangulation must outlive this object
   * @param options of the repair. Surfaces must not be null.
   * @param threads 0 means all cores; results do not depend on it
   */
  ManifoldLabeller(const Triangulation<D>& triangulation, const ManifoldRepairOptions<D>& options,
    unsigned threads, const std::stop_token& stop);

  /**
   * No thread may change the triangulation during the call. Takes time linear in the number of
   * simplices, if few are repaired.
   * @param statistics receives the numbers of ridges that were repaired and are left
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  ManifoldLabels<D> Make(InterfaceStatistics& statistics);

  /** The labels at the circumcentres: no crumb and no ridge is looked for. */
  SimplexLabels MakePlain() const;

  /** Frees all memory. */
  void Forget();

private:
  /** Some simplices, or none: so many that what is known of others is of no use. */
  using Some = std::optional<std::vector<SimplexId>>;

  Some FindNew();
  Some FindChanged(const SimplexLabels& labels, Some added, const std::vector<SimplexId>& crumbs);
  void FindRidges(const SimplexLabels& labels, const Some& changed);
  bool AreFew(const std::vector<SimplexId>& simplices) const;

  const Triangulation<D>& Source;
  const ManifoldRepairOptions<D> Options;
  const unsigned Threads;
  const std::stop_token Stop;
  SeenSimplices<D> Seen;        ///< at the last call
  std::vector<SimplexId> Small; ///< FindSmallFragments() then (3D)
  /** Simplices that RelabelCrumbs() gave another label then, and this label; ascending. */
  std::vector<std::pair<SimplexId, LabelId>> Crumbs;
  std::vector<InterfaceRidge<D>> Ridges; ///< FindNonManifoldRidges() then
  CrumbMemory Relabelled;                ///< then (3D)
  RepairMemory<D> Repaired;              ///< then
};

extern template class ManifoldLabeller<3>;
extern template class ManifoldLabeller<4>;

} // namespace voxplex

#endif
