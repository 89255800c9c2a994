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
#include "Optimisation/Surroundings.h"

#include <type_traits>
#include <variant>

namespace voxplex
{

/** A mesh, and what optimisation needs to know besides. */
template <int D>
struct ExtractedMesh
{
  SimplexMesh<D> Mesh;
  /** 4D: the pentatopes around it, if it is to be optimised. */
  std::conditional_t<D == 4, Surroundings<4>, std::monostate> Outside;
};

/**
 * Moves the vertices of interfaces so that volumes are right (FitInterfaces), opens the ridges
 * that are not manifold (OpenRidges), and extracts the mesh. The fit keeps all components.
 *
 * @param stage in 3D only the points and the simplices of its mesh can be read afterwards
 * @param mesh receives the mesh
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
void Extract(const RunEnvironment<D>& run, RefinementStage<D>& stage,
  const ManifoldLabels<D>& labels, ExtractedMesh<D>& mesh);

/**
 * Improves shapes if the options request it, and lists where the mesh differs from the components and contacts of the image.
 * Optimisation loses none that it has. The triangulation is not needed any more.
 *
 * @param run its statistics have the sampling distance of the mesh
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
void FinishMesh(const RunEnvironment<D>& run, ExtractedMesh<D>& mesh);

extern template void Extract<3>(
  const RunEnvironment<3>&, RefinementStage<3>&, const ManifoldLabels<3>&, ExtractedMesh<3>&);
extern template void Extract<4>(
  const RunEnvironment<4>&, RefinementStage<4>&, const ManifoldLabels<4>&, ExtractedMesh<4>&);
extern template void FinishMesh<3>(const RunEnvironment<3>&, ExtractedMesh<3>&);
extern template void FinishMesh<4>(const RunEnvironment<4>&, ExtractedMesh<4>&);

} // namespace voxplex

#endif
