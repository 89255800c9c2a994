// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Arguments.h"

#include "Description.h"
#include "Errors.h"
#include "OptionValues.h"
#include "Parameters.h"

#include <boost/program_options.hpp>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <optional>
#include <sstream>

namespace po = boost::program_options;

namespace voxplex::slicer
{
namespace
{

using cli::UsageError;

/** Collects the arguments without flags. */
constexpr const char* Places = "places";

const char* ValueName(const Parameter& parameter)
{
  return !parameter.NodeType.empty() ? "FILE"
    : parameter.Type == "double"     ? "NUMBER"
    : parameter.Type == "integer"    ? "WHOLE"
                                     : "TEXT";
}

/** The value of a flag may be empty: applications give empty lists so. */
void AddOption(po::options_description& options, const Parameter& parameter)
{
  std::string names = parameter.LongFlag;
  if (parameter.Flag)
  {
    names += std::string(",") + parameter.Flag;
  }
  std::string text = parameter.Description;
  for (std::size_t i = 0; i < parameter.Elements.size(); ++i)
  {
    text += (i == 0 ? " One of: " : ", ") + parameter.Elements[i];
  }
  if (parameter.IsFlag())
  {
    options.add_options()(names.c_str(), text.c_str());
    return;
  }
  if (!parameter.Default.empty())
  {
    text += " (default " + parameter.Default + ")";
  }
  options.add_options()(
    names.c_str(), po::value<std::string>()->value_name(ValueName(parameter)), text.c_str());
}

po::options_description StandardOptions()
{
  const auto text = [](const char* name) { return po::value<std::string>()->value_name(name); };
  po::options_description options("Flags that every module has");
  options.add_options() //
    ("returnparameterfile", text("FILE"),
      "write the results into this file, as lines of the form name = value") //
    ("processinformationaddress", text("ADDRESS"),
      "where the calling application, in the same process, has its ModuleProcessInformation") //
    ("echo", "print the values of all parameters before the run")                             //
    ("xml", "print the description of the module")                                            //
    ("logo", "print the logo of the module")                                                  //
    ("help,h", "print this text")                                                             //
    ("version", "print the version");
  return options;
}

po::options_description DeclareOptions()
{
  po::options_description all;
  for (const ParameterGroup& group : ParameterGroups())
  {
    po::options_description options(group.Label);
    for (const Parameter& parameter : group.Parameters)
    {
      if (!parameter.LongFlag.empty())
      {
        AddOption(options, parameter);
      }
    }
    if (!options.options().empty())
    {
      all.add(options);
    }
  }
  return all.add(StandardOptions());
}

/** Those that come by their place, in order. */
std::vector<const Parameter*> PlacedParameters()
{
  std::vector<const Parameter*> placed;
  std::copy_if(AllParameters().begin(), AllParameters().end(), std::back_inserter(placed),
    [](const Parameter* parameter) { return parameter->Index >= 0; });
  std::sort(placed.begin(), placed.end(),
    [](const Parameter* a, const Parameter* b) { return a->Index < b->Index; });
  return placed;
}

po::variables_map Parse(int argc, const char* const* argv)
{
  namespace style = po::command_line_style;
  po::options_description options = DeclareOptions();
  options.add_options()(Places, po::value<std::vector<std::string>>());
  po::variables_map values;
  try
  {
    po::store(po::command_line_parser(argc, argv)
                .options(options)
                .positional(po::positional_options_description().add(Places, -1))
                .style(style::allow_long | style::long_allow_adjacent | style::long_allow_next |
                  style::allow_short | style::allow_dash_for_short | style::short_allow_next)
                .run(),
      values);
    po::notify(values);
  }
  catch (const po::error& error)
  {
    throw UsageError(error.what());
  }
  return values;
}

/** Those with flags, given or default. */
std::map<std::string, std::string> ValuesOf(const po::variables_map& given)
{
  std::map<std::string, std::string> values;
  for (const Parameter* parameter : AllParameters())
  {
    const bool isGiven = !parameter->LongFlag.empty() && given.count(parameter->LongFlag);
    values[parameter->Name] = !isGiven ? parameter->Default
      : parameter->IsFlag()            ? "true"
                                       : given[parameter->LongFlag].as<std::string>();
  }
  return values;
}

void TakePlaces(const po::variables_map& given, std::map<std::string, std::string>& values)
{
  const auto texts =
    given.count(Places) ? given[Places].as<std::vector<std::string>>() : std::vector<std::string>();
  const auto placed = PlacedParameters();
  if (texts.size() > placed.size())
  {
    throw UsageError(cli::Quoted(texts[placed.size()]) + " is one argument too many");
  }
  for (std::size_t i = 0; i < placed.size(); ++i)
  {
    if (i >= texts.size() || texts[i].empty())
    {
      throw UsageError("the " + std::string(i == 0 ? "input" : "output") +
        " is missing: " + placed[i]->Name + " (" + placed[i]->Label + ")");
    }
    values[placed[i]->Name] = texts[i];
  }
}

ModuleProcessInformation* ParseAddress(const std::string& text)
{
  void* address = nullptr;
  if (std::sscanf(text.c_str(), "%p", &address) != 1)
  {
    throw UsageError("--processinformationaddress: " + cli::Quoted(text) + " is not an address");
  }
  return static_cast<ModuleProcessInformation*>(address);
}

Arguments::Request RequestOf(const po::variables_map& given)
{
  if (given.count("help"))
  {
    return Arguments::Request::Help;
  }
  if (given.count("version"))
  {
    return Arguments::Request::Version;
  }
  if (given.count("xml"))
  {
    return Arguments::Request::Description;
  }
  return given.count("logo") ? Arguments::Request::Logo : Arguments::Request::Run;
}

/** What commas separate. Scripts of applications turn lists into text with spaces after the commas. */
std::vector<std::string> Items(std::string text)
{
  text.erase(std::remove(text.begin(), text.end(), ' '), text.end());
  return text.empty() ? std::vector<std::string>() : cli::SplitAtCommas(text);
}

/** Labels have no names here: applications know their segments by number. */
std::int64_t LabelNumber(const std::string& option, const std::string& text)
{
  const std::optional<std::int64_t> number = cli::ParseLabelNumber(option, text);
  if (!number)
  {
    throw UsageError("--" + option + ": " + cli::Quoted(text) + " is not the number of a label");
  }
  return *number;
}

/** What applications may give: within their slider, or 0 where no value need be given. */
ParameterRange RangeOf(const Parameter& parameter)
{
  if (parameter.Limits)
  {
    return { parameter.Limits->Minimum, parameter.Limits->Maximum };
  }
  const ParameterRange& range = parameter.Source->Range;
  return parameter.Source->IsOptional() ? ParameterRange{ 0.0, range.High } : range;
}

/** The value of a parameter of the table; none of lists. */
void Take(const Parameter& parameter, const std::string& text, ParameterValues& values)
{
  const MeshingParameter& source = *parameter.Source;
  if (source.Kind == ParameterKind::Flag)
  {
    values[source.Name] = text == "true" || text == "on";
  }
  else if (source.IsNumber() || source.Kind == ParameterKind::Word)
  {
    values[source.Name] = cli::ParseParameter(parameter.LongFlag, text, source, RangeOf(parameter));
  }
}

} // namespace

Arguments::Arguments(int argc, const char* const* argv)
{
  const po::variables_map given = Parse(argc, argv);
  this->Wanted = RequestOf(given);
  if (this->Wanted != Request::Run)
  {
    return;
  }
  this->Values = ValuesOf(given);
  TakePlaces(given, this->Values);
  this->Echo = given.count("echo") > 0;
  if (given.count("returnparameterfile"))
  {
    this->ReturnFile = given["returnparameterfile"].as<std::string>();
  }
  if (given.count("processinformationaddress"))
  {
    this->Host = ParseAddress(given["processinformationaddress"].as<std::string>());
  }
  this->Check();
}

/** Each value as its kind, so that mistakes are known before any work. */
void Arguments::Check() const
{
  for (const Parameter* parameter : AllParameters())
  {
    const auto& elements = parameter->Elements;
    const std::string& text = this->Text(parameter->Name);
    if (!elements.empty() && std::find(elements.begin(), elements.end(), text) == elements.end())
    {
      throw UsageError("--" + parameter->LongFlag + ": " + cli::Quoted(text) + " is not one of " +
        elements.front() + ", " + elements.back());
    }
  }
  const ParameterValues values = this->MeshingValues();
  this->Selection();
  if (values.at("delta") > 0.0 && values.at("elements") > 0.0)
  {
    throw UsageError("--delta and --elements do not go together: delta is what is solved for; "
                     "leave one of the two out");
  }
}

const std::string& Arguments::Text(const std::string& name) const
{
  return this->Values.at(name);
}

ParameterValues Arguments::MeshingValues() const
{
  ParameterValues values;
  for (const Parameter* parameter : AllParameters())
  {
    if (parameter->Source)
    {
      Take(*parameter, this->Text(parameter->Name), values);
    }
  }
  return values;
}

bool Arguments::IsSet(const std::string& name) const
{
  return this->Text(name) == "true";
}

cli::LabelSelection Arguments::Selection() const
{
  cli::LabelSelection selection;
  for (const std::string& text : Items(this->Text("labels")))
  {
    selection.Labels.push_back(LabelNumber("labels", text));
  }
  const auto sizes = [this](const char* name, const std::string& flag, bool isSigned)
  {
    std::map<std::int64_t, double> found;
    for (const std::string& text : Items(this->Text(name)))
    {
      const cli::LabelSizeText parsed = cli::ParseLabelSize(flag, text, isSigned);
      if (!found.emplace(LabelNumber(flag, parsed.Label), parsed.Size).second)
      {
        throw UsageError("--" + flag + ": label " + parsed.Label + " is given twice");
      }
    }
    return found;
  };
  selection.Sizes = sizes("labelSizes", "labelsizes", false);
  selection.Thicknesses = sizes("minimumThickness", "minimumthickness", false);
  selection.Shells = sizes("shells", "shells", true);
  for (const std::string& text : Items(this->Text("interfaceSizes")))
  {
    const cli::InterfaceSizeText parsed = cli::ParseInterfaceSize("interfacesizes", text);
    const std::size_t colon = parsed.Labels.find(':');
    const auto label = [](const std::string& number) -> std::int64_t
    { return number == "0" ? 0 : LabelNumber("interfacesizes", number); };
    const std::int64_t first = label(parsed.Labels.substr(0, colon));
    const std::int64_t other = colon == std::string::npos ? cli::LabelSelection::AnyLabel
                                                          : label(parsed.Labels.substr(colon + 1));
    if (first == other)
    {
      throw UsageError("--interfacesizes: a label has no interface with itself: " + text);
    }
    if (!selection.InterfaceSizes.emplace(std::minmax(first, other), parsed.Size).second)
    {
      throw UsageError("--interfacesizes: " + parsed.Labels + " is given twice");
    }
  }
  return selection;
}

std::string HelpText()
{
  std::ostringstream text;
  text << "Usage: " << ModuleName << " [flags]";
  const auto placed = PlacedParameters();
  for (const Parameter* parameter : placed)
  {
    text << ' ' << parameter->Name;
  }
  text << "\n\n" << ModuleSummary << "\n\n";
  for (const Parameter* parameter : placed)
  {
    text << "  " << parameter->Name << ": " << parameter->Description << '\n';
  }
  text
    << '\n'
    << DeclareOptions() << "\nExample:\n  " << ModuleName
    << " --delta 1.5 --surfaces knee.vtp knee.nrrd knee.vtu\n\n"
       "Exit status: 0 done or cancelled; 1 the image cannot be meshed or a file not be read or\n"
       "written; 2 wrong command line. Files appear whole or not at all.\n";
  return text.str();
}

} // namespace voxplex::slicer
