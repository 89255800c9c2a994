// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ManifoldLabels.h
 * @brief The labels of the simplices of a refined triangulation, with manifold boundaries as far as
 * labels alone can make them so.
 */
#ifndef voxplex_ManifoldLabels_h
#define voxplex_ManifoldLabels_h

#include "Conformity/HiddenLayers.h"
#include "Conformity/InterfaceStatistics.h"
#include "Conformity/LocalSampling.h"
#include "Conformity/ManifoldRepair.h"
#include "Conformity/PieceJoints.h"
#include "Mesh/SimplexLabels.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/** What ManifoldLabeller says of the labels. */
template <int D>
struct ManifoldLabels
{
  std::vector<SimplexId> New = {}; ///< simplices that are not examined; empty after repair
  std::vector<InterfaceRidge<D>> NonManifold; ///< ridges that are not manifold with these labels
  std::vector<Point<D>> Places;               ///< of these ridges
  std::vector<HiddenLayer<D>> Layers;         ///< hidden with these labels
  std::vector<PieceGap<D>> Gaps;              ///< see JoinPieces()
};

/**
 * @brief Labels the simplices of a triangulation (Triangulation::Labels()) so that boundaries of labels
 * are manifold.
 *
 * Each simplex gets the label at its circumcentre. Then ShowHiddenLayers(), JoinPieces() (3D) and
 * RepairManifold() give some of them another label.
 *
 * A simplex keeps the label that it was given as long as it lives, unless there are time planes, or after
 * further refinement this leaves an interface facet with small angles (3D). Then defects are looked for at
 * the simplices that are not Examined: those that are new, those that have lost a label in this way, and
 * those around defects that nothing has mended. Vertices on interfaces are marked in the same way.
 *
 * Not thread safe; uses threads of its own.
 */
template <int D>
class ManifoldLabeller
{
public:
  /**
   * @param triangulation its simplices get their labels; must outlive this object
   * @param options of the repair. Surfaces must not be null.
   * @param threads 0 means all cores; results do not depend on it
   */
  ManifoldLabeller(Triangulation<D>& triangulation, const ManifoldRepairOptions<D>& options,
    unsigned threads, const std::stop_token& stop);

  /**
   * Gives simplices that are not Examined the labels at their circumcentres. Vertices on interfaces are
   * marked. Takes time linear in the number of simplices.
   *
   * No thread may change the triangulation during the call.
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  ManifoldLabels<D> Take();

  /**
   * Repairs labels, and lists what is left. Takes time linear in the number of simplices, if few are
   * repaired.
   * @param taken the result of Take()
   * @param gaps see JoinPieces()
   * @param statistics counts the ridges that were repaired, and receives the number of those left
   * @throws as Take(). Then the next call looks at the same simplices again.
   */
  ManifoldLabels<D> Repair(
    ManifoldLabels<D> taken, GapOptions gaps, InterfaceStatistics& statistics);

  const SimplexLabels& GetLabels() const { return this->Labels; }

private:
  using Simplices = std::vector<SimplexId>;

  Simplices TakeLabels();
  Simplices TakeBack(const Simplices& given);
  LabelId LabelAtCentre(SimplexId s) const
  {
    return voxplex::LabelAtCentre(this->Source, *this->Options.Surfaces, s);
  }
  bool AreFew(const Simplices& some) const;
  void Mark(const Simplices& changed);
  void Examine(const Simplices& fresh, const ManifoldLabels<D>& made);

  Triangulation<D>& Source;
  SimplexLabels& Labels; ///< of the triangulation
  const ManifoldRepairOptions<D> Options;
  const unsigned Threads;
  const std::stop_token Stop;
};

extern template class ManifoldLabeller<3>;
extern template class ManifoldLabeller<4>;

} // namespace voxplex

#endif
