// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SpaceTimeRun.h"

#include "../Testing/Kernel/Support/SpaceTimeChecks.h"
#include "ChildProcess.h"
#include "Quality/MeshQuality.h"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace voxplex::benchmarks
{
namespace
{

using Volumes = std::map<std::int64_t, double>;

void Compare(const Volumes& image, const Volumes& mesh, std::size_t label, Compared& result)
{
  const auto value = [&](const Volumes& volumes)
  {
    const auto found = volumes.find(static_cast<std::int64_t>(label) + 1);
    return found == volumes.end() ? 0.0 : found->second;
  };
  result = { value(image), value(mesh) };
}

Fit FitOf(const SimplexMesh<4>& mesh, const LabelImage<4>& image, double sigma)
{
  Fit fit;
  fit.Frames = static_cast<std::size_t>(image.Grid().Dimensions[3]);
  if (fit.Frames > MostFrames)
  {
    throw std::runtime_error("too many frames to compare");
  }
  const double step = image.Grid().IndexToFrame[3][3];
  for (std::size_t frame = 0; frame < fit.Frames; ++frame)
  {
    // Each slice is the limit from later times. After the last frame there is nothing.
    const double time = step * static_cast<double>(frame);
    const double back = frame + 1 == fit.Frames ? 1e-9 * step : 0.0;
    const Volumes inImage = checks::FrameVolumes(image, static_cast<std::int64_t>(frame));
    const Volumes inMesh = checks::SliceVolumes(mesh, time - back);
    for (std::size_t label = 0; label < MostLabels; ++label)
    {
      Compare(inImage, inMesh, label, fit.Volume[label][frame]);
    }
  }
  const Volumes inImage = checks::Hypervolumes(image);
  const Volumes inMesh = checks::Volumes(mesh);
  for (std::size_t label = 0; label < MostLabels; ++label)
  {
    Compare(inImage, inMesh, label, fit.Hypervolume[label]);
  }
  const ImageDomain<4> domain(image, sigma);
  fit.LateralFacets = static_cast<double>(checks::LateralFacets(mesh, domain).size());
  fit.FacetsOffInterface = static_cast<double>(checks::CountFacetsOffInterface(mesh, domain));
  return fit;
}

void TakeStatistics(const MeshingStatistics& statistics, SpaceTimeRecord& record)
{
  record.PreparationSeconds = statistics.Times.LabelField + statistics.Times.DistanceTransform;
  record.GradingSeconds = statistics.Times.Grading;
  record.GradingSamples = static_cast<double>(statistics.GradingSamples);
  record.RefinementSeconds = statistics.Times.Refinement;
  record.ExtractionSeconds = statistics.Times.Extraction;
  record.TotalSeconds = statistics.Times.Total();
  record.FrameSteps = statistics.FrameSteps;
  record.LostComponents =
    static_cast<double>(statistics.Components.Lost.size() + statistics.FrameComponents.Lost.size());
  const RuleStatistics& rules = statistics.Rules;
  record.AverageCavity = static_cast<double>(rules.CavitySimplices) /
    std::max(1.0, static_cast<double>(rules.Insertions()));
  record.LargestCavity = static_cast<double>(rules.LargestCavity);
  record.SliversKept = static_cast<double>(rules.SliversKept);
  const double share = 1.0 / std::max(1.0, static_cast<double>(statistics.Threads.size()));
  for (const ThreadStatistics& thread : statistics.Threads)
  {
    record.ContentionSeconds += share * thread.ContentionSeconds;
    record.LoadBalanceSeconds += share * thread.LoadBalanceSeconds;
    record.RollbackSeconds += share * thread.RollbackSeconds;
    record.Rollbacks += share * static_cast<double>(thread.Rollbacks);
  }
}

} // namespace

SpaceTimeRecord MeshPhantom(const std::vector<std::uint8_t>& scalars, const GridGeometry<4>& grid,
  const MeshingOptions<4>& options, bool fit)
{
  const auto image =
    LabelImage<4>::FromScalars<std::uint8_t>(scalars, grid, {}, options.Team.Threads);
  ImageMesher<4> mesher(options);
  SimplexMesh<4> mesh;
  mesher.Run(image, mesh);

  SpaceTimeRecord record;
  record.PeakBytes = PeakResidentBytes();
  record.Pentatopes = static_cast<double>(mesh.Simplices.size());
  record.BoundaryTetrahedra = static_cast<double>(mesh.Facets.size());
  record.Vertices = static_cast<double>(mesh.Points.size());
  TakeStatistics(mesher.Statistics(), record);
  const MeshQuality quality = MeasureQuality<4>(mesh, options.Shape.RadiusEdgeRatio, 0.0, 1);
  record.ShortestEdge = quality.ShortestEdge;
  record.RadiusEdgeMax = quality.MaximumRadiusEdgeRatio;
  record.RadiusEdgeMean = quality.MeanRadiusEdgeRatio;
  record.RadiusEdgeDeviation = quality.RadiusEdgeRatioDeviation;
  record.VolumeMin = quality.MinimumNormalizedVolume;
  record.VolumeMean = quality.MeanNormalizedVolume;
  record.VolumeDeviation = quality.NormalizedVolumeDeviation;
  record.Inverted = static_cast<double>(quality.InvertedSimplices);
  if (fit)
  {
    record.Image = FitOf(mesh, image, options.SmoothingSigma);
  }
  return record;
}

} // namespace voxplex::benchmarks
