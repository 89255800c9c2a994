// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/DeltaMeshing.h"

#include "Base/FreeMemory.h"
#include "Base/Stopwatch.h"
#include "Mesher/MeshSizeEstimate.h"
#include "Parallel/ParallelFor.h"
#include "Refinement/Refiner.h"
#include "Refinement/Tiles/TiledRefiner.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace voxplex
{

namespace
{

/**
 * Refinement leaves slivers with a larger angle than this, in degrees, to optimisation, except
 * wedged ones. This reduces the elements of atlases by about a tenth. With 3 degrees they have 2 %
 * more elements, and no fewer poor ones in the end.
 */
constexpr double SliversLeftToOptimisation = 1.0;

//------------------------------------------------------------------------------------------------
/** The sources of a sizing field. */
template <int D>
class MeshSizing
{
public:
  /** @throws Cancelled; InputError from interface sizes */
  explicit MeshSizing(const RunEnvironment<D>& run)
    : Base(Dimension<D>::GradeBase(run, run.Statistics.Delta))
    , Local(run.Prepared.Image)
    , Size(run.Prepared.Size.get())
    , SizeFloor(SpacingFloorFraction * run.Statistics.Delta) // even where grading is coarser
  {
    run.Statistics.LargestDelta = this->Base.Base.Delta;
    if (!run.Options.Sampling.InterfaceSizes.empty())
    {
      const Stopwatch time;
      this->Interfaces.emplace(run.Prepared.Image, run.Options.Sampling.InterfaceSizes,
        this->Base.Base, run.Options.Sampling.Gradation, run.Options.Team.Threads, run.Stop);
      run.Statistics.LargestDelta = this->Interfaces->Largest();
      run.Statistics.Times.Grading += time.Seconds();
    }
  }

  /** The sources refer to this object. */
  SizingSources<D> Sources() const
  {
    return { this->Base.Base, this->Interfaces ? &*this->Interfaces : nullptr, &this->Local,
      this->Size, this->SizeFloor };
  }

  LocalDelta<D>& LocalBounds() { return this->Local; }

private:
  const OwnedBaseDistance<D> Base;
  std::optional<InterfaceSizes<D>> Interfaces; ///< if any are given
  LocalDelta<D> Local;
  const SizeFunction<D>* Size;
  double SizeFloor;
};

//------------------------------------------------------------------------------------------------
template <int D>
RefinementSettings<D> SettingsOf(const MeshingOptions<D>& options, const SizingSources<D>& sizing)
{
  RefinementSettings<D> settings;
  settings.Sizing = sizing;
  settings.Shape = options.Shape;
  settings.SpaceTime = options.SpaceTime;
  if (options.Optimisation.Run && options.Optimisation.Seconds == 0.0)
  {
    double& angle = settings.Shape.Slivers.AngleInside;
    angle = std::min(angle, SliversLeftToOptimisation);
  }
  return settings;
}

/** With the numbers of threads that the machine has. */
TeamOptions TeamOf(TeamOptions team)
{
  team.Threads = std::min(NumberOfThreads(team.Threads), MaximumNumberOfWorkers);
  team.FineGrained = team.FineGrained && team.Threads <= NumberOfThreads(0);
  return team;
}

/**
 * A box at least 2 Delta away from every interface (thesis, sections 2.2 and 4.2), except at flat
 * ends.
 */
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

//------------------------------------------------------------------------------------------------
template <int D>
MeshSizeEstimate EstimateOf(const RunEnvironment<D>& run, double distance, double sizeFloor)
{
  const MeshSizeEstimate estimate = EstimateMeshSize<D>(run.Prepared.Image, distance, sizeFloor,
    run.Prepared.Size.get(), run.Options.Team.Threads, run.Stop);
  run.Statistics.EstimatedElements = estimate.Elements;
  run.Statistics.SizesRaisedTo = estimate.SizesBelowFloor ? sizeFloor : 0.0;
  if (!run.Options.Limits.Force)
  {
    CheckMemory(estimate, run.Options.Limits.Memory);
  }
  return estimate;
}

//------------------------------------------------------------------------------------------------
template <int D>
void AddYielding(MeshingStatistics& statistics, const GridGeometry<D>& grid,
  const std::vector<YieldingRegion<D>>& regions)
{
  for (const YieldingRegion<D>& region : regions)
  {
    const Point<D> index = grid.ToIndex(region.Place);
    YieldingReport report{ static_cast<unsigned>(region.Step), {} };
    for (std::size_t a = 0; a < D; ++a)
    {
      const auto last = static_cast<double>(grid.Dimensions[a] - 1);
      report.Voxel.push_back(std::llround(std::clamp(index[a], 0.0, last)));
    }
    statistics.Yielding.push_back(std::move(report));
  }
}

/** Runs a refiner. @return false if stopped */
template <int D, typename AnyRefiner>
bool RunRefiner(const RunEnvironment<D>& run, AnyRefiner& refiner, std::uint64_t expectedVertices,
  RunProgress& progress)
{
  const Stopwatch time;
  const bool done = refiner.Run(
    [&](std::uint64_t vertices)
    {
      progress.Refine(static_cast<double>(vertices) / static_cast<double>(expectedVertices));
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
  AddYielding(statistics, run.Prepared.Image.Grid(), refiner.GetYielded());
  return done;
}

/** @return false if stopped */
template <int D>
bool Refine(const RunEnvironment<D>& run, RefinementContext<D>& context,
  const std::vector<FeatureSeed<D>>& seeds, RefinementStart start, std::uint64_t expectedVertices,
  RunProgress& progress)
{
  using Rules = typename Dimension<D>::Rules;
  const TeamOptions team = TeamOf(run.Options.Team);
  if (team.Reproducible)
  {
    TiledRefiner<Rules> refiner(context, team, seeds, start);
    return RunRefiner(run, refiner, expectedVertices, progress);
  }
  Refiner<Rules> refiner(context, team, seeds, start);
  const bool done = RunRefiner(run, refiner, expectedVertices, progress);
  run.Statistics.SeedingSeconds += refiner.GetSecondsToSeed();
  run.Statistics.SwitchedToLocal |= refiner.SwitchedToLocal();
  return done;
}

//------------------------------------------------------------------------------------------------
/** Runs the checks in order. Returns the first remedy that is needed. */
template <int D, typename Inspect>
Remedy<D> FindRemedy(const std::vector<ConformityCheck<D>*>& checks, Inspect&& inspect)
{
  for (ConformityCheck<D>* check : checks)
  {
    const Stopwatch time;
    Remedy<D> remedy = inspect(*check);
    check->Seconds += time.Seconds();
    if (remedy.IsNeeded)
    {
      return remedy;
    }
  }
  return {};
}

/** Inspects the triangulation and the mesh. If no check needs a remedy, the mesh is in `mesh`. */
template <int D>
Remedy<D> InspectAndExtract(
  const RunEnvironment<D>& run, typename Dimension<D>::Checks& checks, SimplexMesh<D>& mesh)
{
  const std::vector<ConformityCheck<D>*> all = checks.All();
  Remedy<D> remedy =
    FindRemedy<D>(all, [](ConformityCheck<D>& check) { return check.InspectTriangulation(); });
  if (!remedy.IsNeeded)
  {
    const Stopwatch time;
    StageTimes& times = run.Statistics.Times;
    const double optimisation = times.Optimisation;
    checks.Extract(mesh);
    times.Extraction += time.Seconds() - (times.Optimisation - optimisation);
    remedy = FindRemedy<D>(all, [&](ConformityCheck<D>& check) { return check.InspectMesh(mesh); });
  }
  return remedy;
}

//------------------------------------------------------------------------------------------------
/** Refines until no check needs a remedy. @return false if stopped */
template <int D>
bool RefineAndCheck(const RunEnvironment<D>& run, RunProgress& progress, SimplexMesh<D>& mesh)
{
  MeshSizing<D> sizing(run);
  const SizingField<D> planned(*run.Prepared.Surfaces, sizing.Sources());
  const MeshSizeEstimate estimate = EstimateOf(run, planned.Equivalent(), planned.SizeFloor());

  RefinementContext<D> context(*run.Prepared.Surfaces, SettingsOf(run.Options, sizing.Sources()),
    BoxAround(*run.Prepared.Surfaces, planned.Largest()), estimate.InterfaceVertices);
  typename Dimension<D>::Checks checks(run, context, sizing.LocalBounds());
  context.Sizing.FollowLocalBounds();
  std::vector<FeatureSeed<D>> seeds = Dimension<D>::SampleJunctions(run, context.Sizing);
  const std::vector<FeatureSeed<D>> more = checks.TakeSeeds();
  seeds.insert(seeds.end(), more.begin(), more.end());

  for (RefinementStart start = RefinementStart::Everywhere;
       Refine(run, context, seeds, start, estimate.Vertices, progress);
       start = RefinementStart::AtSeeds)
  {
    progress.EndRefinement();
    sizing.LocalBounds().ForgetLowered(); // refinement has applied the lowered bounds
    Remedy<D> remedy = InspectAndExtract(run, checks, mesh);
    if (!remedy.IsNeeded)
    {
      return true;
    }
    seeds = std::move(remedy.Points);
    context.Sizing.FollowLocalBounds();
  }
  return false;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
bool MeshWithDelta(const RunEnvironment<D>& run, const IsWorthOptimising<D>& isWorthOptimising,
  RunProgress& progress, SimplexMesh<D>& mesh)
{
  if (!RefineAndCheck(run, progress, mesh))
  {
    return false;
  }
  if (isWorthOptimising(mesh))
  {
    ReturnFreeMemory(); // the triangulation's, which is as large as what optimisation needs
    Dimension<D>::Optimise(run, mesh);
  }
  return !run.Stop.stop_requested();
}

template bool MeshWithDelta<3>(
  const RunEnvironment<3>&, const IsWorthOptimising<3>&, RunProgress&, SimplexMesh<3>&);
template bool MeshWithDelta<4>(
  const RunEnvironment<4>&, const IsWorthOptimising<4>&, RunProgress&, SimplexMesh<4>&);

} // namespace voxplex
