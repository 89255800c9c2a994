// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DeltaMeshing.h
 * @brief Meshes a prepared image with one sampling distance.
 */
#ifndef voxplex_DeltaMeshing_h
#define voxplex_DeltaMeshing_h

#include "Mesher/MeshFinishing.h"
#include "Mesher/RefinementStage.h"
#include "Mesher/RunProgress.h"

namespace voxplex
{

/**
 * Chooses sampling distances. Refines and inspects the triangulation (Inspection) in turn, until
 * nothing more is needed. Then extracts the mesh, once. FinishMesh() is the next step.
 *
 * @param run its statistics receive all counts and times; their Delta is the sampling distance
 * @param mesh receives the mesh
 * @return false if stopped
 * @throws Cancelled (a stop may also end in this); TooLargeError; InputError of interface sizes;
 *   std::bad_alloc
 */
template <int D>
bool RefineAndExtract(const RunEnvironment<D>& run, RunProgress& progress, ExtractedMesh<D>& mesh);

extern template bool RefineAndExtract<3>(const RunEnvironment<3>&, RunProgress&, ExtractedMesh<3>&);
extern template bool RefineAndExtract<4>(const RunEnvironment<4>&, RunProgress&, ExtractedMesh<4>&);

} // namespace voxplex

#endif
