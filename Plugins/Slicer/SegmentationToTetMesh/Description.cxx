// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Description.h"

#include "Base/NumberText.h"
#include "MeshingParameters.h"
#include "Parameters.h"
#include "Text.h"

#include <voxplexVersion.h>

#include <sstream>

namespace voxplex::slicer
{

const char* const ModuleSummary =
  "Turns a label map into a conforming mesh of tetrahedra for finite elements. Tissues share the "
  "nodes of their common interfaces, and the interfaces are smooth, not voxel stairs. Also meshes "
  "the region that an isosurface of a volume bounds.";

namespace
{

class Writer
{
public:
  void Open(const std::string& tag, const std::string& attributes = "")
  {
    this->Indent() << '<' << tag << attributes << ">\n";
    this->Depth += 1;
  }

  void Close(const std::string& tag)
  {
    this->Depth -= 1;
    this->Indent() << "</" << tag << ">\n";
  }

  void Element(const std::string& tag, const std::string& text)
  {
    this->Indent() << '<' << tag << '>' << io::EscapeForXML(text) << "</" << tag << ">\n";
  }

  std::string Text() const { return this->Stream.str(); }

private:
  std::ostream& Indent() { return this->Stream << std::string(2 * this->Depth, ' '); }

  std::ostringstream Stream;
  std::size_t Depth = 0;
};

std::string Attribute(const char* name, const std::string& value)
{
  return value.empty() ? "" : std::string(" ") + name + "=\"" + io::EscapeForXML(value) + '"';
}

void Write(Writer& xml, const Parameter& parameter)
{
  xml.Open(parameter.Type,
    Attribute("type", parameter.NodeType) + Attribute("fileExtensions", parameter.FileExtensions));
  xml.Element("name", parameter.Name);
  if (parameter.Flag)
  {
    xml.Element("flag", std::string("-") + parameter.Flag);
  }
  if (!parameter.LongFlag.empty())
  {
    xml.Element("longflag", "--" + parameter.LongFlag);
  }
  xml.Element("label", parameter.Label);
  if (!parameter.Channel.empty())
  {
    xml.Element("channel", parameter.Channel);
  }
  if (parameter.Index >= 0)
  {
    xml.Element("index", std::to_string(parameter.Index));
  }
  xml.Element("description", parameter.Description);
  if (!parameter.Default.empty())
  {
    xml.Element("default", parameter.Default);
  }
  for (const std::string& element : parameter.Elements)
  {
    xml.Element("element", element);
  }
  if (parameter.Limits)
  {
    xml.Open("constraints");
    xml.Element("minimum", NumberText(parameter.Limits->Minimum));
    xml.Element("maximum", NumberText(parameter.Limits->Maximum));
    xml.Element("step", NumberText(parameter.Limits->Step));
    xml.Close("constraints");
  }
  xml.Close(parameter.Type);
}

} // namespace

std::string DescribeModule()
{
  Writer xml;
  xml.Open("executable");
  xml.Element("category", "Segmentation.Meshing");
  xml.Element("title", "Segmentation To Tetrahedral Mesh");
  xml.Element("description", ModuleSummary);
  xml.Element("version", VOXPLEX_VERSION);
  xml.Element("documentation-url", VOXPLEX_REPOSITORY_URL "/Documentation/Slicer.md");
  xml.Element("license", "BSD-3-Clause");
  xml.Element("contributor", "The Voxplex developers");
  for (const ParameterGroup& group : ParameterGroups())
  {
    xml.Open("parameters", group.Advanced ? Attribute("advanced", "true") : "");
    xml.Element("label", group.Label);
    xml.Element("description", group.Description);
    for (const Parameter& parameter : group.Parameters)
    {
      Write(xml, parameter);
    }
    xml.Close("parameters");
  }
  xml.Close("executable");
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" + xml.Text();
}

} // namespace voxplex::slicer
