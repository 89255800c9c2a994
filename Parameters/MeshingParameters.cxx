// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshingParameters.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <stdexcept>

namespace voxplex
{
namespace
{

struct GroupText
{
  const char* Title;
  const char* Description;
};

/** In the order of ParameterGroup. */
constexpr GroupText GroupTexts[] = {
  { "Grey-value images",
    "Mesh the region that an isosurface of a grey-value image bounds, as one label." },
  { "Sampling distance and element sizes",
    "How fine the mesh is. Lengths are in the unit of the image, usually millimetres." },
  { "Labels and coordinates", "What is meshed, and where it lies." },
  { "Shapes and small objects", "Better shapes, and objects that are small compared with delta." },
  { "Sizes of interfaces", "How delta and element sizes vary from place to place." },
  { "Quality", "The defaults suit finite elements." },
  { "Space-time images (four dimensions, the last is time)",
    "They become one mesh of space and time." },
  { "Running", "How the machine is used." },
};

std::string Capitalised(std::string text)
{
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::string CamelCase(const std::string& name)
{
  const std::size_t dash = name.find('-');
  return dash == std::string::npos
    ? name
    : name.substr(0, dash) + Capitalised(CamelCase(name.substr(dash + 1)));
}

std::string Joined(std::string name, char with)
{
  std::replace(name.begin(), name.end(), '-', with);
  return name;
}

/** The name of a parameter in texts of the interface. */
std::string Mention(UserInterface interface, const std::string& name)
{
  const MeshingParameter& parameter = FindParameter(name);
  switch (interface)
  {
    case UserInterface::CommandLine:
      return "--" + NameIn(interface, parameter);
    case UserInterface::Slicer:
      return LabelOf(parameter);
    default:
      return NameIn(interface, parameter);
  }
}

/** Replaces the names in braces. */
std::string Resolve(UserInterface interface, const std::string& text)
{
  std::string resolved;
  std::size_t end = 0;
  for (std::size_t brace; (brace = text.find('{', end)) != std::string::npos;)
  {
    resolved += text.substr(end, brace - end);
    end = text.find('}', brace) + 1;
    resolved += Mention(interface, text.substr(brace + 1, end - brace - 2));
  }
  return resolved + text.substr(end);
}

/** The form in which lists are written. */
const char* FormOf(UserInterface interface, ParameterKind kind)
{
  struct Form
  {
    ParameterKind Kind;
    const char* CommandLine;
    const char* Slicer;
    const char* Python;
  };
  static constexpr Form forms[] = {
    { ParameterKind::Labels, "1,2,5 or Tibia,Femur; may be repeated",
      "1,2,5; empty: all are meshed", "numbers or names" },
    { ParameterKind::LabelSizes, "3=1.5 or Tibia=1.5; may be repeated", "3=1.5,7=2",
      "{label: length}, labels being numbers or names" },
    { ParameterKind::InterfaceSizes,
      "3=0.5 for one label, 3,7=0.5 or Tibia,0=2 for two; may be repeated",
      "3=0.5 for one label, 3:7=0.4 for two; separated by commas",
      "{label: length} and {(label, label): length}" },
    { ParameterKind::Bytes, "such as 8G", "", "in bytes" },
    { ParameterKind::Times, "0,40,80,160", "", "" },
  };
  for (const Form& form : forms)
  {
    if (form.Kind == kind)
    {
      return interface == UserInterface::CommandLine ? form.CommandLine
        : interface == UserInterface::Slicer         ? form.Slicer
                                                     : form.Python;
    }
  }
  return "";
}

/** The default, or the value that switches the parameter off: 0, off, in Python False. */
std::string ValueText(UserInterface interface, const MeshingParameter& p, bool isDefault)
{
  if (p.Kind != ParameterKind::Flag)
  {
    return isDefault ? p.Default : "0";
  }
  const bool isOn = isDefault && p.IsOnByDefault();
  return interface == UserInterface::Python ? (isOn ? "True" : "False") : (isOn ? "on" : "off");
}

std::string DefaultNote(UserInterface interface, const MeshingParameter& p)
{
  if (p.IsOptional())
  {
    return p.Zero.empty() ? "" : "default: " + p.Zero;
  }
  std::string text = "default " + ValueText(interface, p, true);
  if (!p.StandsFor.empty() && NameIn(interface, FindParameter(p.StandsFor)).empty())
  {
    text += ", of grey values " + FindParameter(p.StandsFor).Default;
  }
  return text;
}

std::string ForceNote(UserInterface interface, const MeshingParameter& p)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::string beyond = BeyondLimit(p, p.ForceBelow ? -infinity : infinity);
  return beyond.empty() ? "" : beyond + " only with " + Mention(interface, "force");
}

/** Notes about the values, without those that the application itself shows. */
std::vector<std::string> Notes(UserInterface interface, const MeshingParameter& p)
{
  const bool slicer = interface == UserInterface::Slicer;
  const bool isOption = interface == UserInterface::CommandLine;
  const bool isSwitch = p.Kind == ParameterKind::Flag && (isOption || !p.IsOnByDefault());
  std::vector<std::string> notes{ FormOf(interface, p.Kind) };
  if (!slicer && !isSwitch)
  {
    notes.push_back(DefaultNote(interface, p));
  }
  if (!p.Zero.empty() && !isSwitch && (slicer || !p.IsOptional()))
  {
    notes.push_back(ValueText(interface, p, false) + ": " + p.Zero);
  }
  notes.push_back(ForceNote(interface, p));
  if (p.Dimension == 3 && !slicer)
  {
    notes.push_back("3D only");
  }
  if (p.Dimension == 4 && !isOption) // options are under a headline
  {
    notes.push_back("space-time only");
  }
  std::erase(notes, "");
  return notes;
}

} // namespace

bool MeshingParameter::IsNumber() const
{
  return this->Kind == ParameterKind::Real || this->Kind == ParameterKind::Whole ||
    this->Kind == ParameterKind::Bytes;
}

const MeshingParameter& FindParameter(std::string_view name)
{
  const auto& all = MeshingParameters();
  const auto found = std::find_if(all.begin(), all.end(),
    [name](const MeshingParameter& parameter) { return parameter.Name == name; });
  if (found == all.end())
  {
    throw std::logic_error("there is no parameter '" + std::string(name) + "'");
  }
  return *found;
}

std::string NameIn(UserInterface interface, const MeshingParameter& parameter)
{
  const std::string& given = interface == UserInterface::CommandLine ? parameter.Option
    : interface == UserInterface::Slicer                             ? parameter.Slicer
                                                                     : parameter.Python;
  if (interface == UserInterface::Slicer && parameter.Dimension == 4)
  {
    return "";
  }
  if (!given.empty())
  {
    return given == MeshingParameter::None ? "" : given;
  }
  switch (interface)
  {
    case UserInterface::CommandLine:
      return (parameter.IsOnByDefault() ? "no-" : "") + parameter.Name;
    case UserInterface::Slicer:
      return CamelCase(parameter.Name);
    default:
      return Joined(parameter.Name, '_');
  }
}

std::string LabelOf(const MeshingParameter& parameter)
{
  return parameter.Label.empty() ? Capitalised(Joined(parameter.Name, ' ')) : parameter.Label;
}

std::string PropertyOf(const MeshingParameter& parameter)
{
  return parameter.Property.empty() ? Capitalised(CamelCase(parameter.Name)) : parameter.Property;
}

std::string Describe(UserInterface interface, const MeshingParameter& parameter)
{
  std::string text = Resolve(interface, parameter.Help);
  if (interface == UserInterface::CommandLine && parameter.IsOnByDefault())
  {
    text = "do not " + text + (parameter.Zero.empty() ? "" : "; " + parameter.Zero);
  }
  std::string separator = " (";
  for (const std::string& note : Notes(interface, parameter))
  {
    text += separator + note;
    separator = "; ";
  }
  text += separator == "; " ? ")" : "";
  return interface == UserInterface::CommandLine ? text : Capitalised(text) + '.';
}

std::string BeyondLimit(const MeshingParameter& parameter, double value)
{
  return parameter.ForceBelow && value < *parameter.ForceBelow
    ? "below " + NumberText(*parameter.ForceBelow)
    : parameter.ForceAbove && value > *parameter.ForceAbove
    ? "above " + NumberText(*parameter.ForceAbove)
    : "";
}

const char* TitleOf(ParameterGroup group)
{
  return GroupTexts[static_cast<int>(group)].Title;
}

const char* DescriptionOf(ParameterGroup group)
{
  return GroupTexts[static_cast<int>(group)].Description;
}

std::string NumberText(double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

} // namespace voxplex
