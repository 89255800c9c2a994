// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VoxplexRun.h
 * @brief One run of Voxplex with any options, and its statistics.
 */
#ifndef voxplex_VoxplexRun_h
#define voxplex_VoxplexRun_h

#include "Mesher/ImageMesher.h"
#include "MesherRun.h"

namespace voxplex::benchmarks
{

struct VoxplexRun
{
  MesherRun Run;
  MeshingStatistics Statistics;
};

/**
 * Meshes with options.Threads threads in every stage. The total covers everything from the voxels
 * in memory to the mesh in arrays: label ids, label field, distance transform, refinement,
 * extraction.
 * @param volume consumed: it is released as soon as the kernel has read it
 */
VoxplexRun RunVoxplex(LabelVolume&& volume, const MeshingOptions<3>& options);

} // namespace voxplex::benchmarks

#endif
