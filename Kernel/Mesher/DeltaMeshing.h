// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DeltaMeshing.h
 * @brief Meshes a prepared image with one sampling distance.
 */
#ifndef voxplex_DeltaMeshing_h
#define voxplex_DeltaMeshing_h

#include "Mesh/SimplexMesh.h"
#include "Mesher/Dimension.h"
#include "Mesher/RunProgress.h"

#include <functional>

namespace voxplex
{

/** Whether the extracted mesh is worth optimising. */
template <int D>
using IsWorthOptimising = std::function<bool(const SimplexMesh<D>&)>;

/**
 * Meshes in these steps: chooses sampling distances; refines; runs the checks (ConformityCheck),
 * and refines again until no check needs a remedy; extracts the mesh; optimises it.
 *
 * @param run its statistics receive all counts and times; their Delta is the sampling distance
 * @param mesh receives the mesh
 * @return false if stopped
 * @throws Cancelled (a stop may also end in this); TooLargeError; InputError of interface sizes;
 *   std::bad_alloc
 */
template <int D>
bool MeshWithDelta(const RunEnvironment<D>& run, const IsWorthOptimising<D>& isWorthOptimising,
  RunProgress& progress, SimplexMesh<D>& mesh);

extern template bool MeshWithDelta<3>(
  const RunEnvironment<3>&, const IsWorthOptimising<3>&, RunProgress&, SimplexMesh<3>&);
extern template bool MeshWithDelta<4>(
  const RunEnvironment<4>&, const IsWorthOptimising<4>&, RunProgress&, SimplexMesh<4>&);

} // namespace voxplex

#endif
