// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FragmentCheck.h
 * @brief Checks that the elements of each connected component hold together (3D).
 */
#ifndef voxplex_FragmentCheck_h
#define voxplex_FragmentCheck_h

#include "Conformity/ComponentStatistics.h"
#include "Conformity/ConformityCheck.h"
#include "Domain/Domain.h"
#include "Image/BitMask.h"
#include "Image/Components.h"
#include "Image/FacesNear.h"
#include "Image/LabelImage.h"
#include "Sizing/SizingField.h"

#include <cstdint>
#include <map>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Samples more finely where the elements of a component are in several fragments.
 *
 * A fragment is a maximal set of tetrahedra of one label that are connected through faces. If a part
 * of a component is thin compared with the sampling distance, a Delaunay mesh of too few points joins
 * the regions on both sides of it here and there. Then the component has elements, but they hang
 * together at edges and vertices only, or not at all, and a finite-element model of them falls apart.
 *
 * A fragment belongs to the component in whose voxels the centroid of one of its tetrahedra lies. The
 * largest fragment of a component stays as it is, unless several are as large. Around the vertices of
 * the others, interfaces are sampled more finely, and R1 gets a smaller sampling distance, at each
 * round again, until the component is in one fragment.
 *
 * More points can connect each component, because the label field does: it has the label of two
 * voxels with a common face all along the line between their centres. But the field may be narrow
 * there. So sampling does not become finer than half a voxel, and components as thin as a voxel may
 * stay in fragments.
 *
 * This goes beyond the thesis, which gives no guarantee for parts that are thin compared with delta.
 *
 * Not thread safe. An inspection takes time linear in the number of simplices, and memory of 12 bytes
 * for each.
 */
class FragmentCheck final : public ConformityCheck<3>
{
public:
  /** The objects to inspect. The references must outlive the check. */
  struct Subject
  {
    const LabelImage<3>& Image;
    const BitMask<3>& Sites; ///< surface voxels of the image
    const Domain<3>& Surfaces;
    const SizingField<3>& Sizing;
    const Components<3>& All;
  };

  /**
   * @param fewestVoxels smaller components are not checked, except the largest of each label
   * @param rounds points are requested this many times at most
   * @param local receives the spacing of the points, and bounds; must outlive the check
   * @param statistics counts rounds and points; must outlive the check
   */
  FragmentCheck(const Subject& subject, std::int64_t fewestVoxels, unsigned rounds,
    LocalDelta<3>& local, ComponentStatistics& statistics, double& seconds,
    const std::stop_token& stop);

  Remedy<3> InspectElements(const LabelledTriangulation<3>& elements) override;

private:
  using Index = GridGeometry<3>::Index;

  /** The component in whose voxels the centroid of a simplex lies, or None. */
  std::uint32_t ComponentOf(const Triangulation<3>& mesh, SimplexId s) const;
  /** Faces of components that are in several fragments, near to all of these but the largest. */
  std::vector<VoxelFace<3>> FacesOfFragments(const LabelledTriangulation<3>& elements) const;
  std::vector<FeatureSeed<3>> Sample(const std::vector<VoxelFace<3>>& faces);

  const Subject Of;
  const std::vector<bool> Wanted; ///< by component
  unsigned RoundsLeft;
  LocalDelta<3>& Local;
  ComponentStatistics& Statistics;
  const std::stop_token Stop;
  const double FinestSpacing;
  std::map<Index, double> Spacings; ///< of the last points, by cell of LocalDelta
};

} // namespace voxplex

#endif
