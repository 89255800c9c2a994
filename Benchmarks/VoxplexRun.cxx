// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MesherRun.h"

#include "ChildProcess.h"
#include "ImageMesher.h"
#include "Stopwatch.h"

namespace voxplex::benchmarks
{

MesherRun RunVoxplex(LabelVolume&& volume, double delta, unsigned threads)
{
  MesherRun run;
  const Stopwatch total;
  const auto grid = GridGeometry<3>::Orthogonal(volume.Dimensions, volume.Spacing);
  const auto image = LabelImage<3>::FromScalars<std::uint16_t>(volume.Labels, grid, {}, threads);
  volume.Labels = {}; // the kernel keeps labels of its own

  MeshingOptions<3> options;
  options.Delta = delta;
  options.Threads = threads;
  ImageMesher<3> mesher(options);
  mesher.Run(image, run.Mesh);
  run.TotalSeconds = total.Seconds();
  run.CpuSeconds = total.CpuSeconds();
  run.RefinementSeconds = mesher.Statistics().Times.Refinement;
  run.PeakBytes = PeakResidentBytes();
  return run;
}

} // namespace voxplex::benchmarks
