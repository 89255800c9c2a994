// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandLine.h"

#include "Errors.h"
#include "Version.h"
#include "Writers/Formats.h"

#include <boost/program_options.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <sstream>
#include <string_view>

namespace po = boost::program_options;

namespace voxplex::cli
{
namespace
{

/** Below this it is not proved that refinement ends: sqrt(sqrt(3) + 2). */
constexpr double ProvedRadiusEdgeRatio = 1.9318516525781366;
/** The ratio of the regular tetrahedron, sqrt(6) / 4: no element has a smaller one. */
constexpr double RegularRadiusEdgeRatio = 0.6123724356957945;

/** Collects arguments that are neither a flag nor the value of one. */
constexpr const char* Stray = "stray-arguments";

constexpr const char* Examples = R"(Examples:
  Mesh with triangles of about 1.5 mm on the interfaces:
    voxplex --input knee.nrrd --delta 1.5 --output knee.vtu

  The interfaces between labels as a surface, and figures about the mesh:
    voxplex --input knee.nrrd --delta 1.5 --output knee.vtu --plc knee.vtp --stats knee.json

  Two labels only, label 3 finer than the rest, for Gmsh:
    voxplex --input knee.nrrd --labels 3,7 --delta 2 --size 4 --label-size 3=1 --output knee.msh

  A DICOM series, in the RAS coordinates of 3D Slicer's scene, with a progress bar:
    voxplex --input dicom-folder --space ras --progress --output ct.vtu
)";

std::string Quoted(std::string_view text)
{
  std::string quoted("'");
  quoted.append(text).push_back('\'');
  return quoted;
}

/** The whole text as a number, or nothing. */
template <typename T>
std::optional<T> ToNumber(std::string_view text)
{
  if (!text.empty() && text.front() == '+')
  {
    text.remove_prefix(1);
  }
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
  {
    return std::nullopt;
  }
  return value;
}

double ParseFinite(const std::string& option, std::string_view text)
{
  const std::optional<double> value = ToNumber<double>(text);
  if (!value)
  {
    throw UsageError("--" + option + ": " + Quoted(text) + " is not a number");
  }
  if (!std::isfinite(*value))
  {
    throw UsageError("--" + option + ": must be a finite number, not " + std::string(text));
  }
  return *value;
}

double ParsePositive(const std::string& option, std::string_view text, const std::string& hint = "")
{
  const double value = ParseFinite(option, text);
  if (value <= 0)
  {
    throw UsageError("--" + option + ": must be greater than 0, not " + std::string(text) + hint);
  }
  return value;
}

double ParseRange(const std::string& option, std::string_view text, double low, double high)
{
  const double value = ParseFinite(option, text);
  if (value < low || value > high)
  {
    std::ostringstream message;
    message << "--" << option << ": must lie between " << low << " and " << high << ", not "
            << text;
    throw UsageError(message.str());
  }
  return value;
}

std::int64_t ParseLabel(const std::string& option, std::string_view text)
{
  const std::optional<std::int64_t> label = ToNumber<std::int64_t>(text);
  if (!label || *label <= 0)
  {
    throw UsageError("--" + option + ": " + Quoted(text) +
      " is not a label; labels are whole numbers from 1 on (0 is the background)");
  }
  return *label;
}

std::vector<std::int64_t> ParseLabels(const std::string& option, std::string_view text)
{
  std::vector<std::int64_t> labels;
  while (true)
  {
    const std::size_t comma = text.find(',');
    labels.push_back(ParseLabel(option, text.substr(0, comma)));
    if (comma == std::string_view::npos)
    {
      break;
    }
    text.remove_prefix(comma + 1);
  }
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  return labels;
}

/** "3=1.5": the size of label 3. */
void ParseLabelSize(
  const std::string& option, std::string_view text, std::map<std::int64_t, double>& sizes)
{
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos)
  {
    throw UsageError(
      "--" + option + ": " + Quoted(text) + " is not of the form LABEL=SIZE, such as 3=1.5");
  }
  const std::int64_t label = ParseLabel(option, text.substr(0, equals));
  const double size = ParsePositive(option, text.substr(equals + 1));
  if (!sizes.emplace(label, size).second)
  {
    throw UsageError("--" + option + ": label " + std::to_string(label) + " is given twice");
  }
}

