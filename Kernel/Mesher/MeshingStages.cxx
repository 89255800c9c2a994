// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/MeshingStages.h"

#include "Base/Error.h"
#include "Domain/ImageDomain.h"
#include "Image/GreyValues.h"
#include "Junctions/JunctionSeeds.h"
#include "Mesh/MeshExtraction.h"
#include "Mesher/MeshSizeEstimate.h"
#include "Optimisation/MeshOptimiser.h"
#include "Parallel/ParallelFor.h"
#include "Refinement/Rules3D.h"
#include "Refinement/Rules4D.h"
#include "Sizing/GradedSize.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <type_traits>
#include <utility>

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

/** Of what is left of the progress a run takes so much when the number of runs is not known. */
constexpr double ShareOfRun = 0.6;

/**
 * Meshes turn out so much larger than estimated with slivers split, and when these are left to optimisation; the first run
 * of the search for a number of elements follows it.
 */
constexpr double ElementsPerEstimated = 1.12;
constexpr double OptimisedPerEstimated = 1.0;
/** No delta is tried with which a mesh that is not graded would have more than this times the elements asked for. */
constexpr double LargestExcess = 16.0;

/** Optimisation leaves so many elements of those that refinement made; the search plans with it. */
constexpr double ElementsLeftByOptimisation = 0.96;

/**
 * Refinement leaves slivers to optimisation that are better than this, in degrees. On twelve meshes of eight atlases 3.0
 * million elements become 2.7 million by that, and as many of them as without are poor in the end: under ten.
 */
constexpr double SliversLeftToOptimisation = 3.0;

/** Spacing of the points by which local feature sizes are measured, in delta. */
constexpr double GradingSampleSpacing = 0.75;

/** Of the distance from interfaces that is asked for: too coarse a start takes more elements in the end. */
constexpr double GradingTolerance = 0.9;

/** How far optimisation may move vertices off interfaces as a last means, in smallest voxel spacings. */
constexpr double OptimisationTolerance = 0.1;

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
bool MeshingStages<D>::Run(const LabelImage<D>& image, SimplexMesh<D>& mesh)
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

//------------------------------------------------------------------------------------------------
/** @throws Cancelled if stopped while preparing; false if stopped later; InputError of grey values */
template <int D>
bool MeshingStages<D>::RunUnlessStopped(const LabelImage<D>& image, SimplexMesh<D>& mesh)
{
  const std::stop_token stop = this->Stop.get_token();
  if (!this->Isosurface && !this->Options.Force)
  {
    CheckSegmented(image, this->Options.Threads, stop);
  }
  const std::unique_ptr<const Domain<D>> domain = this->MakeDomain(image, stop);
  this->Fraction = PreparationShare;
  ThrowIfStopped(stop);

  const std::optional<Components<D>> components = this->FindComponents(image, stop);
  const std::optional<JunctionCurves> junctions = this->FindJunctions(*domain, stop);
  const Prepared prepared{ image, *domain, components ? &*components : nullptr,
    junctions ? &*junctions : nullptr, this->LimitGradation(image, stop), stop };
  return this->Options.Elements > 0 ? this->SearchDelta(prepared, mesh)
                                    : this->MeshWithDelta(prepared, mesh);
}

