// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Measuring.h"

#include "Errors.h"
#include "StatisticsText.h"

#include <vtkSegmentationReader.h>
#include <vtkSimplexMeshQuality.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <sstream>
#include <vector>

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

/** Null, as it is, if there is no number. */
ordered_json Percent(const ordered_json& share)
{
  return share.is_number() ? ordered_json(100.0 * share.get<double>()) : share;
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
  const Parameters& parameters, const ParameterValues& selection)
{
  auto filter = vtkSmartPointer<vtkSimplexMeshQuality>::New();
  if (const auto labels = selection.find("labels"); labels != selection.end())
  {
    for (const auto& [label, none] : std::get<LabelValues>(labels->second))
    {
      filter->AddLabel(label.first);
    }
  }
  filter->SetDistances(parameters.Hausdorff);
  if (const auto sigma = parameters.Value("smoothing"))
  {
    filter->SetSmoothingSigma(*sigma);
  }
  if (const auto ratio = parameters.Value("radius-edge"))
  {
    filter->SetRadiusEdgeRatio(*ratio);
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

/** Beside the image or each of its frames, if there is one. */
void Connect(vtkSimplexMeshQuality* filter, const Parameters& parameters, const MeshingInput& input)
{
  filter->SetTimeScale(parameters.Value("time-scale").value_or(1.0));
  if (input.Labels && !parameters.Has("isovalue")) // grey values have no labels
  {
    filter->SetImageConnection(input.Source()->GetOutputPort());
    return;
  }
  for (const double time : input.Labels ? input.TimesOfFrames() : parameters.Numbers("frame-times"))
  {
    filter->AddFrameTime(time);
  }
}

//----------------------------------------------------------------------------------------------------
/** Frames in which a label has less than this part of its largest volume are no measure of it. */
constexpr double LeastShare = 0.05;

/** A figure of one frame, and when that is. */
struct Worst
{
  double Value = 0.0;
  std::string Label;
  ordered_json Time;

  void Update(double value, const std::string& label, const ordered_json& time)
  {
    if (std::abs(value) > std::abs(this->Value))
    {
      *this = { value, label, time };
    }
  }
};

/** A label's volume in a frame of the image. */
double ImageVolume(const ordered_json& frame, const std::string& label)
{
  const ordered_json& labels = frame["labels"];
  return labels.contains(label) ? labels[label].value("image_volume", 0.0) : 0.0;
}

/** The largest volume of each label in the frames of the image. */
std::map<std::string, double> LargestVolumes(const ordered_json& frames)
{
  std::map<std::string, double> largest;
  for (const ordered_json& frame : frames)
  {
    for (const auto& one : frame["labels"].items())
    {
      const std::string& label = one.key();
      largest[label] = std::max(largest[label], ImageVolume(frame, label));
    }
  }
  return largest;
}

/** The largest relative error of a label's volume in a frame. */
Worst WorstVolume(const ordered_json& frames)
{
  const std::map<std::string, double> largest = LargestVolumes(frames);
  Worst worst;
  for (const ordered_json& frame : frames)
  {
    for (const auto& [label, figures] : frame["labels"].items())
    {
      const double volume = ImageVolume(frame, label);
      if (volume > 0.0 && volume >= LeastShare * largest.at(label))
      {
        worst.Update(figures["volume_error"], label, frame["time"]);
      }
    }
  }
  return worst;
}

/** Whether the image has labels, so that the frames were compared with it. */
bool AreCompared(const ordered_json& frames)
{
  return std::any_of(frames.begin(), frames.end(),
    [](const ordered_json& frame) { return !frame["image"].is_null(); });
}

std::vector<std::uint64_t> DihedralAngles(const ordered_json& frames)
{
  std::vector<std::uint64_t> sum;
  for (const ordered_json& frame : frames)
  {
    const auto one = frame["quality"]["dihedral_histogram"].get<std::vector<std::uint64_t>>();
    sum.resize(one.size());
    std::transform(sum.begin(), sum.end(), one.begin(), sum.begin(), std::plus<>());
  }
  return sum;
}

/** Of a report to which frames were added: the cuts beside the frames of the image. */
std::string SummarizeFrames(const ordered_json& report)
{
  const ordered_json& frames = report["frames"];
  if (frames.empty())
  {
    return "";
  }
  std::ostringstream text;
  text << "Quality of the cuts at " << frames.size()
       << " frames:\n  dihedral angles in steps of 10 degrees, %:" << Shares(DihedralAngles(frames))
       << '\n';
  if (!AreCompared(frames))
  {
    return text.str();
  }
  Worst total;
  for (const auto& [label, figures] : report["labels"].items())
  {
    if (figures["volume_error"].is_number()) // not of labels that the image has not
    {
      total.Update(figures["volume_error"], label, nullptr);
    }
  }
  const Worst volume = WorstVolume(frames);
  std::size_t lost = 0;
  std::int64_t components = 0;
  Worst distance;
  for (const ordered_json& frame : frames)
  {
    if (!frame["image"].is_null())
    {
      lost += frame["image"]["lost_components"].size();
      components += frame["image"]["components"].get<std::int64_t>();
    }
    if (frame["hausdorff"].contains("voxels") &&
      frame["hausdorff"]["voxels"]["distance"].is_number())
    {
      distance.Update(frame["hausdorff"]["voxels"]["distance"], "", frame["time"]);
    }
  }
  text << "  " << lost << " of " << components << " components lost; hypervolumes off by up to "
       << Rounded(100.0 * total.Value, 2) << " %, volumes in a frame by up to "
       << Rounded(100.0 * volume.Value, 2) << " % (label " << volume.Label << " at time "
       << Rounded(volume.Time, 3) << ")\n";
  if (distance.Time.is_number())
  {
    text << "  Hausdorff distance to the faces of voxels: at most " << Rounded(distance.Value, 3)
         << " (at time " << Rounded(distance.Time, 3) << ")\n";
  }
  return text.str();
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
    throw RunError(
      "cannot measure the mesh", InTermsOf(parameters.Words, filter->GetErrorMessage()));
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
  const ordered_json image = report.value("image", ordered_json());
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
         << Rounded(Percent(image["label_volume_error"]), 2) << " %\n";
  }
  const ordered_json distances = report.value("hausdorff", ordered_json::object());
  if (distances.contains("voxels"))
  {
    text << Distances("the faces of voxels", distances["voxels"])
         << Distances("the smooth interface", distances["smooth"]);
  }
  return text.str();
}

} // namespace voxplex::cli
