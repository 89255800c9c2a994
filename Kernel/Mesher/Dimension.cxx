// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/Dimension.h"

#include "Base/Stopwatch.h"
#include "Conformity/DistanceCheck.h"
#include "Junctions/JunctionSeeds.h"
#include "Mesher/SlabRefinement.h"
#include "Sizing/Grading/LocalFeatureSize.h"

#include <algorithm>
#include <array>
#include <cmath>
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

/** What grading has in common in space and space-time. */
template <int D>
GradingParameters MakeGradingParameters(const RunEnvironment<D>& run, double delta)
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
  GradingParameters parameters = MakeGradingParameters(run, delta);
  parameters.Tolerance =
    GradingTolerance * DistanceCheck<3>::LargestDistanceToFacets(run.Prepared.Image.Grid(), delta);
  return Grade(run, parameters);
}

// No interface is sampled more coarsely than slabs are thick: most points would be moved onto their ends.
OwnedBaseDistance<4> Dimension<4>::GradeBase(const RunEnvironment<4>& run, double delta)
{
  if (run.Options.Sampling.Grading.Mode != GradingMode::LocalFeatureSize)
  {
    return { BaseDistance<4>{ delta }, nullptr };
  }
  GradingParameters parameters = MakeGradingParameters(run, delta);
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
std::unique_ptr<RefinementStage<4>> Dimension<4>::MakeStage(
  const RunEnvironment<4>& run, const RefinementPlan<4>& plan)
{
  if (run.Prepared.Planes.Exist())
  {
    return std::make_unique<SlabRefinement>(run, plan);
  }
  return std::make_unique<WholeRefinement<4>>(run, plan);
}

bool Dimension<4>::MayRefine(const RunEnvironment<4>& run)
{
  const double spacing = std::pow(run.Prepared.Image.Grid().VoxelVolume(), 0.25);
  return ShortestSlab(run) >= ShortestDuration * std::min(spacing, run.Statistics.Delta);
}

} // namespace voxplex
