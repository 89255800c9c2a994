// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The program voxplex as a CLI module of 3D Slicer. It describes itself as the Slicer Execution Model wants it, turns an
// application's arguments into those of the program, and returns some of the program's figures.

#include "Base/NumberText.h"
#include "MeshingParameters.h"
#include "Program.h"
#include "Text.h"

#include <nlohmann/json.hpp>
#include <voxplexVersion.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>

using nlohmann::json;

namespace voxplex::slicer
{
namespace
{

// --- Parameters

struct Parameter
{
  std::string Type; ///< its element in the description
  std::string Name;
  std::string Flag; ///< empty: by its place
  std::string Label;
  std::string Description;
  std::string Default{};
  std::string Option{};     ///< of the program
  std::string Rest{};       ///< more elements
  std::string Attributes{}; ///< of files
};

std::string Element(
  const std::string& tag, const std::string& content, const std::string& attributes = "")
{
  return '<' + tag + attributes + '>' + content + "</" + tag + ">\n";
}

std::string TextElement(const std::string& tag, const std::string& text)
{
  return text.empty() ? "" : Element(tag, io::EscapeForXML(text));
}

std::vector<Parameter> Files()
{
  const std::string input = Element("channel", "input");
  const std::string output = Element("channel", "output");
  return {
    { "image", "inputLabels", "", "Label map or volume",
      "The segmentation: one whole number a voxel, 0 is background; or, with an isovalue, a volume "
      "of grey values. Origin, spacing and axes are honoured.",
      "", "", input + Element("index", "0"), R"( type="any" fileExtensions=".nrrd")" },
    { "table", "colorTable", "label_table", "Colour table",
      "Names and colours of the labels, for the mesh. Optional: the names in a .seg.nrrd file are "
      "used without.",
      "", "label-table", input, R"( type="color" fileExtensions=".ctbl")" },
    { "geometry", "outputMesh", "", "Mesh",
      "The tetrahedra, with the label of each in the cell array Label.", "", "",
      output + Element("index", "1"), R"( type="model" fileExtensions=".vtu")" },
    { "geometry", "outputSurfaces", "plc", "Interfaces",
      "The triangles between labels, and between labels and background, with both labels of each "
      "in the cell array Labels. Optional.",
      "", "plc", output, R"( type="model" fileExtensions=".vtp")" },
  };
}

std::string Enumeration(const std::vector<std::string>& words)
{
  std::string elements;
  for (const std::string& word : words)
  {
    elements += TextElement("element", word);
  }
  return elements;
}

/** An empty text is no value, as 0 is one. */
bool IsText(const MeshingParameter& parameter)
{
  return parameter.IsNumber() && parameter.IsOptional() && parameter.Range.Low < 0.0;
}

/** Flags that are on by default are words: applications have no flags that switch off. */
bool IsOnOff(const MeshingParameter& parameter)
{
  return parameter.Kind == ParameterKind::Flag && parameter.IsOnByDefault();
}

std::string TypeOf(const MeshingParameter& parameter)
{
  switch (parameter.Kind)
  {
    case ParameterKind::Flag:
      return IsOnOff(parameter) ? "string-enumeration" : "boolean";
    case ParameterKind::Word:
      return "string-enumeration";
    case ParameterKind::Labels:
      return "integer-vector";
    case ParameterKind::LabelSizes:
    case ParameterKind::InterfaceSizes:
      return "string-vector";
    default:
      return IsText(parameter)                  ? "string"
        : parameter.Kind == ParameterKind::Real ? "double"
                                                : "integer";
  }
}

/** Applications give every number: 0 where there is none. */
std::string DefaultOf(const MeshingParameter& parameter)
{
  return TypeOf(parameter) == "boolean"                                    ? "false"
    : parameter.IsNumber() && parameter.IsOptional() && !IsText(parameter) ? "0"
                                                                           : parameter.Default;
}

Parameter FromTable(const MeshingParameter& parameter)
{
  Parameter made{ TypeOf(parameter), NameIn(UserInterface::Slicer, parameter), parameter.Name,
    LabelOf(parameter),
    Describe(UserInterface::Slicer, parameter) +
      (IsText(parameter) ? " Empty: the image has labels." : ""),
    DefaultOf(parameter), NameIn(UserInterface::CommandLine, parameter) };
  std::replace(made.Flag.begin(), made.Flag.end(), '-', '_');    // all that the model allows
  made.Option = made.Option.empty() ? "smoothing" : made.Option; // of labels and of grey values
  made.Rest =
    Enumeration(IsOnOff(parameter) ? std::vector<std::string>{ "on", "off" } : parameter.Words);
  if (parameter.Step > 0.0 && !IsText(parameter))
  {
    const ParameterRange range = parameter.Usual.value_or(parameter.Range);
    made.Rest = Element("constraints",
      TextElement("minimum", NumberText(range.Low)) +
        TextElement("maximum", NumberText(range.High)) +
        TextElement("step", NumberText(parameter.Step)));
  }
  return made;
}

/** In the order in which applications show them. */
constexpr ParameterGroup Groups[] = { ParameterGroup::GreyValues, ParameterGroup::Sampling,
  ParameterGroup::Labels, ParameterGroup::Shapes, ParameterGroup::Interfaces,
  ParameterGroup::Quality, ParameterGroup::Repair, ParameterGroup::Running };

std::vector<Parameter> ParametersOf(ParameterGroup group)
{
  std::vector<Parameter> parameters;
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    if (parameter.Group == group && !NameIn(UserInterface::Slicer, parameter).empty())
    {
      parameters.push_back(FromTable(parameter));
    }
  }
  if (group == ParameterGroup::Labels)
  {
    parameters.push_back({ "string-enumeration", "space", "space", "Coordinates",
      "Coordinates in the files: lps is that of DICOM and of Slicer's files, ras that of Slicer's "
      "scene. The files say which; Slicer reads both.",
      "lps", "space", Enumeration({ "lps", "ras" }) });
  }
  if (group == ParameterGroup::Shapes)
  {
    parameters.push_back({ "boolean", "quality", "hausdorff", "Compare with the label map",
      "Measure the finished mesh: the Hausdorff distance of its interfaces from those of the label "
      "map, errors of volumes, non-manifold edges. Not of isosurfaces.",
      "false", "hausdorff" });
  }
  return parameters;
}

/** Not in the description, as every module has it. */
constexpr const char* ReturnFile = "returnparameterfile";

/** What may be given. */
std::vector<Parameter> AllParameters()
{
  std::vector<Parameter> all = Files();
  all.push_back({ "file", ReturnFile, ReturnFile, "", "", "", "stats" });
  for (const ParameterGroup group : Groups)
  {
    const std::vector<Parameter> more = ParametersOf(group);
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

/** A figure, and where it stands in the program's statistics. */
struct Result
{
  const char* Type;
  const char* Name;
  const char* Place;
  const char* Label;
  const char* Description;
};

constexpr Result Results[] = {
  { "integer", "numberOfTetrahedra", "/elements", "Tetrahedra", "How many there are." },
  { "double", "usedDelta", "/delta", "Delta used", "The sampling distance that was used." },
  { "string", "missingLabels", "/lost_labels", "Labels without elements",
    "Labels of the image that the mesh lacks, because they are too small for delta." },
  { "integer", "missingComponents", "/lost_components", "Components without elements",
    "Number of connected components that should have elements but have none." },
  { "double", "smallestDihedralAngle", "/quality/min_dihedral", "Smallest dihedral angle",
    "Of all tetrahedra, in degrees." },
  { "double", "largestDihedralAngle", "/quality/max_dihedral", "Largest dihedral angle",
    "Of all tetrahedra, in degrees." },
  { "double", "largestRadiusEdge", "/quality/max_radius_edge", "Largest radius-edge ratio",
    "Circumradius over shortest edge, of all tetrahedra." },
  { "double", "smallestFacetAngle", "/quality/min_planar", "Smallest angle of triangles",
    "Of those on the interfaces, in degrees." },
  { "double", "hausdorffDistance", "/hausdorff/voxels/distance", "Hausdorff distance",
    "From the faces between voxels of different labels to the interfaces and back, if the mesh was "
    "compared with the label map." },
  { "integer", "nonManifoldEdges", "/topology/non_manifold_edges", "Non-manifold edges",
    "Edges of the boundary of a label that not exactly two of its triangles share, if the mesh was "
    "compared." },
  { "double", "volumeError", "/volume_error", "Error of volumes",
    "Of the label that has the largest, as a fraction of its volume, if the mesh was compared." },
};

// --- The description

std::string GroupElement(const std::string& label, const std::string& description, bool isAdvanced,
  const std::vector<Parameter>& parameters)
{
  std::string content = TextElement("label", label) + TextElement("description", description);
  for (const Parameter& p : parameters)
  {
    content += Element(p.Type,
      TextElement("name", p.Name) + TextElement("longflag", p.Flag.empty() ? "" : "--" + p.Flag) +
        TextElement("label", p.Label) + TextElement("description", p.Description) +
        TextElement("default", p.Default) + p.Rest,
      p.Attributes);
  }
  return Element("parameters", content, isAdvanced ? R"( advanced="true")" : "");
}

std::string DescribeModule()
{
  std::string xml = TextElement("category", "Segmentation.Meshing") +
    TextElement("title", "Segmentation To Tetrahedral Mesh") +
    TextElement("description",
      "Turns a label map into a conforming mesh of tetrahedra for finite elements. Tissues share "
      "the nodes of their common interfaces, and the interfaces are smooth, not voxel stairs. Also "
      "meshes the region that an isosurface of a volume bounds.") +
    TextElement("version", VOXPLEX_VERSION) +
    TextElement("documentation-url", VOXPLEX_REPOSITORY_URL "/Documentation/Slicer.md") +
    TextElement("license", "BSD-3-Clause") + TextElement("contributor", "The Voxplex developers") +
    GroupElement(
      "Input and output", "The label map, and the mesh that is made of it", false, Files());
  for (const ParameterGroup group : Groups)
  {
    xml += GroupElement(TitleOf(group), DescriptionOf(group), group >= ParameterGroup::Interfaces,
      ParametersOf(group));
  }
  std::vector<Parameter> returned;
  for (const Result& result : Results)
  {
    returned.push_back({ result.Type, result.Name, "", result.Label, result.Description,
      result.Type == std::string("string") ? "" : "0", "", Element("channel", "output") });
  }
  xml += GroupElement("Results", "What is known about the mesh afterwards.", false, returned);
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" + Element("executable", "\n" + xml);
}

// --- A run

/** What the application asks for. */
struct Call
{
  std::vector<std::string> Command{ "voxplex", "mesh", "--messages=slicer", "--progress" };
  std::string ReturnFile;
  bool Echo = false;
};

/** A flag of the description, and the value that the application gives it. */
using Given = std::pair<Parameter, std::string>;

/** What is no flag of the description goes to the program as it is. */
std::vector<Given> TakeFlags(const std::vector<std::string>& words, Call& call)
{
  const std::vector<Parameter> parameters = AllParameters();
  std::vector<Given> given;
  for (auto word = words.begin(); word != words.end(); ++word)
  {
    const std::size_t equals = std::min(word->find('='), word->size());
    std::string flag = word->starts_with("--") ? word->substr(2, equals - 2) : "";
    std::replace(flag.begin(), flag.end(), '-', '_');
    const auto found = std::find_if(parameters.begin(), parameters.end(),
      [&flag](const Parameter& one) { return one.Flag == flag && !flag.empty(); });
    const bool isFlag = found == parameters.end() || found->Type == "boolean";
    if (flag == "echo")
    {
      call.Echo = true;
    }
    else if (isFlag || (equals == word->size() && word + 1 == words.end()))
    {
      const std::string value = word->substr(std::min(equals + 1, word->size()));
      const bool isOn = value.empty() || value == "true" || value == "1";
      if (found == parameters.end() || !(isOn || value == "false" || value == "0"))
      {
        call.Command.push_back(*word);
      }
      else if (isOn)
      {
        call.Command.push_back("--" + found->Option);
      }
    }
    else
    {
      given.emplace_back(*found, equals < word->size() ? word->substr(equals + 1) : *++word);
    }
  }
  return given;
}

/** Whether the value says no more than its absence: applications give all numbers and words. */
bool IsDefault(const Parameter& parameter, const std::string& value)
{
  const auto number = io::ToNumber<double>(value);
  return value == parameter.Default ||
    (number && number == io::ToNumber<double>(parameter.Default));
}

void AddOption(const Parameter& parameter, const std::string& value, Call& call)
{
  const std::string option = "--" + parameter.Option;
  if (!parameter.Type.ends_with("-vector"))
  {
    call.Command.push_back(
      value == "off" && parameter.Default == "on" ? option : option + '=' + value);
    return;
  }
  for (std::string item : io::Split(value, ',')) // "3:7=0.4, 5=1"
  {
    if (parameter.Name == "interfaceSizes")
    {
      std::replace(item.begin(), item.end(), ':', ',');
    }
    call.Command.push_back(option + '=' + item);
  }
}

Call Translate(const std::vector<std::string>& words)
{
  Call call;
  const std::vector<Given> given = TakeFlags(words, call);
  const bool isGrey = std::any_of(given.begin(), given.end(),
    [](const Given& one) { return one.first.Name == "isovalue" && !one.second.empty(); });
  for (const auto& [parameter, value] : given)
  {
    const bool isIdle = parameter.Name == (isGrey ? "smoothing" : "greySmoothing"); // one option
    if (parameter.Name == ReturnFile)
    {
      call.ReturnFile = value;
      AddOption(parameter, value + ".json", call);
    }
    else if (!isIdle && !IsDefault(parameter, value))
    {
      AddOption(parameter, value, call);
    }
  }
  return call;
}

/** From the statistics in FILE.json the lines `name = value` of FILE. What was not measured has none. */
bool WriteResults(const std::string& path)
{
  json figures = json::parse(std::ifstream(path + ".json"), nullptr, false);
  if (figures.is_discarded()) // after --help or --version
  {
    return true;
  }
  std::remove((path + ".json").c_str());
  for (const json& label : figures["labels"])
  {
    if (const auto error = label.find("volume_error"); error != label.end() && error->is_number())
    {
      figures["volume_error"] =
        std::max(figures.value("volume_error", 0.0), std::abs(error->get<double>()));
    }
  }
  std::ofstream file(path);
  for (const Result& result : Results)
  {
    const json value = figures.value(json::json_pointer(result.Place), json());
    if (value.is_null())
    {
      continue;
    }
    std::string text = value.is_array() && result.Type == std::string("integer")
      ? std::to_string(value.size())
      : value.dump();
    std::erase_if(text, [](char c) { return c == '[' || c == ']'; });
    file << result.Name << " = " << text << '\n';
  }
  return bool(file.flush());
}

int Run(const std::vector<std::string>& words)
{
  if (std::find(words.begin(), words.end(), "--xml") != words.end())
  {
    std::cout << DescribeModule() << std::flush;
    return 0;
  }
  const Call call = Translate(words);
  std::vector<const char*> command;
  for (const std::string& word : call.Command)
  {
    command.push_back(word.c_str());
    std::cout << (call.Echo ? word + ' ' : "");
  }
  std::cout << (call.Echo ? "\n" : "") << std::flush;
  const int status = cli::RunProgram(static_cast<int>(command.size()), command.data());
  if (status == 0 && !call.ReturnFile.empty() && !WriteResults(call.ReturnFile))
  {
    std::cerr << "voxplex: cannot write '" << call.ReturnFile << "'\n";
    return 1;
  }
  return status;
}

} // namespace
} // namespace voxplex::slicer

int main(int argc, char* argv[])
{
  return voxplex::slicer::Run({ argv + 1, argv + argc });
}
