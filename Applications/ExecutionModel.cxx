// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ExecutionModel.h"

#include "Base/NumberText.h"
#include "Text.h"
#include "WholeFiles.h"

#include <voxplexVersion.h>

#include <algorithm>
#include <cmath>
#include <optional>

using nlohmann::ordered_json;

namespace voxplex::cli
{
namespace
{

// https://example.org stands for where the repository is published, as in Plugins/Slicer.
constexpr const char* Head = R"(<?xml version="1.0" encoding="utf-8"?>
<executable>
<category>Segmentation.Meshing</category>
<title>Segmentation To Tetrahedral Mesh</title>
<description>Turns a label map into a conforming mesh of tetrahedra for finite elements. Tissues share the nodes of their common interfaces, and the interfaces are smooth, not voxel stairs. Also meshes the region that an isosurface of a volume bounds.</description>
<version>)" VOXPLEX_VERSION R"(</version>
<documentation-url>https://example.org/voxplex/Documentation/Slicer.md</documentation-url>
<license>BSD-3-Clause</license>
<contributor>The Voxplex developers</contributor>
<parameters><label>Input and output</label><description>The label map, and the mesh that is made of it</description>
<image type="any" fileExtensions=".nrrd"><name>inputLabels</name><channel>input</channel><index>0</index><label>Label map or volume</label>
<description>The segmentation: one whole number a voxel, 0 is background; or, with an isovalue, a volume of grey values. Origin, spacing and axes are honoured.</description></image>
<table type="color" fileExtensions=".ctbl"><name>colorTable</name><channel>input</channel><longflag>--label_table</longflag><label>Colour table</label>
<description>Names and colours of the labels, for the mesh. Optional: the names in a .seg.nrrd file are used without.</description></table>
<geometry type="model" fileExtensions=".vtu"><name>outputMesh</name><channel>output</channel><index>1</index><label>Mesh</label>
<description>The tetrahedra, with the label of each in the cell array Label.</description></geometry>
<geometry type="model" fileExtensions=".vtp"><name>outputSurfaces</name><channel>output</channel><longflag>--plc</longflag><label>Interfaces</label>
<description>The triangles between labels, and between labels and background, with both labels of each in the cell array Labels. Optional.</description></geometry>
<string-enumeration><name>space</name><longflag>--space</longflag><label>Coordinates</label><default>lps</default><element>lps</element><element>ras</element>
<description>Coordinates in the files: lps is that of DICOM and of Slicer's files, ras that of Slicer's scene. The files say which; Slicer reads both.</description></string-enumeration>
<boolean><name>quality</name><longflag>--hausdorff</longflag><label>Compare with the label map</label><default>false</default>
<description>Measure the finished mesh: the Hausdorff distance of its interfaces from those of the label map, errors of volumes, non-manifold edges. Not of isosurfaces.</description></boolean>
</parameters>
)";

/** A figure, and where it stands in the statistics. */
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

std::string Element(const std::string& tag, const std::string& content)
{
  return '<' + tag + '>' + content + "</" + tag + ">\n";
}

std::string TextElement(const std::string& tag, const std::string& text)
{
  return text.empty() ? "" : Element(tag, io::EscapeForXML(text));
}

/** A number for which 0 is a value like others, or whose default depends on the image. No value is an empty text. */
bool IsText(const MeshingParameter& parameter)
{
  return parameter.IsNumber() &&
    ((parameter.IsOptional() && parameter.Range.Low < 0.0) || !parameter.StandsFor.empty());
}

std::string TypeOf(const MeshingParameter& parameter)
{
  switch (parameter.Kind)
  {
    case ParameterKind::Flag:
      return "boolean";
    case ParameterKind::Word:
      return "string-enumeration";
    case ParameterKind::Labels:
    case ParameterKind::LabelSizes:
    case ParameterKind::InterfaceSizes:
      return "string-vector";
    default:
      return IsText(parameter) || !parameter.IsNumber() ? "string"
        : parameter.Kind == ParameterKind::Real         ? "double"
                                                        : "integer";
  }
}

std::string DefaultOf(const MeshingParameter& parameter)
{
  return parameter.Kind == ParameterKind::Flag          ? "false"
    : IsText(parameter)                                 ? ""
    : parameter.IsNumber() && parameter.Default.empty() ? "0"
                                                        : parameter.Default;
}

/** What a value may be. */
std::string ChoiceOf(const MeshingParameter& parameter)
{
  std::string elements;
  for (const std::string& word : parameter.Words)
  {
    elements += TextElement("element", word);
  }
  if (parameter.Step > 0.0 && !IsText(parameter))
  {
    const ParameterRange range = parameter.Usual.value_or(parameter.Range);
    elements += Element("constraints",
      Element("minimum", NumberText(range.Low)) + Element("maximum", NumberText(range.High)) +
        Element("step", NumberText(parameter.Step)));
  }
  return elements;
}

/** A flag that is on by default has an option that switches it off. */
std::string DescribeParameter(const MeshingParameter& parameter)
{
  constexpr UserInterface slicer = UserInterface::Slicer;
  std::string name = NameIn(slicer, parameter);
  std::string label = LabelOf(parameter);
  std::string text = Describe(slicer, parameter);
  if (parameter.IsOnByDefault())
  {
    name.front() -= 'a' - 'A';
    name.insert(0, "no");
    label += " off";
    text = "Do not " + InTermsOf(slicer, parameter.Help) + "; " + parameter.Zero + '.';
  }
  else if (IsText(parameter))
  {
    text += parameter.StandsFor.empty() ? " Empty: the image has labels."
                                        : " Empty: " + parameter.Default + ", of grey values " +
        FindParameter(parameter.StandsFor).Default + '.';
  }
  std::string flag = NameIn(UserInterface::CommandLine, parameter);
  std::replace(flag.begin(), flag.end(), '-', '_');
  return Element(TypeOf(parameter),
    Element("name", name) + Element("longflag", "--" + flag) + TextElement("label", label) +
      TextElement("description", text) + TextElement("default", DefaultOf(parameter)) +
      ChoiceOf(parameter));
}

} // namespace

