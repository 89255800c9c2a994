// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Orientation and in-sphere tests. The static filter decides large simplices. Determinants of small
// simplices are below the bound of the box, so the semi-static filter decides them. Points of a
// small lattice are often coplanar or co-spherical, and need exact arithmetic. The counters are
// fractions of the tests.
#include "Geometry/Predicates.h"
#include "RandomPoints.h"

#include <benchmark/benchmark.h>

#include <utility>

namespace
{

using namespace voxplex;
using namespace voxplex::benchmarks;

constexpr std::size_t NumberOfCases = 4096;
constexpr int LatticeSide = 4;
constexpr double SmallSide = 1e-3;

enum class Input
{
  Random, ///< simplices as large as the box
  Small,  ///< a thousandth of the size of the box
  Lattice
};

/** D + 1 vertices and a query point. */
template <int D>
using Case = std::array<Point<D>, static_cast<std::size_t>(D + 2)>;

template <int D>
std::array<const Point<D>*, static_cast<std::size_t>(D + 1)> SimplexOf(const Case<D>& c)
{
  std::array<const Point<D>*, static_cast<std::size_t>(D + 1)> simplex;
  for (std::size_t i = 0; i < simplex.size(); ++i)
  {
    simplex[i] = &c[i];
  }
  return simplex;
}

/** Positively oriented simplices, each with a point that is not one of its vertices. */
template <int D>
std::vector<Case<D>> MakeCases(Predicates<D>& predicates, Input input)
{
  const std::size_t candidates = 8 * NumberOfCases * (D + 2);
  const std::vector<Point<D>> points = input == Input::Lattice
    ? RandomLatticePoints<D>(candidates, LatticeSide)
    : RandomPoints<D>(candidates, Cube<D>(input == Input::Small ? SmallSide : LatticeSide));
  std::vector<Case<D>> cases;
  for (std::size_t first = 0; cases.size() < NumberOfCases && first < points.size(); first += D + 2)
  {
    Case<D> c;
    std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(first), c.size(), c.begin());
    const int orientation = predicates.Orientation(SimplexOf<D>(c).data());
    if (orientation < 0)
    {
      std::swap(c[0], c[1]);
    }
    if (orientation != 0 && std::find(c.begin(), c.end() - 1, c.back()) == c.end() - 1)
    {
      cases.push_back(c);
    }
  }
  return cases;
}

/** Times `test(predicates, case)` over all cases in turn. */
template <int D, Input input, typename Test>
void Run(benchmark::State& state, Test test)
{
  const Box<D> box = Cube<D>(LatticeSide);
  Predicates<D> predicates(box.Min, box.Max);
  const std::vector<Case<D>> cases = MakeCases<D>(predicates, input);
  predicates.GetStatistics() = {};
  std::size_t next = 0;
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(test(predicates, cases[next]));
    next = next + 1 == cases.size() ? 0 : next + 1;
  }
  const PredicateStatistics& statistics = predicates.GetStatistics();
  const auto tests = static_cast<double>(state.iterations());
  state.counters["static_failures"] = static_cast<double>(statistics.StaticFailures) / tests;
  state.counters["exact"] = static_cast<double>(statistics.ExactCalls) / tests;
}

template <int D, Input input>
void Orientation(benchmark::State& state)
{
  Run<D, input>(state,
    [](Predicates<D>& predicates, const Case<D>& c)
    { return predicates.Orientation(SimplexOf<D>(c).data()); });
}

template <int D, Input input>
void InSpherePerturbed(benchmark::State& state)
{
  Run<D, input>(state,
    [](Predicates<D>& predicates, const Case<D>& c)
    { return predicates.InSpherePerturbed(SimplexOf<D>(c).data(), c.back()); });
}

BENCHMARK(Orientation<3, Input::Random>);
BENCHMARK(Orientation<3, Input::Small>);
BENCHMARK(Orientation<3, Input::Lattice>);
BENCHMARK(Orientation<4, Input::Random>);
BENCHMARK(Orientation<4, Input::Small>);
BENCHMARK(Orientation<4, Input::Lattice>);
BENCHMARK(InSpherePerturbed<3, Input::Random>);
BENCHMARK(InSpherePerturbed<3, Input::Small>);
BENCHMARK(InSpherePerturbed<3, Input::Lattice>);
BENCHMARK(InSpherePerturbed<4, Input::Random>);
BENCHMARK(InSpherePerturbed<4, Input::Small>);
BENCHMARK(InSpherePerturbed<4, Input::Lattice>);

} // namespace
