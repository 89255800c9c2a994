// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceGuard.h
 * @brief Sees to it that the mesh's interfaces are near the image's, and manifold.
 */
#ifndef voxplex_InterfaceGuard_h
#define voxplex_InterfaceGuard_h

#include "Conformity/InterfaceVertices.h"
#include "Domain/Domain.h"
#include "Geometry/BoundingTree.h"
#include "Image/BitMask.h"
#include "Image/FacesNear.h"
#include "Mesh/SimplexMesh.h"
#include "Refinement/FeatureGrid.h"
#include "Refinement/FeatureSeed.h"
#include "Sizing/BaseDensity.h"
#include "Sizing/InterfaceSizes.h"
#include "Sizing/LocalDelta.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Finds what sampling with delta missed, and says where to sample more finely.
 *
 * R1 asks for the interface that is closest to a circumcentre, so the tip of a thin process, or a hole
 * through a sheet, may never be looked at; and where two interfaces are nearer to each other than delta,
 * tetrahedra of their labels alternate around edges. It looks for
 * - faces between voxels of different labels that have no vertex of the interfaces within LargestDistance times
 *   delta, or a voxel's diagonal if that is more; where delta is graded and vertices may be rare, from which the mesh's
 *   triangles are farther than 1.22 times the delta that was asked for, or half a voxel's diagonal if that is more;
 * - pinches: edges that are not manifold on the boundary of some label, where other than two of its facets meet.
 *
 * Around each of these it proposes points of the interfaces half a delta apart (a quarter, if it comes there
 * again, and so on), to be inserted before refinement goes on. Where faces are far a second time, R1 gets a
 * smaller delta besides (LocalDelta), so that circumcentres come to lie in what is thin. CGAL's Mesh_3 refines
 * facets around such edges to the same end; the thesis has no such rule.
 *
 * The first InspectVertices() looks at all faces; later ones, and InspectLabels(), at those that were sampled and at
 * those whose vertex is none of an interface any more. Where delta is graded InspectMesh() is called instead; it looks at
 * those that were sampled, and at all others only when nothing is wrong with these.
 *
 * Not thread safe; uses threads of its own. A look at all faces takes time linear in the image's surface voxels, and
 * n log n in the number of the interfaces' facets.
 */
class InterfaceGuard
{
public:
  /** Where the boundary of a label is no surface: at an edge. */
  struct Pinch
  {
    Point<3> Middle;
    bool IsJunction; ///< three labels or more meet there
  };

  /** The distance that is asked for, in delta; to a vertex, so that to a facet is less. */
  static constexpr double LargestDistance = 1.4;
  /** Where delta is graded the mesh may be so far from interfaces, with the finest delta that was asked for. */
  static double LargestSurfaceDistance(const GridGeometry<3>& grid, double delta);

  /**
   * All references must live as long as this.
   * @param sites the image's surface voxels (FindSurfaceVoxels)
   * @param base sampling density
   * @param sizes that of single interfaces, in its place; may be null
   * @param local receives the spacing of what is proposed, and bounds
   * @param threads 0 means all cores; results do not depend on it
   */
  InterfaceGuard(const LabelImage<3>& image, const BitMask<3>& sites, const Domain<3>& domain,
    const BaseDensity<3>& base, const InterfaceSizes<3>* sizes, LocalDelta<3>& local,
    unsigned threads, const std::stop_token& stop);

  /**
   * Points that would bring vertices near to far faces. Not where delta is graded: there triangles count.
   * @param changes of the interfaces' vertices since the last call; at the first all are added
   * @throws Cancelled if a stop was requested before the end
   */
  std::vector<FeatureSeed<3>> InspectVertices(const InterfaceVertices::Changes& changes);

  /**
   * After InspectVertices(): points that would mend pinches, and what changes of labels have made far.
   * @param gone positions of vertices that are on interfaces no more for the sake of these; counted again afterwards
   * @return nothing if all is well, or if the label field has no finer features to sample
   * @throws Cancelled if a stop was requested before the end
   */
  std::vector<FeatureSeed<3>> InspectLabels(
    const std::vector<Point<3>>& gone, const std::vector<Pinch>& pinches);

