// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Measuring.h"

#include "Errors.h"
#include "MeasuringFrames.h"
#include "StatisticsText.h"

#include <vtkSegmentationReader.h>
#include <vtkSimplexMeshQuality.h>
#include <vtkUnstructuredGrid.h>

#include <cstdint>
#include <sstream>

using nlohmann::ordered_json;

namespace voxplex::cli
{
namespace
{

std::string Place(const ordered_json& place)
{
  return "(" + Rounded(place[0], 2) + ", " + Rounded(place[1], 2) + ", " + Rounded(place[2], 2) +
    ")";
}

std::string Distances(const char* name, const ordered_json& figures)
{
  const auto direction = [&figures](const char* key)
  {
    const ordered_json& one = figures[key];
    return Rounded(one["max"], 3) + " (mean " + Rounded(one["mean"], 3) + ", 99 % below " +
      Rounded(one["p99"], 3) + ", largest at " + Place(one["place"]) + ")";
  };
  return std::string("  Hausdorff distance to ") + name + ": " + Rounded(figures["distance"], 3) +
    "\n    from the mesh  " + direction("mesh_to_image") + "\n    from the image " +
    direction("image_to_mesh") + "\n";
}

/** What measures a mesh as `parameters` ask for. It has no input yet. */
vtkSmartPointer<vtkSimplexMeshQuality> MakeFilter(
  const Parameters& parameters, const LabelSelection& selection)
{
  auto filter = vtkSmartPointer<vtkSimplexMeshQuality>::New();
  for (const std::int64_t label : selection.Labels)
  {
    filter->AddLabel(label);
  }
  filter->SetDistances(parameters.Hausdorff);
  if (const auto sigma = parameters.Value("smoothing"))
  {
    filter->SetSmoothingSigma(*sigma);
  }
  if (const auto angle = parameters.Value("facet-angle"))
  {
    filter->SetFacetAngle(*angle);
  }
  if (const auto voxels = parameters.Value("smallest-component"))
  {
    filter->SetSmallestComponent(static_cast<int>(*voxels));
  }
  filter->SetNumberOfThreads(static_cast<int>(parameters.Value("threads").value_or(0.0)));
  return filter;
}

/** Beside the image, or beside each of its frames. */
void Connect(vtkSimplexMeshQuality* filter, const Parameters& parameters, const MeshingInput& input)
{
  const bool hasLabels = !parameters.Has("isovalue"); // grey values have none
  if (hasLabels)
  {
    filter->SetImageConnection(input.Labels->GetOutputPort());
  }
  if (input.Dimension() == 4)
  {
    filter->SetTimeScale(parameters.Value("time-scale").value_or(1.0));
    for (int frame = 0; !hasLabels && frame < input.Labels->GetNumberOfFrames(); ++frame)
    {
      filter->AddFrameTime(input.Labels->GetTimeOfFrame(frame));
    }
  }
}

} // namespace

ordered_json Measure(const Parameters& parameters, const MeshingInput& input,
  vtkUnstructuredGrid* mesh, const ProgressFunction& progress)
{
  const auto filter = MakeFilter(parameters, input.Selection);
  filter->SetInputData(mesh);
  Connect(filter, parameters, input);
  Execute(filter,
    [&progress](double fraction, const std::string&) { return progress(fraction, "Measuring"); });
  if (filter->GetAborted())
  {
    return nullptr;
  }
  if (!filter->GetErrorMessage().empty())
  {
    throw RunError("cannot measure the mesh: " + filter->GetErrorMessage());
  }
  return ordered_json::parse(filter->ToJSON());
}

void AddMeasurement(const ordered_json& measurement, ordered_json& report)
{
  for (const auto& [label, figures] : measurement["labels"].items())
  {
    if (report["labels"].contains(label)) // lost ones are listed in "image"
    {
      report["labels"][label].update(figures);
    }
  }
  const bool hasImage = measurement.contains("image");
  if (measurement.contains("frames"))
  {
    report["worst_elements"] = measurement["worst_elements"];
    report["image"] = measurement.value("image", ordered_json());
    report["frames"] = measurement["frames"];
    return;
  }
  report["topology"] = measurement["topology"];
  report["image"] = hasImage ? measurement["image"] : ordered_json();
  report["hausdorff"] = hasImage ? measurement["hausdorff"] : ordered_json::object();
}

std::string SummarizeMeasurement(const ordered_json& report)
{
  if (report.contains("frames"))
  {
    return SummarizeFrames(report);
  }
  const ordered_json& quality = report["quality"];
  const ordered_json& topology = report["topology"];
  const ordered_json& image = report["image"];
  std::ostringstream text;
  text << "Quality:\n  dihedral angles in steps of 10 degrees, %:"
       << Shares(quality["dihedral_histogram"])
       << "\n  interface angles in steps of 10 degrees, %:" << Shares(quality["planar_histogram"])
       << "\n  smallest interface angle " << Rounded(quality["min_planar_off_junctions"], 1)
       << " degrees off junctions, " << Rounded(quality["min_planar_at_junctions"], 1)
       << " at them\n  " << topology["junction_edges"] << " junction edges, " << topology["corners"]
       << " corners; " << topology["non_manifold_edges"] << " non-manifold edges, "
       << topology["non_manifold_edges_at_junctions"] << " of them at junctions\n"
       << "  fragments of labels that are connected through faces: " << topology["fragments"]
       << "\n";
  if (!image.is_null())
  {
    text << "  " << image["lost_labels"].size() << " labels and " << image["lost_components"].size()
         << " of " << image["components"] << " components lost; volumes of labels off by "
         << Rounded(100.0 * image["label_volume_error"].get<double>(), 2) << " %\n";
  }
  const ordered_json& distances = report["hausdorff"];
  if (distances.contains("voxels"))
  {
    text << Distances("the faces of voxels", distances["voxels"])
         << Distances("the smooth interface", distances["smooth"]);
  }
  return text.str();
}

} // namespace voxplex::cli
