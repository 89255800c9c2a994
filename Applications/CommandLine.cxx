// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandLine.h"

#include "EditDistance.h"
#include "Errors.h"
#include "ExecutionModel.h"
#include "OptionValues.h"
#include "Options.h"
#include "ParameterChecks.h"
#include "SpaceTimeFiles.h"

#include <voxplexVersion.h>
#include <vtkSimplexMeshWriter.h>

#include <boost/program_options.hpp>

#include <algorithm>
#include <string_view>
#include <vector>

namespace po = boost::program_options;

namespace voxplex::cli
{
namespace
{

/** Collects arguments that are neither a flag nor the value of one. */
constexpr const char* Words = "words";

std::string SuggestOption(const po::options_description& options, std::string_view unknown)
{
  std::string best;
  std::size_t bestDistance = 3; // farther than two letters is no misspelling
  for (const auto& option : options.options())
  {
    const std::string name = "--" + option->long_name();
    // A flag that is cut short (--thread) or prolonged (--labelsize) is near, too.
    const std::size_t distance = EditDistance(unknown, name);
    if (distance < bestDistance)
    {
      best = name;
      bestDistance = distance;
    }
  }
  return best.empty() ? "" : "; did you mean " + best + "?";
}

/**
 * An option that needs a value and is followed by another option, which would be taken for the value. A value that
 * begins with two dashes can be given after an equals sign.
 */
void RequireValues(const std::vector<std::string>& arguments, const po::options_description& all)
{
  for (std::size_t i = 0; i + 1 < arguments.size(); ++i)
  {
    const std::string& argument = arguments[i];
    const std::string& next = arguments[i + 1];
    if (!argument.starts_with("--") || argument == "--" || !next.starts_with("--"))
    {
      continue;
    }
    const auto* const option = all.find_nothrow(argument.substr(2), false);
    if (option != nullptr && option->semantic()->min_tokens() > 0)
    {
      throw UsageError(Quoted(argument) + " needs a value, but " + Quoted(next) + " follows it");
    }
  }
}

/** Options may have underscores in place of dashes, as those of the Slicer Execution Model must. */
std::vector<std::string> WithDashes(std::vector<std::string> arguments)
{
  for (std::string& argument : arguments)
  {
    if (argument == "--")
    {
      break;
    }
    if (argument.starts_with("--"))
    {
      const std::size_t end = std::min(argument.find('='), argument.size());
      std::replace(argument.begin(), argument.begin() + static_cast<std::ptrdiff_t>(end), '_', '-');
    }
  }
  return arguments;
}

po::variables_map ParseOptions(const std::vector<std::string>& arguments, Verb verb)
{
  const po::options_description all = OptionsOf(verb);
  namespace style = po::command_line_style;
  po::options_description recognised;
  recognised.add(all).add_options()(Words, po::value<std::vector<std::string>>());
  RequireValues(arguments, all);
  po::variables_map values;
  try
  {
    // No short options, so that '-1' is a value; no guessing from abbreviations.
    const auto parsed =
      po::command_line_parser(arguments)
        .options(recognised)
        .positional(po::positional_options_description().add(Words, -1))
        .style(style::allow_long | style::long_allow_adjacent | style::long_allow_next)
        .run();
    po::store(parsed, values);
    po::notify(values);
  }
  catch (const po::unknown_option& error)
  {
    const std::string commands = CommandsWith(error.get_option_name().substr(2));
    throw UsageError(commands.empty() ? "unknown option " + Quoted(error.get_option_name()) +
          SuggestOption(all, error.get_option_name())
                                      : error.get_option_name() + " is an option of " + commands +
          ", not of '" + CommandOf(verb) + "'");
  }
  catch (const po::multiple_occurrences& error)
  {
    throw UsageError(error.get_option_name() + " is given more than once");
  }
  catch (const po::invalid_command_line_syntax& error)
  {
    if (error.kind() == po::invalid_syntax::missing_parameter)
    {
      throw UsageError(error.get_option_name() + " needs a value");
    }
    throw UsageError(error.what());
  }
  catch (const po::error& error)
  {
    throw UsageError(error.what());
  }
  return values;
}

/** Sets the target to the value of an option, if the option is given. */
template <typename Parser, typename Target>
void Take(
  const po::variables_map& values, const std::string& option, Parser&& parse, Target& target)
{
  if (values.count(option))
  {
    target = parse(option, values[option].as<std::string>());
  }
}

std::vector<std::string> AllGiven(const po::variables_map& values, const char* name)
{
  return values.count(name) ? values[name].as<std::vector<std::string>>()
                            : std::vector<std::string>();
}

/** What is given of the table. */
void TakeParameters(const po::variables_map& given, Parameters& p)
{
  const bool isModule = given.count(ResultsOption) > 0;
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    const std::string option = NameIn(UserInterface::CommandLine, parameter);
    if (option.empty() || !given.count(option))
    {
      continue;
    }
    if (parameter.IsOfLabels())
    {
      for (const std::string& text : AllGiven(given, option.c_str()))
      {
        const bool isOfSizes = parameter.Kind != ParameterKind::Labels;
        for (const std::string& item : isOfSizes ? SplitBehindNumbers(text) : std::vector{ text })
        {
          p.OfLabels[parameter.Name].push_back(ParseLabels(option, item, parameter));
        }
      }
    }
    else if (parameter.Kind == ParameterKind::Flag)
    {
      p.Values[parameter.Name] = parameter.IsOnByDefault() ? 0.0 : 1.0;
    }
    else if (const auto& text = given[option].as<std::string>();
             !isModule || !IsLeftAsDescribed(parameter, text))
    {
      p.Values[parameter.Name] = ParseParameter(option, text, parameter);
    }
  }
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    if (!parameter.StandsFor.empty() && p.Has(parameter.Name) && p.Has("isovalue"))
    {
      p.Values[parameter.StandsFor] = p.Values[parameter.Name];
    }
  }
}

