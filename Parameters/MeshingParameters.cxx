// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshingParameters.h"

#include "Base/NumberText.h"

#include <algorithm>
#include <cctype>
#include <cmath>
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
  { "Reading of images", "In place of what the file says, or where it leaves a choice." },
  { "Grey-value images",
    "Mesh the region that an isosurface of a grey-value image bounds, as one label." },
  { "Sampling distance and element sizes",
    "How fine the mesh is. Lengths are in the unit of the image, usually millimetres." },
  { "Labels and coordinates", "What is meshed, and where it lies." },
  { "Shapes and small objects", "Better shapes, and objects that are small compared with delta." },
  { "Sizes of interfaces", "How delta and element sizes vary from place to place." },
  { "Quality", "The defaults suit finite elements." },
  { "Repair of segmentations", "Changes of the image before it is meshed; each is reported." },
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

/** FacetAngle as "Facet Angle". */
std::string Spaced(const std::string& name)
{
  std::string spaced;
  for (const char c : name)
  {
    spaced += std::isupper(static_cast<unsigned char>(c)) && !spaced.empty() ? " " : "";
    spaced += c;
  }
  return spaced;
}

std::string Joined(std::string name, char with)
{
  std::replace(name.begin(), name.end(), '-', with);
  return name;
}

/** The name of a parameter in texts of the interface; that of VTK if the interface has none. */
std::string Mention(UserInterface interface, const MeshingParameter& parameter)
{
  const std::string name = NameIn(interface, parameter);
  if (name.empty())
  {
    return Mention(UserInterface::VTK, parameter);
  }
  const bool isMethod = parameter.Kind >= ParameterKind::Labels || parameter.IsOfReading();
  const bool isAdded =
    parameter.Kind == ParameterKind::Labels || parameter.Kind == ParameterKind::Times;
  switch (interface)
  {
    case UserInterface::VTK:
    case UserInterface::ITK:
      return isMethod ? (isAdded ? "Add" : "Set") + name + "()" : name;
    case UserInterface::CommandLine:
      return "--" + name;
    case UserInterface::Slicer:
      return LabelOf(parameter);
    case UserInterface::Python:
      return parameter.Kind == ParameterKind::Flag && !parameter.IsOnByDefault() ? name + "=True"
                                                                                 : name;
    case UserInterface::ParaView:
      return "'" + name + "'";
  }
  return name;
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
      "1,2,5 or Tibia,Femur; empty: all are meshed", "numbers or names" },
    { ParameterKind::LabelSizes, "3=1.5,7=2 or Tibia=1.5; may be repeated",
      "3=1.5,7=2 or Tibia=1.5", "{label: length}, labels being numbers or names" },
    { ParameterKind::InterfaceSizes,
      "3=0.5 for one label, 3,7=0.5 or Tibia,0=2 for two; may be repeated",
      "3=0.5 for one label, 3,7=0.5 or Tibia,0=2 for two; separated by commas",
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
        : interface == UserInterface::Python         ? form.Python
                                                     : "";
    }
  }
  return "";
}

