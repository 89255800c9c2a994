// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Parameters.h"

#include <map>
#include <stdexcept>
#include <string_view>

namespace voxplex::slicer
{
namespace
{

ParameterGroup Files()
{
  return { .Label = "Input and output",
    .Description = "The label map, and the mesh that is made of it",
    .Parameters = {
      { .Type = "image",
        .Name = "inputLabels",
        .Label = "Label map or volume",
        .Description =
          "The segmentation: one whole number a voxel, 0 is background; or, if Isosurface "
          "is on, a volume of grey values. Origin, spacing and axes are honoured.",
        .Index = 0,
        .Channel = "input",
        .NodeType = "any",
        .FileExtensions = ".nrrd" },
      { .Type = "table",
        .Name = "colorTable",
        .Label = "Colour table",
        .Description =
          "Names and colours of the labels, for the mesh. Optional: the names in a .seg.nrrd "
          "file are used without.",
        .LongFlag = "colortable",
        .Channel = "input",
        .NodeType = "color",
        .FileExtensions = ".ctbl" },
      { .Type = "geometry",
        .Name = "outputMesh",
        .Label = "Mesh",
        .Description = "The tetrahedra, with the label of each in the cell array Label.",
        .Index = 1,
        .Channel = "output",
        .NodeType = "model",
        .FileExtensions = ".vtu" },
      { .Type = "geometry",
        .Name = "outputSurfaces",
        .Label = "Interfaces",
        .Description = "The triangles between labels, and between labels and background, with both "
                       "labels of each in the cell array Labels. Optional.",
        .LongFlag = "surfaces",
        .Channel = "output",
        .NodeType = "model",
        .FileExtensions = ".vtp" },
    } };
}

/** What the module has beside the parameters of the table, in groups of the same title. */
std::vector<Parameter> OwnParameters(voxplex::ParameterGroup group)
{
  using Group = voxplex::ParameterGroup;
  switch (group)
  {
    case Group::GreyValues:
      return { { .Type = "boolean",
        .Name = "isosurface",
        .Label = "Isosurface",
        .Description = "The input has grey values, not labels.",
        .LongFlag = "isosurface",
        .Default = "false" } };
    case Group::Shapes:
      return { { .Type = "boolean",
        .Name = "quality",
        .Label = "Compare with the label map",
        .Description =
          "Measure the finished mesh: the Hausdorff distance of its interfaces from those of the "
          "label map, errors of volumes, non-manifold edges. Not of isosurfaces.",
        .LongFlag = "quality",
        .Default = "false" } };
    case Group::Labels:
      return { { .Type = "string-enumeration",
        .Name = "space",
        .Label = "Coordinates",
        .Description = "Coordinates in the files: LPS is that of DICOM and of Slicer's files, RAS "
                       "that of Slicer's scene. The files say which; Slicer reads both.",
        .LongFlag = "space",
        .Default = "LPS",
        .Elements = { "LPS", "RAS" } } };
    default:
      return {};
  }
}

/** Flags that are on by default have a value here: applications have no flags that switch off. */
bool IsOnOff(const MeshingParameter& parameter)
{
  return parameter.Kind == ParameterKind::Flag && parameter.IsOnByDefault();
}

const char* TypeOf(const MeshingParameter& parameter)
{
  switch (parameter.Kind)
  {
    case ParameterKind::Flag:
      return IsOnOff(parameter) ? "string-enumeration" : "boolean";
    case ParameterKind::Word:
      return "string-enumeration";
    case ParameterKind::Real:
      return "double";
    case ParameterKind::Whole:
      return "integer";
    case ParameterKind::Labels:
      return "integer-vector";
    case ParameterKind::LabelSizes:
    case ParameterKind::InterfaceSizes:
      return "string-vector";
    default:
      throw std::logic_error("the module cannot have the parameter " + parameter.Name);
  }
}

/** Applications always have a value: 0 where none is given, and flags of their own have the default false. */
std::string DefaultOf(const MeshingParameter& parameter)
{
  return TypeOf(parameter) == std::string_view("boolean") ? "false"
    : parameter.IsOptional() && parameter.IsNumber()      ? "0"
                                                          : parameter.Default;
}

Parameter FromTable(const MeshingParameter& parameter)
{
  Parameter made{ .Type = TypeOf(parameter),
    .Name = NameIn(UserInterface::Slicer, parameter),
    .Label = LabelOf(parameter),
    .Description = Describe(UserInterface::Slicer, parameter),
    .LongFlag = NameIn(UserInterface::SlicerCommand, parameter),
    .Default = DefaultOf(parameter),
    .Elements = IsOnOff(parameter) ? std::vector<std::string>{ "on", "off" } : parameter.Words,
    .Source = &parameter };
  const std::map<std::string, char> flags{ { "delta", 'd' }, { "smoothing", 's' },
    { "threads", 't' } };
  if (const auto flag = flags.find(parameter.Name); flag != flags.end())
  {
    made.Flag = flag->second;
  }
  if (parameter.Step > 0.0)
  {
    const ParameterRange range = parameter.Usual.value_or(parameter.Range);
    made.Limits = Constraints{ range.Low, range.High, parameter.Step };
  }
  return made;
}

/** The module's parameters of a group of the table. */
ParameterGroup FromTable(voxplex::ParameterGroup group)
{
  ParameterGroup made{ .Label = TitleOf(group),
    .Description = DescriptionOf(group),
    .Advanced = group >= voxplex::ParameterGroup::Interfaces };
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    if (parameter.Group == group && !NameIn(UserInterface::Slicer, parameter).empty())
    {
      made.Parameters.push_back(FromTable(parameter));
    }
  }
  const std::vector<Parameter> own = OwnParameters(group);
  const bool first = group == voxplex::ParameterGroup::GreyValues; // it switches the others on
  made.Parameters.insert(
    first ? made.Parameters.begin() : made.Parameters.end(), own.begin(), own.end());
  return made;
}

/** Something that the module returns. */
Parameter Returned(const char* type, const char* name, const char* label, const char* description)
{
  return { .Type = type,
    .Name = name,
    .Label = label,
    .Description = description,
    .Channel = "output",
    .Default = type == std::string_view("string") ? "" : "0" };
}

ParameterGroup Results()
{
  return { .Label = "Results",
    .Description = "What is known about the mesh afterwards.",
    .Parameters = {
      Returned("integer", "numberOfTetrahedra", "Tetrahedra", "How many there are."),
      Returned("double", "usedDelta", "Delta used", "The sampling distance that was used."),
      Returned("string", "missingLabels", "Labels without elements",
        "Labels of the image that the mesh lacks, because they are too small for delta."),
      Returned("integer", "missingComponents", "Components without elements",
        "Number of connected components that should have elements but have none."),
      Returned("double", "smallestDihedralAngle", "Smallest dihedral angle",
        "Of all tetrahedra, in degrees."),
      Returned("double", "largestDihedralAngle", "Largest dihedral angle",
        "Of all tetrahedra, in degrees."),
      Returned("double", "largestRadiusEdge", "Largest radius-edge ratio",
        "Circumradius over shortest edge, of all tetrahedra."),
      Returned("double", "smallestFacetAngle", "Smallest angle of triangles",
        "Of those on the interfaces, in degrees."),
      Returned("double", "hausdorffDistance", "Hausdorff distance",
        "From the faces between voxels of different labels to the interfaces and back, if the mesh "
        "was compared with the label map."),
      Returned("integer", "nonManifoldEdges", "Non-manifold edges",
        "Edges of the boundary of a label that not exactly two of its triangles share, if the mesh "
        "was compared."),
      Returned("double", "volumeError", "Error of volumes",
        "Of the label that has the largest, as a fraction of its volume, if the mesh was "
        "compared."),
    } };
}

} // namespace

const std::vector<ParameterGroup>& ParameterGroups()
{
  static const std::vector<ParameterGroup> groups = []
  {
    using Group = voxplex::ParameterGroup;
    std::vector<ParameterGroup> all{ Files() };
    for (const Group group : { Group::GreyValues, Group::Sampling, Group::Labels, Group::Shapes,
           Group::Interfaces, Group::Quality, Group::Repair, Group::Running })
    {
      all.push_back(FromTable(group));
    }
    all.push_back(Results());
    return all;
  }();
  return groups;
}

const std::vector<const Parameter*>& AllParameters()
{
  static const std::vector<const Parameter*> all = []
  {
    std::vector<const Parameter*> pointers;
    for (const ParameterGroup& group : ParameterGroups())
    {
      for (const Parameter& parameter : group.Parameters)
      {
        pointers.push_back(&parameter);
      }
    }
    return pointers;
  }();
  return all;
}

} // namespace voxplex::slicer
