// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/MeshingPipeline.h"

#include "Base/Error.h"
#include "Base/NumberText.h"
#include "Mesher/DeltaMeshing.h"
#include "Mesher/DeltaSearch.h"
#include "Mesher/MeshSizeEstimate.h"
#include "Mesher/Preparation.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

namespace voxplex
{

namespace
{

/**
 * The number of elements over the estimated number: with slivers split, and with slivers left to
 * optimisation. The first sampling distance of a search follows from it.
 */
constexpr double ElementsPerEstimated = 1.12;
constexpr double OptimisedPerEstimated = 1.0;

/**
 * A delta is not tried if an ungraded mesh would have more than this times the requested elements.
 */
constexpr double LargestExcess = 16.0;

/** The fraction of the elements that optimisation leaves. The search plans with it. */
template <int D>
constexpr double ElementsLeftByOptimisation = D == 3 ? 0.96 : 1.0;

//------------------------------------------------------------------------------------------------
/** Searches the delta that gives the requested number of elements. */
template <int D>
class ElementTarget
{
public:
  ElementTarget(const RunEnvironment<D>& run, RunProgress& progress)
    : Run(run)
    , Progress(progress)
    , LeftOfElements(run.Options.Optimisation.Run ? ElementsLeftByOptimisation<D> : 1.0)
  {
  }

  /**
   * Finishes the mesh nearest to the requested number of elements. If the fraction that is left of them is
   * not the expected one, so that the number is missed, it searches once more with this fraction.
   * @return false if stopped
   * @throws InputError if no delta gives about the requested number
   */
  bool Mesh(SimplexMesh<D>& mesh)
  {
    DeltaSearch search = this->StartSearch();
    MeshingStatistics& statistics = this->Run.Statistics;
    const MeshingStatistics before = statistics;
    MeshingStatistics best;
    InspectedMesh<D> nearest;
    while (search.Next())
    {
      const StageTimes times = statistics.Times;
      statistics = before;
      statistics.Times = times;
      statistics.Delta = *search.Next();
      this->Progress.BeginOneOfSeveral();
      const auto isNearest = [&](std::uint64_t elements)
      {
        search.Add(static_cast<std::uint64_t>(
          std::llround(this->LeftOfElements * static_cast<double>(elements))));
        return search.Best().Delta == statistics.Delta;
      };
      if (!RefineAndInspect<D>(this->Run, this->Progress, isNearest, nearest))
      {
        return false;
      }
      this->Progress.EndOneOfSeveral();
      if (search.Best().Delta == statistics.Delta)
      {
        best = statistics;
      }
    }
    best.Times = statistics.Times;
    best.Runs = search.Runs();
    statistics = std::move(best);
    if (!search.Found())
    {
      this->ThrowNotFound(search, search.Best().Elements);
    }
    FinishMesh<D>(this->Run, nearest, mesh);
    const auto made = static_cast<double>(mesh.Simplices.size());
    const auto wanted = static_cast<double>(this->Run.Options.Sampling.Elements);
    if (std::abs(made / wanted - 1.0) > DeltaSearch::Tolerance)
    {
      if (std::exchange(this->IsCorrected, true))
      {
        this->ThrowNotFound(search, mesh.Simplices.size());
      }
      this->LeftOfElements *= made / static_cast<double>(search.Best().Elements);
      const StageTimes times = statistics.Times;
      statistics = before;
      statistics.Times = times;
      return this->Mesh(mesh);
    }
    for (MeshingRun& run : statistics.Runs)
    {
      run.Elements = run.Delta == statistics.Delta ? mesh.Simplices.size() : run.Elements;
    }
    return !this->Run.Stop.stop_requested();
  }

private:
  /**
   * The first guess is computed from the estimated size of the ungraded mesh with the default
   * delta. A delta is not tried if it would raise sizes (SizingField::SizeFloor) that the default
   * delta does not raise.
   */
  DeltaSearch StartSearch() const
  {
    const PreparedImage<D>& prepared = this->Run.Prepared;
    const double delta = DefaultDelta<D>(prepared.Image.Grid().VoxelVolume());
    const MeshSizeEstimate estimate =
      EstimateMeshSize<D>(prepared.Image, delta, SpacingFloorFraction * delta, prepared.Size.get(),
        this->Run.Options.Team.Threads, this->Run.Stop);
    const double perEstimated =
      D == 3 && this->Run.Options.Optimisation.Run ? OptimisedPerEstimated : ElementsPerEstimated;
    const auto wanted = static_cast<double>(this->Run.Options.Sampling.Elements);
    const double target = wanted / perEstimated;
    const double interfaces = std::max(static_cast<double>(estimate.InterfaceElements), 1.0);
    const double sizes = static_cast<double>(estimate.Elements) - interfaces;
    const double guess =
      delta * std::pow(interfaces / std::max(target - sizes, 0.25 * target), 1.0 / (D - 1));
    const double smallest = delta * std::pow(interfaces / (LargestExcess * wanted), 1.0 / (D - 1));
    return DeltaSearch(this->Run.Options.Sampling.Elements, guess, D - 1, smallest,
      std::max(delta, estimate.SmallestSize / SpacingFloorFraction));
  }

