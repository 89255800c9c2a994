// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/MeshFinishing.h"

#include "Base/Stopwatch.h"
#include "Conformity/MeshTopology.h"
#include "Conformity/OpenRidges.h"
#include "Mesh/MeshExtraction.h"
#include "Mesh/Subdivision.h"
#include "Mesher/Inspection.h"
#include "Optimisation/InterfaceFit.h"
#include "Optimisation/MeshOptimiser.h"
#include "Optimisation/PentatopeOptimiser.h"
#include "Quality/ComponentGuard.h"
#include "Quality/LostComponents.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace voxplex
{

namespace
{

/**
 * How far optimisation may move vertices off interfaces as a last resort. In 3D in deltas: with a quarter
 * of a voxel, up to 14 tetrahedra of an atlas stayed poor at deltas of 3 to 8 voxels; now hardly any does.
 * In 4D in smallest voxel spacings: with 0.1, two phantoms kept a pentatope below the target.
 */
constexpr double ToleranceIn3D = 0.25;
constexpr double ToleranceIn4D = 0.25;

/** Calls visit(components, wanted, statistics) for those of the image, and in 4D of its frames. */
template <int D, typename Visit>
void ForComponents(const RunEnvironment<D>& run, const Visit& visit)
{
  const std::int64_t smallest = run.Options.Components.Smallest;
  if (const auto& all = run.Prepared.AllComponents)
  {
    visit(*all, all->FindWanted(smallest), run.Statistics.Components);
  }
  if (const auto& ofFrames = run.Prepared.OfFrames)
  {
    visit(*ofFrames, ofFrames->FindWanted(smallest), run.Statistics.FrameComponents);
  }
}

template <int D>
ComponentGuard<D> MakeGuard(const RunEnvironment<D>& run)
{
  ComponentGuard<D> guard(run.Prepared.Image);
  ForComponents(run,
    [&](const Components<D>& components, const std::vector<bool>& wanted, ComponentStatistics&)
    { guard.Add(components, wanted); });
  return guard;
}

template <int D>
void CompareWithImage(const RunEnvironment<D>& run, const SimplexMesh<D>& mesh)
{
  const Stopwatch time;
  const LabelImage<D>& image = run.Prepared.Image;
  ForComponents(run,
    [&](const Components<D>& components, const std::vector<bool>& wanted,
      ComponentStatistics& statistics)
    {
      statistics.Lost.clear();
      for (const std::uint32_t c :
        FindLostComponents(components, image, mesh, wanted, run.Options.Team.Threads, run.Stop))
      {
        statistics.Lost.push_back(MakeReport(components.All()[c], image));
      }
      if (&statistics == &run.Statistics.Components)
      {
        ComparePieces(mesh, components, image, wanted, statistics, run.Stop);
      }
    });
  run.Statistics.Components.Contacts =
    FindFalseContacts(mesh, run.Prepared.OfDomain(), run.Options.Team.Threads, run.Stop);
  run.Statistics.Times.Components += time.Seconds();
}

/** The sizes that users give; null if they give none. */
template <int D>
std::unique_ptr<const SizingField<D>> MakeSizes(const RunEnvironment<D>& run)
{
  if (!run.Prepared.Size)
  {
    return nullptr;
  }
  const double delta = run.Statistics.Delta;
  return std::make_unique<const SizingField<D>>(*run.Prepared.Surfaces,
    SizingSources<D>{
      { delta }, nullptr, nullptr, run.Prepared.Size.get(), SpacingFloorFraction * delta });
}

//------------------------------------------------------------------------------------------------
template <int D>
FittedPositions<D> Fit(const RunEnvironment<D>& run, const RefinementStage<D>& stage,
  const ManifoldLabels<D>& labels, const SizingField<D>* sizes)
{
  ComponentGuard<D> guard = MakeGuard(run);
  FitBounds<D> bounds{ .Image = run.Prepared.OfDomain(), .Planes = run.Prepared.Planes };
  if (D == 4)
  {
    bounds.NormalizedVolume = run.Options.SpaceTime.Slivers.VolumeBound;
    bounds.RadiusEdgeRatio = run.Options.Shape.RadiusEdgeRatio;
    bounds.Sizing = sizes;
  }
  bounds.FacetAngle = run.Options.Shape.FacetAngle;
  bounds.Twins = stage.Twins();
  bounds.Volumes = run.Prepared.Volumes;
  bounds.Guard = &guard;
  return FitInterfaces<D>(stage.Mesh(), *run.Prepared.Surfaces, labels.Labels, bounds,
    run.Options.Team.Threads, run.Stop);
}

/** Fills Twins of the mesh. @param numbers the point of each vertex id, or None */
void MakeTwins(const RunEnvironment<4>& run, const RefinementStage<4>& stage,
  std::span<const std::uint32_t> numbers, SimplexMesh<4>& mesh)
{
  for (const auto& [first, last] : stage.Twins())
  {
    if (numbers[first] != None && numbers[last] != None)
    {
      mesh.Twins.push_back({ numbers[first], numbers[last] });
    }
  }
  std::sort(mesh.Twins.begin(), mesh.Twins.end());
  run.Statistics.Planes.Pairs = mesh.Twins.size();
}

/** Fills Slabs of the mesh. */
void FindSlabs(const TimePlanes& planes, SimplexMesh<4>& mesh)
{
  if (!planes.Exist())
  {
    return;
  }
  mesh.Slabs.resize(mesh.Simplices.size());
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    double time = 0.0; // at the centroid, which is on no plane
    for (const std::uint32_t v : mesh.Simplices[s])
    {
      time += 0.2 * mesh.Points[v][3];
    }
    mesh.Slabs[s] = static_cast<std::uint32_t>(planes.SlabAt(time));
  }
}

//------------------------------------------------------------------------------------------------
void Optimise(const RunEnvironment<3>& run, ExtractedMesh<3>& extracted)
{
  const MeshingOptions<3>& asked = run.Options;
  ComponentGuard<3> guard = MakeGuard(run);
  OptimisationOptions options;
  options.Shape = ShapeBounds::With(
    std::max(OptimisedRadiusEdgeRatio, asked.Shape.RadiusEdgeRatio), asked.Shape.FacetAngle);
  options.Seconds = asked.Optimisation.Seconds;
  options.InterfaceTolerance = ToleranceIn3D * run.Statistics.Delta;
  options.Guard = &guard;
  const OptimisationStatistics done =
    OptimiseMesh(extracted.Mesh, *run.Prepared.Surfaces, options, asked.Team.Threads, run.Stop);
  OptimisationSummary& summary = run.Statistics.Optimisation;
  summary.OutOfTime = done.OutOfTime;
  summary.SmallestDihedralBefore = done.Before.SmallestDihedralAngle;
  summary.LargestDihedralBefore = done.Before.LargestDihedralAngle;
  summary.SmallestDihedralAfter = done.After.SmallestDihedralAngle;
  summary.LargestDihedralAfter = done.After.LargestDihedralAngle;
  summary.PoorBefore = done.Before.Poor;
  summary.PoorAfter = done.After.Poor;
}

void Optimise(const RunEnvironment<4>& run, ExtractedMesh<4>& extracted)
{
  const std::unique_ptr<const SizingField<4>> sizes = MakeSizes(run);
  ComponentGuard<4> guard = MakeGuard(run);
  PentatopeBounds bounds;
  bounds.Target = OptimisedNormalizedVolume;
  bounds.RadiusEdgeRatio = run.Options.Shape.RadiusEdgeRatio;
  bounds.InterfaceTolerance = ToleranceIn4D * run.Prepared.Image.Grid().SmallestSpacing();
  bounds.Sizing = sizes.get();
  bounds.Planes = run.Prepared.Planes;
  bounds.Guard = &guard;
  const PentatopeStatistics done = OptimisePentatopes(extracted.Mesh, extracted.Outside,
    *run.Prepared.Surfaces, run.Prepared.OfDomain(), bounds, run.Options.Team.Threads, run.Stop);
  extracted.Outside = {};
  OptimisationSummary& summary = run.Statistics.Optimisation;
  summary.SmallestVolumeBefore = done.SmallestBefore;
  summary.SmallestVolumeAfter = done.SmallestAfter;
  summary.PoorBefore = done.PoorBefore;
  summary.PoorAfter = done.PoorAfter;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void Extract(const RunEnvironment<D>& run, RefinementStage<D>& stage,
  const ManifoldLabels<D>& labels, ExtractedMesh<D>& mesh)
{
  const Stopwatch time;
  const Triangulation<D>& source = stage.Mesh();
  const Domain<D>& surfaces = *run.Prepared.Surfaces;
  const unsigned threads = run.Options.Team.Threads;
  UninitialisedVector<Point<D>> positions; // empty: those of the triangulation
  OpeningContext<D> context;
  const std::unique_ptr<const SizingField<D>> sizes = MakeSizes(run);
  context.Sizing = sizes.get();
  // In 3D shapes and sizes are left to optimisation.
  if (run.Options.Interfaces.Fit && (D == 4 || run.Options.Optimisation.Run))
  {
    positions = Fit(run, stage, labels, context.Sizing).Positions;
  }
  context.Positions = positions;
  const LabelContacts<D> contacts(run.Prepared.OfDomain());
  context.Contacts = &contacts;
  context.Keeps = KeepsItsLabel(run, source);
  OpenedRidges<D> opened =
    OpenRidges<D>(source, surfaces, labels.Labels, labels.NonManifold, run.Stop, context);
  run.Statistics.Interfaces.CountOpened(labels.NonManifold.size(), opened.Left.size());
  if constexpr (D == 3)
  {
    stage.Finish(); // in 4D it is asked which pentatopes are around the mesh
  }
  const MeshChanges<D> changes{ positions, std::move(opened.Parts) };
  UninitialisedVector<std::uint32_t> numbers;
  ExtractMesh<D>(source, surfaces, labels.Labels, mesh.Mesh, threads, run.Stop, changes, &numbers);
  if constexpr (D == 4)
  {
    MakeTwins(run, stage, numbers, mesh.Mesh);
    if (run.Options.Optimisation.Run)
    {
      mesh.Outside = SurroundingsOf(
        source, labels.Labels, changes.Parts, positions, numbers, mesh.Mesh.Points.size());
    }
  }
  run.Statistics.Times.Extraction += time.Seconds();
}

template <int D>
void FinishMesh(const RunEnvironment<D>& run, ExtractedMesh<D>& mesh)
{
  if (run.Options.Optimisation.Run)
  {
    const Stopwatch time;
    Optimise(run, mesh);
    run.Statistics.Optimisation.Ran = true;
    run.Statistics.Times.Optimisation += time.Seconds();
  }
  if constexpr (D == 4)
  {
    FindSlabs(run.Prepared.Planes, mesh.Mesh);
  }
  CompareWithImage(run, mesh.Mesh);
}

template void Extract<3>(
  const RunEnvironment<3>&, RefinementStage<3>&, const ManifoldLabels<3>&, ExtractedMesh<3>&);
template void Extract<4>(
  const RunEnvironment<4>&, RefinementStage<4>&, const ManifoldLabels<4>&, ExtractedMesh<4>&);
template void FinishMesh<3>(const RunEnvironment<3>&, ExtractedMesh<3>&);
template void FinishMesh<4>(const RunEnvironment<4>&, ExtractedMesh<4>&);

} // namespace voxplex
