// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DistanceCheck.h
 * @brief Finds the interfaces of the image that have no interface of the mesh near them.
 */
#ifndef voxplex_DistanceCheck_h
#define voxplex_DistanceCheck_h

#include "Domain/Domain.h"
#include "Geometry/Triangle.h"
#include "Image/BitMask.h"
#include "Image/FacesNear.h"
#include "Image/LabelImage.h"
#include "Mesh/LabelledTriangulation.h"
#include "Sizing/SizingField.h"

#include <cstddef>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** The interfaces of a mesh: facets between different labels, those on the box left out. */
template <int D>
struct MeshInterfaces
{
  std::vector<Point<D>> Vertices;
  std::vector<Triangle> Facets; ///< only if distances to them are measured; 3D
};

/**
 * @brief Finds the faces between voxels of different labels that are far from the mesh.
 *
 * R1 looks only at the interface closest to a circumcentre. So it may never see the tip of a thin
 * process, or a hole through a sheet. The thesis has no such check. There are two measures:
 * - A face is far if no vertex of an interface is within LargestDistance times the sampling distance
 *   of its centre, or within a voxel's diagonal if that is larger.
 * - If sampling distances are graded, vertices may be sparse, and in 3D the distance to facets
 *   counts. Let L be LargestDistanceToFacets(). A face is far if no facet is within 1.15 L of its
 *   centre, or if none is within L of the interface point between its two voxel centres. In 4D there
 *   is the first measure only.
 *
 * It keeps no state: threads may call it at once. It uses threads of its own. Checking all faces
 * takes time linear in the number of the image's surface voxels and of the elements, and with facets
 * O(n log n) for n facets.
 */
template <int D>
class DistanceCheck
{
public:
  /**
   * The largest allowed distance from a face to a vertex, in sampling distances. The distance to a
   * facet is smaller.
   */
  static constexpr double LargestDistance = 1.4;

  /**
   * The largest allowed distance of facets from interfaces.
   * @param delta the finest requested sampling distance
   */
  static double LargestDistanceToFacets(const GridGeometry<D>& grid, double delta);

  /**
   * All references must outlive the check.
   * @param sites the image's surface voxels (FindSurfaceVoxels)
   * @param threads 0 means all cores; results do not depend on it
   */
  DistanceCheck(const LabelImage<D>& image, const BitMask<D>& sites, const Domain<D>& domain,
    const SizingField<D>& sizing, unsigned threads, const std::stop_token& stop);

  ///@{
  /**
   * The faces that are far: of all, in the order of voxels, or among some, in their order. The vertices
   * on interfaces have to be marked (MarkInterfaceVertices).
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  std::vector<VoxelFace<D>> FindFar(const LabelledTriangulation<D>& elements) const;
  std::vector<VoxelFace<D>> FindFar(
    const LabelledTriangulation<D>& elements, const std::vector<VoxelFace<D>>& among) const;
  ///@}

  /** FindFar() for a mesh that is given by its interfaces. */
  std::vector<VoxelFace<D>> FindFar(MeshInterfaces<D> interfaces) const;

private:
  using Index = typename GridGeometry<D>::Index;

  class Mesh;

  template <typename IsWanted>
  std::vector<Point<D>> FindVertices(
    const LabelledTriangulation<D>& elements, const IsWanted& isWanted) const;
  MeshInterfaces<D> Find(
    const LabelledTriangulation<D>& elements, const std::vector<VoxelFace<D>>* among) const;
  BitMask<D> VoxelsToLookAt(const std::vector<Point<D>>& vertices) const;
  Point<D> PlaceInMask(const Point<D>& p) const;
  void ClearVoxelsNear(
    const Point<D>& centre, std::size_t axis, double left2, Index& voxel, BitMask<D>& voxels) const;

  const LabelImage<D>& Image;
  const BitMask<D>& Sites;
  const Domain<D>& Surfaces;
  const SizingField<D>& Sizing;
  const unsigned Threads;
  const std::stop_token Stop;
  const bool MeasuresFacets;
  const double VoxelDiagonal;
  const double Reach; ///< no face whose nearest vertex is farther away can be near it
  /**
   * If a vertex is within this distance of a voxel's centre, no face on the voxel's upper sides is
   * far. 0: depends on the face.
   */
  double NearVoxel = 0.0;
};

extern template class DistanceCheck<3>;
extern template class DistanceCheck<4>;

} // namespace voxplex

#endif
