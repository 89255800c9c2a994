// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Inspection.h
 * @brief Decides whether refinement goes on, and makes the labels of the mesh.
 */
#ifndef voxplex_Inspection_h
#define voxplex_Inspection_h

#include "Conformity/ComponentCheck.h"
#include "Conformity/InterfaceCheck.h"
#include "Conformity/LocalSampling.h"
#include "Conformity/ManifoldLabels.h"
#include "Mesher/RefinementStage.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace voxplex
{

/**
 * @brief Inspects the refined triangulation.
 *
 * The simplices get their labels (ManifoldLabeller). What refinement has to go on for is found in this
 * order:
 * 1. faces of voxels that are far from the interfaces of the mesh (InterfaceCheck), of those that were
 *    sampled; the first time, of all. If there are any, inspection ends here;
 * 2. edges that are not manifold (InterfaceCheck; 3D);
 * 3. layers of the image that the mesh hides (HiddenLayers);
 * 4. components, in 4D also those of frames, that have no simplex (ComponentCheck);
 * 5. components whose simplices do not hold together (JoinPieces);
 * 6. if nothing was found, far faces among all.
 *
 * Refinement goes on for what steps 2 to 5 find together. A check that requested nothing in the
 * previous round is skipped once another check has requested refinement. Each gives up after a limited number of rounds, so the
 * run ends.
 *
 * Components may lower local bounds already in the constructor. Not thread safe.
 */
template <int D>
class Inspection
{
public:
  /** All references must outlive this object. */
  Inspection(const RunEnvironment<D>& run, RefinementStage<D>& stage, LocalDelta<D>& local);

  /** Points to be inserted before refinement: at first for thin components, then for what is missing. */
  std::vector<FeatureSeed<D>> TakeSeeds() { return this->Sampling.TakeSeeds(); }

  /**
   * To be called after each refinement.
   * @return whether refinement has to go on
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  bool Inspect();

  /** Valid if the last Inspect() was false. */
  const ManifoldLabels<D>& Labels() const { return this->Made; }

private:
  /** The finders of steps 2 to 5. */
  enum Finder : std::size_t
  {
    BadRidges,
    HiddenLayers,
    LostComponents,
    LostInFrames,
    NumberOfFinders
  };

  bool InspectGaps();
  template <typename Find>
  void Look(bool& isNeeded, Finder finder, double& seconds, const Find& find);

  const RunEnvironment<D> Run;
  Triangulation<D>& Source;
  LocalSampling<D> Sampling;
  InterfaceCheck<D> Interfaces;
  const LabelContacts<D> Contacts;
  ManifoldLabeller<D> Labeller;
  std::optional<ComponentCheck<D>> Components; ///< empty if components are not checked
  std::optional<ComponentCheck<D>> OfFrames;   ///< likewise, and in 3D
  ManifoldLabels<D> Made;
  unsigned GapRounds;                                ///< that are left
  GapOptions Gaps;                                   ///< of the next repair
  std::array<bool, NumberOfFinders> NeededNothing{}; ///< at its last inspection
};

extern template class Inspection<3>;
extern template class Inspection<4>;

} // namespace voxplex

#endif