/** "8G": bytes, with K, M, G and T for powers of 1024. */
std::uint64_t ParseBytes(const std::string& option, const std::string& text)
{
  constexpr std::string_view units = "KMGT";
  std::string_view digits = text;
  double scale = 1.0;
  if (!digits.empty())
  {
    const auto unit = units.find(static_cast<char>(std::toupper(digits.back())));
    if (unit != std::string_view::npos)
    {
      scale = std::pow(1024.0, static_cast<double>(unit) + 1.0);
      digits.remove_suffix(1);
    }
  }
  const std::optional<double> value = ToNumber<double>(digits);
  if (!value || !(*value * scale >= 1.0) || *value * scale > 1e18)
  {
    throw UsageError(
      "--" + option + ": " + Quoted(text) + " is not an amount of memory such as 8G or 500M");
  }
  return static_cast<std::uint64_t>(*value * scale);
}

/** One of several words, whatever the case. */
std::string ParseWord(
  const std::string& option, const std::string& text, std::span<const std::string_view> words)
{
  std::string word = text;
  std::transform(word.begin(), word.end(), word.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (std::find(words.begin(), words.end(), word) != words.end())
  {
    return word;
  }
  std::string choice;
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    choice.append(i == 0 ? "" : i + 1 < words.size() ? ", " : " or ").append(words[i]);
  }
  throw UsageError("--" + option + ": must be " + choice + ", not " + Quoted(text));
}

Space ParseSpace(const std::string& option, const std::string& text)
{
  constexpr std::array<std::string_view, 2> spaces{ "lps", "ras" };
  return ParseWord(option, text, spaces) == spaces[0] ? Space::LPS : Space::RAS;
}

/** Levenshtein distance, for "did you mean". */
std::size_t EditDistance(std::string_view a, std::string_view b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{ 0 });
  for (std::size_t i = 1; i <= a.size(); ++i)
  {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j)
    {
      const std::size_t substitution = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({ row[j] + 1, row[j - 1] + 1, substitution });
    }
  }
  return row.back();
}

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

struct OptionGroups
{
  po::options_description Files{ "Files" };
  po::options_description Mesh{ "Density and quality of the mesh" };
  po::options_description Selection{ "Labels and coordinates" };
  po::options_description Run{ "Running" };

  po::options_description All() const
  {
    po::options_description all;
    all.add(this->Files).add(this->Mesh).add(this->Selection).add(this->Run);
    return all;
  }
};

