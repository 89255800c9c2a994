// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/FiguresJson.h"

#include "Private/QualityTables.h"

#include <cstdint>
#include <string>
#include <utility>

using nlohmann::ordered_json;

namespace voxplex
{
namespace
{

void AddCounts(ordered_json& json, const MeshCounts& counts)
{
  json["elements"] = counts.Elements;
  json["vertices"] = counts.Vertices;
  json["interface_facets"] = counts.InterfaceFacets;
  json["faces_of_three_elements"] = counts.FacesOfThreeElements;
}

ordered_json LabelsToJson(const MeshMeasurement& measurement)
{
  ordered_json labels = ordered_json::object();
  for (const auto& [label, figures] : CollectLabels(measurement))
  {
    ordered_json one = { { "elements", figures.Comparison.Elements },
      { "volume", figures.Comparison.Volume } };
    if (measurement.Image)
    {
      one["voxels"] = figures.Comparison.Voxels;
      one["image_volume"] = figures.Comparison.ImageVolume;
      one["volume_error"] = figures.Comparison.VolumeError();
    }
    one["fragments"] = figures.Fragments;
    one["boundary_edges"] = figures.Topology.BoundaryEdges;
    one["non_manifold_edges"] = figures.Topology.NonManifoldEdges;
    one["non_manifold_edges_at_junctions"] = figures.Topology.NonManifoldEdgesAtJunctions;
    AppendLabel(labels, label, std::move(one));
  }
  return labels;
}

ordered_json TopologyToJson(const MeshMeasurement& measurement)
{
  const InterfaceTopology& topology = measurement.Topology;
  std::uint64_t fragments = 0;
  for (const auto& [label, number] : measurement.Fragments)
  {
    fragments += number;
  }
  return {
    { "fragments", fragments },
    { "interface_edges", topology.InterfaceEdges },
    { "junction_edges", topology.JunctionEdges },
    { "junction_points", topology.JunctionPoints },
    { "corners", topology.Corners },
    { "irregular_junction_points", topology.IrregularJunctionPoints },
    { "boundary_edges", topology.BoundaryEdges },
    { "non_manifold_edges", topology.NonManifoldEdges },
    { "non_manifold_edges_at_junctions", topology.NonManifoldEdgesAtJunctions },
  };
}

ordered_json DistancesToJson(const DistanceFigures& figures)
{
  return {
    { "max", figures.Maximum },
    { "mean", figures.Mean },
    { "p99", figures.Percentile99 },
    { "place", figures.Place },
    { "points", figures.Points },
  };
}

void AddHausdorff(ordered_json& json, const char* name, const HausdorffFigures& figures)
{
  if (figures.MeshToImage.Points == 0 && figures.ImageToMesh.Points == 0)
  {
    return; // was not measured
  }
  json[name] = {
    { "distance", figures.Distance() },
    { "mesh_to_image", DistancesToJson(figures.MeshToImage) },
    { "image_to_mesh", DistancesToJson(figures.ImageToMesh) },
  };
}

void AddImage(ordered_json& json, const ImageComparison& image)
{
  json["image"] = {
    { "lost_labels", image.LostLabels },
    { "extra_labels", image.ExtraLabels },
    { "volume", image.ImageVolume },
    { "mesh_volume", image.Volume },
    { "label_volume_error", image.VolumeError },
    { "components", image.Components },
    { "lost_components", ComponentsToJson(image.LostComponents) },
  };
  ordered_json& distances = json["hausdorff"] = ordered_json::object();
  AddHausdorff(distances, "voxels", image.Voxels);
  AddHausdorff(distances, "smooth", image.Smooth);
}

} // namespace

ordered_json QualityToJson(const MeshQuality& quality)
{
  return {
    { "shortest_edge", quality.ShortestEdge },
    { "max_radius_edge", quality.MaximumRadiusEdgeRatio },
    { "mean_radius_edge", quality.MeanRadiusEdgeRatio },
    { "radius_edge_deviation", quality.RadiusEdgeRatioDeviation },
    { "min_dihedral", quality.MinimumDihedralAngle },
    { "max_dihedral", quality.MaximumDihedralAngle },
    { "min_planar", quality.MinimumFacetAngle },
    { "min_normalized_volume", quality.MinimumNormalizedVolume },
    { "mean_normalized_volume", quality.MeanNormalizedVolume },
    { "normalized_volume_deviation", quality.NormalizedVolumeDeviation },
    { "normalized_volume_histogram", quality.NormalizedVolumes },
    { "inverted_elements", quality.InvertedSimplices },
    { "radius_edge_violations", quality.RadiusEdgeViolations },
    { "facet_angle_violations", quality.FacetAngleViolations },
    { "facet_angle_violations_at_junctions", quality.FacetAngleViolationsAtJunctions },
    { "min_planar_off_junctions", quality.MinimumFacetAngleOffJunctions },
    { "min_planar_at_junctions", quality.MinimumFacetAngleAtJunctions },
    { "small_facet_angles_at_junctions", quality.SmallFacetAnglesAtJunctions },
    { "dihedral_histogram", quality.DihedralAngles },
    { "planar_histogram", quality.PlanarAngles },
    { "radius_edge_histogram", quality.RadiusEdgeRatios },
  };
}

ordered_json ComponentToJson(const ComponentReport& component)
{
  return { { "label", component.Label }, { "voxels", component.Voxels },
    { "voxel", component.Voxel } };
}

ordered_json ComponentsToJson(const std::vector<ComponentReport>& components)
{
  return ListToJson(components, ComponentToJson);
}

void AppendLabel(ordered_json& labels, std::int64_t label, ordered_json figures)
{
  labels.get_ref<ordered_json::object_t&>().emplace_back(std::to_string(label), std::move(figures));
}

//----------------------------------------------------------------------------------------------------
namespace
{

void AddMeasurement(ordered_json& json, const MeshMeasurement& measurement)
{
  AddCounts(json, measurement.Counts);
  json["labels"] = LabelsToJson(measurement);
  json["quality"] = QualityToJson(measurement.Quality);
  json["topology"] = TopologyToJson(measurement);
  if (measurement.Image)
  {
    AddImage(json, *measurement.Image);
  }
}

ordered_json FrameToJson(const FrameMeasurement& frame)
{
  ordered_json json = { { "time", frame.Time } };
  AddMeasurement(json, frame.Measured);
  if (!frame.Measured.Image)
  {
    json["image"] = nullptr;
    json["hausdorff"] = ordered_json::object();
  }
  return json;
}

ordered_json WorstToJson(const WorstElement& element)
{
  return { { "cell", element.Cell }, { "label", element.Label },
    { "normalized_volume", element.NormalizedVolume }, { "radius_edge", element.RadiusEdgeRatio },
    { "place", element.Place } };
}

} // namespace

std::string ToJson(const MeshMeasurement& measurement)
{
  ordered_json json;
  AddMeasurement(json, measurement);
  return json.dump();
}

std::string ToJson(const SpaceTimeMeasurement& figures)
{
  ordered_json json;
  AddCounts(json, figures.Counts);
  ordered_json labels = ordered_json::object();
  for (const SpaceTimeLabel& label : figures.Labels())
  {
    ordered_json one = { { "elements", label.Elements }, { "volume", label.Volume },
      { "components", label.Components } };
    if (figures.Components)
    {
      one["image_volume"] = label.ImageVolume;
      one["volume_error"] = label.VolumeError();
    }
    AppendLabel(labels, label.Label, std::move(one));
  }
  json["labels"] = std::move(labels);
  json["quality"] = QualityToJson(figures.Quality);
  json["worst_elements"] = ListToJson(figures.Worst, WorstToJson);
  if (figures.Components)
  {
    json["image"] = {
      { "lost_labels", figures.LostLabels() },
      { "components", figures.Components->Wanted },
      { "lost_components", ComponentsToJson(figures.Components->Lost) },
    };
  }
  json["frames"] = ListToJson(figures.Frames, FrameToJson);
  return json.dump();
}

} // namespace voxplex