//------------------------------------------------------------------------------------------------
/** @throws Cancelled */
template <int D>
std::unique_ptr<const Domain<D>> MeshingStages<D>::MakeDomain(
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
template <int D>
template <typename DomainType>
std::unique_ptr<const Domain<D>> MeshingStages<D>::Measured(
  std::unique_ptr<const DomainType> domain)
{
  this->Sites = &domain->GetSites();
  this->Stats.Times.LabelField = domain->LabelFieldSeconds();
  this->Stats.Times.DistanceTransform = domain->DistanceSeconds();
  this->Stats.LabelFieldBytes = domain->GetLabelField().MemoryBytes();
  this->Stats.DistanceBytes =
    domain->GetFeatureTransform().MemoryBytes() + domain->GetSites().MemoryBytes();
  return domain;
}

//------------------------------------------------------------------------------------------------
/** @throws Cancelled */
template <int D>
std::shared_ptr<const SizeFunction<D>> MeshingStages<D>::LimitGradation(
  const LabelImage<D>& image, const std::stop_token& stop)
{
  Stopwatch time;
  auto size = GradedSize<D>::Limit(
    this->Options.Size, image, this->Options.Gradation, this->Options.Threads, stop);
  this->Stats.Times.Grading += size ? time.Seconds() : 0.0;
  return size;
}

//------------------------------------------------------------------------------------------------
/** @throws Cancelled */
template <int D>
std::optional<Components<D>> MeshingStages<D>::FindComponents(
  const LabelImage<D>& image, const std::stop_token& stop)
{
  std::optional<Components<D>> components;
  if (D == 3 && this->Options.SmallestComponent > 0)
  {
    Stopwatch time;
    components.emplace(image, this->Options.Threads, stop);
    this->Stats.Components = components->All().size();
    this->Stats.Times.Components += time.Seconds();
  }
  return components;
}

//------------------------------------------------------------------------------------------------
/** @throws Cancelled */
template <int D>
std::optional<JunctionCurves> MeshingStages<D>::FindJunctions(
  const Domain<D>& domain, const std::stop_token& stop)
{
  std::optional<JunctionCurves> junctions;
  if constexpr (D == 3)
  {
    const auto find = [&](const auto& image)
    {
      Stopwatch time;
      junctions.emplace(
        image.GetImage(), image.GetLabelField(), image.GetSites(), this->Options.Threads, stop);
      this->Stats.Interfaces.JunctionCurves = junctions->Curves().size();
      this->Stats.Interfaces.Corners = junctions->NumberOfCorners();
      this->Stats.Times.Interfaces += time.Seconds();
    };
    if (!this->Options.SampleJunctions)
    {
      return junctions;
    }
    if (const auto* labels = dynamic_cast<const ImageDomain<D>*>(&domain))
    {
      find(*labels);
    }
    // An isosurface has junctions only where the image cuts it.
    if (const auto* isosurface = dynamic_cast<const ImageDomain<D, ScalarField<D>>*>(&domain))
    {
      find(*isosurface);
    }
  }
  return junctions;
}

//------------------------------------------------------------------------------------------------
/**
 * Meshes with one delta after the other until there are as many elements as asked for, and keeps the mesh that comes
 * nearest. False if stopped.
 * @throws InputError if no delta makes so many
 */
template <int D>
bool MeshingStages<D>::SearchDelta(const Prepared& prepared, SimplexMesh<D>& mesh)
{
  DeltaSearch search = this->StartSearch(prepared);
  const MeshingStatistics before = this->Stats;
  MeshingStatistics best;
  SimplexMesh<D> next;
  while (search.Next())
  {
    const StageTimes times = this->Stats.Times;
    this->Stats = before;
    this->Stats.Times = times;
    this->Stats.Delta = *search.Next();
    this->ProgressEnd = this->ProgressStart + ShareOfRun * (RefinementShare - this->ProgressStart);
    if (!this->MeshWithDelta(prepared, next))
    {
      return false;
    }
    this->ProgressStart = this->ProgressEnd;
    search.Add(this->ExpectedElements(next));
    if (search.Best().Delta == this->Stats.Delta)
    {
      best = this->Stats;
      mesh = std::move(next);
    }
  }
  best.Times = this->Stats.Times;
  best.Runs = search.Runs();
  this->Stats = std::move(best);
  if (!search.Found())
  {
    const bool isCoarse = this->Options.Grading.Mode == GradingMode::LocalFeatureSize &&
      search.Best().Elements < this->Options.Elements;
    throw InputError("no delta makes a mesh of " + std::to_string(this->Options.Elements) +
      " elements within " + Number(100.0 * DeltaSearch::Tolerance) + " %: the nearest of " +
      std::to_string(search.Runs().size()) + " meshes has " +
      std::to_string(search.Best().Elements) + ", with a delta of " + Number(search.Best().Delta) +
      (isCoarse
          ? "; grading by the local feature size keeps interfaces coarse whatever delta: ask for "
            "less, or for a smaller ratio of the sampling density to the local feature size"
          : "; ask for about so many, or for larger sizes: small components, element sizes and "
            "interface sizes have elements whatever delta"));
  }
  return true;
}

//------------------------------------------------------------------------------------------------
/**
 * The first guess is from the estimate of the size of the mesh with the default delta, not graded. No delta is tried
 * that would raise sizes (RefinementContext::SizeFloor) that the default does not raise.
 */
template <int D>
DeltaSearch MeshingStages<D>::StartSearch(const Prepared& prepared) const
{
  const double delta = DefaultDelta<D>(prepared.Image.Grid().VoxelVolume());
  const MeshSizeEstimate estimate = EstimateMeshSize<D>(prepared.Image, delta,
    SpacingFloorFraction * delta, prepared.Size.get(), this->Options.Threads, prepared.Stop);
  const double perEstimated =
    D == 3 && this->Options.Optimise ? OptimisedPerEstimated : ElementsPerEstimated;
  const auto wanted = static_cast<double>(this->Options.Elements);
  const double target = wanted / perEstimated;
  const double interfaces = std::max(static_cast<double>(estimate.InterfaceElements), 1.0);
  const double sizes = static_cast<double>(estimate.Elements) - interfaces;
  const double guess =
    delta * std::pow(interfaces / std::max(target - sizes, 0.25 * target), 1.0 / (D - 1));
  const double smallest = delta * std::pow(interfaces / (LargestExcess * wanted), 1.0 / (D - 1));
  return DeltaSearch(this->Options.Elements, guess, D - 1, smallest,
    std::max(delta, estimate.SmallestSize / SpacingFloorFraction));
}

//------------------------------------------------------------------------------------------------
/** Of a mesh that is optimised if it may be the one asked for, and else would have fewer elements. */
template <int D>
std::uint64_t MeshingStages<D>::ExpectedElements(const SimplexMesh<D>& mesh) const
{
  const auto elements = static_cast<double>(mesh.Simplices.size());
  return static_cast<std::uint64_t>(
    D == 3 && this->Options.Optimise && !this->Stats.Optimisation.Ran
      ? elements * ElementsLeftByOptimisation
      : elements);
}

/** Whether a mesh of the search needs no optimisation, because it is not the one asked for. */
template <int D>
bool MeshingStages<D>::IsFarFromTarget(const SimplexMesh<D>& mesh) const
{
  const double ratio =
    static_cast<double>(this->ExpectedElements(mesh)) / static_cast<double>(this->Options.Elements);
  return this->Options.Elements > 0 && std::abs(ratio - 1.0) > DeltaSearch::Tolerance;
}

//------------------------------------------------------------------------------------------------
/** Refines with Stats.Delta. False if stopped. @throws Cancelled */
template <int D>
bool MeshingStages<D>::MeshWithDelta(const Prepared& prepared, SimplexMesh<D>& mesh)
{
  const auto& [image, domain, all, junctions, size, stop] = prepared;
  const Density density = this->ChooseDensity(prepared);
  const double sizeFloor = SpacingFloorFraction * this->Stats.Delta;
  const MeshSizeEstimate estimate = EstimateMeshSize<D>(
    image, density.Equivalent(), sizeFloor, size.get(), this->Options.Threads, stop);
  this->Stats.EstimatedElements = estimate.Elements;
  this->Stats.SizesRaisedTo = estimate.SizesBelowFloor ? sizeFloor : 0.0;
  if (!this->Options.Force)
  {
    CheckMemory(estimate, this->Options.MemoryLimit);
  }

  LocalDelta<D> local(image);
  std::optional<ComponentGuard<D>> components = this->GuardComponents(prepared, density, local);
  RefinementContext<D> context(domain, this->Settings(prepared, density, local),
    this->MakeBox(domain, density), estimate.InterfaceVertices);
  std::vector<FeatureSeed<D>> seeds = this->SampleJunctions(prepared, context);
  if (components)
  {
    const std::vector<FeatureSeed<D>> more = components->TakeSeeds();
    seeds.insert(seeds.end(), more.begin(), more.end());
  }
  const std::uint64_t expected = estimate.Vertices;
  bool goOn = this->Refine(prepared, context, seeds, RefinementStart::Everywhere, expected);
  std::optional<InterfaceStage> interfaces;
  if constexpr (D == 3)
  {
    interfaces.emplace(InterfaceStage::Subject{ context.Mesh, image, *this->Sites, domain,
                         density.Base, density.Sizes(), size.get(),
                         ShapeBounds::With(this->Options.RadiusEdgeRatio, this->Options.FacetAngle),
                         this->Options.Threads },
      this->Options.Interfaces, local, this->Stats.Interfaces, stop);
  }
  while (goOn)
  {
    this->Fraction = this->ProgressEnd;
    local.ForgetLowered(); // refinement has seen to it
    seeds = this->InspectTriangulation(interfaces);
    if (seeds.empty())
    {
      this->Extract(context.Mesh, domain, interfaces, stop, mesh);
      if (components && this->SampleLostComponents(*components, image, mesh))
      {
        ++this->Stats.ComponentRounds;
        context.FollowLocalDelta();
        goOn = this->Refine(
          prepared, context, components->TakeSeeds(), RefinementStart::AtSeeds, expected);
        continue;
      }
      seeds = this->InspectMesh(interfaces, mesh);
    }
    if (seeds.empty())
    {
      if (!this->IsFarFromTarget(mesh))
      {
        this->Optimise(prepared, components ? &*components : nullptr, mesh);
      }
      return !stop.stop_requested();
    }
    context.FollowLocalDelta();
    goOn = this->Refine(prepared, context, seeds, RefinementStart::AtSeeds, expected);
  }
  return false;
}

//------------------------------------------------------------------------------------------------
/** @throws Cancelled; InputError from interface sizes */
template <int D>
typename MeshingStages<D>::Density MeshingStages<D>::ChooseDensity(const Prepared& prepared)
{
  Density density;
  density.Base.Delta = this->Stats.Delta;
  density.Base.Equivalent = this->Stats.Delta;
  density.Base.Asked = this->Stats.Delta;
  if constexpr (D == 3)
  {
    density.Grading = this->Grade(prepared);
    if (density.Grading)
    {
      density.Base = { density.Grading->Largest(), &density.Grading->Delta(),
        density.Grading->Equivalent(), this->Stats.Delta };
    }
  }
  this->Stats.LargestDelta = density.Base.Delta;
  if (!this->Options.InterfaceSizes.empty())
  {
    Stopwatch time;
    density.Interfaces.emplace(prepared.Image, this->Options.InterfaceSizes, density.Base,
      this->Options.Gradation, this->Options.Threads, prepared.Stop);
    this->Stats.LargestDelta = density.Interfaces->Largest();
    this->Stats.Times.Grading += time.Seconds();
  }
  return density;
}

//------------------------------------------------------------------------------------------------
/** Null in uniform mode. @throws Cancelled */
template <int D>
std::unique_ptr<const LocalFeatureSize> MeshingStages<D>::Grade(const Prepared& prepared)
{
  std::unique_ptr<const LocalFeatureSize> grading;
  if constexpr (D == 3)
  {
    if (this->Options.Grading.Mode == GradingMode::LocalFeatureSize)
    {
      Stopwatch time;
      GradingParameters parameters;
      const GridGeometry<3>& grid = prepared.Image.Grid();
      parameters.Finest = this->Stats.Delta;
      parameters.Ratio = this->Options.Grading.Ratio;
      parameters.Lambda = this->Options.Grading.Lambda * std::cbrt(grid.VoxelVolume());
      parameters.SampleSpacing = GradingSampleSpacing * this->Stats.Delta;
      parameters.Salience =
        std::max({ grid.Spacing(0), grid.Spacing(1), grid.Spacing(2), parameters.SampleSpacing });
      parameters.Tolerance =
        GradingTolerance * InterfaceGuard::LargestSurfaceDistance(grid, this->Stats.Delta);
      grading = std::make_unique<const LocalFeatureSize>(
        prepared.Image, prepared.Domain, parameters, this->Options.Threads, prepared.Stop);
      this->Stats.GradingSamples = grading->Sample().size();
      this->Stats.GradingPoles = grading->NumberOfPoles();
      this->Stats.Times.Grading += time.Seconds();
    }
  }
  return grading;
}

//------------------------------------------------------------------------------------------------
/** @throws Cancelled */
template <int D>
std::optional<ComponentGuard<D>> MeshingStages<D>::GuardComponents(
  const Prepared& prepared, const Density& density, LocalDelta<D>& local)
{
  std::optional<ComponentGuard<D>> guard;
  if (prepared.All)
  {
    Stopwatch components;
    std::vector<double> delta(prepared.Image.Values().size(), density.Base.Delta);
    for (std::size_t label = 0; density.Interfaces && label < delta.size(); ++label)
    {
      const double largest = density.Interfaces->LargestOf(static_cast<LabelId>(label));
      delta[label] = largest > 0.0 ? largest : delta[label]; // 0 if no voxel has it any more
    }
    guard.emplace(prepared.Image, prepared.Domain, *prepared.All, delta,
      this->Options.SmallestComponent, this->Options.ExactComponents, local, this->Options.Threads,
      prepared.Stop);
    this->Stats.Times.Components += components.Seconds();
  }
  return guard;
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<FeatureSeed<D>> MeshingStages<D>::SampleJunctions(
  const Prepared& prepared, const RefinementContext<D>& context)
{
  std::vector<FeatureSeed<D>> seeds;
  if constexpr (D == 3)
  {
    if (prepared.Junctions)
    {
      Stopwatch sampling;
      seeds = voxplex::SampleJunctions(
        *prepared.Junctions,
        [&](const Point<3>& z, const std::array<LabelId, 3>& labels)
        {
          return std::min({ context.Delta(z, labels[0], labels[1]),
            context.Delta(z, labels[1], labels[2]), context.Delta(z, labels[0], labels[2]) });
        },
        context.LargestDelta());
      this->Stats.Interfaces.JunctionSeeds = seeds.size();
      this->Stats.Times.Interfaces += sampling.Seconds();
    }
  }
  return seeds;
}

//------------------------------------------------------------------------------------------------
template <int D>
RefinementSettings<D> MeshingStages<D>::Settings(
  const Prepared& prepared, const Density& density, const LocalDelta<D>& local) const
{
  RefinementSettings<D> settings;
  settings.Delta = density.Base.Delta;
  settings.Graded = density.Base.Graded;
  settings.Interfaces = density.Sizes();
  settings.Local = D == 3 ? &local : nullptr;
  settings.RadiusEdgeRatio = this->Options.RadiusEdgeRatio;
  settings.FacetAngle = this->Options.FacetAngle;
  settings.Size = prepared.Size.get();
  settings.SizeFloor =
    SpacingFloorFraction * this->Stats.Delta; // also where grading is coarser everywhere
  settings.Order = this->Options.Order;
  settings.Slivers = this->Options.Slivers;
  settings.TetSlivers = this->Options.TetSlivers;
  if (this->Options.Optimise && this->Options.OptimisationSeconds == 0.0)
  {
    settings.TetSlivers.AngleInside =
      std::min(settings.TetSlivers.AngleInside, SliversLeftToOptimisation);
  }
  return settings;
}

//------------------------------------------------------------------------------------------------
/** At least 2 delta from every interface (thesis, sections 2.2 and 4.2), but at flat ends. */
template <int D>
Box<D> MeshingStages<D>::MakeBox(const Domain<D>& domain, const Density& density) const
{
  const double delta = density.Interfaces
    ? std::max(density.Base.Delta, density.Interfaces->Largest())
    : density.Base.Delta;
  Box<D> box = domain.Bounds();
  for (std::size_t a = 0; a < D; ++a)
  {
    const bool time = D == 4 && a == 3;
    box.Min[a] -= time && domain.IsFlatEnd(0) ? 0.0 : 2.0 * delta;
    box.Max[a] += time && domain.IsFlatEnd(1) ? 0.0 : 2.0 * delta;
  }
  return box;
}

//------------------------------------------------------------------------------------------------
template <int D>
TeamOptions MeshingStages<D>::Team() const
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

//------------------------------------------------------------------------------------------------
/** False if stopped. */
template <int D>
bool MeshingStages<D>::Refine(const Prepared& prepared, RefinementContext<D>& context,
  const std::vector<FeatureSeed<D>>& seeds, RefinementStart start, std::uint64_t expectedVertices)
{
  using Rules = std::conditional_t<D == 3, Rules3D, Rules4D>;
  Stopwatch refinement;
  Refiner<Rules> refiner(context, this->Team(), seeds, start);
  const auto expected = static_cast<double>(expectedVertices);
  const bool done = refiner.Run(
    [&](std::uint64_t vertices)
    {
      const double part = std::min(0.98, static_cast<double>(vertices) / expected);
      this->Fraction = this->ProgressStart + (this->ProgressEnd - this->ProgressStart) * part;
      return !prepared.Stop.stop_requested();
    });
  this->Stats.Times.Refinement += refinement.Seconds();
  this->Stats.Rules += refiner.GetRuleStatistics();
  this->Stats.Predicates += refiner.GetPredicateStatistics();
  this->AddThreads(refiner.GetThreadStatistics());
  this->AddYielded(prepared.Image.Grid(), refiner.GetYielded());
  this->Stats.SeedingSeconds += refiner.GetSecondsToSeed();
  this->Stats.SwitchedToLocal |= refiner.SwitchedToLocal();
  return done;
}

template <int D>
void MeshingStages<D>::AddThreads(const std::vector<ThreadStatistics>& threads)
{
  this->Stats.Threads.resize(std::max(this->Stats.Threads.size(), threads.size()));
  for (std::size_t t = 0; t < threads.size(); ++t)
  {
    this->Stats.Threads[t] += threads[t];
  }
}

template <int D>
void MeshingStages<D>::AddYielded(
  const GridGeometry<D>& grid, const std::vector<YieldingRegion<D>>& regions)
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
    this->Stats.Yielding.push_back(std::move(report));
  }
}