OptionGroups DeclareOptions()
{
  const auto text = [](const char* name) { return po::value<std::string>()->value_name(name); };
  OptionGroups groups;
  groups.Files.add_options() //
    ("input", text("FILE"),
      "the label image: any file that ITK reads (NRRD, NIfTI, MetaImage, ...) or a folder that "
      "holds a DICOM series; 0 is background")                                 //
    ("series", text("UID"), "which DICOM series, if the folder holds several") //
    ("output", text("FILE"),
      ("the tetrahedra; the extension chooses the format: " + ListExtensions(Content::Mesh))
        .c_str()) //
    ("plc", text("FILE"),
      ("the triangles between labels: " + ListExtensions(Content::Interfaces)).c_str()) //
    ("stats", text("FILE"), "figures about the mesh and the run: .json");
  groups.Mesh.add_options() //
    ("delta", text("LENGTH"),
      "sampling density of the interfaces: their triangles' edges are about one to two times as "
      "long; the number of elements grows with the square of 1/delta (default: derived from the "
      "spacing)")                                                                    //
    ("size", text("LENGTH"), "upper bound of the elements' circumradii, everywhere") //
    ("label-size", po::value<std::vector<std::string>>()->composing()->value_name("LABEL=LENGTH"),
      "the same in one label; may be repeated") //
    ("size-image", text("FILE"),
      "the same from an image whose values are lengths, 0 where there is no bound") //
    ("radius-edge", text("RATIO"),
      "upper bound of circumradius over shortest edge (default 2; below 1.932 only with --force)") //
    ("facet-angle", text("DEGREES"),
      "lower bound of the angles of triangles on the interfaces (default 30, at most 30)") //
    ("smoothing", text("VOXELS"),
      "standard deviation of the smoothing of voxel stairs; 0 switches it off (default 1)");
  groups.Selection.add_options() //
    ("labels", text("LIST"),
      "mesh these labels only, such as 1,2,5; the others become background") //
    ("space", text("lps|ras"), "coordinates of the mesh (default lps, ITK's physical space)");
  groups.Run.add_options() //
    ("threads", text("NUMBER"),
      "threads to use in every stage, refinement included (default 0: all cores); with 1 the mesh "
      "is the same, bit for bit, in every run") //
    ("contention", text("MANAGER"),
      "what a thread does when another holds what it needs: aggressive (try again at once), random "
      "(sleep now and then), global or local (wait until another thread makes progress; default "
      "local)") //
    ("balance", text("rws|hws"),
      "from whom a thread without work gets some: whichever thread looks first (rws) or the "
      "nearest (hws, default)")                                                              //
    ("pin", "keep each thread on a core of its own; not while other programs use the cores") //
    ("memory-limit", text("BYTES"),
      "refuse meshes estimated to need more, such as 8G (default: the machine's memory)")     //
    ("force", "go on although the mesh is estimated not to fit, or --radius-edge is too low") //
    ("progress", "show a progress bar, if standard error is a terminal")                      //
    ("help", "print this text")                                                               //
    ("version", "print the version");
  return groups;
}

std::string HelpText(const OptionGroups& groups)
{
  std::ostringstream text;
  text << "Usage: voxplex --input FILE [--delta LENGTH] [--output FILE] [--plc FILE] [options]\n\n"
          "Turns a segmented 3D image into a conforming mesh of tetrahedra for finite elements.\n"
          "Lengths are in the unit of the image, usually millimetres.\n"
       << groups.All() << '\n'
       << Examples
       << "\n"
          "Exit status: 0 done; 1 the image cannot be meshed or a file not be read or written;\n"
          "2 wrong command line; 130 interrupted with Ctrl-C. Output files appear whole or not at "
          "all.\n";
  return text.str();
}

