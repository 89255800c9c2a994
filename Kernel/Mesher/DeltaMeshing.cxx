// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/DeltaMeshing.h"

#include "Base/Stopwatch.h"
#include "Mesher/MeshSizeEstimate.h"
#include "Mesher/RefinementStage.h"

#include <algorithm>
#include <cstdint>
#include <memory>
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

/**
 * Bytes that a mesh with time planes needs for each element beyond those of the estimate: the union
 * of the slabs' triangulations. 191 on a mesh of 214,479 pentatopes.
 */
constexpr double UnionBytesPerElement = 200.0;

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

//------------------------------------------------------------------------------------------------
template <int D>
MeshSizeEstimate EstimateOf(const RunEnvironment<D>& run, double distance, double sizeFloor)
{
  MeshSizeEstimate estimate = EstimateMeshSize<D>(run.Prepared.Image, distance, sizeFloor,
    run.Prepared.Size.get(), run.Options.Team.Threads, run.Stop);
  if (run.Prepared.Planes.Exist())
  {
    estimate.Bytes +=
      static_cast<std::uint64_t>(UnionBytesPerElement * static_cast<double>(estimate.Elements));
  }
  run.Statistics.EstimatedElements = estimate.Elements;
  run.Statistics.SizesRaisedTo = estimate.SizesBelowFloor ? sizeFloor : 0.0;
  if (!run.Options.Limits.Force)
  {
    CheckMemory(estimate, run.Options.Limits.Memory);
  }
  return estimate;
}

//------------------------------------------------------------------------------------------------
/** A step of inspection, as ConformityCheck describes them. It may be taken once a round. */
template <int D>
class InspectionStep
{
public:
  /**
   * Runs the checks in order. Returns what they need together. If one needs a remedy, this round is
   * not the last. Then checks that needed nothing in the round before can wait.
   */
  template <typename Inspect>
  Remedy<D> Take(const std::vector<ConformityCheck<D>*>& checks, Inspect&& inspect)
  {
    this->NeededNothing.resize(checks.size(), false);
    Remedy<D> all;
    for (std::size_t k = 0; k < checks.size(); ++k)
    {
      if (all.IsNeeded && this->NeededNothing[k])
      {
        continue;
      }
      const Stopwatch time;
      const Remedy<D> remedy = inspect(*checks[k]);
      checks[k]->Seconds += time.Seconds();
      this->NeededNothing[k] = !remedy.IsNeeded;
      all.IsNeeded = all.IsNeeded || remedy.IsNeeded;
      all.Points.insert(all.Points.end(), remedy.Points.begin(), remedy.Points.end());
    }
    return all;
  }

private:
  std::vector<bool> NeededNothing; ///< of each check, at its last inspection
};

/** The steps of inspection. */
template <int D>
struct Inspection
{
  InspectionStep<D> OfTriangulation;
  InspectionStep<D> OfElements;
  InspectionStep<D> OfMesh;
};

/** Inspects the triangulation and the mesh. If no check needs a remedy, the mesh is in `mesh`. */
template <int D>
Remedy<D> InspectAndExtract(const RunEnvironment<D>& run, RefinementStage<D>& stage,
  typename Dimension<D>::Checks& checks, Inspection<D>& inspection, SimplexMesh<D>& mesh)
{
  const std::vector<ConformityCheck<D>*> all = checks.All();
  Remedy<D> remedy = inspection.OfTriangulation.Take(
    all, [](ConformityCheck<D>& check) { return check.InspectTriangulation(); });
  if (!remedy.IsNeeded)
  {
    const LabelledTriangulation<D> elements = checks.Elements();
    remedy = inspection.OfElements.Take(
      all, [&](ConformityCheck<D>& check) { return check.InspectElements(elements); });
  }
  if (!remedy.IsNeeded)
  {
    if (!checks.NeedMesh())
    {
      checks.Finish();
      stage.Finish();
    }
    const Stopwatch time;
    StageTimes& times = run.Statistics.Times;
    const double optimisation = times.Optimisation;
    checks.Extract(mesh);
    times.Extraction += time.Seconds() - (times.Optimisation - optimisation);
    remedy = inspection.OfMesh.Take(
      all, [&](ConformityCheck<D>& check) { return check.InspectMesh(mesh); });
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

  const std::unique_ptr<RefinementStage<D>> stage = Dimension<D>::MakeStage(run,
    { SettingsOf(run.Options, sizing.Sources()), planned.Largest(), estimate.Vertices,
      estimate.InterfaceVertices });
  typename Dimension<D>::Checks checks(run, *stage, sizing.LocalBounds());
  Inspection<D> inspection;
  stage->FollowLocalBounds();
  std::vector<FeatureSeed<D>> seeds = Dimension<D>::SampleJunctions(run, stage->Sizing());
  const std::vector<FeatureSeed<D>> more = checks.TakeSeeds();
  seeds.insert(seeds.end(), more.begin(), more.end());

  for (RefinementStart start = RefinementStart::Everywhere; stage->Refine(seeds, start, progress);
       start = RefinementStart::AtSeeds)
  {
    progress.EndRefinement();
    sizing.LocalBounds().ForgetLowered(); // refinement has applied the lowered bounds
    Remedy<D> remedy = InspectAndExtract(run, *stage, checks, inspection, mesh);
    if (!remedy.IsNeeded)
    {
      return true;
    }
    seeds = std::move(remedy.Points);
    stage->FollowLocalBounds();
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
    Dimension<D>::Optimise(run, mesh);
  }
  return !run.Stop.stop_requested();
}

template bool MeshWithDelta<3>(
  const RunEnvironment<3>&, const IsWorthOptimising<3>&, RunProgress&, SimplexMesh<3>&);
template bool MeshWithDelta<4>(
  const RunEnvironment<4>&, const IsWorthOptimising<4>&, RunProgress&, SimplexMesh<4>&);

} // namespace voxplex