std::string DescribeModule()
{
  std::string xml = Head;
  std::optional<ParameterGroup> last;
  const auto beginGroup = [&xml](const char* title, const char* description, bool isAdvanced)
  {
    xml += std::string(isAdvanced ? "<parameters advanced=\"true\">" : "<parameters>") +
      TextElement("label", title) + TextElement("description", description);
  };
  for (const MeshingParameter& parameter : MeshingParameters()) // whose groups are in order
  {
    if (NameIn(UserInterface::Slicer, parameter).empty() ||
      NameIn(UserInterface::CommandLine, parameter).empty())
    {
      continue;
    }
    if (parameter.Group != last)
    {
      xml += last ? "</parameters>\n" : "";
      last = parameter.Group;
      beginGroup(TitleOf(*last), DescriptionOf(*last), *last >= ParameterGroup::Interfaces);
    }
    xml += DescribeParameter(parameter);
  }
  xml += "</parameters>\n";
  beginGroup("Results", "What is known about the mesh afterwards.", false);
  for (const Result& result : Results)
  {
    const bool isText = result.Type == std::string_view("string");
    xml += Element(result.Type,
      Element("name", result.Name) + Element("label", result.Label) +
        Element("description", result.Description) + Element("default", isText ? "" : "0") +
        Element("channel", "output"));
  }
  return xml + "</parameters>\n</executable>\n";
}

bool IsLeftAsDescribed(const MeshingParameter& parameter, std::string_view text)
{
  const std::string described = DefaultOf(parameter);
  const auto number = io::ToNumber<double>(text);
  return !IsText(parameter) &&
    (text == described || (number && number == io::ToNumber<double>(described)));
}

void WriteResults(const ordered_json& report, const std::string& path, const io::WholeFiles& files)
{
  ordered_json figures = report;
  for (const ordered_json& label : report["labels"])
  {
    if (const ordered_json error = label.value("volume_error", ordered_json()); error.is_number())
    {
      figures["volume_error"] =
        std::max(figures.value("volume_error", 0.0), std::abs(error.get<double>()));
    }
  }
  files.WriteText(path,
    [&figures](io::TextFile& file)
    {
      for (const Result& result : Results)
      {
        const ordered_json value =
          figures.value(ordered_json::json_pointer(result.Place), ordered_json());
        const bool isCount = value.is_array() && result.Type == std::string_view("integer");
        std::string text = isCount ? std::to_string(value.size()) : value.dump();
        std::erase_if(text, [](char c) { return c == '[' || c == ']'; });
        file << (value.is_null() ? "" : result.Name + (" = " + text) + '\n');
      }
    });
}

} // namespace voxplex::cli
