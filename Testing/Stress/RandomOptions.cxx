// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Draws all meshing options at random. The order of the draws defines the meaning of a seed.
#include "StressCase.h"

#include <algorithm>
#include <set>
#include <utility>

namespace voxplex::stress
{

namespace
{

/** Larger meshes would make a run slow: delta is raised. */
constexpr double ElementsOfMostCases = 12000.0;
constexpr double ElementsOfFewCases = 150000.0;
constexpr double ElementsInSpaceTime = 4000.0;

/** Memory limit of a case in bytes; no case needs as much. */
constexpr std::uint64_t MemoryOfCase = std::uint64_t{ 4 } << 30;

template <int D>
void DrawDelta(StressCase<D>& of, Random& random)
{
  const double voxel = std::pow(of.Image.VoxelVolume(), 1.0 / D);
  MeshingOptions<D>& options = of.Options;
  options.Sampling.Delta =
    voxel * (random.Chance(0.1) ? random.LogUniform(5.0, 40.0) : random.LogUniform(0.5, 6.0));
  const double most = D == 4 ? ElementsInSpaceTime
    : random.Chance(0.98)    ? ElementsOfMostCases
                             : ElementsOfFewCases;
  while (of.ExpectedElements() > most && options.Sampling.Delta < 4.0 * voxel)
  {
    options.Sampling.Delta *= 1.2;
  }
  if (random.Chance(0.06) && of.ExpectedElements() < most)
  {
    options.Sampling.Delta = 0.0; // derived from the spacing
  }
}

template <int D>
void DrawSmoothing(MeshingOptions<D>& options, Random& random)
{
  options.SmoothingSigma = random.Chance(0.6) ? 1.0
    : random.Chance(0.4)                      ? 0.0
                                              : random.Uniform(0.2, 3.0);
}

template <int D>
void DrawRatio(MeshingOptions<D>& options, Random& random)
{
  options.Shape.RadiusEdgeRatio = random.Chance(0.6) ? 2.0
    : random.Chance(0.5)                             ? random.Uniform(1.94, 2.3)
                                                     : random.Uniform(2.0, 6.0);
  if (random.Chance(0.005)) // termination is not proved there
  {
    options.Shape.RadiusEdgeRatio = random.Uniform(1.6, 1.93);
    options.Limits.Force = true;
  }
}

template <int D>
void DrawThreads(MeshingOptions<D>& options, Random& random)
{
  options.Team.Threads = static_cast<unsigned>(random.Chance(0.6) ? 1
      : random.Chance(0.85)                                       ? random.Integer(2, 4)
                                                                  : random.Integer(5, 16));
  options.Team.Contention = random.Chance(0.6)
    ? ContentionPolicy::Local
    : static_cast<ContentionPolicy>(random.Integer(0, 3));
  options.Team.Balance = random.OneOf({ BalancePolicy::Random, BalancePolicy::Hierarchical });
  options.Team.Pin = random.Chance(0.02);
  options.Team.Synchronise = random.Chance(0.1);
  random.Chance(0.2); // of an option that is gone: the numbers of cases keep their meaning
  options.Team.FineGrained = random.Chance(0.3);
  options.Team.SeedsPerThread =
    static_cast<unsigned>(random.Chance(0.7) ? 128 : random.OneOf({ 0, 1, 10, 1000 }));
}

template <int D>
void DrawSizes(StressCase<D>& of, Random& random)
{
  const double delta = of.Delta();
  of.Options.Sampling.Gradation = random.Chance(0.6) ? DefaultGradation
    : random.Chance(0.3)                             ? 0.0
                                                     : random.LogUniform(0.05, 2.0);
  if (!random.Chance(0.2))
  {
    return;
  }
  const std::vector<std::int32_t> labels = of.Image.LabelValues();
  const double least = D == 3 ? 0.5 : 1.0; // elements grow with the power D below delta
  if (random.Chance(0.6))
  {
    of.Size.Everywhere = delta * random.LogUniform(least, 5.0);
  }
  if (random.Chance(0.5) && !labels.empty())
  {
    of.Size.Label =
      labels[static_cast<std::size_t>(random.Integer(0, std::int64_t(labels.size()) - 1))];
    of.Size.OfLabel = delta * random.LogUniform(least, 5.0);
  }
  if (random.Chance(0.3))
  {
    of.Size.Slope = random.Uniform(0.0, 1.0);
  }
}

template <int D>
void DrawInterfaceSizes(StressCase<D>& of, Random& random)
{
  const std::vector<std::int32_t> labels = of.Image.LabelValues();
  if (!random.Chance(0.15) || labels.empty())
  {
    return;
  }
  const double delta = of.Delta();
  const auto any = [&]
  { return labels[static_cast<std::size_t>(random.Integer(0, std::int64_t(labels.size()) - 1))]; };
  std::set<std::pair<std::int64_t, std::int64_t>> given;
  const std::int64_t count = random.Integer(1, 3);
  for (std::int64_t k = 0; k < count; ++k)
  {
    InterfaceSize size;
    size.Label = any();
    size.Other = random.Chance(0.4) ? InterfaceSize::AnyLabel : random.Chance(0.5) ? 0 : any();
    size.Size = delta * random.LogUniform(0.5, 5.0);
    if (size.Label != size.Other && given.insert(std::minmax({ size.Label, size.Other })).second)
    {
      of.Options.Sampling.InterfaceSizes.push_back(size);
    }
  }
}

void DrawGrading(GradingOptions& grading, Random& random)
{
  if (random.Chance(0.25))
  {
    grading.Mode = GradingMode::LocalFeatureSize;
    grading.Ratio = random.Chance(0.3) ? 1.0 : random.LogUniform(0.1, 4.0);
    grading.Lambda = random.Chance(0.5) ? 12.0 : random.LogUniform(1.0, 50.0);
  }
}

void DrawSpaceOptions(StressCase<3>& of, Random& random)
{
  MeshingOptions<3>& options = of.Options;
  options.Shape.FacetAngle = random.Chance(0.7) ? 30.0
    : random.Chance(0.3)                        ? 0.0
                                                : random.Uniform(0.0, 30.0);
  options.Shape.Slivers.Angle = random.Chance(0.6) ? 9.0
    : random.Chance(0.3)                           ? 0.0
                                                   : random.Uniform(0.0, 15.0);
  if (random.Chance(0.1))
  {
    options.Shape.Slivers.PickingRadius = random.Uniform(0.05, 0.95);
    options.Shape.Slivers.Picks = static_cast<unsigned>(random.Integer(1, 40));
  }
  options.Shape.Slivers.Seed = random.Chance(0.5) ? 0 : random.Next() >> 33;
  options.Components.Smallest = random.Chance(0.6) ? 8
    : random.Chance(0.5)                           ? random.Integer(0, 1)
                                                   : random.Integer(2, 60);
  options.Interfaces.SampleJunctions = random.Chance(0.8);
  options.Interfaces.Rounds = random.Chance(0.7) ? 5 : static_cast<unsigned>(random.Integer(0, 10));
  options.Optimisation.Run = random.Chance(0.5);
  options.Optimisation.Seconds = random.Chance(0.02) ? random.LogUniform(0.001, 1.0) : 0.0;
  DrawGrading(options.Sampling.Grading, random);
  if (random.Chance(0.02))
  {
    options.Sampling.Elements = static_cast<std::uint64_t>(random.LogUniform(0.3, 10.0) *
                                  std::min(of.ExpectedElements(), 3000.0)) +
      1;
    options.Sampling.Delta = 0.0;
  }
  options.Components.Exact = random.Chance(0.2);
}

void DrawSpaceTimeOptions(StressCase<4>& of, Random& random)
{
  MeshingOptions<4>& options = of.Options;
  options.SpaceTime.Order = random.OneOf({ RuleOrder::RadiusEdgeFirst, RuleOrder::SurfaceFirst });
  options.SpaceTime.Slivers.Fight = random.Chance(0.7);
  if (random.Chance(0.3))
  {
    options.SpaceTime.Slivers.PickingRadius = random.Uniform(0.05, 0.95);
    options.SpaceTime.Slivers.RadiusFactor = random.LogUniform(0.5, 8.0);
    options.SpaceTime.Slivers.VolumeBound = random.Uniform(0.0, LargestSliverBound);
    options.SpaceTime.Slivers.Picks = static_cast<unsigned>(random.Integer(1, 30));
  }
  options.SpaceTime.Slivers.Seed = random.Chance(0.5) ? 0 : random.Next() >> 33;
  options.Components.Smallest = random.Chance(0.6) ? 8
    : random.Chance(0.5)                           ? random.Integer(0, 1)
                                                   : random.Integer(2, 60);
  options.Components.Exact = random.Chance(0.2);
  options.Interfaces.Rounds = random.Chance(0.7) ? 5 : static_cast<unsigned>(random.Integer(0, 10));
  options.Interfaces.Fit = random.Chance(0.7);
  options.Optimisation.Run = random.Chance(0.7);
  options.FrameSteps = random.Chance(0.7) ? 0 : static_cast<unsigned>(random.Integer(1, 4));
  DrawGrading(options.Sampling.Grading, random);
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void DrawOptions(StressCase<D>& of, Random& random)
{
  of.Options.Limits.Memory = MemoryOfCase;
  DrawDelta(of, random);
  DrawSmoothing(of.Options, random);
  DrawRatio(of.Options, random);
  DrawThreads(of.Options, random);
  DrawSizes(of, random);
  DrawInterfaceSizes(of, random);
  if constexpr (D == 3)
  {
    DrawSpaceOptions(of, random);
  }
  else
  {
    DrawSpaceTimeOptions(of, random);
  }
  of.Twice =
    random.Chance(0.15) && of.Options.Team.Threads == 1 && of.Options.Optimisation.Seconds == 0.0;
  if constexpr (D == 3)
  {
    of.Options.Interfaces.Manifold = random.Chance(0.9);
    of.Options.Interfaces.Fit = random.Chance(0.7);
  }
  of.Options.Team.Reproducible = random.Chance(0.2);
  if (of.Options.Team.Reproducible)
  {
    of.Twice = random.Chance(0.5) && of.Options.Optimisation.Seconds == 0.0;
  }
}

template void DrawOptions<3>(StressCase<3>&, Random&);
template void DrawOptions<4>(StressCase<4>&, Random&);

} // namespace voxplex::stress
