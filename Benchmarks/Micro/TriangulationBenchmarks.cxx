// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Measures the processor time of inserting and removing points. An iteration is a whole run. Items
// are points. The counter `simplices` counts all created simplices, including those deleted since.
#include "CpuStopwatch.h"
#include "PointTriangulation.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>

namespace
{

using namespace voxplex;
using namespace voxplex::benchmarks;

template <int D, Input input>
void Insertion(benchmark::State& state)
{
  const auto n = static_cast<std::size_t>(state.range(0));
  const double side = SideFor<D>(n, input);
  const std::vector<Point<D>> points = MakePoints<D>(n, input, side);
  double created = 0.0;
  for (auto _ : state)
  {
    const CpuStopwatch stopwatch;
    Instance<D> instance(Cube<D>(side));
    if (!instance.Insert(points))
    {
      state.SkipWithError("a point was not inserted");
    }
    state.SetIterationTime(stopwatch.CpuSeconds()); // one thread
    created += static_cast<double>(instance.Worker.NumberOfCreated);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
  state.counters["simplices"] = benchmark::Counter(created, benchmark::Counter::kIsRate);
}

/** Removes half of the vertices, in random order. */
template <int D, Input input>
void Removal(benchmark::State& state)
{
  const auto n = static_cast<std::size_t>(state.range(0));
  const double side = SideFor<D>(n, input);
  const std::vector<Point<D>> points = MakePoints<D>(n, input, side);
  std::int64_t removed = 0;
  double created = 0.0;
  for (auto _ : state)
  {
    Instance<D> instance(Cube<D>(side));
    std::vector<VertexId> vertices;
    if (instance.Insert(points))
    {
      std::sample(instance.Vertices.begin(), instance.Vertices.end(), std::back_inserter(vertices),
        points.size() / 2, std::mt19937_64(1));
      std::shuffle(vertices.begin(), vertices.end(), std::mt19937_64(2));
    }
    const std::uint64_t before = instance.Worker.NumberOfCreated;
    const CpuStopwatch stopwatch;
    if (vertices.empty() || !instance.Remove(vertices))
    {
      state.SkipWithError("a vertex was not removed");
    }
    state.SetIterationTime(stopwatch.CpuSeconds()); // one thread
    removed += static_cast<std::int64_t>(vertices.size());
    created += static_cast<double>(instance.Worker.NumberOfCreated - before);
  }
  state.SetItemsProcessed(removed);
  state.counters["simplices"] = benchmark::Counter(created, benchmark::Counter::kIsRate);
}

void Configure3D(benchmark::internal::Benchmark* b)
{
  b->Arg(100000)->UseManualTime()->Unit(benchmark::kMillisecond);
}

void Configure4D(benchmark::internal::Benchmark* b)
{
  b->Arg(5000)->UseManualTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK(Insertion<3, Input::Random>)->Apply(Configure3D);
BENCHMARK(Insertion<3, Input::Lattice>)->Apply(Configure3D);
BENCHMARK(Insertion<4, Input::Random>)->Apply(Configure4D);
BENCHMARK(Insertion<4, Input::Lattice>)->Apply(Configure4D);
BENCHMARK(Removal<3, Input::Random>)->Apply(Configure3D);
BENCHMARK(Removal<3, Input::Lattice>)->Apply(Configure3D);
BENCHMARK(Removal<4, Input::Random>)->Apply(Configure4D);
BENCHMARK(Removal<4, Input::Lattice>)->Apply(Configure4D);

} // namespace