  /** @param elements of the nearest mesh */
  [[noreturn]] void ThrowNotFound(const DeltaSearch& search, std::uint64_t elements) const
  {
    const bool isCoarse =
      this->Run.Options.Sampling.Grading.Mode == GradingMode::LocalFeatureSize &&
      elements < this->Run.Options.Sampling.Elements;
    throw InputError("no delta makes a mesh of " +
      std::to_string(this->Run.Options.Sampling.Elements) + " elements within " +
      NumberText(100.0 * DeltaSearch::Tolerance) + " %: the nearest of " +
      std::to_string(search.Runs().size()) + " meshes has " + std::to_string(elements) +
      ", with a delta of " + NumberText(search.Best().Delta) +
      (isCoarse
          ? "; grading by the local feature size keeps interfaces coarse with every delta: ask "
            "for fewer, or for a smaller ratio of the sampling distance to the local feature size"
          : "; ask for about that number, or for larger sizes: small components, element sizes "
            "and interface sizes make elements with every delta"));
  }

  const RunEnvironment<D> Run;
  RunProgress& Progress;
  double LeftOfElements;    ///< the fraction of those inspected that the mesh is expected to have
  bool IsCorrected = false; ///< whether it is that of an earlier mesh
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
bool RunPipeline(LabelImage<D>& image, const IsosurfaceImage<D>* isosurface,
  const MeshingOptions<D>& options, MeshingStatistics& statistics, RunProgress& progress,
  const std::stop_token& stop, SimplexMesh<D>& mesh)
{
  try
  {
    const PreparedImage<D> prepared = Prepare(image, isosurface, options, statistics, stop);
    progress.EndPreparation();
    const RunEnvironment<D> run{ prepared, options, statistics, stop };
    if (options.Sampling.Elements > 0)
    {
      return ElementTarget<D>(run, progress).Mesh(mesh);
    }
    InspectedMesh<D> inspected;
    if (!RefineAndInspect<D>(
          run, progress, [](std::uint64_t) { return true; }, inspected))
    {
      return false;
    }
    FinishMesh<D>(run, inspected, mesh);
    return !stop.stop_requested();
  }
  catch (const Cancelled&)
  {
    return false;
  }
}

template bool RunPipeline<3>(LabelImage<3>&, const IsosurfaceImage<3>*, const MeshingOptions<3>&,
  MeshingStatistics&, RunProgress&, const std::stop_token&, SimplexMesh<3>&);
template bool RunPipeline<4>(LabelImage<4>&, const IsosurfaceImage<4>*, const MeshingOptions<4>&,
  MeshingStatistics&, RunProgress&, const std::stop_token&, SimplexMesh<4>&);

} // namespace voxplex
