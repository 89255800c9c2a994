// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/RefinementStage.h"

#include "Base/Stopwatch.h"
#include "Parallel/ParallelFor.h"
#include "Refinement/Refiner.h"
#include "Refinement/Rules/Rules3D.h"
#include "Refinement/Rules/Rules4D.h"
#include "Refinement/Tiles/TiledRefiner.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace voxplex
{

namespace
{

template <int D>
using RulesOf = std::conditional_t<D == 3, Rules3D, Rules4D>;

/** With the numbers of threads that the machine has. */
TeamOptions LimitThreads(TeamOptions team)
{
  team.Threads = std::min(NumberOfThreads(team.Threads), MaximumNumberOfWorkers);
  team.FineGrained = team.FineGrained && team.Threads <= NumberOfThreads(0);
  return team;
}

//------------------------------------------------------------------------------------------------
template <int D>
void AddRelaxedRegions(MeshingStatistics& statistics, const GridGeometry<D>& grid,
  const std::vector<RelaxedRegion<D>>& regions)
{
  for (const RelaxedRegion<D>& region : regions)
  {
    const Point<D> index = grid.ToIndex(region.Position);
    RelaxationReport report{ static_cast<unsigned>(region.Step), {} };
    for (std::size_t a = 0; a < D; ++a)
    {
      const auto last = static_cast<double>(grid.Dimensions[a] - 1);
      report.Voxel.push_back(std::llround(std::clamp(index[a], 0.0, last)));
    }
    statistics.RelaxedRegions.push_back(std::move(report));
  }
}

/** Runs a refiner. @return false if stopped */
template <int D, typename AnyRefiner>
bool RunRefiner(const RunEnvironment<D>& run, AnyRefiner& refiner, std::uint64_t expectedVertices,
  std::uint64_t others, RunProgress& progress)
{
  const Stopwatch time;
  const bool done = refiner.Run(
    [&](std::uint64_t vertices)
    {
      progress.Refine(
        static_cast<double>(others + vertices) / static_cast<double>(expectedVertices));
      return !run.Stop.stop_requested();
    });
  MeshingStatistics& statistics = run.Statistics;
  statistics.Times.Refinement += time.Seconds();
  statistics.Rules += refiner.GetRuleStatistics();
  statistics.Predicates += refiner.GetPredicateStatistics();
  const std::vector<ThreadStatistics>& threads = refiner.GetThreadStatistics();
  statistics.Threads.resize(std::max(statistics.Threads.size(), threads.size()));
  for (std::size_t t = 0; t < threads.size(); ++t)
  {
    statistics.Threads[t] += threads[t];
  }
  AddRelaxedRegions(statistics, run.Prepared.Image.Grid(), refiner.GetRelaxedRegions());
  return done;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
bool RefineContext(const RunEnvironment<D>& run, RefinementContext<D>& context,
  const std::vector<FeatureSeed<D>>& seeds, RefinementStart start, std::uint64_t expectedVertices,
  RunProgress& progress, std::uint64_t others)
{
  using Rules = RulesOf<D>;
  const TeamOptions team = LimitThreads(run.Options.Team);
  if (team.Reproducible)
  {
    TiledRefiner<Rules> refiner(context, team, seeds, start);
    return RunRefiner(run, refiner, expectedVertices, others, progress);
  }
  const bool done = [&]
  {
    Refiner<Rules> refiner(context, team, seeds, start);
    const bool isDone = RunRefiner(run, refiner, expectedVertices, others, progress);
    run.Statistics.SeedingSeconds += refiner.GetSecondsToSeed();
    run.Statistics.SwitchedToLocal |= refiner.SwitchedToLocal();
    return isDone;
  }();
  if (done && start == RefinementStart::Everywhere)
  {
    const Stopwatch time;
    context.Mesh.Renumber(team.Threads); // all that follows finds neighbours near in memory
    run.Statistics.Times.Refinement += time.Seconds();
  }
  return done;
}

template <int D>
Box<D> BoxAround(const Domain<D>& domain, double largestDistance)
{
  Box<D> box = domain.Bounds();
  for (std::size_t a = 0; a < D; ++a)
  {
    const bool isLast = a + 1 == D;
    box.Min[a] -= isLast && domain.HasTimeBorder(0) ? 0.0 : 2.0 * largestDistance;
    box.Max[a] += isLast && domain.HasTimeBorder(1) ? 0.0 : 2.0 * largestDistance;
  }
  return box;
}

template <int D>
WholeRefinement<D>::WholeRefinement(const RunEnvironment<D>& run, const RefinementPlan<D>& plan)
  : Run(run)
  , Context(*run.Prepared.Surfaces, plan.Settings,
      BoxAround(*run.Prepared.Surfaces, plan.LargestDistance), plan.InterfaceVertices)
  , Vertices(plan.Vertices)
{
}

template bool RefineContext<3>(const RunEnvironment<3>&, RefinementContext<3>&,
  const std::vector<FeatureSeed<3>>&, RefinementStart, std::uint64_t, RunProgress&, std::uint64_t);
template bool RefineContext<4>(const RunEnvironment<4>&, RefinementContext<4>&,
  const std::vector<FeatureSeed<4>>&, RefinementStart, std::uint64_t, RunProgress&, std::uint64_t);
template Box<3> BoxAround<3>(const Domain<3>&, double);
template Box<4> BoxAround<4>(const Domain<4>&, double);
template class WholeRefinement<3>;
template class WholeRefinement<4>;

} // namespace voxplex