/** What says something of an image has no effect without one. */
void CheckOptionsOfImage(const po::variables_map& values)
{
  for (const auto& [option, value] : values)
  {
    if (NeedsImage(option))
    {
      throw UsageError(
        "--" + option + ": only with an image beside the mesh; give it with --input");
    }
  }
}

/** Words without a flag: what is read first, what is written last. */
void TakeWords(std::vector<std::string> words, Parameters& p)
{
  const auto takeLast = [&words](std::string& target)
  {
    target = words.back();
    words.pop_back();
  };
  const auto takeFirst = [&words](std::string& target)
  {
    target = words.front();
    words.erase(words.begin());
  };
  const bool readsMesh = p.Action == Verb::Measure || p.Action == Verb::Convert;
  if (readsMesh && p.Mesh.empty() && !words.empty())
  {
    takeFirst(p.Mesh);
  }
  const bool isFollowing = words.size() + p.Inputs.size() > (readsMesh ? 0 : 1) && !words.empty();
  const auto isFormatOf = [&words](int content)
  { return vtkSimplexMeshWriter::HasFormat(words.back(), content, 0); };
  const bool isOutput = isFollowing &&
    (p.Action == Verb::Mesh ? isFormatOf(vtkSimplexMeshWriter::CONTENT_MESH) ||
          isFormatOf(vtkSimplexMeshWriter::CONTENT_INTERFACES) // which is refused by name
                            : p.Action != Verb::Measure);
  if (isOutput && p.Output.empty())
  {
    takeLast(p.Output);
  }
  const std::size_t most = p.Action == Verb::Image ? 1
    : p.Action == Verb::Convert                    ? 0
                                                   : words.size();
  if (words.size() > most)
  {
    throw UsageError(Quoted(words.back()) +
      " is one name too many; give masks with --input, and other files with their flags");
  }
  p.Inputs.insert(p.Inputs.end(), words.begin(), words.end());
}

