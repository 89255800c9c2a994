// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FragmentCheck.h
 * @brief Checks that the elements of each connected component hold together (3D).
 */
#ifndef voxplex_FragmentCheck_h
#define voxplex_FragmentCheck_h

#include "Conformity/ComponentStatistics.h"
#include "Conformity/ConformityOptions.h"
#include "Conformity/ElementFragments.h"
#include "Conformity/LocalSampling.h"
#include "Image/BitMask.h"
#include "Image/Components.h"
#include "Image/FacesNear.h"
#include "Image/LabelImage.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Tells which components are in several fragments, and samples more finely where they have gaps.
 *
 * A fragment is a maximal set of tetrahedra of one label that are connected through faces. If a part
 * of a component is thin compared with the sampling distance, a Delaunay mesh of too few points joins
 * the regions on both sides of it here and there. Then the component has elements, but they hang
 * together at edges and vertices only, or not at all, and a finite-element model of them falls apart.
 *
 * A fragment belongs to the component in whose voxels the centroid of one of its tetrahedra lies. The
 * fragment with the largest volume stays as it is. Where one of the others ends, and the component goes
 * on, interfaces are sampled more finely, with a smaller sampling distance, at each round again,
 * until the component is in one fragment.
 *
 * More points can connect each component, because the label field does: it has the label of two
 * voxels with a common face all along the line between their centres. But the field may be narrow
 * there. So sampling does not become finer than a tenth of a voxel, and ends after 64 rounds.
 * ComponentStatistics::Broken lists what is left in fragments.
 *
 * This goes beyond the thesis, which gives no guarantee for parts that are thin compared with delta.
 *
 * Not thread safe. An inspection takes time linear in the number of simplices, and memory of 10 bytes
 * for each.
 */
class FragmentCheck
{
public:
  /** The objects to inspect. The references must outlive the check. */
  struct Subject
  {
    const LabelImage<3>& Image;
    const BitMask<3>& Sites; ///< surface voxels of the image
    const Components<3>& All;
  };

  /**
   * @param options components smaller than Smallest are not checked, except the largest of each label.
   * Unless they are to be exact, they are listed only, if the largest fragment has less than 90 % of
   * the volume
   * @param mayRefine false: components in fragments are listed only
   * @param sampling where to sample more finely; must outlive the check
   * @param statistics lists components in fragments, and counts rounds and points; must outlive the
   * check
   */
  FragmentCheck(const Subject& subject, const ComponentOptions& options, bool mayRefine,
    LocalSampling<3>& sampling, ComponentStatistics& statistics, const std::stop_token& stop);

  /** Whether an inspection may ask for more points. Otherwise it lists components in fragments. */
  bool MayRefine() const { return this->RoundsLeft > 0; }

  /** @return whether finer sampling was requested */
  bool Inspect(const LabelledTriangulation<3>& elements);

private:
  using Index = GridGeometry<3>::Index;

  /** The fragments of a component. */
  struct Pieces
  {
    std::uint64_t Number = 0;
    double Volume = 0.0; ///< of all; if there are several, like the rest
    double LargestVolume = 0.0;
    std::uint32_t Largest = None; ///< the fragment that has it
  };

  /** The fragments of each component. Measures those of components that have several. */
  std::vector<Pieces> FindPieces(ElementFragments& fragments) const;
  void Report(const std::vector<Pieces>& pieces);
  /** Balls where components are broken. */
  std::vector<SearchBall<3>> FindGaps(
    const ElementFragments& fragments, const std::vector<Pieces>& pieces) const;
  /** The faces of broken components in these balls. */
  std::vector<VoxelFace<3>> FacesNear(
    const std::vector<SearchBall<3>>& gaps, const std::vector<Pieces>& pieces) const;

  const Subject Of;
  const std::vector<bool> Wanted; ///< by component
  const bool Exact;
  unsigned RoundsLeft;
  LocalSampling<3>& Sampling;
  ComponentStatistics& Statistics;
  const std::stop_token Stop;
};

} // namespace voxplex

#endif
