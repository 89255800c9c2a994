// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/MeshFinishing.h"

#include "Base/Stopwatch.h"
#include "Conformity/MeshTopology.h"
#include "Optimisation/ComponentGuard.h"
#include "Optimisation/Fit/InterfaceFit.h"
#include "Optimisation/OpenRidges.h"
#include "Optimisation/Pentatopes/PentatopeOptimiser.h"
#include "Optimisation/Tetrahedra/MeshOptimiser.h"
#include "Quality/LostComponents.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

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
void CompareWithImage(const RunEnvironment<D>& run, const LabelledCells<D>& elements)
{
  const Stopwatch time;
  const LabelImage<D>& image = run.Prepared.Image;
  const unsigned threads = run.Options.Team.Threads;
  ForComponents(run,
    [&](const Components<D>& components, const std::vector<bool>& wanted,
      ComponentStatistics& statistics)
    {
      statistics.Lost.clear();
      for (const std::uint32_t c :
        FindLostComponents(components, image, elements, wanted, threads, run.Stop))
      {
        statistics.Lost.push_back(MakeReport(components.All()[c], image));
      }
      if (&statistics == &run.Statistics.Components)
      {
        ComparePieces(elements, components, image, wanted, statistics, threads, run.Stop);
      }
    });
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
void Fit(const RunEnvironment<D>& run, const SizingField<D>* sizes, Complex<D>& complex)
{
  FitBounds<D> bounds{ .Image = run.Prepared.OfDomain(), .Planes = run.Prepared.Planes };
  if (D == 4)
  {
    bounds.NormalizedVolume = run.Options.SpaceTime.Slivers.VolumeBound;
    bounds.RadiusEdgeRatio = run.Options.Shape.RadiusEdgeRatio;
    bounds.Sizing = sizes;
  }
  bounds.FacetAngle = run.Options.Shape.FacetAngle;
  bounds.Volumes = run.Prepared.Volumes;
  FitInterfaces<D>(complex, *run.Prepared.Surfaces, bounds, run.Options.Team.Threads, run.Stop);
}

template <int D>
void Open(const RunEnvironment<D>& run, const SizingField<D>* sizes, InspectedMesh<D>& inspected)
{
  const LabelContacts<D> contacts(run.Prepared.OfDomain());
  OpeningContext<D> context{ .Sizing = sizes, .Contacts = &contacts };
  if (D == 4)
  {
    context.Planes = run.Prepared.Planes;
  }
  const std::size_t left =
    OpenRidges<D>(inspected.Mesh, *run.Prepared.Surfaces, inspected.NonManifold, context, run.Stop)
      .size();
  run.Statistics.Interfaces.CountOpened(inspected.NonManifold.size(), left);
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
void Optimise(const RunEnvironment<3>& run, const SizingField<3>*, ComponentGuard<3>& guard,
  TetrahedralComplex& complex)
{
  const MeshingOptions<3>& asked = run.Options;
  OptimisationOptions options;
  options.Shape = ShapeBounds::With(
    std::max(OptimisedRadiusEdgeRatio, asked.Shape.RadiusEdgeRatio), asked.Shape.FacetAngle);
  options.Seconds = asked.Optimisation.Seconds;
  options.InterfaceTolerance = ToleranceIn3D * run.Statistics.Delta;
  options.Guard = &guard;
  const OptimisationStatistics done =
    OptimiseMesh(complex, *run.Prepared.Surfaces, options, asked.Team.Threads, run.Stop);
  OptimisationSummary& summary = run.Statistics.Optimisation;
  summary.OutOfTime = done.OutOfTime;
  summary.SmallestDihedralBefore = done.Before.SmallestDihedralAngle;
  summary.LargestDihedralBefore = done.Before.LargestDihedralAngle;
  summary.SmallestDihedralAfter = done.After.SmallestDihedralAngle;
  summary.LargestDihedralAfter = done.After.LargestDihedralAngle;
  summary.PoorBefore = done.Before.Poor;
  summary.PoorAfter = done.After.Poor;
}

void Optimise(const RunEnvironment<4>& run, const SizingField<4>* sizes, ComponentGuard<4>& guard,
  PentatopeComplex& complex)
{
  PentatopeBounds bounds;
  bounds.Target = OptimisedNormalizedVolume;
  bounds.RadiusEdgeRatio = run.Options.Shape.RadiusEdgeRatio;
  bounds.InterfaceTolerance = ToleranceIn4D * run.Prepared.Image.Grid().SmallestSpacing();
  bounds.Sizing = sizes;
  bounds.Planes = run.Prepared.Planes;
  bounds.Guard = &guard;
  const PentatopeStatistics done = OptimisePentatopes(complex, *run.Prepared.Surfaces,
    run.Prepared.OfDomain(), bounds, run.Options.Team.Threads, run.Stop);
  OptimisationSummary& summary = run.Statistics.Optimisation;
  summary.SmallestVolumeBefore = done.SmallestBefore;
  summary.SmallestVolumeAfter = done.SmallestAfter;
  summary.PoorBefore = done.PoorBefore;
  summary.PoorAfter = done.PoorAfter;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
InspectedMesh<D> TakeMesh(
  const RunEnvironment<D>& run, RefinementStage<D>& stage, const ManifoldLabels<D>& labels)
{
  const Stopwatch time;
  stage.Finish();
  UninitialisedVector<std::uint32_t> numbers;
  InspectedMesh<D> mesh{ Complex<D>(stage.Mesh(), stage.Mesh().Labels(), stage.Twins(), numbers,
                           run.Options.Team.Threads, run.Stop),
    labels.NonManifold };
  for (InterfaceRidge<D>& ridge : mesh.NonManifold)
  {
    for (std::uint32_t& v : ridge.Vertices)
    {
      v = numbers[v];
    }
  }
  run.Statistics.Times.Extraction += time.Seconds();
  return mesh;
}

template <int D>
void FinishMesh(const RunEnvironment<D>& run, InspectedMesh<D>& inspected, SimplexMesh<D>& mesh)
{
  const unsigned threads = run.Options.Team.Threads;
  Complex<D>& complex = inspected.Mesh;
  const std::unique_ptr<const SizingField<D>> sizes = MakeSizes(run);
  ComponentGuard<D> guard = MakeGuard(run);
  StageTimes& times = run.Statistics.Times;
  Stopwatch time;
  // In 3D shapes and sizes are left to optimisation.
  if (run.Options.Interfaces.Fit && (D == 4 || run.Options.Optimisation.Run))
  {
    complex.Protect(&guard, threads, run.Stop);
    Fit(run, sizes.get(), complex);
    complex.Protect(nullptr); // opening leaves something of each simplex
  }
  Open(run, sizes.get(), inspected);
  times.Extraction += time.Seconds();
  if (run.Options.Optimisation.Run)
  {
    time = Stopwatch();
    Optimise(run, sizes.get(), guard, complex);
    run.Statistics.Optimisation.Ran = true;
    times.Optimisation += time.Seconds();
  }
  time = Stopwatch();
  complex.Compact(false, threads, run.Stop);
  times.Extraction += time.Seconds();
  CompareWithImage<D>(run, complex.Elements());
  time = Stopwatch();
  complex.Write(run.Prepared.OfDomain().Values(), mesh, threads, run.Stop);
  if constexpr (D == 4)
  {
    run.Statistics.Planes.Pairs = mesh.Twins.size();
    FindSlabs(run.Prepared.Planes, mesh);
  }
  times.Extraction += time.Seconds();
  time = Stopwatch();
  run.Statistics.Components.Contacts =
    FindFalseContacts(mesh, run.Prepared.OfDomain(), threads, run.Stop);
  times.Components += time.Seconds();
}

template InspectedMesh<3> TakeMesh<3>(
  const RunEnvironment<3>&, RefinementStage<3>&, const ManifoldLabels<3>&);
template InspectedMesh<4> TakeMesh<4>(
  const RunEnvironment<4>&, RefinementStage<4>&, const ManifoldLabels<4>&);
template void FinishMesh<3>(const RunEnvironment<3>&, InspectedMesh<3>&, SimplexMesh<3>&);
template void FinishMesh<4>(const RunEnvironment<4>&, InspectedMesh<4>&, SimplexMesh<4>&);

} // namespace voxplex
