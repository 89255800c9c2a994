// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/SpaceTimeMeasurement.h"

#include "Geometry/SimplexQuality.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

namespace voxplex
{

namespace
{

constexpr std::size_t Grain = 4096;

/** The volume of a label in a frame of the image. */
double ImageVolume(const FrameMeasurement& frame, std::int64_t label)
{
  if (!frame.Measured.Image)
  {
    return 0.0;
  }
  const auto& labels = frame.Measured.Image->Labels;
  const auto found = std::find_if(labels.begin(), labels.end(),
    [label](const LabelComparison& comparison) { return comparison.Label == label; });
  return found == labels.end() ? 0.0 : found->ImageVolume;
}

} // namespace

//------------------------------------------------------------------------------------------------
SpaceTimeMeasurer::SpaceTimeMeasurer(
  SimplexMesh<4> mesh, double timeScale, const MeasurementOptions& options)
  : Pentatopes(std::move(mesh))
  , TimeScale(timeScale)
  , Options(options)
{
  for (const Point<4>& p : this->Pentatopes.Points)
  {
    this->Positions.insert(this->Positions.end(), p.begin(), p.begin() + 3);
    this->Times.push_back(p[3] / timeScale);
  }
  this->Offsets.push_back(0);
  for (const auto& simplex : this->Pentatopes.Simplices)
  {
    this->Connectivity.insert(this->Connectivity.end(), simplex.begin(), simplex.end());
    this->Offsets.push_back(static_cast<long long>(this->Connectivity.size()));
  }
  this->Slicer.emplace(
    SpaceTimeMesh{ this->Positions, this->Times, this->Offsets, this->Connectivity });
}

void SpaceTimeMeasurer::MeasureElements(std::size_t worst, const std::stop_token& stop)
{
  const SimplexMesh<4>& mesh = this->Pentatopes;
  this->All.Quality = MeasureQuality(
    mesh, this->Options.RadiusEdgeBound, this->Options.FacetAngleBound, this->Options.Threads);
  this->All.Topology = MeasureTopology(mesh, stop);
  const std::size_t n = mesh.Simplices.size();
  this->All.Counts = { n, mesh.Points.size(), this->All.Topology.InterfaceFacets,
    this->All.Topology.FacetsOfThreeElements };
  std::vector<double>& ratios = this->All.RadiusEdgeRatios;
  std::vector<double>& shapes = this->All.NormalizedVolumes;
  ratios.resize(n);
  shapes.resize(n);
  this->All.Hypervolumes.resize(n);
  ParallelFor(
    0, n, Grain, this->Options.Threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t s = first; s < last; ++s)
      {
        const auto v = mesh.PointsOf(s);
        ratios[s] = RadiusEdgeRatio<4>(v.data());
        shapes[s] = NormalizedVolume<4>(v.data());
        this->All.Hypervolumes[s] = SignedVolume<4>(v.data());
      }
    },
    stop);

  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(worst, n));
  std::partial_sort(order.begin(), end, order.end(),
    [&](std::uint32_t a, std::uint32_t b)
    { return std::pair(shapes[a], a) < std::pair(shapes[b], b); });
  for (auto s = order.begin(); s != end; ++s)
  {
    Point<4> centroid{};
    for (const Point<4>* p : mesh.PointsOf(*s))
    {
      for (std::size_t a = 0; a < 4; ++a)
      {
        centroid[a] += 0.2 * (*p)[a];
      }
    }
    centroid[3] /= this->TimeScale;
    this->All.Worst.push_back({ *s, mesh.Labels[*s], shapes[*s], ratios[*s], centroid });
  }
}

//------------------------------------------------------------------------------------------------
void SpaceTimeMeasurer::MeasureCut(
  double time, const LabelImage<3>* image, const ImageFrame& frame, const std::stop_token& stop)
{
  const TimeSlice slice = this->Slicer->Slice(time);
  SimplexMesh<3> cut;
  cut.Points.assign(slice.Points.begin(), slice.Points.end());
  for (std::size_t c = 0; c < slice.Sources.size(); ++c)
  {
    std::copy_n(slice.Connectivity.data() + 4 * c, 4, cut.Simplices.emplace_back().begin());
    cut.Labels.push_back(this->Pentatopes.Labels[static_cast<std::size_t>(slice.Sources[c])]);
  }
  this->All.Frames.push_back({ time, MeasureMesh(cut, image, frame, this->Options, stop) });
}

//------------------------------------------------------------------------------------------------
void SpaceTimeMeasurer::MeasureImage(
  const LabelImage<4>& image, const SpaceTimeFrame& frame, const std::stop_token& stop)
{
  SimplexMesh<4> mesh = this->Pentatopes;
  for (Point<4>& p : mesh.Points)
  {
    const Point<3> x = frame.Space.ToFrame({ p[0], p[1], p[2] });
    p = { x[0], x[1], x[2], p[3] - this->TimeScale * frame.FirstTime };
  }
  this->All.Components =
    CompareComponents(mesh, image, this->Options.SmallestComponent, this->Options.Threads, stop);

  const auto& frames = this->All.Frames;
  for (std::size_t id = 1; id < image.Values().size(); ++id)
  {
    const std::int64_t label = image.Values()[id];
    double volume = 0.0; // the mesh ends at the first and the last frame
    for (std::size_t k = 1; k < frames.size(); ++k)
    {
      volume += 0.5 * this->TimeScale * (frames[k].Time - frames[k - 1].Time) *
        (ImageVolume(frames[k - 1], label) + ImageVolume(frames[k], label));
    }
    if (volume > 0.0)
    {
      this->All.ImageHypervolumes[label] = volume;
    }
  }
}

//------------------------------------------------------------------------------------------------
std::vector<SpaceTimeLabel> SpaceTimeMeasurement::Labels() const
{
  std::map<std::int64_t, SpaceTimeLabel> labels;
  for (const LabelMeasure& measure : this->Quality.Labels)
  {
    labels[measure.Label] = { measure.Label, measure.Elements, measure.Volume,
      this->Topology.Components.at(measure.Label), 0.0 };
  }
  for (const auto& [label, volume] : this->ImageHypervolumes)
  {
    labels[label].Label = label;
    labels[label].ImageVolume = volume;
  }
  std::vector<SpaceTimeLabel> all;
  for (const auto& [label, figures] : labels)
  {
    all.push_back(figures);
  }
  return all;
}

std::vector<std::int64_t> SpaceTimeMeasurement::LostLabels() const
{
  std::vector<std::int64_t> lost;
  for (const SpaceTimeLabel& label : this->Labels())
  {
    if (label.Elements == 0)
    {
      lost.push_back(label.Label);
    }
  }
  return lost;
}

} // namespace voxplex
