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

#include <cstdint>
#include <functional>

namespace voxplex
{

/**
 * Chooses sampling distances. Refines and inspects the triangulation (Inspection) in turn, until
 * nothing more is needed. FinishMesh() is the next step.
 *
 * @param run its statistics receive all counts and times; their Delta is the sampling distance
 * @param wants is told the number of elements; says whether the mesh is wanted
 * @param mesh receives the mesh, if it is
 * @return false if stopped
 * @throws Cancelled (a stop may also end in this); TooLargeError; InputError of interface sizes;
 *   std::bad_alloc
 */
template <int D>
bool RefineAndInspect(const RunEnvironment<D>& run, RunProgress& progress,
  const std::function<bool(std::uint64_t)>& wants, InspectedMesh<D>& mesh);

extern template bool RefineAndInspect<3>(const RunEnvironment<3>&, RunProgress&,
  const std::function<bool(std::uint64_t)>&, InspectedMesh<3>&);
extern template bool RefineAndInspect<4>(const RunEnvironment<4>&, RunProgress&,
  const std::function<bool(std::uint64_t)>&, InspectedMesh<4>&);

} // namespace voxplex

#endif
