// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceCheck.h
 * @brief Whether the interfaces of a refined triangulation are those of the image, and manifold (3D).
 */
#ifndef voxplex_InterfaceCheck_h
#define voxplex_InterfaceCheck_h

#include "Conformity/ConformityCheck.h"
#include "Conformity/EdgeSpindles.h"
#include "Conformity/GradedInterfaceCheck.h"
#include "Conformity/InterfaceOptions.h"
#include "Conformity/InterfaceStatistics.h"
#include "Conformity/InterfaceVertices.h"
#include "Conformity/ManifoldRepair.h"
#include "Conformity/UniformInterfaceCheck.h"
#include "Delaunay/Triangulation.h"
#include "Geometry/ShapeBounds.h"
#include "Mesh/SimplexLabels.h"
#include "Mesh/SimplexMesh.h"
#include "Mesh/Subdivision.h"

#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Gives tetrahedra their labels, and says where refinement has to go on for the sake of interfaces.
 *
 * InspectTriangulation() first looks for faces of voxels that are far from all vertices of interfaces. If there are none
 * each tetrahedron gets the label at its circumcentre, or another one where that makes the boundary of a label manifold
 * (RepairManifold); and what that has left or made is looked at (UniformInterfaceCheck). All that happens in the
 * triangulation, so that no mesh is extracted before all is well. Edges that are not manifold yet, when refinement does not go
 * on, are opened: there the mesh has tetrahedra in pieces (MakeSpindles).
 *
 * Where sampling distances are graded, triangles count instead of vertices: then only InspectMesh() asks for points
 * (GradedInterfaceCheck).
 *
 * Not thread safe; uses threads of its own. Nobody may change the triangulation meanwhile.
 */
class InterfaceCheck final : public ConformityCheck<3>
{
public:
  /** What there is to look at; the references must live as long as the check. */
  struct Subject
  {
    const Triangulation<3>& Mesh;
    const LabelImage<3>& Image;
    const BitMask<3>& Sites; ///< surface voxels of the image
    const Domain<3>& Surfaces;
    const SizingField<3>& Sizing;
    ShapeBounds Shape; ///< that repair keeps
    unsigned Threads;  ///< 0 means all cores
  };

  /**
   * All references must live as long as this.
   * @param local receives the spacing of what is to be inserted, and bounds
   * @param statistics counts rounds, points and edges
   */
  InterfaceCheck(const Subject& subject, const InterfaceOptions& options, LocalDelta<3>& local,
    InterfaceStatistics& statistics, double& seconds, const std::stop_token& stop);

  /** Asks for nothing more when as many rounds were made as the options allow. */
  Remedy<3> InspectTriangulation() override;
  Remedy<3> InspectMesh(const SimplexMesh<3>& mesh) override;

  /** Of each simplex id, when InspectTriangulation() has asked for nothing. */
  std::span<const LabelId> Labels() const { return this->LabelOf; }

  /** Which tetrahedra the mesh has in pieces, when InspectTriangulation() has asked for nothing. */
  const Subdivision& Parts() const { return this->Spindles; }

private:
  bool MayGoOn() const { return this->Statistics.Rounds < this->Options.Rounds; }
  Remedy<3> Counted(std::vector<FeatureSeed<3>> points);
  void MakeLabels();
  std::vector<SimplexId> Repair();
  void OpenEdges();
  std::vector<Point<3>> VerticesWithin(const std::vector<SimplexId>& relabelled) const;

  const Subject Of;
  const InterfaceOptions Options;
  InterfaceStatistics& Statistics;
  const std::stop_token Stop;
  InterfaceVertices Vertices;
  std::optional<UniformInterfaceCheck> Uniform;
  std::optional<GradedInterfaceCheck> Graded;
  SimplexLabels LabelOf;
  std::vector<Point<3>> Gone; ///< vertices that are inside of a label since others were given
  std::vector<InterfaceEdge> NonManifold; ///< with these labels
  std::vector<NonManifoldPlace> Places;   ///< of these edges
  Subdivision Spindles;
};

} // namespace voxplex

#endif
