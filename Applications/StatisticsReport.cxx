// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "StatisticsReport.h"

#include "StatisticsText.h"
#include "WholeFiles.h"

#include <voxplexVersion.h>
#include <vtkMeshingStatistics.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <iomanip>
#include <map>
#include <sstream>

#ifdef _WIN32
#include <windows.h>

#include <psapi.h>
#else
#include <sys/resource.h>
#endif

using nlohmann::ordered_json;

namespace voxplex::cli
{
namespace
{

std::uint64_t PeakMemoryBytes()
{
#ifdef _WIN32 // which has no getrusage()
  PROCESS_MEMORY_COUNTERS counters{};
  GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof(counters));
  return counters.PeakWorkingSetSize;
#else
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
  constexpr std::uint64_t unit = 1; // macOS counts in bytes
#else
  constexpr std::uint64_t unit = 1024; // Linux counts in KiB
#endif
  return static_cast<std::uint64_t>(usage.ru_maxrss) * unit;
#endif
}

template <typename T>
ordered_json OrNull(const std::optional<T>& value)
{
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json OrNull(const std::string& text)
{
  return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

ordered_json OrNull(const std::vector<double>& numbers)
{
  return numbers.empty() ? ordered_json(nullptr) : ordered_json(numbers);
}

ordered_json DescribeValue(const Parameters& p, const MeshingParameter& parameter)
{
  const std::optional<double> value = p.Value(parameter.Name);
  switch (parameter.Kind)
  {
    case ParameterKind::Flag:
      return value.has_value();
    case ParameterKind::Word:
      return value ? ordered_json(parameter.Words.at(static_cast<std::size_t>(*value)))
                   : ordered_json(nullptr);
    case ParameterKind::Real:
      return OrNull(value);
    default:
      return value ? ordered_json(static_cast<std::int64_t>(*value)) : ordered_json(nullptr);
  }
}

/** Null for what was left to its default. */
ordered_json DescribeParameters(const Parameters& p, const LabelSelection& selection)
{
  const auto byLabel = [](const std::map<std::int64_t, double>& sizes)
  {
    ordered_json object = ordered_json::object();
    for (const auto& [label, size] : sizes)
    {
      object[std::to_string(label)] = size;
    }
    return object;
  };
  ordered_json interfaceSizes = ordered_json::object();
  for (const auto& [labels, size] : selection.InterfaceSizes)
  {
    interfaceSizes[std::to_string(labels.first) +
      (labels.second == LabelSelection::AnyLabel ? "" : "," + std::to_string(labels.second))] =
      size;
  }
  ordered_json parameters = {
    { "input", p.Inputs.size() == 1 ? ordered_json(p.Inputs.front()) : ordered_json(p.Inputs) },
    { "overlap", p.Reading.Overlap == 0 ? "smallest" : "order" },
    { "mask_threshold", p.Reading.MaskThreshold }, { "resample_masks", p.Reading.ResampleMasks },
    { "series", OrNull(p.Reading.Series) }, { "output", OrNull(p.Output) },
    { "plc", OrNull(p.Interfaces) }
  };
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    std::string key = NameIn(UserInterface::CommandLine, parameter);
    std::replace(key.begin(), key.end(), '-', '_');
    if (!key.empty())
    {
      parameters[key] = DescribeValue(p, parameter);
    }
  }
  parameters.update({ { "interface_size", interfaceSizes },
    { "label_size", byLabel(selection.Sizes) }, { "min_thickness", byLabel(selection.Thicknesses) },
    { "shell", byLabel(selection.Shells) }, { "size_image", OrNull(p.SizeImage) },
    { "labels", selection.Labels }, { "label_table", OrNull(p.Reading.LabelTable) },
    { "frame_times", OrNull(p.Reading.FrameTimes) }, { "spacing", OrNull(p.Reading.Spacing) },
    { "origin", OrNull(p.Reading.Origin) }, { "direction", OrNull(p.Reading.Direction) },
    { "data_files_anywhere", p.Reading.DataFilesAnywhere }, { "space", ToString(p.Reading.Space) },
    { "quality", p.Quality }, { "hausdorff", p.Hausdorff }, { "slices", OrNull(p.Slices) },
    { "slice_count", OrNull(p.SliceCount) }, { "uncompressed", !p.Compress } });
  return parameters;
}

ordered_json DescribeTimes(const vtkMeshingStatistics& s, const InputOutputTimes& times)
{
  return { { "read", times.Read }, { "label_field", s.GetLabelFieldTime() },
    { "distance_transform", s.GetDistanceTransformTime() }, { "grading", s.GetGradingTime() },
    { "components", s.GetComponentsTime() }, { "interfaces", s.GetInterfacesTime() },
    { "refinement", s.GetRefinementTime() }, { "extraction", s.GetExtractionTime() },
    { "optimisation", s.GetOptimisationTime() }, { "write", times.Write },
    { "total_without_io", s.GetTotalTime() } };
}

/** Adds the names to the object that has figures for each label. */
void NameLabels(ordered_json& report, const LabelReport& labels)
{
  for (auto& [label, figures] : report["labels"].items())
  {
    ordered_json named = { { "name", OrNull(labels.Names.NameOf(std::stoll(label))) } };
    named.update(figures);
    figures = named;
  }
  ordered_json lost = ordered_json::array();
  for (const ordered_json& label : report["lost_labels"])
  {
    lost.push_back(OrNull(labels.Names.NameOf(label.get<std::int64_t>())));
  }
  report["lost_label_names"] = lost;
  for (ordered_json& label : report["shrunk_labels"])
  {
    label["name"] = OrNull(labels.Names.NameOf(label["label"].get<std::int64_t>()));
  }
  report["label_names_from"] = OrNull(labels.Source);
}

/** 436120 as "436,120". */
std::string Grouped(std::int64_t number)
{
  std::string text = std::to_string(number);
  for (std::size_t i = text.size(); i > 3;)
  {
    i -= 3;
    text.insert(i, ",");
  }
  return text;
}

std::string Significant(const ordered_json& number)
{
  if (!number.is_number())
  {
    return "-";
  }
  std::ostringstream text;
  text << std::setprecision(4) << number.get<double>();
  return text.str();
}

std::string SummarizeTetrahedra(const ordered_json& quality)
{
  return "Radius-edge ratio at most " + Rounded(quality["max_radius_edge"], 4) +
    ", dihedral angles from " + Rounded(quality["min_dihedral"], 1) + " to " +
    Rounded(quality["max_dihedral"], 1) + " degrees, interface angles from " +
    Rounded(quality["min_planar"], 1) + " degrees";
}

/** The figures of the thesis' tables 4.2 and 4.3. */
std::string SummarizePentatopes(const ordered_json& quality)
{
  return "Shortest edge " + Significant(quality["shortest_edge"]) + "; radius-edge ratio at most " +
    Rounded(quality["max_radius_edge"], 4) + ", " + Rounded(quality["mean_radius_edge"], 2) +
    " +- " + Rounded(quality["radius_edge_deviation"], 2) + "; normalized volume at least " +
    Rounded(quality["min_normalized_volume"], 4) + ", " +
    Rounded(quality["mean_normalized_volume"], 2) + " +- " +
    Rounded(quality["normalized_volume_deviation"], 2);
}

std::string SummarizeCavities(const ordered_json& cavities)
{
  return "; cavities of " + Rounded(cavities["mean"], 0) + " pentatopes, at most " +
    Grouped(cavities["largest"]);
}

/** How --elements was met. */
std::string SummarizeRuns(const ordered_json& report)
{
  if (report["elements_asked_for"].is_null())
  {
    return "";
  }
  const std::size_t runs = report["runs"].size();
  return " (found in " + std::to_string(runs) + (runs == 1 ? " run" : " runs") + " for " +
    Grouped(report["elements_asked_for"].get<std::int64_t>()) + " elements)";
}

/** What --min-component-volume left out. */
std::string SummarizeDropped(const ordered_json& components)
{
  if (components.empty())
  {
    return "";
  }
  std::map<std::int64_t, std::int64_t> voxels;
  for (const ordered_json& component : components)
  {
    voxels[component["label"].get<std::int64_t>()] += component["voxels"].get<std::int64_t>();
  }
  std::string text;
  for (const auto& [label, count] : voxels)
  {
    text += (text.empty() ? "" : ", ") + Grouped(count) + " of label " + std::to_string(label);
  }
  return "Left out: " + Grouped(static_cast<std::int64_t>(components.size())) +
    (components.size() == 1 ? " component" : " components") + " (voxels: " + text + "). ";
}

} // namespace

ordered_json MakeReport(vtkMeshingStatistics* statistics, const Parameters& parameters,
  const LabelReport& labels, const InputOutputTimes& times)
{
  ordered_json report = { { "program", "voxplex" }, { "version", VOXPLEX_VERSION },
    { "parameters", DescribeParameters(parameters, labels.Selection) } };
  report.update(ordered_json::parse(statistics->ToJSON()));
  NameLabels(report, labels);
  report["space"] = ToString(parameters.Reading.Space);
  report["time"] = DescribeTimes(*statistics, times);
  const double seconds = statistics->GetTotalTime();
  report["elements_per_second"] = seconds > 0
    ? ordered_json(static_cast<double>(statistics->GetNumberOfElements()) / seconds)
    : ordered_json(nullptr);
  report["peak_memory_bytes"] = PeakMemoryBytes();
  return report;
}

void WriteReport(const ordered_json& report, const std::string& path, const io::WholeFiles& files)
{
  files.WriteText(path,
    [&report](io::TextFile& file)
    { file << report.dump(2, ' ', false, ordered_json::error_handler_t::replace) << '\n'; });
}

std::string Summarize(const ordered_json& report)
{
  const ordered_json& time = report["time"];
  const bool isSpaceTime = report["dimension"].get<int>() == 4;
  std::ostringstream text;
  text << Grouped(report["elements"]) << (isSpaceTime ? " pentatopes in " : " tetrahedra in ")
       << report["labels"].size() << (report["labels"].size() == 1 ? " label, " : " labels, ")
       << Grouped(report["vertices"]) << " vertices, " << Grouped(report["interface_facets"])
       << (isSpaceTime ? " boundary tetrahedra" : " interface triangles") << " with delta "
       << Significant(report["delta"]) << SummarizeRuns(report) << ". "
       << SummarizeDropped(report["dropped_components"])
       << (isSpaceTime
              ? SummarizePentatopes(report["quality"]) + SummarizeCavities(report["cavities"])
              : SummarizeTetrahedra(report["quality"]))
       << ". Read in " << Rounded(time["read"], 2) << " s, meshed in "
       << Rounded(time["total_without_io"], 2) << " s, written in " << Rounded(time["write"], 2)
       << " s, with at most "
       << Grouped(report["peak_memory_bytes"].get<std::int64_t>() / (1 << 20))
       << " MiB of memory.\n";
  return text.str();
}

std::string SummarizeMesh(vtkUnstructuredGrid* mesh, int dimension, const ordered_json& measurement,
  const InputOutputTimes& times)
{
  const bool isSpaceTime = dimension == 4;
  std::ostringstream text;
  text << Grouped(mesh->GetNumberOfCells()) << (isSpaceTime ? " pentatopes, " : " tetrahedra, ")
       << Grouped(mesh->GetNumberOfPoints()) << " vertices. ";
  if (!measurement.is_null())
  {
    const ordered_json& quality = measurement["quality"];
    text << (isSpaceTime ? SummarizePentatopes(quality) : SummarizeTetrahedra(quality)) << ". ";
  }
  text << "Read in " << Rounded(times.Read, 2) << " s, written in " << Rounded(times.Write, 2)
       << " s.\n";
  return text.str();
}

} // namespace voxplex::cli
