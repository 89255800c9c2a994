// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UniformInterfaceCheck.h
 * @brief Whether the interfaces of the image have vertices near them.
 */
#ifndef voxplex_UniformInterfaceCheck_h
#define voxplex_UniformInterfaceCheck_h

#include "Conformity/InterfaceSampling.h"
#include "Conformity/InterfaceVertices.h"
#include "Refinement/FeatureGrid.h"

#include <optional>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Finds what sampling with one distance missed, and says where to sample more finely.
 *
 * R1 asks for the interface that is closest to a circumcentre, so the tip of a thin process, or a hole through a sheet,
 * may never be looked at; and where two interfaces are nearer to each other than their sampling distance, tetrahedra of
 * their labels alternate around edges. The check looks for
 * - faces between voxels of different labels that have no vertex of the interfaces within LargestDistance times the sampling
 *   distance, or a voxel's diagonal if that is more;
 * - edges that are not manifold on the boundary of some label.
 * InterfaceSampling proposes points around them. CGAL's Mesh_3 refines facets around such edges to the same end; the
 * thesis has no such rule.
 *
 * The first InspectVertices() looks at all faces; later calls, and InspectLabels(), look at those that were sampled and
 * at those whose vertex is none of an interface any more.
 *
 * Not thread safe; uses threads of its own. A look at all faces takes time linear in the image's surface voxels.
 */
class UniformInterfaceCheck
{
public:
  /** The distance that is asked for, in sampling distances; to a vertex, so that to a facet is less. */
  static constexpr double LargestDistance = 1.4;

  /**
   * All references must live as long as this.
   * @param sites the image's surface voxels (FindSurfaceVoxels)
   * @param local receives the spacing of what is proposed, and bounds
   * @param threads 0 means all cores; results do not depend on it
   */
  UniformInterfaceCheck(const LabelImage<3>& image, const BitMask<3>& sites,
    const Domain<3>& domain, const SizingField<3>& sizing, LocalDelta<3>& local, unsigned threads,
    const std::stop_token& stop);

  /**
   * Points that would bring vertices near to far faces.
   * @param changes of the interfaces' vertices since the last call; at the first all are added
   * @throws Cancelled if a stop was requested before the end
   */
  std::vector<FeatureSeed<3>> InspectVertices(const InterfaceVertices::Changes& changes);

  /**
   * After InspectVertices(): points that would make edges manifold, and what changes of labels have made far.
   * @param gone positions of vertices that are on interfaces no more because of these changes; they count again afterwards
   * @return nothing if all is well, or if the label field has no finer features to sample
   * @throws Cancelled if a stop was requested before the end
   */
  std::vector<FeatureSeed<3>> InspectLabels(
    const std::vector<Point<3>>& gone, const std::vector<NonManifoldPlace>& edges);

  /** At the last inspection. */
  std::size_t NumberOfFarFaces() const { return this->FarFaces; }

private:
  /** A vertex that was near a face nearby, or null. */
  using Hint = const Point<3>*;

  double LargestDistanceOf(const VoxelFace& face, const Point<3>& centre) const;
  bool IsFar(const VoxelFace& face, Hint& known) const;
  std::vector<VoxelFace> FindAllFar(const std::vector<Point<3>>& vertices) const;
  std::vector<VoxelFace> FindFarAgain(const std::vector<Point<3>>& gone) const;
  void ClearVoxelsNear(const Point<3>& p, BitMask<3>& voxels) const;

  const LabelImage<3>& Image;
  const BitMask<3>& Sites;
  const SizingField<3>& Sizing;
  InterfaceSampling Sampling;
  const unsigned Threads;
  const std::stop_token Stop;
  double VoxelDiagonal;
  double Reach; ///< no face asks for a vertex that is farther
  /** No face is far whose lower voxel has a vertex nearer to its centre. 0: depends on the face. */
  double NearVoxel = 0.0;
  std::optional<FeatureGrid<3>> Vertices; ///< at the last InspectVertices()
  std::size_t FarFaces = 0;
};

} // namespace voxplex

#endif
