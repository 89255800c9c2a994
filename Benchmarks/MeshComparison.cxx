// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshComparison.h"

#include "ChildProcess.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace voxplex::benchmarks
{

double CountTetrahedra(const Contestant& contestant, double size)
{
  const double tetrahedra =
    RunInChild([&] { return static_cast<double>(contestant.Mesh(size).Mesh.Simplices.size()); });
  std::fprintf(
    stderr, "tuning: %s of size %.4g makes %.0f tetrahedra\n", contestant.Name, size, tetrahedra);
  return tetrahedra;
}

double TuneSize(Contestant& contestant, double size, double wanted)
{
  // Leaves a margin, because several threads make a different mesh in each run.
  constexpr double tolerance = 0.6 * SizeTolerance;
  double exponent = -2.4; // between a surface (-2) and a volume (-3)
  double previousSize = 0.0;
  double previousCount = 0.0;
  for (int attempt = 0; attempt < 8; ++attempt)
  {
    const double tetrahedra = CountTetrahedra(contestant, size);
    if (std::abs(tetrahedra / wanted - 1.0) <= tolerance)
    {
      contestant.Size = size;
      return tetrahedra;
    }
    if (attempt > 0)
    {
      exponent = std::log(tetrahedra / previousCount) / std::log(size / previousSize);
      exponent = std::clamp(exponent, -4.0, -1.0);
    }
    previousSize = size;
    previousCount = tetrahedra;
    size *= std::pow(wanted / tetrahedra, 1.0 / exponent);
  }
  throw std::runtime_error(std::string("cannot tune the size of ") + contestant.Name);
}

void AddRun(Contestant& contestant, const LabelVolumes& image)
{
  contestant.Records.push_back(RunInChild(
    [&]
    {
      const MesherRun run = contestant.Mesh(contestant.Size);
      return Record{ Measure(run.Mesh, image), run.RefinementSeconds, run.TotalSeconds,
        run.CpuSeconds, run.PeakBytes };
    }));
}

} // namespace voxplex::benchmarks