Parameters ToParameters(Verb verb, const po::variables_map& values)
{
  Parameters p;
  p.Action = verb;
  p.Inputs = AllGiven(values, "input");
  std::for_each(
    p.Inputs.begin(), p.Inputs.end(), [](const std::string& path) { ParseName("input", path); });
  Take(values, "mesh", ParseName, p.Mesh);
  Take(values, "interfaces", ParseName, p.MeshInterfaces);
  Take(values, "output", ParseName, p.Output);
  Take(values, "plc", ParseName, p.Interfaces);
  Take(values, "stats", ParseName, p.Statistics);
  TakeWords(AllGiven(values, Words), p);
  if (p.Inputs.empty())
  {
    CheckOptionsOfImage(values);
  }
  TakeParameters(values, p);
  const auto prefix = [](const char* example)
  {
    return [example](const std::string& option, const std::string& text)
    {
      CheckFilePrefix(option, text, example);
      return text;
    };
  };
  Take(values, "slices", prefix("heart_"), p.Slices);
  Take(values, "slabs", prefix("slab_"), p.Slabs);
  Take(
    values, "slice-count",
    [](const std::string& option, const std::string& text)
    { return ParseWhole(option, text, 2, 10000); },
    p.SliceCount);
  Take(
    values, "time-planes",
    [&p](const std::string& option, const std::string& text)
    {
      p.TimePlanesAtFrames = text == "frames";
      return p.TimePlanesAtFrames ? std::vector<double>() : ParseNumbers(option, text);
    },
    p.TimePlanes);
  Take(values, "messages", ParseWords, p.Words);
  Take(values, ResultsOption, ParseName, p.Results);
  p.Words = p.Results.empty() ? p.Words : UserInterface::Slicer;
  p.Progress = values.count("progress") > 0 || !p.Results.empty();
  p.Compress = values.count("uncompressed") == 0;
  p.Hausdorff = values.count("hausdorff") > 0;
  p.Quality = p.Hausdorff || verb == Verb::Measure || values.count("quality") > 0;
  if (verb == Verb::Image && p.Output.empty())
  {
    p.Values["check-image"] = 1.0;
  }
  return p;
}

} // namespace

UserInterface WordsOf(int argc, const char* const* argv)
{
  constexpr std::string_view option = "--messages=";
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = std::string(argv[i]) + '=' + (i + 1 < argc ? argv[i + 1] : "");
    if (argument.starts_with("--" + std::string(ResultsOption) + '='))
    {
      return UserInterface::Slicer;
    }
    if (argument.starts_with(option))
    {
      const std::string word =
        argument.substr(option.size(), argument.find('=', option.size()) - option.size());
      return word == "python" ? UserInterface::Python : UserInterface::CommandLine;
    }
  }
  return UserInterface::CommandLine;
}

CommandLine ParseCommandLine(int argc, const char* const* argv)
{
  const std::optional<Verb> given = argc > 1 ? FindVerb(argv[1]) : std::nullopt;
  const Verb verb = given.value_or(Verb::Mesh);
  const auto help = std::find_if(argv + 1, argv + argc,
    [](std::string_view argument) { return argument == "--help" || argument == "-h"; });
  if (help != argv + argc)
  {
    const bool isLong = given || (help + 1 != argv + argc && std::string_view(help[1]) == "all");
    return { std::nullopt, isLong ? Help(verb) : ShortHelp() };
  }
  if (argc <= 1)
  {
    throw UsageError("which image shall be meshed?");
  }
  const int first = given ? 2 : 1;
  const po::variables_map values = ParseOptions(WithDashes({ argv + first, argv + argc }), verb);
  if (values.count("xml"))
  {
    return { std::nullopt, DescribeModule() };
  }
  if (values.count("version"))
  {
    return { std::nullopt, "voxplex " VOXPLEX_VERSION "\n" };
  }
  CommandLine commandLine{ ToParameters(verb, values), "" };
  CheckTogether(*commandLine.Run);
  return commandLine;
}

} // namespace voxplex::cli
