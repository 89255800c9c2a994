// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingPipeline.h
 * @brief All stages of a run.
 */
#ifndef voxplex_MeshingPipeline_h
#define voxplex_MeshingPipeline_h

#include "Image/IsosurfaceImage.h"
#include "Image/LabelImage.h"
#include "Mesh/SimplexMesh.h"
#include "Mesher/MeshingOptions.h"
#include "Mesher/MeshingStatistics.h"
#include "Mesher/RunProgress.h"

#include <stop_token>

namespace voxplex
{

/**
 * Calls Prepare() once. Then calls RefineAndInspect() with the sampling distance of the options. If
 * the options request a number of elements, tries several sampling distances until it is met
 * (DeltaSearch). Then calls FinishMesh(), once.
 *
 * @param image loses what is noise, see Prepare()
 * @param isosurface the isosurface to mesh, or null to mesh the labels alone
 * @param statistics must have the sampling distance, unless a number of elements is requested
 * @param progress other threads may read it during the run
 * @return false if stopped
 * @throws InputError, TooLargeError, std::bad_alloc as ImageMesher::Run()
 */
template <int D>
bool RunPipeline(LabelImage<D>& image, const IsosurfaceImage<D>* isosurface,
  const MeshingOptions<D>& options, MeshingStatistics& statistics, RunProgress& progress,
  const std::stop_token& stop, SimplexMesh<D>& mesh);

extern template bool RunPipeline<3>(LabelImage<3>&, const IsosurfaceImage<3>*,
  const MeshingOptions<3>&, MeshingStatistics&, RunProgress&, const std::stop_token&,
  SimplexMesh<3>&);
extern template bool RunPipeline<4>(LabelImage<4>&, const IsosurfaceImage<4>*,
  const MeshingOptions<4>&, MeshingStatistics&, RunProgress&, const std::stop_token&,
  SimplexMesh<4>&);

} // namespace voxplex

#endif