/** The default, or the value that switches the parameter off: 0, off, in Python False, an empty text. */
std::string ValueText(UserInterface interface, const MeshingParameter& p, bool isDefault)
{
  if (p.Kind != ParameterKind::Flag)
  {
    return isDefault ? p.Default : p.Kind == ParameterKind::File ? "empty" : "0";
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
  return beyond.empty() ? "" : beyond + " only with " + Mention(interface, FindParameter("force"));
}

/** Notes about the values, without those that the application itself shows. */
std::vector<std::string> Notes(UserInterface interface, const MeshingParameter& p)
{
  const bool isPanel = interface == UserInterface::Slicer || interface == UserInterface::ParaView;
  const bool isOption = interface == UserInterface::CommandLine;
  const bool isSwitch = p.Kind == ParameterKind::Flag && (isOption || !p.IsOnByDefault());
  std::vector<std::string> notes{ FormOf(interface, p.Kind) };
  if (!isPanel && !isSwitch)
  {
    notes.push_back(DefaultNote(interface, p));
  }
  if (!p.Zero.empty() && !isSwitch && (isPanel || !p.IsOptional()))
  {
    notes.push_back(ValueText(interface, p, false) + ": " + p.Zero);
  }
  notes.push_back(ForceNote(interface, p));
  if (p.Dimension == 3 && !isPanel)
  {
    notes.push_back("3D only");
  }
  if (p.Dimension == 4 && !isOption && !isPanel) // options are under a headline
  {
    notes.push_back("space-time only");
  }
  std::erase(notes, "");
  return notes;
}

/** What messages name beside the parameters of the table. */
struct Term
{
  const char* Name;
  const char* In[6]; ///< by UserInterface; null: its users do not have it
};

constexpr Term Terms[] = {
  { "isosurface",
    { "SetInputModeToIsosurface()", "--isovalue", "Isovalue", "isovalue", "'Input Mode'",
      "vtkImageToTetMeshFilter" } },
  { "array", { "SetInputArrayToProcess()", nullptr, nullptr, nullptr, "'Label Array'" } },
  // Of readers.
  { "trust",
    { ", or use SetDataFilesAnywhere() if you trust the header", nullptr,
      ", or save the image as one file" } },
  { "anywhere",
    { "SetDataFilesAnywhere()", "--data-files-anywhere", nullptr,
      "read_segmentation(..., data_files_anywhere=True)" } },
  { "resample",
    { "ResampleMasksOn()", "--resample-masks", nullptr,
      "read_segmentation(..., resample_masks=True)" } },
  { "series", { "SetSeriesUID()", "--series", nullptr, "series_uid" } },
  { "spacing", { "SetSpacing()", "--spacing", "3D Slicer's module Volumes", "spacing=" } },
  { "origin", { "SetOrigin()", "--origin", nullptr, "origin=" } },
  { "direction", { "SetDirection()", "--direction", nullptr, "direction=" } },
  { "weight", { "SetTimeScale()", "--time-scale", nullptr, "time_scale=" } },
  { "times", { "AddFrameTime()", "--frame-times" } },
};

/** What an interface calls it; null if its users do not have it. */
const char* NameIn(UserInterface interface, const Term& term)
{
  return term.In[static_cast<int>(interface)];
}

/** What stands for a name in braces, perhaps with a text behind a colon; nothing if it is no name. */
std::optional<std::string> Resolved(UserInterface interface, const std::string& mark)
{
  const std::size_t colon = mark.find(':');
  const std::string name = mark.substr(0, colon);
  std::optional<std::string> mention;
  for (const Term& term : Terms)
  {
    if (name == term.Name)
    {
      mention = NameIn(interface, term) ? NameIn(interface, term) : "";
    }
  }
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    if (name == parameter.Name)
    {
      const bool isConditional = colon != std::string::npos;
      mention = isConditional ? NameIn(interface, parameter) : Mention(interface, parameter);
    }
  }
  return !mention || mention->empty() || colon == std::string::npos ? mention
                                                                    : mark.substr(colon + 1);
}

/** The methods that messages of readers name. */
std::string WithoutMethods(UserInterface interface, std::string message)
{
  // By hand: to compile one std::regex takes longer than the rest of the table.
  constexpr std::string_view series = "SetSeriesUID(\"";
  const bool isOption = interface == UserInterface::CommandLine;
  const bool isNamed = isOption || interface == UserInterface::Python;
  for (std::size_t at = 0; isNamed && (at = message.find(series, at)) != std::string::npos; ++at)
  {
    const std::size_t quote = message.find('"', at + series.size());
    if (quote != std::string::npos && message.compare(quote, 2, "\")") == 0)
    {
      message.replace(quote, 2, isOption ? "" : "\"");
      message.replace(at, series.size(), isOption ? "--series " : "series_uid=\"");
    }
  }
  for (const Term& term : Terms)
  {
    const std::string_view method = NameIn(UserInterface::VTK, term);
    const char* const name = NameIn(interface, term);
    const std::string_view ours = name ? name : method;
    for (std::size_t at = 0; (at = message.find(method, at)) != std::string::npos;
         at += ours.size())
    {
      message.replace(at, method.size(), ours);
    }
  }
  return message;
}

} // namespace

