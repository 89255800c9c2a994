// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageMesher.h"

#include "ComponentGuard.h"
#include "Error.h"
#include "Geometry/Predicates.h"
#include "Image/ImageDomain.h"
#include "Mesh/MeshExtraction.h"
#include "MeshSizeEstimate.h"
#include "Optimisation/MeshOptimiser.h"
#include "Parallel/ParallelFor.h"
#include "Refinement/Refiner.h"
#include "Refinement/Rules3D.h"
#include "Refinement/Rules4D.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <type_traits>

namespace voxplex
{

namespace
{

class Stopwatch
{
public:
  double Seconds() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count();
  }

private:
  std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
};

std::string Number(double x)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", x);
  return text;
}

void CheckSliverOptions(const SliverOptions& slivers, bool force)
{
  if (!(slivers.PickingRadius > 0.0 && slivers.PickingRadius < 1.0))
  {
    throw InputError("the radius of picking regions must be between 0 and 1; it is " +
      Number(slivers.PickingRadius));
  }
  if (!(slivers.RadiusFactor > 0.0) || std::isinf(slivers.RadiusFactor))
  {
    throw InputError("the factor that tells small slivers must be positive; it is " +
      Number(slivers.RadiusFactor));
  }
  if (slivers.Picks == 0)
  {
    throw InputError("there must be at least one pick in a picking region");
  }
  if (!(slivers.VolumeBound >= 0.0 && slivers.VolumeBound < 1.0))
  {
    throw InputError("the normalized volume of slivers must be at least 0 and below 1; it is " +
      Number(slivers.VolumeBound));
  }
  if (slivers.VolumeBound > LargestSliverBound && !force)
  {
    throw InputError("a sliver bound of " + Number(slivers.VolumeBound) + " is above " +
      Number(LargestSliverBound) +
      ", where meshes can become very large; ask for less, or force it");
  }
}

void CheckTetSliverOptions(const TetSliverOptions& slivers, bool force)
{
  if (!(slivers.Angle >= 0.0 && slivers.Angle < 60.0))
  {
    throw InputError(
      "the dihedral angle of slivers must be at least 0 and below 60 degrees; it is " +
      Number(slivers.Angle));
  }
  if (slivers.Angle > LargestSliverAngle && !force)
  {
    throw InputError("a dihedral angle of " + Number(slivers.Angle) + " degrees is above " +
      Number(LargestSliverAngle) +
      ", where meshes can become very large; ask for less, or force it");
  }
  if (!(slivers.PickingRadius > 0.0 && slivers.PickingRadius < 1.0) || slivers.Picks == 0)
  {
    throw InputError("slivers need at least one pick, and a picking radius between 0 and 1");
  }
}

template <int D>
void CheckOptions(const MeshingOptions<D>& options)
{
  if (!(options.Delta >= 0.0) || std::isinf(options.Delta))
  {
    throw InputError("delta must be a positive length, or 0 to derive it from the spacing; it is " +
      Number(options.Delta));
  }
  if (!(options.RadiusEdgeRatio > 0.0) || std::isinf(options.RadiusEdgeRatio))
  {
    throw InputError(
      "the radius-edge ratio must be positive; it is " + Number(options.RadiusEdgeRatio));
  }
  if (options.RadiusEdgeRatio < 1.93 && !options.Force)
  {
    throw InputError("a radius-edge ratio of " + Number(options.RadiusEdgeRatio) +
      " is below 1.93, where it is not proved that meshing ends; ask for 1.93 or more, or force "
      "it");
  }
  if (!(options.FacetAngle >= 0.0 && options.FacetAngle <= 30.0))
  {
    throw InputError(
      "the facet angle must be between 0 and 30 degrees; it is " + Number(options.FacetAngle));
  }
  if constexpr (D == 4)
  {
    CheckSliverOptions(options.Slivers, options.Force);
  }
  else
  {
    CheckTetSliverOptions(options.TetSlivers, options.Force);
  }
  if (!FloatingPointIsStrict())
  {
    throw Error("this build of Voxplex fuses or extends floating-point operations, which makes its "
                "predicates unreliable; compile it with -ffp-contract=off and without -ffast-math");
  }
}

