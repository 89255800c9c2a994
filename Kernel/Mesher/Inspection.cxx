// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/Inspection.h"

#include "Base/Stopwatch.h"
#include "Geometry/ShapeBounds.h"
#include "Mesh/LabelledTriangulation.h"
#include "Mesher/Dimension.h"
#include "Refinement/Rules/PlaneLabels.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace voxplex
{

namespace
{

/** Gaps of components are sampled this many times; more finely each time. */
constexpr unsigned UsualGapRounds = 4;
constexpr unsigned MostGapRounds = 64; ///< if components are to be exact

/**
 * Unless components are to be exact, gaps are sampled beside pieces of at least this number of
 * voxels only, and of a cube of half of delta. With 8 voxels, meshes of brains get 2 to 5 % more elements, for
 * pieces that are seldom missed.
 */
constexpr double SmallestUsualGap = 27.0;

/**
 * Tells whether a simplex has a facet on a time plane or on an end of a periodic mesh. Such simplices
 * keep their labels, so that both sides of the plane have the same ones. Empty if there are no
 * planes, and in 3D. Both must outlive the result.
 */
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
        return FacetOnPlane(mesh, s, [&planes](double time) { return planes.HaveFacetsAt(time); })
          .has_value();
      };
    }
  }
  return {};
}

template <int D>
ManifoldRepairOptions<D> MakeRepairOptions(
  const RunEnvironment<D>& run, const RefinementStage<D>& stage, const LabelContacts<D>& contacts)
{
  ManifoldRepairOptions<D> options;
  options.Shape =
    ShapeBounds::With(run.Options.Shape.RadiusEdgeRatio, run.Options.Shape.FacetAngle);
  if constexpr (D == 3) // optimisation mends slivers
  {
    options.SliverAngle = run.Options.Optimisation.Run ? 0.0 : run.Options.Shape.Slivers.Angle;
  }
  options.Surfaces = run.Prepared.Surfaces.get();
  options.Sizing = &stage.Sizing();
  // In 4D noise would bring many more triangles that have to be opened.
  options.Contacts = D == 3 || run.Options.Components.Exact ? &contacts : nullptr;
  if (const std::optional<Components<D>>& all = run.Prepared.AllComponents; D == 3 && all)
  {
    options.Kept.emplace(KeptComponents<D>{
      *all, run.Prepared.Image, all->FindWanted(run.Options.Components.Smallest) });
  }
  options.Keeps = KeepsItsLabel(run, stage.Mesh());
  return options;
}

} // namespace

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
  , Contacts(run.Prepared.OfDomain())
  , Labeller(stage.Mesh(), MakeRepairOptions(run, stage, this->Contacts), run.Options.Team.Threads,
      run.Stop)
  , GapRounds(Dimension<D>::MayRefine(run) && run.Options.Interfaces.Rounds > 0
        ? (run.Options.Components.Exact ? MostGapRounds : UsualGapRounds)
        : 0)
  , Gaps{ run.Options.Components.Exact
      ? 0.0
      : std::max(SmallestUsualGap * run.Prepared.Image.Grid().VoxelVolume(),
          std::pow(0.5 * run.Statistics.Delta, D)),
    this->GapRounds == 0 }
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
  run.Statistics.Times.Components += time.Seconds();
}

//------------------------------------------------------------------------------------------------
template <int D>
bool Inspection<D>::Inspect()
{
  StageTimes& times = this->Run.Statistics.Times;
  {
    const Stopwatch time;
    this->Made = this->Labeller.Take();
    const bool isNeeded = this->Interfaces.InspectSampled(this->Made);
    if (!isNeeded && this->Run.Options.Interfaces.Manifold)
    {
      this->Made =
        this->Labeller.Repair(std::move(this->Made), this->Gaps, this->Run.Statistics.Interfaces);
    }
    times.Interfaces += time.Seconds();
    if (isNeeded)
    {
      return true;
    }
  }
  bool isNeeded = false;
  const LabelledTriangulation<D> elements(this->Source, this->Source.Labels());
  this->Look(isNeeded, BadRidges, times.Interfaces,
    [&] { return this->Interfaces.InspectRidges(this->Made); });
  this->Look(isNeeded, HiddenLayers, times.Interfaces,
    [&] { return this->Interfaces.InspectLayers(this->Made, this->Run.Options.Components.Exact); });
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
  isNeeded = isNeeded || this->InspectGaps();
  if (!isNeeded)
  {
    const Stopwatch time;
    isNeeded = this->Interfaces.InspectAll(this->Made);
    times.Interfaces += time.Seconds();
  }
  return isNeeded;
}

/** Requests finer sampling where components have gaps; if that ends, another attempt to join the pieces. */
template <int D>
bool Inspection<D>::InspectGaps()
{
  if (this->Made.Gaps.empty() || this->Gaps.AreLast)
  {
    return false;
  }
  const auto& all = *this->Run.Prepared.AllComponents;
  std::vector<SearchBall<D>> balls;
  std::vector<bool> hasGap(all.All().size());
  for (const PieceGap<D>& gap : this->Made.Gaps)
  {
    balls.push_back(gap.Where);
    hasGap[gap.Component] = true;
  }
  std::vector<VoxelFace<D>> faces =
    FindFacesNear(this->Run.Prepared.OfDomain(), *this->Run.Prepared.Sites, balls, this->Run.Stop);
  const auto isOfGap = [&](const auto& voxel)
  {
    const std::uint32_t c = all.At(voxel);
    return c != None && hasGap[c];
  };
  std::erase_if(
    faces, [&](const VoxelFace<D>& face) { return !isOfGap(face.Voxel) && !isOfGap(face.Next()); });
  const std::size_t points = this->Sampling.SampleGaps(faces);
  ComponentStatistics& statistics = this->Run.Statistics.Components;
  --this->GapRounds;
  statistics.Rounds += points > 0 ? 1 : 0;
  statistics.Seeds += points;
  this->Gaps.AreLast = points == 0 || this->GapRounds == 0;
  return true;
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

template class Inspection<3>;
template class Inspection<4>;

} // namespace voxplex
