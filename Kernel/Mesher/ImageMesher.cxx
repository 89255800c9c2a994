// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/ImageMesher.h"

#include "Mesher/MeshingPipeline.h"
#include "Parallel/ThreadTeam.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace voxplex
{

//------------------------------------------------------------------------------------------------
template <int D>
MeshingOutcome ImageMesher<D>::Run(LabelImage<D> image, SimplexMesh<D>& mesh)
{
  return this->Run(image, nullptr, mesh);
}

template <int D>
MeshingOutcome ImageMesher<D>::Run(IsosurfaceImage<D> image, SimplexMesh<D>& mesh)
{
  return this->Run(image.Labels(), &image, mesh);
}

template <int D>
MeshingOutcome ImageMesher<D>::Run(
  LabelImage<D>& image, const IsosurfaceImage<D>* isosurface, SimplexMesh<D>& mesh)
{
  mesh = SimplexMesh<D>();
  this->Stats = MeshingStatistics();
  CheckOptions(this->Options);
  this->Stats.Dimension = D;
  this->Stats.NumberOfThreads = this->Options.Team.Threads;
  this->Stats.Delta = this->Options.Sampling.Delta > 0.0
    ? this->Options.Sampling.Delta
    : DefaultDelta<D>(image.Grid().VoxelVolume());
  this->Stats.ElementsAskedFor = this->Options.Sampling.Elements;
  this->Stats.SmoothingSigma =
    isosurface ? isosurface->Surface().SmoothingSigma : this->Options.SmoothingSigma;
  if (isosurface)
  {
    this->Stats.Isosurface = MeshedIsosurface{ isosurface->Surface(), isosurface->Range() };
  }
  this->Stats.Contention = this->Options.Team.Contention;
  this->Stats.Balance = this->Options.Team.Balance;

  RunProgress progress;
  std::stop_source stop;
  const auto run = [&]
  {
    const ThreadTeam team(this->Options.Team.Threads); // for the loops of the stages
    if (!RunPipeline(
          image, isosurface, this->Options, this->Stats, progress, stop.get_token(), mesh))
    {
      return false;
    }
    this->Measure(image, mesh);
    return true;
  };
  const bool done = this->Progress ? this->RunReporting(run, progress, stop) : run();
  if (!done)
  {
    mesh = SimplexMesh<D>();
    return MeshingOutcome::Cancelled;
  }
  return MeshingOutcome::Done;
}

//------------------------------------------------------------------------------------------------
template <int D>
void ImageMesher<D>::Measure(const LabelImage<D>& image, const SimplexMesh<D>& mesh)
{
  const ShapeOptions& shape = this->Options.Shape;
  const unsigned threads = this->Options.Team.Threads;
  this->Stats.Elements = mesh.Simplices.size();
  this->Stats.Vertices = mesh.Points.size();
  this->Stats.InterfaceFacets = mesh.Facets.size();
  this->Stats.LostLabels = FindLostLabels(mesh, image);
  if constexpr (D == 3)
  {
    VolumeShares shares = FindShrunkLabels(
      mesh, image, this->Stats.Isosurface ? ShrunkFractionOfIsosurface : ShrunkFraction, threads);
    this->Stats.ShrunkLabels = std::move(shares.Shrunk);
    this->Stats.VolumeShare = this->Stats.Isosurface ? 1.0 : shares.All;
  }
  else if (!this->Stats.Isosurface)
  {
    this->Stats.FramesOff = CompareFrames(mesh, image);
  }
  if (this->Options.MeasureQuality)
  {
    const double ratio = D == 3 && this->Options.Optimisation.Run
      ? std::max(OptimisedRadiusEdgeRatio, shape.RadiusEdgeRatio)
      : shape.RadiusEdgeRatio;
    this->Stats.Quality = MeasureQuality(mesh, ratio, shape.FacetAngle, threads);
    this->Stats.HasQuality = true;
  }
}

//------------------------------------------------------------------------------------------------
// The stages run on a separate thread, so that the caller's thread can report progress at a steady
// pace.
template <int D>
bool ImageMesher<D>::RunReporting(
  const std::function<bool()>& run, const RunProgress& progress, std::stop_source& stop)
{
  bool done = false;
  std::exception_ptr error;
  bool finished = false;
  std::mutex mutex; // guards `finished`
  std::condition_variable changed;
  std::jthread worker(
    [&]
    {
      try
      {
        done = run();
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
      reported = std::max(reported, progress.Fraction());
      if (!stop.stop_requested() && !this->Progress(reported))
      {
        stop.request_stop();
      }
      std::unique_lock lock(mutex);
      over = changed.wait_for(lock, Period, [&] { return finished; });
    }
  }
  catch (...) // from the callback; the worker is joined when the scope is left
  {
    stop.request_stop();
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

} // namespace voxplex