  /**
   * Where delta is graded: points that would mend what is wrong with a mesh's interfaces.
   * @param pinches of the mesh
   * @return as that of InspectLabels()
   * @throws Cancelled if a stop was requested before the end
   */
  std::vector<FeatureSeed<3>> InspectMesh(
    const SimplexMesh<3>& mesh, const std::vector<Pinch>& pinches);

  /** At the last inspection. */
  std::size_t NumberOfFarFaces() const { return this->FarFaces; }

private:
  using Index = GridGeometry<3>::Index;
  using Face = VoxelFace;

  /** What interfaces consist of. */
  struct Interfaces
  {
    Interfaces(double reach, std::size_t expected, std::vector<Triangle> triangles,
      unsigned threads, const std::stop_token& stop);

    FeatureGrid<3> Vertices;
    BoundingTree<Triangle> Triangles; ///< empty unless delta is graded
  };
  /** What was near a face nearby. */
  struct Hint
  {
    const Point<3>* Vertex = nullptr;
    std::uint32_t Triangle = 0; ///< see BoundingTree
  };
  /** Those of a voxel on its upper sides. */
  void FindFarFacesOf(
    const Index& voxel, const Interfaces& mesh, Hint& hint, std::vector<Face>& far) const;
  /** Clears the bits of voxels nearer to p than NearVoxel. Other threads may do so at the same time. */
  void ClearVoxelsNear(const Point<3>& p, BitMask<3>& voxels) const;
  double Reach() const;
  std::vector<Face> FindFarFaces(const SimplexMesh<3>& mesh) const;
  /** @param vertices those of the interfaces */
  std::vector<Face> FindAllFar(
    const Interfaces& interfaces, const std::vector<Point<3>>& vertices) const;
  /** Of those that were sampled, and those that may have been near to vertices that have gone. */
  std::vector<Face> FindFarAgain(
    const std::vector<Point<3>>& gone, const Interfaces& interfaces) const;
  std::vector<Face> FilterFar(const std::vector<Face>& faces, const Interfaces& interfaces) const;
  /** Points around far faces and pinches. */
  std::vector<FeatureSeed<3>> Propose(
    const std::vector<Face>& far, const std::vector<Pinch>& pinches);
  std::vector<FeatureSeed<3>> ProposeIfBad(
    const std::vector<Face>& far, const std::vector<Pinch>& pinches);
  bool IsFar(const Face& face, const Interfaces& mesh, Hint& hint) const;
  bool IsFarFromVertices(
    const Face& face, const FeatureGrid<3>& vertices, const Point<3>*& known) const;
  bool IsFarFromTriangles(const Face& face, const Interfaces& mesh, std::uint32_t& hint) const;
  void LowerBound(const Face& face);
  static Index CellOf(const Face& face);
  /** Of what is sampled when a cell is visited again after so many visits. */
  double SpacingAt(const Face& face, unsigned visit) const;
  double DeltaAt(const Face& face) const;
  double DeltaAt(const Face& face, const Point<3>& centre) const;
  /** What sampling around a far face begins with: delta, but where that is graded no more than was asked for. */
  double RemedyAt(const Face& face) const;
  double DensestAt(const Point<3>& p) const;
  Point<3> CentreOf(const Face& face) const;

  const LabelImage<3>& Image;
  const BitMask<3>& Sites;
  const Domain<3>& Surfaces;
  const BaseDensity<3> Base;
  const InterfaceSizes<3>* const Sizes;
  double VoxelDiagonal;
  double NearEnough; ///< LargestSurfaceDistance()
  /** No face is far whose lower voxel has a vertex nearer to its centre. 0: depends on the face. */
  double NearVoxel = 0.0;
  double FinestSpacing;
  LocalDelta<3>& Local;
  const unsigned Threads;
  const std::stop_token Stop;
  std::map<Index, unsigned> Visits; ///< by cell of LocalDelta
  std::vector<Face> Sampled;        ///< in earlier inspections, ascending
  std::optional<Interfaces> Known;  ///< vertices at the last InspectVertices()
  std::size_t FarFaces = 0;
};

} // namespace voxplex

#endif
