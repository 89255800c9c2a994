// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UniformInterfaceCheck.h
 * @brief Checks that the interfaces of the image have vertices of the mesh near them.
 */
#ifndef voxplex_UniformInterfaceCheck_h
#define voxplex_UniformInterfaceCheck_h

#include "Conformity/InterfaceSampling.h"
#include "Conformity/InterfaceVertices.h"
#include "Refinement/FeatureGrid.h"

#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Finds features that sampling missed, and proposes where to sample more finely.
 *
 * R1 looks only at the interface closest to a circumcentre. So it may never see the tip of a thin
 * process, or a hole through a sheet. If two interfaces are closer to each other than their
 * sampling distance, tetrahedra of their labels alternate around edges. The check looks for
 * - faces between voxels of different labels without an interface vertex within LargestDistance
 *   times the sampling distance, or within a voxel's diagonal if that is larger;
 * - non-manifold edges on the boundary of some label.
 *
 * InterfaceSampling proposes points around them. CGAL's Mesh_3 refines facets around such edges for
 * the same purpose. The thesis has no such rule.
 *
 * The first InspectVertices() checks all faces. Later calls, and InspectLabels(), check only faces
 * that were sampled, and faces whose near vertex is no longer on an interface.
 *
 * Not thread safe; uses threads of its own. Checking all faces takes time linear in the number of
 * the image's surface voxels.
 */
template <int D>
class UniformInterfaceCheck
{
public:
  /**
   * The largest allowed distance from a face to a vertex, in sampling distances. The distance to a
   * facet is smaller.
   */
  static constexpr double LargestDistance = 1.4;

  /**
   * All references must outlive the check.
   * @param sites the image's surface voxels (FindSurfaceVoxels)
   * @param local receives the spacing of the proposed points, and bounds
   * @param threads 0 means all cores; results do not depend on it
   */
  UniformInterfaceCheck(const LabelImage<D>& image, const BitMask<D>& sites,
    const Domain<D>& domain, const SizingField<D>& sizing, LocalDelta<D>& local, unsigned threads,
    const std::stop_token& stop);

  /**
   * Proposes points that bring vertices near to far faces.
   * @param changes changes of the interface vertices since the last call; at the first call all are
   *   added
   * @throws Cancelled if a stop was requested before the end
   */
  std::vector<FeatureSeed<D>> InspectVertices(
    const typename InterfaceVertices<D>::Changes& changes);

  /**
   * To be called after InspectVertices(). Proposes points that make edges manifold, and points near
   * faces that became far because labels changed.
   * @param gone positions of vertices that are no longer on interfaces because labels changed. They
   *   count again after this call.
   * @return empty if nothing is wrong, or if the label field has no finer features to sample
   * @throws Cancelled if a stop was requested before the end
   */
  std::vector<FeatureSeed<D>> InspectLabels(
    const std::vector<Point<D>>& gone, const std::vector<NonManifoldPlace<D>>& edges);

  /** The number of far faces at the last inspection. */
  std::size_t NumberOfFarFaces() const { return this->FarFaces; }

private:
  using Index = typename GridGeometry<D>::Index;

  /** A vertex that was near an adjacent face, or null. */
  using Hint = const Point<D>*;

  double LargestDistanceOf(const VoxelFace<D>& face, const Point<D>& centre) const;
  bool IsFar(const VoxelFace<D>& face, Hint& known) const;
  std::vector<VoxelFace<D>> FindAllFar(std::span<const Point<D>> vertices) const;
  std::vector<VoxelFace<D>> FindFarAgain(const std::vector<Point<D>>& gone) const;
  Point<D> PlaceInMask(const Point<D>& p) const;
  void ClearVoxelsNear(const Point<D>& centre, BitMask<D>& voxels) const;
  void ClearVoxelsNear(
    const Point<D>& centre, std::size_t axis, double left2, Index& voxel, BitMask<D>& voxels) const;

  const LabelImage<D>& Image;
  const BitMask<D>& Sites;
  const SizingField<D>& Sizing;
  InterfaceSampling<D> Sampling;
  const unsigned Threads;
  const std::stop_token Stop;
  double VoxelDiagonal;
  double Reach; ///< the largest distance at which any face may have its vertex
  /**
   * If a vertex is within this distance of a voxel's centre, no face on the voxel's upper sides is
   * far. 0: depends on the face.
   */
  double NearVoxel = 0.0;
  std::optional<FeatureGrid<D>> Vertices; ///< at the last InspectVertices()
  std::size_t FarFaces = 0;
};

extern template class UniformInterfaceCheck<3>;
extern template class UniformInterfaceCheck<4>;

} // namespace voxplex

#endif
