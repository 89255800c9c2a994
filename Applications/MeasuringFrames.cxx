// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeasuringFrames.h"

#include "StatisticsText.h"

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

} // namespace

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
