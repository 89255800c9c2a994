// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/Dimension.h"

#include "Base/Stopwatch.h"
#include "Conformity/EdgeSpindles.h"
#include "Junctions/JunctionSeeds.h"
#include "Mesh/MeshExtraction.h"
#include "Mesh/Subdivision.h"
#include "Mesher/SlabRefinement.h"
#include "Optimisation/InterfaceFit.h"
#include "Optimisation/MeshOptimiser.h"
#include "Optimisation/PentatopeOptimiser.h"
#include "Quality/LostComponents.h"
#include "Refinement/PlaneLabels.h"
#include "Sizing/Grading/LocalFeatureSize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace voxplex
{

namespace
{

/**
 * Spacing of the points used to measure local feature sizes, in delta. In 4D a spacing of 0.75 takes up
 * to three times as many points, and meshes are as good.
 */
template <int D>
constexpr double GradingSampleSpacing = D == 3 ? 0.75 : 1.0;

/**
 * The tolerance of grading, as a fraction of the largest distance from interfaces that the check
 * allows. A start that is too coarse takes more elements in the end.
 */
constexpr double GradingTolerance = 0.9;

/**
 * The tolerance of grading in 4D, in delta. Distances of facets are not checked, and volumes of frames
 * suffer from chords first.
 */
constexpr double SpaceTimeTolerance = 0.3;

/**
 * How far optimisation may move vertices off interfaces as a last resort. In 3D in cube roots of the
 * voxel volume: with 0.1 of the smallest spacing, one to nine tetrahedra of an atlas stayed poor, at
 * 12 degrees and more; now hardly any does. In 4D in smallest voxel spacings: with 0.1, two
 * phantoms kept a pentatope below the target.
 */
constexpr double ToleranceIn3D = 0.25;
constexpr double LargestToleranceIn3D = 0.5; ///< in smallest voxel spacings
constexpr double ToleranceIn4D = 0.25;

/**
 * If a space-time image is shorter than this many mean voxel spacings, nothing is sampled more
 * finely. Between two flat ends that are near each other, most points would be moved onto the ends,
 * and rules answer each other: images of a hundred voxels took minutes.
 */
constexpr double ShortestDuration = 5.0;

/** The duration of the shortest slab between two time planes. */
double ShortestSlab(const RunEnvironment<4>& run)
{
  const Box<4> bounds = run.Prepared.Surfaces->Bounds();
  double shortest = std::numeric_limits<double>::infinity();
  double last = bounds.Min[3];
  for (const double time : run.Prepared.Planes.Times)
  {
    shortest = std::min(shortest, time - last);
    last = time;
  }
  return std::min(shortest, bounds.Max[3] - last);
}

bool MayBeRefined(const RunEnvironment<4>& run)
{
  const double spacing = std::pow(run.Prepared.Image.Grid().VoxelVolume(), 0.25);
  return ShortestSlab(run) >= ShortestDuration * std::min(spacing, run.Statistics.Delta);
}

/** What grading has in common in space and space-time. */
template <int D>
GradingParameters ParametersOf(const RunEnvironment<D>& run, double delta)
{
  const double volume = run.Prepared.Image.Grid().VoxelVolume();
  const GridGeometry<D>& grid = run.Prepared.OfDomain().Grid();
  GradingParameters parameters;
  parameters.Finest = delta;
  parameters.Ratio = run.Options.Sampling.Grading.Ratio;
  parameters.Lambda =
    run.Options.Sampling.Grading.Lambda * (D == 3 ? std::cbrt(volume) : std::pow(volume, 1.0 / D));
  parameters.SampleSpacing = GradingSampleSpacing<D> * delta;
  parameters.Salience =
    std::max({ grid.Spacing(0), grid.Spacing(1), grid.Spacing(2), parameters.SampleSpacing });
  return parameters;
}

template <int D>
OwnedBaseDistance<D> Grade(const RunEnvironment<D>& run, const GradingParameters& parameters)
{
  const Stopwatch time;
  auto grading = std::make_shared<const LocalFeatureSize<D>>(run.Prepared.OfDomain(),
    *run.Prepared.Surfaces, parameters, run.Options.Team.Threads, run.Stop);
  run.Statistics.GradingSamples = grading->Sample().size();
  run.Statistics.GradingPoles = grading->NumberOfPoles();
  run.Statistics.Times.Grading += time.Seconds();
  return { { grading->Largest(), &grading->Delta(), grading->Equivalent(), parameters.Finest },
    grading };
}

} // namespace

//------------------------------------------------------------------------------------------------
OwnedBaseDistance<3> Dimension<3>::GradeBase(const RunEnvironment<3>& run, double delta)
{
  if (run.Options.Sampling.Grading.Mode != GradingMode::LocalFeatureSize)
  {
    return { BaseDistance<3>{ delta }, nullptr };
  }
  GradingParameters parameters = ParametersOf(run, delta);
  parameters.Tolerance =
    GradingTolerance * GradedInterfaceCheck::LargestDistance(run.Prepared.Image.Grid(), delta);
  return Grade(run, parameters);
}

// No interface is sampled more coarsely than slabs are thick: most points would be moved onto their ends.
OwnedBaseDistance<4> Dimension<4>::GradeBase(const RunEnvironment<4>& run, double delta)
{
  if (run.Options.Sampling.Grading.Mode != GradingMode::LocalFeatureSize)
  {
    return { BaseDistance<4>{ delta }, nullptr };
  }
  GradingParameters parameters = ParametersOf(run, delta);
  parameters.Coarsest = ShortestSlab(run);
  parameters.Tolerance = SpaceTimeTolerance * delta;
  return Grade(run, parameters);
}

//------------------------------------------------------------------------------------------------
std::vector<FeatureSeed<3>> Dimension<3>::SampleJunctions(
  const RunEnvironment<3>& run, const SizingField<3>& sizing)
{
  if (!run.Prepared.Junctions)
  {
    return {};
  }
  const Stopwatch time;
  std::vector<FeatureSeed<3>> seeds = voxplex::SampleJunctions(
    *run.Prepared.Junctions,
    [&](const Point<3>& z, const std::array<LabelId, 3>& labels)
    {
      return std::min({ sizing.SamplingDistance(z, labels[0], labels[1]),
        sizing.SamplingDistance(z, labels[1], labels[2]),
        sizing.SamplingDistance(z, labels[0], labels[2]) });
    },
    sizing.Largest());
  run.Statistics.Interfaces.JunctionSeeds = seeds.size();
  run.Statistics.Times.Interfaces += time.Seconds();
  return seeds;
}

//------------------------------------------------------------------------------------------------
Dimension<3>::Checks::Checks(
  const RunEnvironment<3>& run, const RefinementStage<3>& stage, LocalDelta<3>& local)
  : Run(run)
  , Source(stage.Mesh())
  , Interfaces({ stage.Mesh(), run.Prepared.Image, *run.Prepared.Sites, *run.Prepared.Surfaces,
                 stage.Sizing(),
                 ShapeBounds::With(run.Options.Shape.RadiusEdgeRatio, run.Options.Shape.FacetAngle),
                 run.Options.Team.Threads },
      run.Options.Interfaces, local, run.Statistics.Interfaces, run.Statistics.Times.Interfaces,
      run.Stop)
{
  if (run.Prepared.AllComponents)
  {
    const Stopwatch time;
    this->Components.emplace(run.Prepared.Image, *run.Prepared.Surfaces,
      *run.Prepared.AllComponents, stage.Sizing(), run.Options.Components.Smallest,
      run.Options.Components.Exact, true, local, run.Statistics.Components,
      run.Statistics.Times.Components, run.Options.Team.Threads, run.Stop);
    run.Statistics.Times.Components += time.Seconds();
    this->Fragments.emplace(FragmentCheck::Subject{ run.Prepared.Image, *run.Prepared.Sites,
                              *run.Prepared.Surfaces, stage.Sizing(), *run.Prepared.AllComponents },
      run.Options.Components, run.Options.Interfaces.Rounds > 0, local, run.Statistics.Components,
      run.Statistics.Times.Components, run.Stop);
  }
}

std::vector<FeatureSeed<3>> Dimension<3>::Checks::TakeSeeds()
{
  return this->Components ? this->Components->TakeSeeds() : std::vector<FeatureSeed<3>>();
}

std::vector<ConformityCheck<3>*> Dimension<3>::Checks::All()
{
  std::vector<ConformityCheck<3>*> all;
  if (this->Components)
  {
    all.push_back(&*this->Components);
  }
  all.push_back(&this->Interfaces);
  if (this->Fragments)
  {
    all.push_back(&*this->Fragments);
  }
  return all;
}

//------------------------------------------------------------------------------------------------
void Dimension<3>::Checks::Extract(SimplexMesh<3>& mesh) const
{
  const Domain<3>& surfaces = *this->Run.Prepared.Surfaces;
  const unsigned threads = this->Run.Options.Team.Threads;
  const Subdivision<3>& parts = this->Interfaces.Parts();
  ExtractMesh<3>(this->Source, surfaces, this->Interfaces.Labels(), mesh, threads, this->Run.Stop,
    {}, nullptr, parts.Pieces.size());
  Subdivide(this->Source, surfaces, parts, mesh, threads, this->Run.Stop);
}

//------------------------------------------------------------------------------------------------
namespace
{

/**
 * Tells whether a pentatope has a facet on a time plane or on an end of a periodic mesh. Such
 * pentatopes keep their labels, so that both sides of the plane have the same ones. Empty if there
 * are no planes.
 */
std::function<bool(SimplexId)> TellKept(const Triangulation<4>& mesh, const TimePlanes& planes)
{
  if (!planes.Exist())
  {
    return {};
  }
  return [&mesh, &planes](SimplexId s)
  {
    return FacetOnPlane(
      mesh, s, [&planes](double time) { return planes.AreAt(time) || planes.IsPeriodicEnd(time); })
      .has_value();
  };
}

} // namespace

//------------------------------------------------------------------------------------------------
std::unique_ptr<RefinementStage<4>> Dimension<4>::MakeStage(
  const RunEnvironment<4>& run, const RefinementPlan<4>& plan)
{
  if (run.Prepared.Planes.Exist())
  {
    return std::make_unique<SlabRefinement>(run, plan);
  }
  return std::make_unique<WholeRefinement<4>>(run, plan);
}

//------------------------------------------------------------------------------------------------
Dimension<4>::Checks::Checks(
  const RunEnvironment<4>& run, const RefinementStage<4>& stage, LocalDelta<4>& local)
  : Run(run)
  , Stage(stage)
  , Source(stage.Mesh())
  , Sizing(stage.Sizing())
  , MayRefine(MayBeRefined(run))
  , Interfaces(stage.Mesh(), run.Prepared.OfDomain(), *run.Prepared.Sites, *run.Prepared.Surfaces,
      stage.Sizing(), run.Options.Interfaces, MayRefine,
      TellKept(stage.Mesh(), run.Prepared.Planes), local, run.Statistics.Interfaces,
      run.Statistics.Times.Interfaces, run.Options.Team.Threads, run.Stop)
{
  const auto start = [&](const std::optional<voxplex::Components<4>>& all,
                       ComponentStatistics& statistics, std::optional<ComponentCheck<4>>& check)
  {
    if (all)
    {
      const Stopwatch time;
      check.emplace(run.Prepared.Image, *run.Prepared.Surfaces, *all, stage.Sizing(),
        run.Options.Components.Smallest, run.Options.Components.Exact, MayRefine, local, statistics,
        run.Statistics.Times.Components, run.Options.Team.Threads, run.Stop);
      run.Statistics.Times.Components += time.Seconds();
    }
  };
  start(run.Prepared.AllComponents, run.Statistics.Components, this->Components);
  start(run.Prepared.OfFrames, run.Statistics.FrameComponents, this->OfFrames);
}

std::vector<FeatureSeed<4>> Dimension<4>::Checks::TakeSeeds()
{
  std::vector<FeatureSeed<4>> seeds;
  for (std::optional<ComponentCheck<4>>* check : { &this->Components, &this->OfFrames })
  {
    if (*check)
    {
      const std::vector<FeatureSeed<4>> more = (*check)->TakeSeeds();
      seeds.insert(seeds.end(), more.begin(), more.end());
    }
  }
  return seeds;
}

std::vector<ConformityCheck<4>*> Dimension<4>::Checks::All()
{
  std::vector<ConformityCheck<4>*> all;
  if (this->Components)
  {
    all.push_back(&*this->Components);
  }
  if (this->OfFrames)
  {
    all.push_back(&*this->OfFrames);
  }
  all.push_back(&this->Interfaces);
  return all;
}

void Dimension<4>::Checks::Extract(SimplexMesh<4>& mesh) const
{
  const MeshingOptions<4>& options = this->Run.Options;
  const Domain<4>& surfaces = *this->Run.Prepared.Surfaces;
  const unsigned threads = options.Team.Threads;
  const ManifoldLabels<4>& made = this->Interfaces.Labels();
  const SizingField<4>* const sizing = this->Run.Prepared.Size ? &this->Sizing : nullptr;
  FittedPositions fitted;
  if (options.Interfaces.Fit)
  {
    const FitBounds bounds{ options.SpaceTime.Slivers.VolumeBound, options.Shape.RadiusEdgeRatio,
      sizing, this->Run.Prepared.OfDomain(), this->Run.Prepared.Planes, this->Stage.Twins() };
    fitted = FitInterfaces(this->Source, surfaces, made.Labels, bounds, threads, this->Run.Stop);
  }
  UninitialisedVector<std::uint32_t> numbers;
  ExtractMesh<4>(
    this->Source, surfaces, made.Labels, mesh, threads, this->Run.Stop, fitted.Positions, &numbers);

  const SpindleResult<4> spindles =
    MakeSpindles<4>(this->Source, surfaces, made.Labels, made.NonManifold, this->Run.Stop,
      { fitted.Positions, sizing, TellKept(this->Source, this->Run.Prepared.Planes) });
  this->Run.Statistics.Interfaces.CountOpened(made.NonManifold.size(), spindles.Left.size());
  Subdivide<4>(this->Source, surfaces, spindles.Parts, mesh, threads, this->Run.Stop,
    { fitted.Positions, &numbers });
  this->TellTwins(mesh, numbers);
  if (options.Optimisation.Run)
  {
    this->Optimise(mesh,
      SurroundingsOf(
        this->Source, made.Labels, spindles.Parts, fitted.Positions, numbers, mesh.Points.size()));
  }
  this->TellSlabs(mesh);
}

void Dimension<4>::Checks::TellSlabs(SimplexMesh<4>& mesh) const
{
  const TimePlanes& planes = this->Run.Prepared.Planes;
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

void Dimension<4>::Checks::TellTwins(
  SimplexMesh<4>& mesh, std::span<const std::uint32_t> numbers) const
{
  for (const auto& [first, last] : this->Stage.Twins())
  {
    if (numbers[first] != None && numbers[last] != None)
    {
      mesh.Twins.push_back({ numbers[first], numbers[last] });
    }
  }
  std::sort(mesh.Twins.begin(), mesh.Twins.end());
  this->Run.Statistics.Planes.Pairs = mesh.Twins.size();
}

void Dimension<4>::Checks::Optimise(SimplexMesh<4>& mesh, const Surroundings& outside) const
{
  const Stopwatch time;
  const MeshingOptions<4>& options = this->Run.Options;
  const LabelImage<4>& image = this->Run.Prepared.OfDomain();
  PentatopeBounds bounds;
  bounds.Target = OptimisedNormalizedVolume;
  bounds.RadiusEdgeRatio = options.Shape.RadiusEdgeRatio;
  bounds.InterfaceTolerance = ToleranceIn4D * this->Run.Prepared.Image.Grid().SmallestSpacing();
  bounds.Sizing = this->Run.Prepared.Size ? &this->Sizing : nullptr;
  bounds.Planes = this->Run.Prepared.Planes;
  const PentatopeStatistics done = OptimisePentatopes(mesh, outside, *this->Run.Prepared.Surfaces,
    image, bounds, options.Team.Threads, this->Run.Stop);
  MeshingStatistics& statistics = this->Run.Statistics;
  statistics.Times.Optimisation += time.Seconds();
  OptimisationSummary& summary = statistics.Optimisation;
  summary.Ran = true;
  summary.SmallestVolumeBefore = done.SmallestBefore;
  summary.SmallestVolumeAfter = done.SmallestAfter;
  summary.PoorBefore = done.PoorBefore;
  summary.PoorAfter = done.PoorAfter;
}

//------------------------------------------------------------------------------------------------
void Dimension<3>::Optimise(const RunEnvironment<3>& run, SimplexMesh<3>& mesh)
{
  const MeshingOptions<3>& asked = run.Options;
  if (!asked.Optimisation.Run || run.Stop.stop_requested())
  {
    return;
  }
  const LabelImage<3>& image = run.Prepared.Image;
  OptimisationOptions options;
  options.Shape = ShapeBounds::With(
    std::max(OptimisedRadiusEdgeRatio, asked.Shape.RadiusEdgeRatio), asked.Shape.FacetAngle);
  options.Seconds = asked.Optimisation.Seconds;
  options.InterfaceTolerance = std::min(ToleranceIn3D * std::cbrt(image.Grid().VoxelVolume()),
    LargestToleranceIn3D * image.Grid().SmallestSpacing());
  if (run.Prepared.AllComponents)
  {
    const Components<3>& components = *run.Prepared.AllComponents;
    options.ShouldHaveStayed = [&, wanted = components.FindWanted(asked.Components.Smallest)](
                                 const SimplexMesh<3>& result)
    {
      return FindWitnessesOf(
        FindLostComponents(components, image, result, wanted, asked.Team.Threads, run.Stop),
        components, image, mesh);
    };
  }
  const OptimisationStatistics done =
    OptimiseMesh(mesh, *run.Prepared.Surfaces, options, asked.Team.Threads, run.Stop);
  MeshingStatistics& statistics = run.Statistics;
  statistics.Times.Optimisation += done.Seconds;
  OptimisationSummary& summary = statistics.Optimisation;
  summary.Ran = true;
  summary.OutOfTime = done.OutOfTime;
  summary.SmallestDihedralBefore = done.Before.SmallestDihedralAngle;
  summary.LargestDihedralBefore = done.Before.LargestDihedralAngle;
  summary.SmallestDihedralAfter = done.After.SmallestDihedralAngle;
  summary.LargestDihedralAfter = done.After.LargestDihedralAngle;
  summary.PoorBefore = done.Before.Poor;
  summary.PoorAfter = done.After.Poor;
}

} // namespace voxplex
