// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Measures the processor time of inserting and removing points. An iteration is a whole run. Items
// are points. The counter `simplices` counts all created simplices, including those deleted since.
#include "Delaunay/Triangulation.h"
#include "Geometry/HilbertOrder.h"
#include "RandomPoints.h"
#include "CpuStopwatch.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>

namespace
{

using namespace voxplex;
using namespace voxplex::benchmarks;

enum class Input
{
  Random,
  Lattice
};

/** n distinct points inside a cube of the given side, along a Hilbert curve. */
template <int D>
std::vector<Point<D>> MakePoints(std::size_t n, Input input, double side)
{
  const Box<D> cube = Cube<D>(side);
  std::vector<Point<D>> points;
  if (input == Input::Random)
  {
    points = RandomPoints<D>(n, cube);
  }
  else
  {
    points = RandomLatticePoints<D>(n, static_cast<int>(side) - 1);
    for (Point<D>& p : points)
    {
      for (double& x : p)
      {
        x += 1.0; // off the box
      }
    }
  }
  std::sort(points.begin(), points.end(),
    [&](const Point<D>& a, const Point<D>& b)
    { return std::pair(HilbertIndex<D>(a, cube), a) < std::pair(HilbertIndex<D>(b, cube), b); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/** A triangulation with its worker. */
template <int D>
struct Instance
{
  Triangulation<D> Delaunay;
  typename Triangulation<D>::Worker Worker;
  std::vector<VertexId> Vertices;

  explicit Instance(const Box<D>& box)
    : Delaunay(box)
    , Worker(Delaunay)
  {
  }

  bool Insert(const std::vector<Point<D>>& points)
  {
    SimplexId hint = 0;
    this->Vertices.reserve(points.size());
    for (const Point<D>& p : points)
    {
      const SimplexId seed = this->Delaunay.FindConflict(this->Worker, p, hint);
      if (this->Delaunay.Insert(this->Worker, p, VertexKind::Free, seed) !=
        InsertionOutcome::Inserted)
      {
        return false;
      }
      this->Vertices.push_back(this->Worker.NewVertex);
      hint = this->Worker.Created.Back();
    }
    return true;
  }

  bool Remove(const std::vector<VertexId>& vertices)
  {
    return std::all_of(vertices.begin(), vertices.end(),
      [this](VertexId v)
      { return this->Delaunay.Remove(this->Worker, v) == RemovalOutcome::Removed; });
  }
};

/** The side of a cube in which points use about two out of three lattice points. */
template <int D>
double SideFor(std::size_t n, Input input)
{
  return input == Input::Random ? 1.0 : std::ceil(std::pow(static_cast<double>(n), 1.0 / D)) + 1.0;
}

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
