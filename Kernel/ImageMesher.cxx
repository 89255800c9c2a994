// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageMesher.h"

#include "ComponentGuard.h"
#include "Error.h"
#include "Geometry/Predicates.h"
#include "Grading/LocalFeatureSize.h"
#include "Image/ImageDomain.h"
#include "Image/JunctionCurves.h"
#include "InterfaceGuard.h"
#include "Mesh/ManifoldRepair.h"
#include "Mesh/MeshExtraction.h"
#include "MeshSizeEstimate.h"
#include "Optimisation/MeshOptimiser.h"
#include "Parallel/ParallelFor.h"
#include "Refinement/JunctionSeeds.h"
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
#include <memory>
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

void CheckGradingOptions(const GradingOptions& grading)
{
  if (!(grading.Ratio > 0.0) || std::isinf(grading.Ratio))
  {
    throw InputError(
      "the ratio of the sampling density to the local feature size must be positive; it is " +
      Number(grading.Ratio));
  }
  if (!(grading.Lambda > 0.0) || std::isinf(grading.Lambda))
  {
    throw InputError("the largest local feature size must be a positive number of voxels; it is " +
      Number(grading.Lambda));
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
    CheckGradingOptions(options.Grading);
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

/** Spacing of the points by which local feature sizes are measured, in delta. */
constexpr double GradingSampleSpacing = 0.75;

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
  /** @param isosurface what is meshed, or null to mesh the labels alone */
  Stages(const MeshingOptions<D>& options, const IsosurfaceImage<D>* isosurface,
    MeshingStatistics& statistics)
    : Options(options)
    , Isosurface(isosurface)
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
    const std::unique_ptr<const Domain<D>> made = this->MakeDomain(image, stop);
    const Domain<D>& domain = *made;
    this->Fraction = PreparationShare;
    ThrowIfStopped(stop);

    const std::unique_ptr<const LocalFeatureSize> grading = this->Grade(image, domain, stop);
    const MeshSizeEstimate estimate = EstimateMeshSize<D>(image,
      grading ? grading->Equivalent() : this->Stats.Delta, SpacingFloorFraction * this->Stats.Delta,
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

    LocalDelta<D> local(image);
    std::optional<ComponentGuard<D>> components = this->GuardComponents(image, domain, local, stop);
    RefinementContext<D> context(domain, this->Settings(local, grading.get()),
      this->MakeBox(domain), estimate.InterfaceVertices);
    std::vector<FeatureSeed<D>> seeds = this->SampleJunctions(domain, context, stop);
    if (components)
    {
      seeds.insert(seeds.end(), components->GetSeeds().begin(), components->GetSeeds().end());
    }
    const std::uint64_t expected = estimate.Vertices;
    bool goOn = this->Refine(context, seeds, RefinementStart::Everywhere, expected, stop);
    std::optional<InterfaceGuard> interfaces;
    if constexpr (D == 3)
    {
      interfaces.emplace(image, *this->Sites, domain, this->Stats.LargestDelta,
        grading ? &grading->Delta() : nullptr, local, this->Options.Threads, stop);
    }
    while (goOn)
    {
      this->Fraction = RefinementShare;
      Stopwatch extraction;
      ExtractMesh<D>(context.Mesh, domain, mesh, this->Options.Threads, stop);
      this->Stats.Times.Extraction += extraction.Seconds();
      if (components && this->SampleLostComponents(*components, image, mesh))
      {
        ++this->Stats.ComponentRounds;
        context.FollowLocalDelta();
        goOn = this->Refine(
          context, components->GetSeeds(), RefinementStart::Everywhere, expected, stop);
        continue;
      }
      this->RepairInterfaces(mesh, stop);
      seeds = this->InspectInterfaces(interfaces, mesh);
      if (seeds.empty())
      {
        this->Optimise(image, domain, mesh, stop);
        return !stop.stop_requested();
      }
      context.FollowLocalDelta();
      goOn = this->Refine(context, seeds, RefinementStart::AtSeeds, expected, stop);
    }
    return false;
  }

  /** Points to go on with, for as many rounds as were asked for. @throws Cancelled */
  std::vector<FeatureSeed<D>> InspectInterfaces(
    std::optional<InterfaceGuard>& guard, const SimplexMesh<D>& mesh)
  {
    std::vector<FeatureSeed<D>> seeds;
    if constexpr (D == 3)
    {
      InterfaceFigures& figures = this->Stats.Interfaces;
      if (figures.Rounds < this->Options.InterfaceRounds)
      {
        Stopwatch inspection;
        seeds = guard->Inspect(mesh);
        figures.Rounds += seeds.empty() ? 0 : 1;
        figures.Seeds += seeds.size();
        this->Stats.Times.Interfaces += inspection.Seconds();
      }
    }
    return seeds;
  }

  /** @throws Cancelled */
  void RepairInterfaces(SimplexMesh<D>& mesh, const std::stop_token& stop)
  {
    if constexpr (D == 3)
    {
      if (this->Options.InterfaceRounds > 0)
      {
        Stopwatch repair;
        ManifoldRepairOptions options;
        options.FacetAngle = this->Options.FacetAngle;
        options.JunctionFacetAngle = std::min(options.JunctionFacetAngle, options.FacetAngle);
        const ManifoldRepairCounts counts = RepairManifold(mesh, options, stop);
        this->Stats.Interfaces.NonManifoldRepaired = counts.Before - counts.After;
        this->Stats.Interfaces.NonManifoldLeft = counts.After;
        this->Stats.Times.Interfaces += repair.Seconds();
      }
    }
  }

  /** @throws Cancelled */
  std::vector<FeatureSeed<D>> SampleJunctions(
    const Domain<D>& domain, const RefinementContext<D>& context, const std::stop_token& stop)
  {
    std::vector<FeatureSeed<D>> seeds;
    if constexpr (D == 3)
    {
      const auto* labelled =
        dynamic_cast<const ImageDomain<D>*>(&domain); // an isosurface has no junctions
      if (labelled && this->Options.SampleJunctions)
      {
        Stopwatch sampling;
        const JunctionCurves junctions(labelled->GetImage(), labelled->GetLabelField(),
          labelled->GetSites(), this->Options.Threads, stop);
        seeds = voxplex::SampleJunctions(
          junctions,
          [&](const Point<3>& z, const std::array<LabelId, 3>& labels)
          {
            return std::min(
              context.Delta(z, labels[0], labels[1]), context.Delta(z, labels[1], labels[2]));
          },
          this->Stats.LargestDelta);
        this->Stats.Interfaces.JunctionCurves = junctions.Curves().size();
        this->Stats.Interfaces.Corners = junctions.NumberOfCorners();
        this->Stats.Interfaces.JunctionSeeds = seeds.size();
        this->Stats.Times.Interfaces += sampling.Seconds();
      }
    }
    return seeds;
  }

  /** @throws Cancelled */
  std::unique_ptr<const Domain<D>> MakeDomain(
    const LabelImage<D>& image, const std::stop_token& stop)
  {
    if (this->Isosurface)
    {
      return this->Measured(std::make_unique<const ImageDomain<D, ScalarField<D>>>(
        *this->Isosurface, this->Options.Threads, stop));
    }
    return this->Measured(std::make_unique<const ImageDomain<D>>(
      image, this->Options.SmoothingSigma, this->Options.Threads, stop));
  }

  /** Notes what it took to make a domain. */
  template <typename DomainType>
  std::unique_ptr<const Domain<D>> Measured(std::unique_ptr<const DomainType> domain)
  {
    this->Sites = &domain->GetSites();
    this->Stats.Times.LabelField = domain->LabelFieldSeconds();
    this->Stats.Times.DistanceTransform = domain->DistanceSeconds();
    this->Stats.LabelFieldBytes = domain->GetLabelField().MemoryBytes();
    this->Stats.DistanceBytes =
      domain->GetFeatureTransform().MemoryBytes() + domain->GetSites().MemoryBytes();
    return domain;
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
      options.Seconds = this->Options.OptimisationSeconds;
      options.InterfaceTolerance = OptimisationTolerance *
        std::min({ image.Grid().Spacing(0), image.Grid().Spacing(1), image.Grid().Spacing(2) });
      const OptimisationStatistics done =
        OptimiseMesh(mesh, domain, options, this->Options.Threads, stop);
      this->Stats.Times.Optimisation = done.Seconds;
      this->Stats.Optimisation = { true, done.OutOfTime, done.Before.SmallestDihedralAngle,
        done.Before.LargestDihedralAngle, done.After.SmallestDihedralAngle,
        done.After.LargestDihedralAngle, done.Before.Poor, done.After.Poor };
    }
  }

  /** Null in uniform mode. @throws Cancelled */
  std::unique_ptr<const LocalFeatureSize> Grade(
    const LabelImage<D>& image, const Domain<D>& domain, const std::stop_token& stop)
  {
    std::unique_ptr<const LocalFeatureSize> grading;
    this->Stats.LargestDelta = this->Stats.Delta;
    if constexpr (D == 3)
    {
      if (this->Options.Grading.Mode == GradingMode::LocalFeatureSize)
      {
        Stopwatch time;
        GradingParameters parameters;
        const GridGeometry<3>& grid = image.Grid();
        parameters.Finest = this->Stats.Delta;
        parameters.Ratio = this->Options.Grading.Ratio;
        parameters.Lambda = this->Options.Grading.Lambda * std::cbrt(grid.VoxelVolume());
        parameters.SampleSpacing = GradingSampleSpacing * this->Stats.Delta;
        parameters.Salience =
          std::max({ grid.Spacing(0), grid.Spacing(1), grid.Spacing(2), parameters.SampleSpacing });
        grading = std::make_unique<const LocalFeatureSize>(
          image, domain, parameters, this->Options.Threads, stop);
        this->Stats.LargestDelta = grading->Largest();
        this->Stats.GradingSamples = grading->Sample().size();
        this->Stats.GradingPoles = grading->NumberOfPoles();
        this->Stats.Times.Grading = time.Seconds();
      }
    }
    return grading;
  }

  std::optional<ComponentGuard<D>> GuardComponents(const LabelImage<D>& image,
    const Domain<D>& domain, LocalDelta<D>& local, const std::stop_token& stop)
  {
    std::optional<ComponentGuard<D>> guard;
    if (D == 3 && this->Options.SmallestComponent > 0)
    {
      Stopwatch components;
      guard.emplace(image, domain, this->Stats.LargestDelta, this->Options.SmallestComponent, local,
        this->Options.Threads, stop);
      this->Stats.Components = guard->GetComponents().All().size();
      this->Stats.Times.Components = components.Seconds();
    }
    return guard;
  }

  /** False if stopped. */
  bool Refine(RefinementContext<D>& context, const std::vector<FeatureSeed<D>>& seeds,
    RefinementStart start, std::uint64_t expectedVertices, const std::stop_token& stop)
  {
    Stopwatch refinement;
    Refiner<Rules> refiner(context, this->Team(), seeds, start);
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

  RefinementSettings<D> Settings(const LocalDelta<D>& local, const LocalFeatureSize* grading) const
  {
    RefinementSettings<D> settings;
    settings.Local = D == 3 ? &local : nullptr;
    settings.Delta = this->Stats.LargestDelta;
    if constexpr (D == 3)
    {
      settings.Graded = grading ? &grading->Delta() : nullptr;
    }
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
      box.Min[a] -= time && domain.IsFlatEnd(0) ? 0.0 : 2.0 * this->Stats.LargestDelta;
      box.Max[a] += time && domain.IsFlatEnd(1) ? 0.0 : 2.0 * this->Stats.LargestDelta;
    }
    return box;
  }

  const BitMask<D>* Sites = nullptr; ///< surface voxels of the domain
  const MeshingOptions<D>& Options;
  const IsosurfaceImage<D>* Isosurface;
  MeshingStatistics& Stats;
};

//------------------------------------------------------------------------------------------------
template <int D>
MeshingOutcome ImageMesher<D>::Run(const LabelImage<D>& image, SimplexMesh<D>& mesh)
{
  return this->Run(image, nullptr, mesh);
}

template <int D>
MeshingOutcome ImageMesher<D>::Run(const IsosurfaceImage<D>& image, SimplexMesh<D>& mesh)
{
  return this->Run(image.Labels(), &image, mesh);
}

template <int D>
MeshingOutcome ImageMesher<D>::Run(
  const LabelImage<D>& image, const IsosurfaceImage<D>* isosurface, SimplexMesh<D>& mesh)
{
  mesh = SimplexMesh<D>();
  this->Stats = MeshingStatistics();
  CheckOptions(this->Options);
  this->Stats.Delta =
    this->Options.Delta > 0.0 ? this->Options.Delta : DefaultDelta<D>(image.Grid().VoxelVolume());
  this->Stats.SmoothingSigma =
    isosurface ? isosurface->Surface().SmoothingSigma : this->Options.SmoothingSigma;
  this->Stats.Contention = this->Options.Contention;
  this->Stats.Balance = this->Options.Balance;

  Stages stages(this->Options, isosurface, this->Stats);
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
