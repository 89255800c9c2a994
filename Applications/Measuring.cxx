// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Measuring.h"

#include "Errors.h"
#include "StatisticsText.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>
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

void OnProgress(vtkObject* caller, unsigned long, void* clientData, void*)
{
  auto* const filter = static_cast<vtkSimplexMeshQuality*>(caller);
  const auto& progress = *static_cast<const ProgressFunction*>(clientData);
  if (!progress(filter->GetProgress(), "Measuring"))
  {
    filter->SetAbortExecute(1);
  }
}

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

} // namespace

vtkSmartPointer<vtkSimplexMeshQuality> MakeQualityFilter(
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

ordered_json Execute(vtkSimplexMeshQuality* filter, const ProgressFunction& progress)
{
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(OnProgress);
  observer->SetClientData(const_cast<ProgressFunction*>(&progress));
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, observer);
  filter->Update();
  filter->RemoveObserver(tag);
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

ordered_json Measure(const Parameters& parameters, const MeshingInput& input,
  vtkUnstructuredGrid* mesh, const ProgressFunction& progress)
{
  const auto filter = MakeQualityFilter(parameters, input.Selection);
  filter->SetInputData(mesh);
  if (!parameters.Has("isovalue")) // otherwise the image has no labels
  {
    filter->SetImageConnection(input.Labels->GetOutputPort());
  }
  return Execute(filter, progress);
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
  report["topology"] = measurement["topology"];
  const bool hasImage = measurement.contains("image");
  report["image"] = hasImage ? measurement["image"] : ordered_json();
  report["hausdorff"] = hasImage ? measurement["hausdorff"] : ordered_json::object();
}

std::string SummarizeMeasurement(const ordered_json& report)
{
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
