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

/** By "3" or "7,3". */
ordered_json DescribeSizes(const LabelValues& sizes)
{
  ordered_json object = ordered_json::object();
  for (const auto& [labels, size] : sizes)
  {
    object[std::to_string(labels.first) +
      (labels.second == AnyLabel ? "" : "," + std::to_string(labels.second))] = size;
  }
  return object;
}

ordered_json DescribeValue(
  const Parameters& p, const MeshingParameter& parameter, const ParameterValues& selection)
{
  const bool isScalar = parameter.Kind < ParameterKind::Text;
  const std::optional<double> value = isScalar ? p.Value(parameter.Name) : std::nullopt;
  if (parameter.IsOfReading() && isScalar && !value && parameter.Kind != ParameterKind::Flag)
  {
    return parameter.Kind == ParameterKind::Word ? ordered_json(parameter.Default)
                                                 : ordered_json::parse(parameter.Default);
  }
  const auto found = selection.find(parameter.Name);
  const LabelValues labels =
    found == selection.end() ? LabelValues() : std::get<LabelValues>(found->second);
  switch (parameter.Kind)
  {
    case ParameterKind::Flag:
      return value.has_value();
    case ParameterKind::Word:
      return value ? ordered_json(parameter.Words.at(static_cast<std::size_t>(*value)))
                   : ordered_json(nullptr);
    case ParameterKind::Real:
      return OrNull(value);
    case ParameterKind::Text:
    case ParameterKind::File:
    case ParameterKind::Image:
      return OrNull(p.Text(parameter.Name));
    case ParameterKind::Numbers:
    case ParameterKind::Times:
      return OrNull(p.Numbers(parameter.Name));
    case ParameterKind::LabelSizes:
    case ParameterKind::InterfaceSizes:
      return DescribeSizes(labels);
    case ParameterKind::Labels:
    {
      ordered_json numbers = ordered_json::array();
      for (const auto& [label, none] : labels)
      {
        numbers.push_back(label.first);
      }
      return numbers;
    }
    default:
      return value ? ordered_json(static_cast<std::int64_t>(*value)) : ordered_json(nullptr);
  }
}

/** Null for what was left to its default, but for how the image was read. */
ordered_json DescribeParameters(const Parameters& p, const ParameterValues& selection)
{
  ordered_json parameters = {
    { "input", p.Inputs.size() == 1 ? ordered_json(p.Inputs.front()) : ordered_json(p.Inputs) },
    { "output", OrNull(p.Output) }, { "plc", OrNull(p.Interfaces) }
  };
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    std::string key = NameIn(UserInterface::CommandLine, parameter);
    std::replace(key.begin(), key.end(), '-', '_');
    if (!key.empty())
    {
      parameters[key] = DescribeValue(p, parameter, selection);
    }
  }
  parameters.update({ { "space", ToString(p.Space()) }, { "quality", p.Quality },
    { "hausdorff", p.Hausdorff }, { "slices", OrNull(p.Slices) },
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
  report["space"] = ToString(parameters.Space());
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