//------------------------------------------------------------------------------------------------
/** Whether refinement is to go on because a component has no element; tells of those it gives up. */
template <int D>
bool MeshingStages<D>::SampleLostComponents(
  ComponentGuard<D>& guard, const LabelImage<D>& image, const SimplexMesh<D>& mesh)
{
  Stopwatch components;
  const std::vector<std::uint32_t> lost = guard.FindLost(mesh);
  const bool goOn = guard.SampleFiner(lost);
  this->Stats.LostComponents.clear(); // of an earlier round
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
  this->Stats.ComponentSeeds = guard.NumberOfSeeds();
  this->Stats.Times.Components += components.Seconds();
  return goOn;
}

//------------------------------------------------------------------------------------------------
/** Points to go on with before there is a mesh. @throws Cancelled */
template <int D>
std::vector<FeatureSeed<D>> MeshingStages<D>::InspectTriangulation(
  std::optional<InterfaceStage>& interfaces)
{
  std::vector<FeatureSeed<D>> seeds;
  if constexpr (D == 3)
  {
    Stopwatch inspection;
    seeds = interfaces->InspectTriangulation();
    this->Stats.Times.Interfaces += inspection.Seconds();
  }
  return seeds;
}

/** Points to go on with. @throws Cancelled */
template <int D>
std::vector<FeatureSeed<D>> MeshingStages<D>::InspectMesh(
  std::optional<InterfaceStage>& interfaces, const SimplexMesh<D>& mesh)
{
  std::vector<FeatureSeed<D>> seeds;
  if constexpr (D == 3)
  {
    Stopwatch inspection;
    seeds = interfaces->InspectMesh(mesh);
    this->Stats.Times.Interfaces += inspection.Seconds();
  }
  return seeds;
}

