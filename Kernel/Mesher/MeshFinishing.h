// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshFinishing.h
 * @brief From the labelled triangulation to the mesh.
 */
#ifndef voxplex_MeshFinishing_h
#define voxplex_MeshFinishing_h

#include "Conformity/ManifoldLabels.h"
#include "Mesh/SimplexMesh.h"
#include "Mesher/RefinementStage.h"
#include "Optimisation/Complex.h"
#include "Quality/InterfaceEdges.h"

#include <vector>

namespace voxplex
{

/** The mesh that inspection leaves. */
template <int D>
struct InspectedMesh
{
  Complex<D> Mesh;
  std::vector<InterfaceRidge<D>> NonManifold; ///< its ridges that are not manifold
};

/**
 * Makes the mesh of a labelled triangulation, which is not needed any more.
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
InspectedMesh<D> TakeMesh(
  const RunEnvironment<D>& run, RefinementStage<D>& stage, const ManifoldLabels<D>& labels);

/**
 * Moves the vertices of interfaces so that volumes are right (FitInterfaces), opens the ridges that are not
 * manifold (OpenRidges), improves shapes if the options request it, and writes the mesh. Lists where
 * it differs from the components and contacts of the image. The fit and optimisation lose no component.
 *
 * @param run its statistics have the sampling distance of the mesh
 * @param inspected is empty afterwards
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
void FinishMesh(const RunEnvironment<D>& run, InspectedMesh<D>& inspected, SimplexMesh<D>& mesh);

extern template InspectedMesh<3> TakeMesh<3>(
  const RunEnvironment<3>&, RefinementStage<3>&, const ManifoldLabels<3>&);
extern template InspectedMesh<4> TakeMesh<4>(
  const RunEnvironment<4>&, RefinementStage<4>&, const ManifoldLabels<4>&);
extern template void FinishMesh<3>(const RunEnvironment<3>&, InspectedMesh<3>&, SimplexMesh<3>&);
extern template void FinishMesh<4>(const RunEnvironment<4>&, InspectedMesh<4>&, SimplexMesh<4>&);

} // namespace voxplex

#endif
