// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeasuringFrames.h"

#include "Errors.h"
#include "Measuring.h"
#include "StatisticsText.h"

#include <vtkDataArrayRange.h>
#include <vtkDataSetTriangleFilter.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPentatopeMeshTimeSlice.h>
#include <vtkPointData.h>
#include <vtkSegmentationReader.h>
#include <vtkSimplexMeshQuality.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <vector>

using nlohmann::ordered_json;

namespace voxplex::cli
{
namespace
{

/** Frames in which a label has less than this part of its largest volume are no measure of it. */
constexpr double LeastShare = 0.2;

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

/** Whether a voxel has a label that is meshed. */
bool HasForeground(vtkImageData* image, const LabelSelection& selection)
{
  const auto values = vtk::DataArrayValueRange<1>(image->GetPointData()->GetScalars());
  const std::set<double> chosen(selection.Labels.begin(), selection.Labels.end());
  return std::any_of(values.begin(), values.end(),
    [&chosen](double label)
    { return label != 0.0 && (chosen.empty() || chosen.count(label) != 0); });
}

} // namespace

ordered_json MeasureFrames(const Parameters& parameters, const MeshingInput& input,
  vtkUnstructuredGrid* mesh, const ProgressFunction& progress)
{
  vtkNew<vtkPentatopeMeshTimeSlice> cut;
  cut->SetInputData(mesh);
  vtkNew<vtkDataSetTriangleFilter> split;
  const int numberOfFrames = input.Labels->GetNumberOfFrames();
  ordered_json frames = ordered_json::array();
  for (int frame = 0; frame < numberOfFrames; ++frame)
  {
    const double time = input.Labels->GetTimeOfFrame(frame);
    cut->UpdateTimeStep(time);
    if (!cut->GetErrorMessage().empty())
    {
      throw RunError("cannot measure the mesh: " + cut->GetErrorMessage());
    }
    split->SetInputData(cut->GetOutputDataObject(0));
    split->Update();
    input.Labels->UpdateTimeStep(time);
    vtkNew<vtkImageData> image;
    image->ShallowCopy(input.Labels->GetOutput());

    const auto filter = MakeQualityFilter(parameters, input.Selection);
    filter->SetInputData(split->GetOutput());
    const bool hasForeground = !parameters.Has("isovalue") && HasForeground(image, input.Selection);
    if (hasForeground) // otherwise there is nothing to compare with
    {
      filter->SetImageData(image);
    }
    filter->SmoothDistancesOff(); // the interface of one frame alone is another one
    ordered_json figures = Execute(filter,
      [&](double fraction, const std::string& step)
      { return progress((frame + fraction) / numberOfFrames, step); });
    if (figures.is_null())
    {
      return nullptr;
    }
    ordered_json one = { { "time", time } };
    one.update(figures);
    if (!hasForeground)
    {
      one["image"] = nullptr;
      one["hausdorff"] = ordered_json::object();
    }
    frames.push_back(std::move(one));
  }
  return frames;
}

void AddFrames(ordered_json frames, ordered_json& report)
{
  if (!AreCompared(frames))
  {
    report["frames"] = std::move(frames);
    return;
  }
  const ordered_json& given = report["parameters"]["time_scale"];
  const double scale = given.is_number() ? given.get<double>() : 1.0;
  for (auto& [label, figures] : report["labels"].items())
  {
    double volume = 0.0; // by the trapezoidal rule, as the mesh ends at the first and last frame
    for (std::size_t k = 1; k < frames.size(); ++k)
    {
      const double step = frames[k]["time"].get<double>() - frames[k - 1]["time"].get<double>();
      volume +=
        0.5 * scale * step * (ImageVolume(frames[k - 1], label) + ImageVolume(frames[k], label));
    }
    figures["image_volume"] = volume;
    figures["volume_error"] = (figures["volume"].get<double>() - volume) / volume;
  }
  report["frames"] = std::move(frames);
}

std::string SummarizeFrames(const ordered_json& report)
{
  const ordered_json& frames = report["frames"];
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
    total.Update(figures["volume_error"], label, nullptr);
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

} // namespace voxplex::cli
