// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/MeshMeasurement.h"

#include "Domain/ImageDomain.h"
#include "Domain/InterfacePoints.h"
#include "Image/Components.h"
#include "Mesh/FindInterfaces.h"
#include "Parallel/ParallelFor.h"
#include "Quality/ComponentPieces.h"
#include "Quality/LostComponents.h"

#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace voxplex
{
namespace
{

void CompareLabels(
  const std::vector<LabelMeasure>& mesh, const LabelImage<3>& image, ImageComparison& comparison)
{
  std::map<std::int64_t, LabelComparison> labels;
  const double voxelVolume = image.Grid().VoxelVolume();
  for (std::size_t id = 1; id < image.Values().size(); ++id)
  {
    if (image.Counts()[id] > 0)
    {
      LabelComparison& label = labels[image.Values()[id]];
      label.Voxels = image.Counts()[id];
      label.ImageVolume = static_cast<double>(label.Voxels) * voxelVolume;
    }
  }
  for (const LabelMeasure& measure : mesh)
  {
    LabelComparison& label = labels[measure.Label];
    label.Elements = measure.Elements;
    label.Volume = measure.Volume;
  }
  double deviation = 0.0;
  for (auto& [value, label] : labels)
  {
    label.Label = value;
    comparison.ImageVolume += label.ImageVolume;
    comparison.Volume += label.Volume;
    deviation += std::abs(label.Volume - label.ImageVolume);
    if (label.Elements == 0)
    {
      comparison.LostLabels.push_back(value);
    }
    if (label.Voxels == 0)
    {
      comparison.ExtraLabels.push_back(value);
    }
    comparison.Labels.push_back(label);
  }
  comparison.VolumeError = deviation / comparison.ImageVolume;
}

void CompareInterfaces(const SimplexMesh<3>& mesh, const LabelImage<3>& image,
  const MeasurementOptions& options, const std::stop_token& stop, ImageComparison& comparison)
{
  comparison.Voxels = MeasureHausdorff(
    mesh, VoxelFaceCentres(image, options.Threads, stop), nullptr, options.Threads, stop);
  if (options.SmoothDistances)
  {
    const ImageDomain<3> domain(image, options.SmoothingSigma, options.Threads, stop);
    comparison.Smooth = MeasureHausdorff(mesh,
      SmoothInterfacePoints(image, domain.GetLabelField(), options.Threads, stop), &domain,
      options.Threads, stop);
  }
}

void MoveToFrame(const ImageFrame& frame, SimplexMesh<3>& mesh)
{
  for (Point<3>& p : mesh.Points)
  {
    p = frame.ToFrame(p);
  }
  if (frame.LeftHanded) // so that volumes are positive in the frame, too
  {
    for (auto& simplex : mesh.Simplices)
    {
      std::swap(simplex[2], simplex[3]);
    }
  }
}

void MoveToWorld(const ImageFrame& frame, HausdorffFigures& figures)
{
  for (DistanceFigures* direction : { &figures.MeshToImage, &figures.ImageToMesh })
  {
    direction->Place = frame.ToWorld(direction->Place);
  }
}

} // namespace

template <int D>
ComponentComparison CompareComponents(const SimplexMesh<D>& mesh, const LabelImage<D>& image,
  std::int64_t smallest, unsigned threads, const std::stop_token& stop)
{
  const Components<D> components(image, threads, stop);
  const std::vector<bool> wanted = components.FindWanted(smallest);
  ComponentComparison comparison;
  comparison.Wanted = static_cast<std::uint64_t>(std::count(wanted.begin(), wanted.end(), true));
  for (const std::uint32_t c : FindLostComponents(components, image, mesh, wanted, threads, stop))
  {
    comparison.Lost.push_back(MakeReport(components.All()[c], image));
  }
  return comparison;
}

template ComponentComparison CompareComponents<3>(
  const SimplexMesh<3>&, const LabelImage<3>&, std::int64_t, unsigned, const std::stop_token&);
template ComponentComparison CompareComponents<4>(
  const SimplexMesh<4>&, const LabelImage<4>&, std::int64_t, unsigned, const std::stop_token&);

MeshMeasurement MeasureMesh(SimplexMesh<3>& mesh, const LabelImage<3>* image,
  const ImageFrame& frame, const MeasurementOptions& options, const std::stop_token& stop)
{
  MoveToFrame(frame, mesh);
  MeshMeasurement measurement;
  const std::uint64_t faces = FindInterfaces(mesh, options.Threads, stop);
  measurement.Counts = { mesh.Simplices.size(), mesh.Points.size(), mesh.Facets.size(), faces };
  measurement.Quality =
    MeasureQuality(mesh, options.RadiusEdgeBound, options.FacetAngleBound, options.Threads);
  ThrowIfStopped(stop);
  measurement.Topology = MeasureTopology(mesh, options.Threads, stop);
  measurement.Fragments = CountFragments(mesh, stop);
  if (image)
  {
    ImageComparison& comparison = measurement.Image.emplace();
    CompareLabels(measurement.Quality.Labels, *image, comparison);
    ComponentComparison components =
      CompareComponents(mesh, *image, options.SmallestComponent, options.Threads, stop);
    comparison.Components = components.Wanted;
    comparison.LostComponents = std::move(components.Lost);
    if (options.Distances)
    {
      CompareInterfaces(mesh, *image, options, stop, comparison);
      MoveToWorld(frame, comparison.Voxels);
      MoveToWorld(frame, comparison.Smooth);
    }
  }
  return measurement;
}

} // namespace voxplex
