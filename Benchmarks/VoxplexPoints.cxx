// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "PointsRun.h"

#include "ChildProcess.h"
#include "Delaunay/Triangulation.h"
#include "CpuStopwatch.h"

#include <stdexcept>

namespace voxplex::benchmarks
{

template <int D>
PointsRun TriangulateWithVoxplex(const std::vector<Point<D>>& points)
{
  Box<D> cube;
  cube.Min.fill(0.0);
  cube.Max.fill(1.0);

  PointsRun run;
  const CpuStopwatch stopwatch;
  Triangulation<D> triangulation(cube);
  typename Triangulation<D>::Worker worker(triangulation);
  SimplexId hint = 0;
  for (const Point<D>& p : points)
  {
    const SimplexId seed = triangulation.FindConflict(worker, p, hint);
    if (triangulation.Insert(worker, p, VertexKind::Feature, seed) != InsertionOutcome::Inserted)
    {
      throw std::runtime_error("a point was not inserted");
    }
    hint = worker.Created.Back();
  }
  run.Seconds = stopwatch.Seconds();
  run.CpuSeconds = stopwatch.CpuSeconds();
  run.PeakBytes = PeakResidentBytes();
  for (SimplexId s = 0; s < triangulation.SimplexIdEnd(); ++s)
  {
    run.Simplices += triangulation.IsAlive(s);
  }
  return run;
}

template PointsRun TriangulateWithVoxplex<3>(const std::vector<Point<3>>&);
template PointsRun TriangulateWithVoxplex<4>(const std::vector<Point<4>>&);

} // namespace voxplex::benchmarks