/** @throws Cancelled */
template <int D>
void MeshingStages<D>::Extract(const Triangulation<D>& triangulation, const Domain<D>& domain,
  const std::optional<InterfaceStage>& interfaces, const std::stop_token& stop,
  SimplexMesh<D>& mesh)
{
  Stopwatch extraction;
  if (interfaces)
  {
    ExtractMesh<D>(triangulation, domain, interfaces->Labels(), mesh, this->Options.Threads, stop);
    if constexpr (D == 3)
    {
      Subdivide(triangulation, domain, interfaces->Parts(), mesh, this->Options.Threads, stop);
    }
  }
  else
  {
    ExtractMesh<D>(triangulation, domain, mesh, this->Options.Threads, stop);
  }
  this->Stats.Times.Extraction += extraction.Seconds();
}

//------------------------------------------------------------------------------------------------
/** Keeps components that the mesh has. @throws Cancelled */
template <int D>
void MeshingStages<D>::Optimise(
  const Prepared& prepared, const ComponentGuard<D>* components, SimplexMesh<D>& mesh)
{
  if constexpr (D == 3)
  {
    if (!this->Options.Optimise || prepared.Stop.stop_requested())
    {
      return;
    }
    OptimisationOptions options;
    options.Shape = ShapeBounds::With(
      std::max(OptimisedRadiusEdgeRatio, this->Options.RadiusEdgeRatio), this->Options.FacetAngle);
    options.Seconds = this->Options.OptimisationSeconds;
    const GridGeometry<3>& grid = prepared.Image.Grid();
    options.InterfaceTolerance =
      OptimisationTolerance * std::min({ grid.Spacing(0), grid.Spacing(1), grid.Spacing(2) });
    if (components)
    {
      options.ShouldHaveStayed = [&mesh, components](const SimplexMesh<3>& result)
      { return components->FindWitnesses(mesh, components->FindLost(result)); };
    }
    const OptimisationStatistics done =
      OptimiseMesh(mesh, prepared.Domain, options, this->Options.Threads, prepared.Stop);
    this->Stats.Times.Optimisation += done.Seconds;
    this->Stats.Optimisation = { true, done.OutOfTime, done.Before.SmallestDihedralAngle,
      done.Before.LargestDihedralAngle, done.After.SmallestDihedralAngle,
      done.After.LargestDihedralAngle, done.Before.Poor, done.After.Poor };
  }
}

template class MeshingStages<3>;
template class MeshingStages<4>;

} // namespace voxplex