po::variables_map ParseOptions(
  int argc, const char* const* argv, const po::options_description& all)
{
  namespace style = po::command_line_style;
  po::options_description recognised;
  recognised.add(all).add_options()(Stray, po::value<std::vector<std::string>>());
  po::variables_map values;
  try
  {
    // No short options, so that '-1' is a value; no guessing from abbreviations.
    const auto parsed =
      po::command_line_parser(argc, argv)
        .options(recognised)
        .positional(po::positional_options_description().add(Stray, -1))
        .style(style::allow_long | style::long_allow_adjacent | style::long_allow_next)
        .run();
    po::store(parsed, values);
    po::notify(values);
  }
  catch (const po::unknown_option& error)
  {
    throw UsageError("unknown option " + Quoted(error.get_option_name()) +
      SuggestOption(all, error.get_option_name()));
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
  if (values.count(Stray))
  {
    throw UsageError(Quoted(values[Stray].as<std::vector<std::string>>().front()) +
      " is not understood without a flag; give the image with --input");
  }
  return values;
}

Parameters ToParameters(const po::variables_map& values)
{
  Parameters p;
  const auto given = [&values](const char* name) -> const std::string*
  { return values.count(name) ? &values[name].as<std::string>() : nullptr; };
  const auto file = [&given](const char* name, std::string& target)
  {
    if (const std::string* text = given(name))
    {
      if (text->empty())
      {
        throw UsageError("--" + std::string(name) + ": the name is empty");
      }
      target = *text;
    }
  };

  file("input", p.Input);
  file("series", p.Series);
  file("output", p.Output);
  file("plc", p.Interfaces);
  file("stats", p.Statistics);
  file("size-image", p.SizeImage);
  if (const auto* text = given("delta"))
  {
    p.Delta = ParsePositive("delta", *text, "; leave --delta out to derive it from the spacing");
  }
  if (const auto* text = given("size"))
  {
    p.Size = ParsePositive("size", *text);
  }
  if (values.count("label-size"))
  {
    for (const std::string& text : values["label-size"].as<std::vector<std::string>>())
    {
      ParseLabelSize("label-size", text, p.LabelSizes);
    }
  }
  if (const auto* text = given("radius-edge"))
  {
    p.RadiusEdgeRatio = ParsePositive("radius-edge", *text);
  }
  if (const auto* text = given("facet-angle"))
  {
    p.FacetAngle = ParseRange("facet-angle", *text, 0, 30);
  }
  if (const auto* text = given("smoothing"))
  {
    p.SmoothingSigma = ParseRange("smoothing", *text, 0, 10);
  }
  if (const auto* text = given("labels"))
  {
    p.Labels = ParseLabels("labels", *text);
  }
  if (const auto* text = given("space"))
  {
    p.OutputSpace = ParseSpace("space", *text);
  }
  if (const auto* text = given("threads"))
  {
    const std::optional<int> threads = ToNumber<int>(*text);
    if (!threads || *threads < 0 || *threads > 4096)
    {
      throw UsageError(
        "--threads: must be a whole number from 0 (all cores) to 4096, not " + *text);
    }
    p.Threads = *threads;
  }
  if (const auto* text = given("contention"))
  {
    p.Contention = ParseWord("contention", *text, ContentionManagers);
  }
  if (const auto* text = given("balance"))
  {
    p.Balance = ParseWord("balance", *text, LoadBalancers);
  }
  p.PinThreads = values.count("pin") > 0;
  if (const auto* text = given("memory-limit"))
  {
    p.MemoryLimit = ParseBytes("memory-limit", *text);
  }
  p.Force = values.count("force") > 0;
  p.Progress = values.count("progress") > 0;
  return p;
}

/** What no single option can tell. */
void CheckTogether(const Parameters& p)
{
  if (p.Input.empty())
  {
    throw UsageError("--input is missing: which image shall be meshed?");
  }
  if (!p.Output.empty())
  {
    RequireFormat("output", p.Output, Content::Mesh);
  }
  if (!p.Interfaces.empty())
  {
    RequireFormat("plc", p.Interfaces, Content::Interfaces);
  }
  if (!p.Statistics.empty())
  {
    RequireFormat("stats", p.Statistics, Content::Statistics);
  }
  if (p.RadiusEdgeRatio)
  {
    if (*p.RadiusEdgeRatio <= RegularRadiusEdgeRatio)
    {
      throw UsageError("--radius-edge: no tetrahedron has a ratio of 0.612 or less");
    }
    if (*p.RadiusEdgeRatio < ProvedRadiusEdgeRatio && !p.Force)
    {
      throw UsageError("--radius-edge: below 1.932 it is not proved that refinement ends; "
                       "give --force to try all the same");
    }
  }
  for (const auto& [label, size] : p.LabelSizes)
  {
    if (!p.Labels.empty() && !std::binary_search(p.Labels.begin(), p.Labels.end(), label))
    {
      throw UsageError(
        "--label-size: label " + std::to_string(label) + " is not among those of --labels");
    }
  }
}

} // namespace

CommandLine ParseCommandLine(int argc, const char* const* argv)
{
  const OptionGroups groups = DeclareOptions();
  if (std::any_of(argv + 1, argv + argc,
        [](std::string_view argument) { return argument == "--help" || argument == "-h"; }))
  {
    return { std::nullopt, HelpText(groups) };
  }
  if (argc <= 1)
  {
    throw UsageError("--input is missing: which image shall be meshed?");
  }
  const po::variables_map values = ParseOptions(argc, argv, groups.All());
  if (values.count("version"))
  {
    return { std::nullopt, "voxplex " + std::string(Version) + "\n" };
  }
  CommandLine commandLine{ ToParameters(values), "" };
  CheckTogether(*commandLine.Run);
  return commandLine;
}

} // namespace voxplex::cli
