// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceCheck.h
 * @brief Checks that the interfaces of a refined triangulation match those of the image.
 */
#ifndef voxplex_InterfaceCheck_h
#define voxplex_InterfaceCheck_h

#include "Conformity/ConformityOptions.h"
#include "Conformity/DistanceCheck.h"
#include "Conformity/InterfaceStatistics.h"
#include "Conformity/LocalSampling.h"
#include "Conformity/ManifoldLabels.h"
#include "Delaunay/Triangulation.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Decides where refinement has to be resumed to correct interfaces.
 *
 * It looks for
 * - faces between voxels of different labels that are far from the interfaces of the mesh
 *   (DistanceCheck);
 * - edges that are not manifold with the labels, in 3D. CGAL's Mesh_3 refines facets around such edges
 *   for the same purpose. Triangles (4D) are not sampled: on noise the mesh would become many times as
 *   large.
 *
 * LocalSampling samples around them. All faces are looked at in the first inspection, and
 * when nothing else is wrong. In between only those are that were sampled before: a face seldom becomes
 * far where refinement was not asked for.
 *
 * Not thread safe; uses threads of its own. No thread may change the triangulation during a call.
 */
template <int D>
class InterfaceCheck
{
public:
  /** The objects to inspect. The references must outlive the check. */
  struct Subject
  {
    const Triangulation<D>& Mesh;
    const LabelImage<D>& Image;
    const BitMask<D>& Sites; ///< surface voxels of the image
    const Domain<D>& Surfaces;
    const SizingField<D>& Sizing;
    unsigned Threads; ///< 0 means all cores; results do not depend on it
  };

  /**
   * All references must outlive the check.
   * @param rounds the number of rounds after which nothing more is requested
   * @param sampling where to sample more finely
   * @param statistics counts rounds and points
   */
  InterfaceCheck(const Subject& subject, unsigned rounds, LocalSampling<D>& sampling,
    InterfaceStatistics& statistics, const std::stop_token& stop);

  /**
   * Begins an inspection. Requests finer sampling near far faces, of those that were sampled before; the
   * first time, of all.
   * @return whether anything was requested; the same holds below
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  bool InspectSampled(const ManifoldLabels<D>& made);

  /** Requests finer sampling at edges that are not manifold. */
  bool InspectRidges(const ManifoldLabels<D>& made);

  /** Requests finer sampling near far faces, unless this inspection has looked at all faces. */
  bool InspectAll(const ManifoldLabels<D>& made);

  /** Requests finer sampling where layers of the image are hidden. @param exact ComponentOptions::Exact */
  bool InspectLayers(const ManifoldLabels<D>& made, bool exact);

private:
  bool MayGoOn() const { return this->Statistics.Rounds < this->Rounds; }
  bool AreFew(std::size_t defects) const;
  bool Sample(const std::vector<VoxelFace<D>>& far, const ManifoldLabels<D>& made);

  const Triangulation<D>& Mesh;
  const unsigned Rounds;
  InterfaceStatistics& Statistics;
  const DistanceCheck<D> Distances;
  LocalSampling<D>& Sampling;
  bool IsFirst = true;
  bool HasSeenAll = false; ///< in this inspection
};

extern template class InterfaceCheck<3>;
extern template class InterfaceCheck<4>;

} // namespace voxplex

#endif
