// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceCheck.h
 * @brief Checks that the interfaces of a refined triangulation match those of the image, and are
 * manifold (3D).
 */
#ifndef voxplex_InterfaceCheck_h
#define voxplex_InterfaceCheck_h

#include "Conformity/ConformityCheck.h"
#include "Conformity/ConformityOptions.h"
#include "Conformity/EdgeSpindles.h"
#include "Conformity/GradedInterfaceCheck.h"
#include "Conformity/InterfaceStatistics.h"
#include "Conformity/InterfaceVertices.h"
#include "Conformity/ManifoldLabels.h"
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
 * @brief Gives tetrahedra their labels, and decides where refinement has to be resumed to correct
 * interfaces.
 *
 * InspectTriangulation() looks for voxel faces that are far from all vertices of interfaces. If
 * there are none, it takes these steps:
 * - Each tetrahedron gets the label at its circumcentre. Some tetrahedra get another label, so that
 *   a label holds together (RelabelCrumbs) and its boundary is manifold (RepairManifold).
 * - Edges that are still not manifold are opened: the mesh gets the tetrahedra around them in pieces
 *   (MakeSpindles).
 *
 * InspectElements() checks the edges that were opened, and the faces that the repair made far
 * (UniformInterfaceCheck). Both use the triangulation, so no mesh is extracted before its interfaces
 * are correct.
 *
 * If sampling distances are graded, distances are measured to triangles instead of vertices. Then
 * only InspectMesh() requests points (GradedInterfaceCheck).
 *
 * Not thread safe; uses threads of its own. No thread may change the triangulation during a call.
 */
class InterfaceCheck final : public ConformityCheck<3>
{
public:
  /** The objects to inspect. The references must outlive the check. */
  struct Subject
  {
    const Triangulation<3>& Mesh;
    const LabelImage<3>& Image;
    const BitMask<3>& Sites; ///< surface voxels of the image
    const Domain<3>& Surfaces;
    const SizingField<3>& Sizing;
    ShapeBounds Shape; ///< bounds that the repair respects
    unsigned Threads;  ///< 0 means all cores
  };

  /**
   * All references must outlive the check.
   * @param local receives the spacing of the points to be inserted, and bounds
   * @param statistics counts rounds, points and edges
   */
  InterfaceCheck(const Subject& subject, const InterfaceOptions& options, LocalDelta<3>& local,
    InterfaceStatistics& statistics, double& seconds, const std::stop_token& stop);

  /** Requests no points once the number of rounds has reached the limit in the options. */
  Remedy<3> InspectTriangulation() override;
  Remedy<3> InspectElements(const LabelledTriangulation<3>& elements) override;
  Remedy<3> InspectMesh(const SimplexMesh<3>& mesh) override;

  /** Whether InspectMesh() may request points. */
  bool NeedsMesh() const { return this->Graded && this->MayGoOn(); }
  /** Call this if refinement is not resumed. It frees what only further inspections need. */
  void Finish();

  /** The label of each simplex id. Valid if InspectTriangulation() requested nothing. */
  std::span<const LabelId> Labels() const { return this->Made.Labels; }

  /** The tetrahedra that were cut in pieces. Valid if InspectTriangulation() requested nothing. */
  const Subdivision<3>& Parts() const { return this->Spindles; }

private:
  bool MayGoOn() const { return this->Statistics.Rounds < this->Options.Rounds; }
  Remedy<3> Counted(std::vector<FeatureSeed<3>> points);
  void MakeLabels();
  void OpenEdges();

  const Subject Of;
  const InterfaceOptions Options;
  InterfaceStatistics& Statistics;
  const std::stop_token Stop;
  InterfaceVertices<3> Vertices;
  ManifoldLabeller<3> Labeller;
  std::optional<UniformInterfaceCheck<3>> Uniform;
  std::optional<GradedInterfaceCheck> Graded;
  ManifoldLabels<3> Made;
  Subdivision<3> Spindles;
};

} // namespace voxplex

#endif
