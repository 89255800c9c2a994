// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/DeltaMeshing.h"

#include "Base/Stopwatch.h"
#include "Mesher/Dimension.h"
#include "Mesher/Inspection.h"
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
RefinementSettings<D> MakeSettings(const MeshingOptions<D>& options, const SizingSources<D>& sizing)
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
MeshSizeEstimate EstimateSize(const RunEnvironment<D>& run, double distance, double sizeFloor)
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

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
bool RefineAndInspect(const RunEnvironment<D>& run, RunProgress& progress,
  const std::function<bool(std::uint64_t)>& wants, InspectedMesh<D>& mesh)
{
  MeshSizing<D> sizing(run);
  const SizingField<D> planned(*run.Prepared.Surfaces, sizing.Sources());
  const MeshSizeEstimate estimate = EstimateSize(run, planned.Equivalent(), planned.SizeFloor());

  const std::unique_ptr<RefinementStage<D>> stage = Dimension<D>::MakeStage(run,
    { MakeSettings(run.Options, sizing.Sources()), planned.Largest(), estimate.Vertices,
      estimate.InterfaceVertices });
  Inspection<D> inspection(run, *stage, sizing.LocalBounds());
  std::vector<FeatureSeed<D>> seeds = Dimension<D>::SampleJunctions(run, stage->Sizing());
  const std::vector<FeatureSeed<D>> more = inspection.TakeSeeds();
  seeds.insert(seeds.end(), more.begin(), more.end());

  for (RefinementStart start = RefinementStart::Everywhere; stage->Refine(seeds, start, progress);
       start = RefinementStart::AtSeeds)
  {
    progress.EndRefinement();
    if (!inspection.Inspect())
    {
      const SimplexLabels& labels = stage->Mesh().Labels();
      if (wants(static_cast<std::uint64_t>(
            std::count_if(labels.begin(), labels.end(), [](LabelId label) { return label != 0; }))))
      {
        mesh = TakeMesh(run, *stage, inspection.Labels());
      }
      return !run.Stop.stop_requested();
    }
    seeds = inspection.TakeSeeds();
  }
  return false;
}

template bool RefineAndInspect<3>(const RunEnvironment<3>&, RunProgress&,
  const std::function<bool(std::uint64_t)>&, InspectedMesh<3>&);
template bool RefineAndInspect<4>(const RunEnvironment<4>&, RunProgress&,
  const std::function<bool(std::uint64_t)>&, InspectedMesh<4>&);

} // namespace voxplex