/** How much of a run each stage takes, about; only progress depends on it. */
constexpr double PreparationShare = 0.2;
constexpr double RefinementShare = 0.95; ///< end of refinement

/** How far optimisation may move vertices off interfaces as a last means, in smallest voxel spacings. */
constexpr double OptimisationTolerance = 0.1;

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
double DefaultDelta(double voxelVolume)
{
  return 2.0 * std::pow(voxelVolume, 1.0 / D);
}

//------------------------------------------------------------------------------------------------
/**
 * The stages of a run, on whatever thread; shares only the fraction and the request to stop with
 * the thread that reports.
 */
template <int D>
class ImageMesher<D>::Stages
{
public:
  Stages(const MeshingOptions<D>& options, MeshingStatistics& statistics)
    : Options(options)
    , Stats(statistics)
  {
  }

  std::atomic<double> Fraction{ 0.0 };
  std::stop_source Stop;

  /** False if stopped. */
  bool Run(const LabelImage<D>& image, SimplexMesh<D>& mesh)
  {
    try
    {
      return this->RunUnlessStopped(image, mesh);
    }
    catch (const Cancelled&)
    {
      return false;
    }
  }

private:
  using Rules = std::conditional_t<D == 3, Rules3D, Rules4D>;

  /** @throws Cancelled if stopped while preparing; false if stopped later */
  bool RunUnlessStopped(const LabelImage<D>& image, SimplexMesh<D>& mesh)
  {
    const std::stop_token stop = this->Stop.get_token();
    const ImageDomain<D> domain(image, this->Options.SmoothingSigma, this->Options.Threads, stop);
    this->Stats.Times.LabelField = domain.LabelFieldSeconds();
    this->Stats.Times.DistanceTransform = domain.DistanceSeconds();
    this->Stats.LabelFieldBytes = domain.GetLabelField().MemoryBytes();
    this->Stats.DistanceBytes =
      domain.GetFeatureTransform().MemoryBytes() + domain.GetSites().MemoryBytes();
    this->Fraction = PreparationShare;
    ThrowIfStopped(stop);

    const MeshSizeEstimate estimate =
      EstimateMeshSize<D>(image, this->Stats.Delta, SpacingFloorFraction * this->Stats.Delta,
        this->Options.Size.get(), this->Options.Threads, stop);
    this->Stats.EstimatedElements = estimate.Elements;
    if (estimate.SizesBelowFloor)
    {
      this->Stats.SizesRaisedTo = SpacingFloorFraction * this->Stats.Delta;
    }
    if (!this->Options.Force)
    {
      CheckMemory(estimate, this->Options.MemoryLimit);
    }

    std::optional<ComponentGuard<D>> guard = this->GuardComponents(image, domain, stop);
    RefinementContext<D> context(domain, this->Settings(guard ? &guard->GetLocalDelta() : nullptr),
      this->MakeBox(domain), estimate.InterfaceVertices);
    const std::uint64_t expected = estimate.Vertices;
    if (!this->Refine(context, guard, expected, stop))
    {
      return false;
    }
    for (;;)
    {
      this->Fraction = RefinementShare;
      Stopwatch extraction;
      ExtractMesh<D>(context.Mesh, domain, mesh, this->Options.Threads, stop);
      this->Stats.Times.Extraction += extraction.Seconds();
      if (!guard || !this->SampleLostComponents(*guard, image, mesh))
      {
        this->Optimise(image, domain, mesh, stop);
        return !stop.stop_requested();
      }
      ++this->Stats.ComponentRounds;
      context.FollowLocalDelta();
      if (!this->Refine(context, guard, expected, stop))
      {
        return false;
      }
    }
  }

