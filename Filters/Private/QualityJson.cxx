// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/QualityJson.h"

#include <cmath>
#include <map>

namespace voxplex
{
namespace
{

/** What there is to say of a label, from wherever. */
struct LabelFigures
{
  LabelComparison Comparison;
  LabelTopology Topology;
};

std::map<std::int64_t, LabelFigures> CollectLabels(const MeshMeasurement& measurement)
{
  std::map<std::int64_t, LabelFigures> labels;
  for (const LabelMeasure& measure : measurement.Quality.Labels)
  {
    LabelComparison& comparison = labels[measure.Label].Comparison;
    comparison.Elements = measure.Elements;
    comparison.Volume = measure.Volume;
  }
  for (const LabelTopology& topology : measurement.Topology.Labels)
  {
    labels[topology.Label].Topology = topology;
  }
  if (measurement.Image)
  {
    for (const LabelComparison& comparison : measurement.Image->Labels)
    {
      labels[comparison.Label].Comparison = comparison;
    }
  }
  return labels;
}

void AddLabels(JsonWriter& json, const MeshMeasurement& measurement)
{
  json.Begin("labels");
  for (const auto& [label, figures] : CollectLabels(measurement))
  {
    json.Begin(std::to_string(label));
    json.Add("elements", figures.Comparison.Elements);
    json.Add("volume", figures.Comparison.Volume);
    if (measurement.Image)
    {
      const double volume = figures.Comparison.ImageVolume;
      json.Add("voxels", figures.Comparison.Voxels);
      json.Add("image_volume", volume);
      json.Add("volume_error", (figures.Comparison.Volume - volume) / volume);
    }
    json.Add("boundary_edges", figures.Topology.BoundaryEdges);
    json.Add("non_manifold_edges", figures.Topology.NonManifoldEdges);
    json.Add("non_manifold_edges_at_junctions", figures.Topology.NonManifoldEdgesAtJunctions);
    json.End();
  }
  json.End();
}

void AddTopology(JsonWriter& json, const InterfaceTopology& topology)
{
  json.Begin("topology");
  json.Add("interface_edges", topology.InterfaceEdges);
  json.Add("junction_edges", topology.JunctionEdges);
  json.Add("junction_points", topology.JunctionPoints);
  json.Add("corners", topology.Corners);
  json.Add("irregular_junction_points", topology.IrregularJunctionPoints);
  json.Add("boundary_edges", topology.BoundaryEdges);
  json.Add("non_manifold_edges", topology.NonManifoldEdges);
  json.Add("non_manifold_edges_at_junctions", topology.NonManifoldEdgesAtJunctions);
  json.End();
}

void AddDistances(JsonWriter& json, const std::string& name, const DistanceFigures& figures)
{
  json.Begin(name);
  json.Add("max", figures.Maximum);
  json.Add("mean", figures.Mean);
  json.Add("p99", figures.Percentile99);
  json.Add<double>("place", figures.Place);
  json.Add("points", figures.Points);
  json.End();
}

void AddHausdorff(JsonWriter& json, const std::string& name, const HausdorffFigures& figures)
{
  if (figures.MeshToImage.Points == 0 && figures.ImageToMesh.Points == 0)
  {
    return; // was not measured
  }
  json.Begin(name);
  json.Add("distance", figures.Distance());
  AddDistances(json, "mesh_to_image", figures.MeshToImage);
  AddDistances(json, "image_to_mesh", figures.ImageToMesh);
  json.End();
}

void AddImage(JsonWriter& json, const ImageComparison& image)
{
  json.Begin("image");
  json.Add<std::int64_t>("lost_labels", image.LostLabels);
  json.Add<std::int64_t>("extra_labels", image.ExtraLabels);
  json.Add("volume", image.ImageVolume);
  json.Add("mesh_volume", image.Volume);
  json.Add("label_volume_error", image.VolumeError);
  json.Add("components", image.Components);
  AddComponents(json, "lost_components", image.LostComponents);
  json.End();
  json.Begin("hausdorff");
  AddHausdorff(json, "voxels", image.Voxels);
  AddHausdorff(json, "smooth", image.Smooth);
  json.End();
}

} // namespace

void AddQuality(JsonWriter& json, const MeshQuality& quality)
{
  json.Begin("quality");
  json.Add("shortest_edge", quality.ShortestEdge);
  json.Add("max_radius_edge", quality.MaximumRadiusEdgeRatio);
  json.Add("mean_radius_edge", quality.MeanRadiusEdgeRatio);
  json.Add("radius_edge_deviation", quality.RadiusEdgeRatioDeviation);
  json.Add("min_dihedral", quality.MinimumDihedralAngle);
  json.Add("max_dihedral", quality.MaximumDihedralAngle);
  json.Add("min_planar", quality.MinimumFacetAngle);
  json.Add("min_normalized_volume", quality.MinimumNormalizedVolume);
  json.Add("mean_normalized_volume", quality.MeanNormalizedVolume);
  json.Add("normalized_volume_deviation", quality.NormalizedVolumeDeviation);
  json.Add<std::uint64_t>("normalized_volume_histogram", quality.NormalizedVolumes);
  json.Add("inverted_elements", quality.InvertedSimplices);
  json.Add("radius_edge_violations", quality.RadiusEdgeViolations);
  json.Add("facet_angle_violations", quality.FacetAngleViolations);
  json.Add("facet_angle_violations_at_junctions", quality.FacetAngleViolationsAtJunctions);
  json.Add("min_planar_off_junctions", quality.MinimumFacetAngleOffJunctions);
  json.Add("min_planar_at_junctions", quality.MinimumFacetAngleAtJunctions);
  json.Add("small_facet_angles_at_junctions", quality.SmallFacetAnglesAtJunctions);
  json.Add<std::uint64_t>("dihedral_histogram", quality.DihedralAngles);
  json.Add<std::uint64_t>("planar_histogram", quality.PlanarAngles);
  json.Add<std::uint64_t>("radius_edge_histogram", quality.RadiusEdgeRatios);
  json.End();
}

void AddComponents(
  JsonWriter& json, const std::string& name, const std::vector<ComponentReport>& components)
{
  json.BeginList(name);
  for (const ComponentReport& component : components)
  {
    json.BeginItem();
    json.Add("label", component.Label);
    json.Add("voxels", component.Voxels);
    json.Add<std::int64_t>("voxel", component.Voxel);
    json.End();
  }
  json.EndList();
}

void AddMeasurement(JsonWriter& json, const MeshMeasurement& measurement)
{
  AddLabels(json, measurement);
  AddQuality(json, measurement.Quality);
  AddTopology(json, measurement.Topology);
  if (measurement.Image)
  {
    AddImage(json, *measurement.Image);
  }
}

} // namespace voxplex
