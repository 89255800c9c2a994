// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceStage.h
 * @brief What becomes of the interfaces of a refined triangulation before it is a mesh (3D).
 */
#ifndef voxplex_InterfaceStage_h
#define voxplex_InterfaceStage_h

#include "Conformity/EdgeSpindles.h"
#include "Conformity/InterfaceGuard.h"
#include "Conformity/InterfaceOptions.h"
#include "Conformity/InterfaceStatistics.h"
#include "Conformity/InterfaceVertices.h"
#include "Conformity/ManifoldRepair.h"
#include "Delaunay/Triangulation.h"
#include "Geometry/ShapeBounds.h"
#include "Mesh/SimplexLabels.h"
#include "Mesh/SimplexMesh.h"
#include "Mesh/Subdivision.h"

#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Gives tetrahedra their labels, and says where refinement has to go on for the sake of interfaces.
 *
 * InspectTriangulation() is called after each refinement, until it returns no points; then Labels() are those of the
 * mesh. It first looks for faces of voxels that are far from all vertices of interfaces. If there are none each
 * tetrahedron gets the label at its circumcentre, or another one where that makes the boundary of a label manifold
 * (RepairManifold); and InterfaceGuard looks at what that has left or made. All that happens in the triangulation, so that no mesh is extracted before all is well. At edges that
 * are not manifold yet when there are no more points, the mesh has tetrahedra in pieces (MakeSpindles).
 *
 * Where delta is graded triangles count instead of vertices: then only InspectMesh() has points.
 *
 * Not thread safe; uses threads of its own. Nobody may change the triangulation meanwhile.
 */
class InterfaceStage
{
public:
  /** What there is to look at; the references must live as long as the stage. */
  struct Subject
  {
    const Triangulation<3>& Mesh;
    const LabelImage<3>& Image;
    const BitMask<3>& Sites; ///< surface voxels of the image
    const Domain<3>& Surfaces;
    const BaseDensity<3>& Base;
    const InterfaceSizes<3>* Sizes; ///< of single interfaces; may be null
    const SizeFunction<3>* Size;    ///< of elements; may be null
    ShapeBounds Shape;              ///< that repair keeps
    unsigned Threads;               ///< 0 means all cores
  };

  /**
   * All references must live as long as this.
   * @param local receives the spacing of what is to be inserted, and bounds
   * @param figures counts rounds, points and edges
   */
  InterfaceStage(const Subject& subject, const InterfaceOptions& options, LocalDelta<3>& local,
    InterfaceStatistics& figures, const std::stop_token& stop);

  /**
   * Points to go on with; none if all is well, Rounds were made, or the image has no finer features to show.
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  std::vector<FeatureSeed<3>> InspectTriangulation();

  /** Of each simplex id, when InspectTriangulation() has returned nothing. */
  std::span<const LabelId> Labels() const { return this->LabelOf; }

  /** Which tetrahedra the mesh has in pieces, when InspectTriangulation() has returned nothing. */
  const Subdivision& Parts() const { return this->Spindles; }

  /**
   * What InspectTriangulation() does, for a mesh with these labels where delta is graded; elsewhere nothing.
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  std::vector<FeatureSeed<3>> InspectMesh(const SimplexMesh<3>& mesh);

private:
  bool MayGoOn() const { return this->Figures.Rounds < this->Options.Rounds; }
  std::vector<FeatureSeed<3>> Counted(std::vector<FeatureSeed<3>> seeds);
  void MakeLabels();
  std::vector<SimplexId> Repair();
  void OpenEdges();
  std::vector<Point<3>> VerticesWithin(const std::vector<SimplexId>& relabelled) const;

  const Subject Of;
  const InterfaceOptions& Options;
  InterfaceStatistics& Figures;
  const std::stop_token Stop;
  InterfaceVertices Vertices;
  InterfaceGuard Guard;
  SimplexLabels LabelOf;
  std::vector<Point<3>> Gone; ///< vertices that are inside of a label since others were given
  std::vector<InterfaceEdge> NonManifold;     ///< with these labels
  std::vector<InterfaceGuard::Pinch> Pinches; ///< there
  Subdivision Spindles;
};

} // namespace voxplex

#endif