  /** @throws Cancelled */
  void Optimise(const LabelImage<D>& image, const Domain<D>& domain, SimplexMesh<D>& mesh,
    const std::stop_token& stop)
  {
    if constexpr (D == 3)
    {
      if (!this->Options.Optimise || stop.stop_requested())
      {
        return;
      }
      OptimisationOptions options;
      options.RadiusEdgeRatio = std::max(OptimisedRadiusEdgeRatio, this->Options.RadiusEdgeRatio);
      options.FacetAngle = this->Options.FacetAngle;
      options.JunctionFacetAngle = std::min(options.JunctionFacetAngle, options.FacetAngle);
      options.InterfaceTolerance = OptimisationTolerance *
        std::min({ image.Grid().Spacing(0), image.Grid().Spacing(1), image.Grid().Spacing(2) });
      const OptimisationStatistics done =
        OptimiseMesh(mesh, domain, options, this->Options.Threads, stop);
      this->Stats.Times.Optimisation = done.Seconds;
      this->Stats.Optimisation = { true, done.Before.SmallestDihedralAngle,
        done.Before.LargestDihedralAngle, done.After.SmallestDihedralAngle,
        done.After.LargestDihedralAngle, done.Before.Poor, done.After.Poor };
    }
  }

  std::optional<ComponentGuard<D>> GuardComponents(
    const LabelImage<D>& image, const Domain<D>& domain, const std::stop_token& stop)
  {
    std::optional<ComponentGuard<D>> guard;
    if (D == 3 && this->Options.SmallestComponent > 0)
    {
      Stopwatch components;
      guard.emplace(image, domain, this->Stats.Delta, this->Options.SmallestComponent,
        this->Options.Threads, stop);
      this->Stats.Components = guard->GetComponents().All().size();
      this->Stats.Times.Components = components.Seconds();
    }
    return guard;
  }

  /** False if stopped. */
  bool Refine(RefinementContext<D>& context, const std::optional<ComponentGuard<D>>& guard,
    std::uint64_t expectedVertices, const std::stop_token& stop)
  {
    Stopwatch refinement;
    Refiner<Rules> refiner(
      context, this->Team(), guard ? guard->GetSeeds() : std::vector<FeatureSeed<D>>());
    const auto expected = static_cast<double>(expectedVertices);
    const bool done = refiner.Run(
      [&](std::uint64_t vertices)
      {
        const double part = std::min(0.98, static_cast<double>(vertices) / expected);
        this->Fraction = PreparationShare + (RefinementShare - PreparationShare) * part;
        return !stop.stop_requested();
      });
    this->Stats.Times.Refinement += refinement.Seconds();
    this->Stats.Rules += refiner.GetRuleStatistics();
    this->Stats.Predicates += refiner.GetPredicateStatistics();
    this->AddThreads(refiner.GetThreadStatistics());
    this->Stats.SeedingSeconds += refiner.GetSecondsToSeed();
    this->Stats.SwitchedToLocal |= refiner.SwitchedToLocal();
    return done;
  }

  void AddThreads(const std::vector<ThreadStatistics>& threads)
  {
    this->Stats.Threads.resize(std::max(this->Stats.Threads.size(), threads.size()));
    for (std::size_t t = 0; t < threads.size(); ++t)
    {
      this->Stats.Threads[t] += threads[t];
    }
  }

  /** Whether refinement is to go on because a component has no element; tells of those it gives up. */
  bool SampleLostComponents(
    ComponentGuard<D>& guard, const LabelImage<D>& image, const SimplexMesh<D>& mesh)
  {
    Stopwatch components;
    const std::vector<std::uint32_t> lost = guard.FindLost(mesh);
    const bool goOn = guard.SampleFiner(lost);
    if (!goOn)
    {
      for (const std::uint32_t c : lost)
      {
        const Component<D>& component = guard.GetComponents().All()[c];
        ComponentReport entry{ image.Values()[component.Label], component.Voxels, {} };
        for (std::size_t a = 0; a < D; ++a)
        {
          entry.Voxel.push_back(image.CropOrigin()[a] + component.First[a]);
        }
        this->Stats.LostComponents.push_back(std::move(entry));
      }
    }
    this->Stats.ComponentSeeds = guard.GetSeeds().size();
    this->Stats.Times.Components += components.Seconds();
    return goOn;
  }

  RefinementSettings<D> Settings(const LocalDelta<D>* local) const
  {
    RefinementSettings<D> settings;
    settings.Local = local;
    settings.Delta = this->Stats.Delta;
    settings.RadiusEdgeRatio = this->Options.RadiusEdgeRatio;
    settings.FacetAngle = this->Options.FacetAngle;
    settings.Size = this->Options.Size.get();
    settings.Order = this->Options.Order;
    settings.Slivers = this->Options.Slivers;
    settings.TetSlivers = this->Options.TetSlivers;
    return settings;
  }

