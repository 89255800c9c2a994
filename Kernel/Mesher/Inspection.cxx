// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/Inspection.h"

#include "Base/Stopwatch.h"
#include "Conformity/InterfaceVertices.h"
#include "Geometry/ShapeBounds.h"
#include "Mesh/LabelledTriangulation.h"
#include "Mesher/Dimension.h"
#include "Refinement/Rules/PlaneLabels.h"

namespace voxplex
{

namespace
{

template <int D>
ManifoldRepairOptions<D> MakeRepairOptions(
  const RunEnvironment<D>& run, const RefinementStage<D>& stage)
{
  ManifoldRepairOptions<D> options;
  options.Shape =
    ShapeBounds::With(run.Options.Shape.RadiusEdgeRatio, run.Options.Shape.FacetAngle);
  options.Surfaces = run.Prepared.Surfaces.get();
  options.Sizing = &stage.Sizing();
  options.Keeps = KeepsItsLabel(run, stage.Mesh());
  return options;
}

} // namespace

template <int D>
std::function<bool(SimplexId)> KeepsItsLabel(
  const RunEnvironment<D>& run, const Triangulation<D>& mesh)
{
  if constexpr (D == 4)
  {
    const TimePlanes& planes = run.Prepared.Planes;
    if (planes.Exist())
    {
      return [&mesh, &planes](SimplexId s)
      {
        return FacetOnPlane(mesh, s,
          [&planes](double time) { return planes.AreAt(time) || planes.IsPeriodicEnd(time); })
          .has_value();
      };
    }
  }
  return {};
}

//------------------------------------------------------------------------------------------------
template <int D>
Inspection<D>::Inspection(
  const RunEnvironment<D>& run, RefinementStage<D>& stage, LocalDelta<D>& local)
  : Run(run)
  , Source(stage.Mesh())
  , Sampling(run.Prepared.Image, run.Prepared.OfDomain(), *run.Prepared.Sites,
      *run.Prepared.Surfaces, stage.Sizing(), local, run.Stop)
  , Interfaces({ stage.Mesh(), run.Prepared.OfDomain(), *run.Prepared.Sites, *run.Prepared.Surfaces,
                 stage.Sizing(), run.Options.Team.Threads },
      Dimension<D>::MayRefine(run) ? run.Options.Interfaces.Rounds : 0, this->Sampling,
      run.Statistics.Interfaces, run.Stop)
  , Labeller(stage.Mesh(), MakeRepairOptions(run, stage), run.Options.Team.Threads, run.Stop)
{
  const Stopwatch time;
  const PreparedImage<D>& prepared = run.Prepared;
  const ComponentOptions& options = run.Options.Components;
  const auto start = [&](const std::optional<voxplex::Components<D>>& all,
                       ComponentStatistics& statistics, std::optional<ComponentCheck<D>>& check)
  {
    if (all)
    {
      check.emplace(prepared.Image, *all, stage.Sizing(), options.Smallest, options.Exact,
        Dimension<D>::MayRefine(run), this->Sampling, statistics, run.Options.Team.Threads,
        run.Stop);
    }
  };
  start(prepared.AllComponents, run.Statistics.Components, this->Components);
  start(prepared.OfFrames, run.Statistics.FrameComponents, this->OfFrames);
  if constexpr (D == 3)
  {
    if (prepared.AllComponents)
    {
      this->Fragments.emplace(
        FragmentCheck::Subject{ prepared.Image, *prepared.Sites, *prepared.AllComponents }, options,
        run.Options.Interfaces.Rounds > 0, this->Sampling, run.Statistics.Components, run.Stop);
    }
  }
  run.Statistics.Times.Components += time.Seconds();
}

//------------------------------------------------------------------------------------------------
template <int D>
bool Inspection<D>::Inspect()
{
  StageTimes& times = this->Run.Statistics.Times;
  {
    const Stopwatch time;
    this->MakeLabels();
    const bool isNeeded = this->Interfaces.InspectSampled(this->Made);
    times.Interfaces += time.Seconds();
    if (isNeeded)
    {
      return true;
    }
  }
  bool isNeeded = false;
  const LabelledTriangulation<D> elements(this->Source, this->Made.Labels);
  if (this->Components)
  {
    this->Look(isNeeded, LostComponents, times.Components,
      [&] { return this->Components->Inspect(elements); });
  }
  if (this->OfFrames)
  {
    this->Look(
      isNeeded, LostInFrames, times.Components, [&] { return this->OfFrames->Inspect(elements); });
  }
  this->Look(isNeeded, BadRidges, times.Interfaces,
    [&] { return this->Interfaces.InspectRidges(this->Made); });
  const auto inspectFragments = [&](bool mayRefine)
  {
    if constexpr (D == 3)
    {
      if (this->Fragments && this->Fragments->MayRefine() == mayRefine)
      {
        this->Look(isNeeded, LooseFragments, times.Components,
          [&] { return this->Fragments->Inspect(elements); });
      }
    }
  };
  inspectFragments(true);
  if (!isNeeded)
  {
    const Stopwatch time;
    isNeeded = this->Interfaces.InspectAll(this->Made);
    times.Interfaces += time.Seconds();
  }
  if (!isNeeded)
  {
    inspectFragments(false);
  }
  return isNeeded;
}

/** Lets a finder look. */
template <int D>
template <typename Find>
void Inspection<D>::Look(bool& isNeeded, Finder finder, double& seconds, const Find& find)
{
  if (isNeeded && this->NeededNothing[finder])
  {
    return;
  }
  const Stopwatch time;
  const bool needs = find();
  this->NeededNothing[finder] = !needs;
  isNeeded |= needs;
  seconds += time.Seconds();
}

template <int D>
void Inspection<D>::MakeLabels()
{
  this->Made = {}; // the labels of the round before need no memory beside the new ones
  if (this->Run.Options.Interfaces.Manifold)
  {
    this->Made = this->Labeller.Make(this->Run.Statistics.Interfaces);
  }
  else
  {
    this->Made.Labels = this->Labeller.MakePlain();
    MarkInterfaceVertices<D>(
      this->Source, this->Made.Labels, this->Run.Options.Team.Threads, this->Run.Stop);
  }
}

template class Inspection<3>;
template class Inspection<4>;
template std::function<bool(SimplexId)> KeepsItsLabel<3>(
  const RunEnvironment<3>&, const Triangulation<3>&);
template std::function<bool(SimplexId)> KeepsItsLabel<4>(
  const RunEnvironment<4>&, const Triangulation<4>&);

} // namespace voxplex