std::string InTermsOf(UserInterface interface, const std::string& message)
{
  std::string resolved;
  std::size_t end = 0;
  for (std::size_t brace; (brace = message.find('{', end)) != std::string::npos;)
  {
    const std::size_t close = std::min(message.find('}', brace), message.size());
    const auto mark = Resolved(interface, message.substr(brace + 1, close - brace - 1));
    resolved += message.substr(end, brace - end) + mark.value_or("{");
    end = mark ? close + 1 : brace + 1;
  }
  resolved += message.substr(end);
  return interface == UserInterface::VTK ? resolved : WithoutMethods(interface, resolved);
}

bool MeshingParameter::IsNumber() const
{
  return this->Kind == ParameterKind::Real || this->Kind == ParameterKind::Whole ||
    this->Kind == ParameterKind::Bytes;
}

bool MeshingParameter::IsOfLabels() const
{
  return this->Kind == ParameterKind::Labels || this->Kind == ParameterKind::LabelSizes ||
    this->Kind == ParameterKind::InterfaceSizes;
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
  using P = MeshingParameter;
  static constexpr std::string P::*columns[] = { &P::Property, &P::Option, &P::Slicer, &P::Python,
    &P::Panel, &P::Property }; // by UserInterface
  const std::string& given = parameter.*columns[static_cast<int>(interface)];
  if (interface == UserInterface::Slicer && parameter.Dimension == 4)
  {
    return "";
  }
  if (interface == UserInterface::ITK && parameter.Name == "threads")
  {
    return "NumberOfWorkUnits";
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
    case UserInterface::Python:
      return Joined(parameter.Name, '_');
    case UserInterface::ParaView:
      return Spaced(PropertyOf(parameter));
    default:
      return PropertyOf(parameter);
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
  std::string text = InTermsOf(interface, parameter.Help);
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

std::string FaultOf(const MeshingParameter& parameter, double value, bool force)
{
  const ParameterRange& range = parameter.Range;
  const bool mayBeZero =
    parameter.IsOptional() || (range.Low == 0.0 && !range.LowIsOutside && !parameter.Zero.empty());
  const bool isInside = std::isfinite(value) && value <= range.High &&
    (range.LowIsOutside ? value > range.Low : value >= range.Low);
  const bool isBeyond = !force && !BeyondLimit(parameter, value).empty();
  if ((isInside && !isBeyond) || (mayBeZero && value == 0.0))
  {
    return "";
  }
  const std::string low =
    NumberText(isBeyond ? parameter.ForceBelow.value_or(range.Low) : range.Low);
  const std::string high =
    NumberText(isBeyond ? parameter.ForceAbove.value_or(range.High) : range.High);
  const bool isBounded = std::isfinite(range.High);
  const bool isPositive = range.Low == 0.0 && (range.LowIsOutside || mayBeZero);
  std::string must = isBounded ? "between " + low + " and " + high
    : isPositive               ? "positive and finite"
    : std::isfinite(range.Low) ? "at least " + low
                               : "finite";
  if (mayBeZero && !isBounded)
  {
    must += ", or 0 (" + parameter.Zero + ")";
  }
  if (isBeyond)
  {
    must += std::string(", because ") + (parameter.ForceBelow ? "below" : "above") + " it " +
      parameter.ForceWhy + "; {force} goes " +
      (parameter.ForceBelow ? "down to " + NumberText(range.Low)
                            : "up to " + NumberText(range.High));
  }
  return "{" + parameter.Name + "} is " + NumberText(value) + "; it must be " + must + ".";
}

std::string ClashOf(const std::function<bool(const MeshingParameter&)>& isGiven)
{
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    for (const ParameterRule* const rule : { &parameter.Needs, &parameter.Excludes })
    {
      const bool isBroken = !rule->Other.empty() && isGiven(parameter) &&
        isGiven(FindParameter(rule->Other)) == (rule == &parameter.Excludes);
      if (isBroken)
      {
        return "{" + parameter.Name + "}" + rule->Text;
      }
    }
  }
  return "";
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

} // namespace voxplex