  TeamOptions Team() const
  {
    TeamOptions team;
    team.Threads = std::min(NumberOfThreads(this->Options.Threads), MaximumNumberOfWorkers);
    team.Contention = this->Options.Contention;
    team.SuccessesToWake = D == 3 ? 10 : 2; // an operation in 4D takes ten times as long
    team.Balance = this->Options.Balance;
    team.Pin = this->Options.PinThreads;
    team.Synchronise = this->Options.Synchronise;
    team.RemoveEagerly = this->Options.RemoveEagerly;
    team.FineGrained = this->Options.FineGrained && team.Threads <= NumberOfThreads(0);
    team.SeedsPerThread = this->Options.SeedsPerThread;
    return team;
  }

  /** At least 2 delta from every interface (thesis, sections 2.2 and 4.2), but at flat ends. */
  Box<D> MakeBox(const Domain<D>& domain) const
  {
    Box<D> box = domain.Bounds();
    for (std::size_t a = 0; a < D; ++a)
    {
      const bool time = D == 4 && a == 3;
      box.Min[a] -= time && domain.IsFlatEnd(0) ? 0.0 : 2.0 * this->Stats.Delta;
      box.Max[a] += time && domain.IsFlatEnd(1) ? 0.0 : 2.0 * this->Stats.Delta;
    }
    return box;
  }

  const MeshingOptions<D>& Options;
  MeshingStatistics& Stats;
};

//------------------------------------------------------------------------------------------------
template <int D>
MeshingOutcome ImageMesher<D>::Run(const LabelImage<D>& image, SimplexMesh<D>& mesh)
{
  mesh = SimplexMesh<D>();
  this->Stats = MeshingStatistics();
  CheckOptions(this->Options);
  this->Stats.Delta =
    this->Options.Delta > 0.0 ? this->Options.Delta : DefaultDelta<D>(image.Grid().VoxelVolume());
  this->Stats.SmoothingSigma = this->Options.SmoothingSigma;
  this->Stats.Contention = this->Options.Contention;
  this->Stats.Balance = this->Options.Balance;

  Stages stages(this->Options, this->Stats);
  const bool done =
    this->Progress ? this->RunReporting(stages, image, mesh) : stages.Run(image, mesh);
  if (!done)
  {
    mesh = SimplexMesh<D>();
    return MeshingOutcome::Cancelled;
  }
  return MeshingOutcome::Done;
}

//------------------------------------------------------------------------------------------------
// The stages run on a thread of their own, so that the caller's thread can report at a steady pace
// whatever they are doing.
template <int D>
bool ImageMesher<D>::RunReporting(Stages& stages, const LabelImage<D>& image, SimplexMesh<D>& mesh)
{
  bool done = false;
  std::exception_ptr error;
  bool finished = false;
  std::mutex mutex; // of finished
  std::condition_variable changed;
  std::jthread worker(
    [&]
    {
      try
      {
        done = stages.Run(image, mesh);
      }
      catch (...)
      {
        error = std::current_exception();
      }
      const std::scoped_lock lock(mutex);
      finished = true;
      changed.notify_one();
    });
  constexpr auto Period = std::chrono::milliseconds(20);
  double reported = 0.0;
  try
  {
    for (bool over = false; !over;)
    {
      reported = std::max(reported, stages.Fraction.load());
      if (!stages.Stop.stop_requested() && !this->Progress(reported))
      {
        stages.Stop.request_stop();
      }
      std::unique_lock lock(mutex);
      over = changed.wait_for(lock, Period, [&] { return finished; });
    }
  }
  catch (...) // from the callback: the worker joins on the way out
  {
    stages.Stop.request_stop();
    throw;
  }
  worker.join();
  if (error)
  {
    std::rethrow_exception(error);
  }
  if (done && !this->Progress(1.0))
  {
    done = false;
  }
  return done;
}

template class ImageMesher<3>;
template class ImageMesher<4>;
template double DefaultDelta<3>(double);
template double DefaultDelta<4>(double);

} // namespace voxplex
