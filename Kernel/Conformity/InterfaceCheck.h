// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceCheck.h
 * @brief Checks that the interfaces of a refined triangulation match those of the image.
 */
#ifndef voxplex_InterfaceCheck_h
#define voxplex_InterfaceCheck_h

#include "Conformity/ConformityOptions.h"
#include "Conformity/GradedInterfaceCheck.h"
#include "Conformity/InterfaceStatistics.h"
#include "Conformity/InterfaceVertices.h"
#include "Conformity/ManifoldLabels.h"
#include "Conformity/Remedy.h"
#include "Conformity/UniformInterfaceCheck.h"
#include "Delaunay/Triangulation.h"

#include <optional>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Decides where refinement has to be resumed to correct interfaces.
 *
 * Distances are measured to the vertices of interfaces (UniformInterfaceCheck), first without
 * labels, then where labels have changed interfaces. So no label is made before all faces of voxels
 * have a vertex near them. If sampling distances are graded, distances are measured to facets
 * (GradedInterfaceCheck), which have to have labels; 3D only.
 *
 * Edges that are not manifold with the labels are sampled, too. Triangles (4D) are not: on noise the
 * mesh would become many times as large.
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
   * @param rounds the number of remedies after which nothing more is requested
   * @param local receives the spacing of the points to be inserted, and bounds
   * @param statistics counts rounds and points
   */
  InterfaceCheck(const Subject& subject, unsigned rounds, LocalDelta<D>& local,
    InterfaceStatistics& statistics, const std::stop_token& stop);

  /**
   * Requests points near faces of voxels that have no vertex of interfaces near them; nothing if
   * sampling distances are graded.
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  Remedy<D> InspectVertices();

  /**
   * To be called after InspectVertices() has requested nothing. Requests points where the labels
   * have taken vertices from the interfaces, and at edges that are not manifold.
   * @throws as InspectVertices()
   */
  Remedy<D> InspectLabels(const ManifoldLabels<D>& made);

  /** Frees all memory that only further inspections need. */
  void Finish();

private:
  bool MayGoOn() const { return this->Statistics.Rounds < this->Rounds; }
  Remedy<D> Counted(std::vector<FeatureSeed<D>> points);

  const Subject Of;
  const unsigned Rounds;
  InterfaceStatistics& Statistics;
  InterfaceVertices<D> Vertices;
  std::optional<UniformInterfaceCheck<D>> Uniform; ///< one of both
  std::optional<GradedInterfaceCheck> Graded;
};

extern template class InterfaceCheck<3>;
extern template class InterfaceCheck<4>;

} // namespace voxplex

#endif
