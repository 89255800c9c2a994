// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "VoxplexRun.h"

#include "ChildProcess.h"
#include "CpuStopwatch.h"

#include <utility>

namespace voxplex::benchmarks
{

VoxplexRun RunVoxplex(LabelVolume&& volume, const MeshingOptions<3>& options)
{
  VoxplexRun result;
  MesherRun& run = result.Run;
  const CpuStopwatch total;
  const auto grid = GridGeometry<3>::Orthogonal(volume.Dimensions, volume.Spacing);
  const auto image =
    LabelImage<3>::FromScalars<std::uint16_t>(volume.Labels, grid, {}, options.Team.Threads);
  volume.Labels = {}; // the kernel has its own copy of the labels

  ImageMesher<3> mesher(options);
  mesher.Run(image, run.Mesh);
  run.TotalSeconds = total.Seconds();
  run.CpuSeconds = total.CpuSeconds();
  result.Statistics = mesher.Statistics();
  run.RefinementSeconds = result.Statistics.Times.Refinement;
  run.PeakBytes = PeakResidentBytes();
  return result;
}

MesherRun RunVoxplex(LabelVolume&& volume, double delta, unsigned threads, Care care)
{
  MeshingOptions<3> options;
  options.Sampling.Delta = delta;
  options.Team.Threads = threads;
  if (care == Care::Plain)
  {
    options.Shape.Slivers.Angle = 0.0;
    options.Components.Smallest = 0;
    options.Interfaces.SampleJunctions = false;
    options.Interfaces.Rounds = 0;
    options.Interfaces.Manifold = false;
  }
  return RunVoxplex(std::move(volume), options).Run;
}

} // namespace voxplex::benchmarks
