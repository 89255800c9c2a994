// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/Preparation.h"

#include "Base/Error.h"
#include "Base/NumberText.h"
#include "Base/Stopwatch.h"
#include "Domain/ImageDomain.h"
#include "Image/DropComponents.h"
#include "Image/GreyValues.h"
#include "Image/Series/FrameInterpolation.h"
#include "Parallel/ParallelFor.h"
#include "Sizing/GradedSize.h"

#include <algorithm>
#include <utility>

namespace voxplex
{

namespace
{

/** A time plane that is nearer to an end than this part of the duration is at the end. */
constexpr double EndTolerance = 1e-9;

/** Finds junctions. Only in three dimensions do interfaces meet in curves. */
template <typename Field>
void FindJunctions(const ImageDomain<3, Field>& domain, const MeshingOptions<3>& options,
  std::optional<JunctionCurves>& junctions, MeshingStatistics& statistics,
  const std::stop_token& stop)
{
  if (!options.Interfaces.SampleJunctions)
  {
    return;
  }
  const Stopwatch time;
  junctions.emplace(
    domain.GetImage(), domain.GetLabelField(), domain.GetSites(), options.Team.Threads, stop);
  statistics.Interfaces.JunctionCurves = junctions->Curves().size();
  statistics.Interfaces.Corners = junctions->NumberOfCorners();
  statistics.Times.Interfaces += time.Seconds();
}

template <typename Field>
void FindJunctions(const ImageDomain<4, Field>&, const MeshingOptions<4>&,
  std::optional<JunctionCurves>&, MeshingStatistics&, const std::stop_token&)
{
}

/**
 * The planes that the options ask for, without those at the ends of the object. A periodic mesh without
 * planes gets one half-way.
 * @throws InputError if a plane is outside of the image's duration, or the time axis is oblique
 */
TimePlanes FindPlanes(
  const MeshingOptions<4>& options, const LabelImage<4>& image, const Domain<4>& domain)
{
  TimePlanes planes;
  if (!options.Planes.AreWanted())
  {
    return planes;
  }
  const auto& m = image.Grid().IndexToFrame;
  if (m[0][3] != 0.0 || m[1][3] != 0.0 || m[2][3] != 0.0)
  {
    throw InputError("time planes need a time axis at right angles to space");
  }
  const double duration = static_cast<double>(image.Grid().Dimensions[3] - 1) * m[3][3];
  const Box<4> bounds = domain.Bounds();
  for (const double time : options.Planes.Times)
  {
    if (!(time >= 0.0 && time <= duration))
    {
      throw InputError("a time plane at " + NumberText(time) +
        " is not between the first frame, at 0, and the last one, at " + NumberText(duration));
    }
    const double rounding = EndTolerance * duration;
    if (time > bounds.Min[3] + rounding && time < bounds.Max[3] - rounding)
    {
      planes.Times.push_back(time);
    }
  }
  std::sort(planes.Times.begin(), planes.Times.end());
  planes.Times.erase(std::unique(planes.Times.begin(), planes.Times.end()), planes.Times.end());
  planes.Periodic = options.Planes.Periodic && domain.HasTimeBorder(0) && domain.HasTimeBorder(1);
  if (planes.Periodic && planes.Times.empty())
  {
    planes.Times.push_back(0.5 * (bounds.Min[3] + bounds.Max[3])); // SlabRefinement needs two slabs
  }
  planes.First = bounds.Min[3];
  planes.Last = bounds.Max[3];
  return planes;
}

TimePlanes FindPlanes(const MeshingOptions<3>&, const LabelImage<3>&, const Domain<3>&)
{
  return {};
}

/** Adds frames where labels move far between two frames. Makes the image periodic if it is to be. */
void AddFrames(const MeshingOptions<4>& options, PreparedImage<4>& prepared,
  MeshingStatistics& statistics, const std::stop_token& stop)
{
  const unsigned threads = options.Team.Threads;
  statistics.FrameSteps =
    options.FrameSteps > 0 ? options.FrameSteps : FrameStepsFor(prepared.Image, threads, stop);
  if (statistics.FrameSteps > 1)
  {
    prepared.WithSteps = std::make_unique<const LabelImage<4>>(
      InterpolateFrames(prepared.Image, statistics.FrameSteps, threads, stop));
  }
  if (options.Planes.Periodic)
  {
    auto image = std::make_unique<LabelImage<4>>(prepared.OfDomain());
    image->MakePeriodicInTime();
    prepared.WithSteps = std::move(image);
  }
}

void AddFrames(
  const MeshingOptions<3>&, PreparedImage<3>&, MeshingStatistics&, const std::stop_token&)
{
}

/**
 * That an isosurface's image was made to be periodic, and is so still if components were removed from it.
 * @throws InputError
 */
template <int D>
void CheckPeriodicLabels(const LabelImage<D>& image, const IsosurfaceImage<D>& isosurface)
{
  if (!isosurface.Surface().PeriodicInTime)
  {
    throw InputError(
      "a periodic mesh of an isosurface needs an image that was made to be periodic");
  }
  LabelImage<D>(image).MakePeriodicInTime();
}

/** Small components go. @return how long it took */
template <int D>
double RemoveNoise(LabelImage<D>& image, const MeshingOptions<D>& options,
  MeshingStatistics& statistics, const std::stop_token& stop)
{
  const Stopwatch time;
  statistics.DroppedComponents =
    DropComponents(image, options.SmallestVolume, options.Team.Threads, stop);
  return time.Seconds();
}

/** Stores a domain, and computes everything that depends on the type of its field. */
template <int D, typename Field>
void TakeDomain(std::unique_ptr<const ImageDomain<D, Field>> domain,
  const MeshingOptions<D>& options, PreparedImage<D>& prepared, MeshingStatistics& statistics,
  const std::stop_token& stop)
{
  statistics.Times.LabelField = domain->LabelFieldSeconds();
  statistics.Times.DistanceTransform = domain->DistanceSeconds();
  statistics.LabelFieldBytes = domain->GetLabelField().MemoryBytes();
  statistics.DistanceBytes =
    domain->GetFeatureTransform().MemoryBytes() + domain->GetSites().MemoryBytes();
  FindJunctions(*domain, options, prepared.Junctions, statistics, stop);
  prepared.Sites = &domain->GetSites();
  prepared.Surfaces = std::move(domain);
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
PreparedImage<D> Prepare(LabelImage<D>& image, const IsosurfaceImage<D>* isosurface,
  const MeshingOptions<D>& options, MeshingStatistics& statistics, const std::stop_token& stop)
{
  if (!isosurface && !options.Limits.Force)
  {
    CheckSegmented(image, options.Team.Threads, stop); // with its noise, which tells grey values
  }
  double seconds = RemoveNoise(image, options, statistics, stop);
  PreparedImage<D> prepared{ image, nullptr, nullptr, nullptr, std::nullopt, std::nullopt,
    std::nullopt, nullptr, {}, {} };
  if (isosurface)
  {
    if (options.Planes.Periodic)
    {
      CheckPeriodicLabels(image, *isosurface);
    }
    TakeDomain<D>(std::make_unique<const ImageDomain<D, ScalarField<D>>>(
                    *isosurface, options.Team.Threads, stop),
      options, prepared, statistics, stop);
  }
  else
  {
    const Stopwatch time;
    AddFrames(options, prepared, statistics, stop);
    seconds += time.Seconds();
    TakeDomain<D>(std::make_unique<const ImageDomain<D>>(
                    prepared.OfDomain(), options.SmoothingSigma, options.Team.Threads, stop),
      options, prepared, statistics, stop);
    for (std::size_t label = 0; D == 3 && label < image.Counts().size(); ++label)
    {
      prepared.Volumes.push_back(
        static_cast<double>(image.Counts()[label]) * image.Grid().VoxelVolume());
    }
  }
  statistics.Times.LabelField += seconds;
  prepared.Planes = FindPlanes(options, image, *prepared.Surfaces);
  if (options.KeepsComponents())
  {
    const Stopwatch time;
    prepared.AllComponents.emplace(image, options.Team.Threads, stop);
    statistics.Components.Found = prepared.AllComponents->All().size();
    if constexpr (D == 4)
    {
      prepared.OfFrames.emplace(image, options.Team.Threads, stop, 3);
      statistics.FrameComponents.Found = prepared.OfFrames->All().size();
    }
    statistics.Times.Components += time.Seconds();
  }
  const Stopwatch time;
  prepared.Size = GradedSize<D>::Limit(
    options.Sampling.Size, image, options.Sampling.Gradation, options.Team.Threads, stop);
  statistics.Times.Grading += prepared.Size ? time.Seconds() : 0.0;
  return prepared;
}

template PreparedImage<3> Prepare<3>(LabelImage<3>&, const IsosurfaceImage<3>*,
  const MeshingOptions<3>&, MeshingStatistics&, const std::stop_token&);
template PreparedImage<4> Prepare<4>(LabelImage<4>&, const IsosurfaceImage<4>*,
  const MeshingOptions<4>&, MeshingStatistics&, const std::stop_token&);

} // namespace voxplex
