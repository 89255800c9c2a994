// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Options.h"

#include "OutputFormats.h"

#include <algorithm>
#include <array>
#include <set>
#include <sstream>
#include <vector>

namespace po = boost::program_options;

namespace voxplex::cli
{
namespace
{

// --- Verbs

struct VerbText
{
  Verb Value;
  std::string_view Name;
  const char* Arguments;
  const char* What;
};

constexpr std::array<VerbText, 4> Verbs{ {
  { Verb::Mesh, "mesh", "IMAGE... MESH",
    "Makes a conforming mesh of tetrahedra of a segmented 3D image, of pentatopes of one of space "
    "and\n"
    "time, and with --isovalue of the region that an isosurface of a grey-value image bounds." },
  { Verb::Measure, "measure", "MESH [IMAGE...]",
    "Measures a mesh that is there: shapes, topology, and beside the image what is lost." },
  { Verb::Convert, "convert", "MESH MESH",
    "Writes a mesh that is there in another format, or its slices in time." },
  { Verb::Image, "image", "IMAGE [IMAGE]",
    "Says what is suspicious in a segmentation, or writes it as it is read, repaired on request." },
} };

const VerbText& TextOf(Verb verb)
{
  return *std::find_if(
    Verbs.begin(), Verbs.end(), [verb](const VerbText& text) { return text.Value == verb; });
}

// --- Options

/** Verbs that have an option. */
using VerbSet = std::set<Verb>;
const VerbSet All{ Verb::Mesh, Verb::Measure, Verb::Convert, Verb::Image };
const VerbSet OfImages{ Verb::Mesh, Verb::Measure, Verb::Image };
const VerbSet OfWriting{ Verb::Mesh, Verb::Convert };

/** One of the program's own, beside the table of parameters. */
struct OwnOption
{
  std::string Name;
  std::string Value; ///< the word in the help; empty for a flag
  VerbSet Of;
  std::string Help;
  std::optional<ParameterGroup> Group{}; ///< none: files
};

const std::vector<OwnOption>& OwnOptions()
{
  static const std::vector<OwnOption> options{
    { "input", "FILE", OfImages,
      "the label image, of three or four dimensions: NRRD, NIfTI, MetaImage, DICOM, TIFF, VTK, "
      "MGH, GIPL, MRC, or a folder that holds a DICOM series; 0 is background; or a grey-value "
      "image (--isovalue). Several files, or a folder of them, are masks, which become labels "
      "1, 2, ... with the names of their files" },
    { "mesh", "FILE", { Verb::Measure, Verb::Convert },
      "the mesh that is there: a .vtu file of tetrahedra with the cell array Label, or of "
      "pentatopes, which also have the point array Time" },
    { "interfaces", "FILE", { Verb::Convert },
      "the interfaces of the mesh that is there (.vtp or .vtu; of pentatopes .vtu); without it "
      "they are made from the labels. --plc writes them in another format, also without the mesh" },
    { "output", "FILE", OfWriting,
      "the tetrahedra; the extension chooses the format: " +
        ListExtensions(OutputOption::Output, 3) +
        "; of a space-time image the pentatopes: " + ListExtensions(OutputOption::Output, 4) },
    { "output", "FILE", { Verb::Image },
      "the label image as it is read, with its place, its times and the names of its labels: "
      ".nrrd" },
    { "plc", "FILE", OfWriting,
      "the triangles between labels: " + ListExtensions(OutputOption::Interfaces, 3) +
        "; of a space-time image the tetrahedra: " + ListExtensions(OutputOption::Interfaces, 4) },
    { "uncompressed", "", OfWriting,
      "write .vtu and .vtp files without compression: they are larger, and faster to write and "
      "to read" },
    { "stats", "FILE", OfImages, "figures about the mesh, the run and repairs: .json" },
    { "quality", "", { Verb::Mesh },
      "measure the mesh against the image and print it: histograms of angles, junctions, non-"
      "manifold edges, volumes, what is lost; --stats has all of it, for each label, too. Of a "
      "space-time mesh the cuts at the times of the frames are measured" },
    { "hausdorff", "", { Verb::Mesh, Verb::Measure },
      "measure the symmetric Hausdorff distance between the interfaces of the mesh and of the "
      "image, too" },
    { "time-planes", "TIME,...|frames", { Verb::Mesh },
      "times of planes that the mesh conforms to, or frames for the time of each frame: no "
      "element has points before and after a plane",
      ParameterGroup::SpaceTime },
    { "slabs", "PREFIX", OfWriting,
      "write each slab between two time planes alone: PREFIX0.vtu, PREFIX1.vtu, ..., or in the "
      "format of --output",
      ParameterGroup::SpaceTime },
    { "slices", "PREFIX", OfWriting,
      "write the mesh as it is at several times: PREFIX0.vtu, PREFIX1.vtu, ... and a .pvd file "
      "that ParaView plays",
      ParameterGroup::SpaceTime },
    { "slice-count", "NUMBER", OfWriting,
      "number of slices, equally spaced from the first to the last time, both included "
      "(default: one for each frame of the image)",
      ParameterGroup::SpaceTime },
    { "progress", "", All,
      "show a progress bar; if standard error is no terminal, print a line for each new "
      "percent, such as '37 % Meshing'",
      ParameterGroup::Running },
    { "messages", "shell|python", All,
      "for programs that start this one: python makes errors, warnings and progress lines of JSON, "
      "with Python's names for options (default shell)",
      ParameterGroup::Running },
    { "returnparameterfile", "FILE", { Verb::Mesh },
      "for 3D Slicer: a file for results, in lines such as 'numberOfTetrahedra = 4711'; with it "
      "numbers and words that are as by default count as not given, and progress and messages are "
      "those of a module of 3D Slicer",
      ParameterGroup::Running },
    { "xml", "", { Verb::Mesh }, "print the description of this program as a module of 3D Slicer",
      ParameterGroup::Running },
    { "help", "", All, "print this text", ParameterGroup::Running },
    { "version", "", All, "print the version", ParameterGroup::Running },
  };
  return options;
}

VerbSet VerbsOf(const MeshingParameter& parameter)
{
  static const std::set<std::string_view> measuring{ "labels", "smoothing", "facet-angle",
    "smallest-component", "radius-edge", "time-scale" };
  return parameter.Name == "frame-times"                                               ? All
    : parameter.Name == "threads" || parameter.IsOfReading() || parameter.IsOfRepair() ? OfImages
    : measuring.count(parameter.Name) ? VerbSet{ Verb::Mesh, Verb::Measure }
                                      : VerbSet{ Verb::Mesh };
}

/** Of the option of this name; empty if there is none. */
VerbSet VerbsOf(const std::string& option)
{
  VerbSet verbs;
  for (const OwnOption& own : OwnOptions())
  {
    verbs.insert(own.Of.begin(), own.Name == option ? own.Of.end() : own.Of.begin());
  }
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    if (NameIn(UserInterface::CommandLine, parameter) == option)
    {
      verbs = VerbsOf(parameter);
    }
  }
  return verbs;
}

/** What the help has for the value. */
std::string ValueName(const MeshingParameter& parameter)
{
  std::string name = parameter.Unit;
  for (const std::string& word : name.empty() ? parameter.Words : std::vector<std::string>())
  {
    name += (name.empty() ? "" : "|") + word;
  }
  return name;
}

/** A flag if no value is named; one that may come again if values are composed. */
void Add(po::options_description& options, const std::string& name, const std::string& value,
  const std::string& help, bool isRepeatable)
{
  if (value.empty())
  {
    options.add_options()(name.c_str(), help.c_str());
  }
  else if (!isRepeatable)
  {
    options.add_options()(name.c_str(), po::value<std::string>()->value_name(value), help.c_str());
  }
  else
  {
    auto* const values = po::value<std::vector<std::string>>()->composing()->value_name(value);
    options.add_options()(
      name.c_str(), name == "input" ? values->multitoken() : values, help.c_str());
  }
}

/** The options of one group; files have none. */
po::options_description OptionsOf(Verb verb, std::optional<ParameterGroup> group)
{
  po::options_description options(group ? TitleOf(*group) : "Files");
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    const std::string name = NameIn(UserInterface::CommandLine, parameter);
    if (parameter.Group == group && VerbsOf(parameter).count(verb) && !name.empty())
    {
      Add(options, name, ValueName(parameter), Describe(UserInterface::CommandLine, parameter),
        parameter.IsOfLabels());
    }
  }
  for (const OwnOption& option : OwnOptions())
  {
    if (option.Group == group && option.Of.count(verb))
    {
      Add(options, option.Name, option.Value, option.Help, option.Name == "input");
    }
  }
  return options;
}

constexpr const char* Ending =
  "Lengths are in the unit of the image, usually millimetres. Output files appear whole or not at "
  "all.\n"
  "Exit status: 0 done; 1 the image cannot be meshed; 2 wrong command line; 3 a file cannot be\n"
  "read or written; 130 interrupted with Ctrl-C.\n";

} // namespace

std::optional<Verb> FindVerb(std::string_view name)
{
  const auto found = std::find_if(
    Verbs.begin(), Verbs.end(), [name](const VerbText& text) { return text.Name == name; });
  return found == Verbs.end() ? std::nullopt : std::optional(found->Value);
}

std::string CommandOf(Verb verb)
{
  return "voxplex " + std::string(TextOf(verb).Name);
}

po::options_description OptionsOf(Verb verb)
{
  po::options_description all;
  std::optional<ParameterGroup> last;
  all.add(OptionsOf(verb, last));
  for (const MeshingParameter& parameter : MeshingParameters()) // whose groups are in order
  {
    if (parameter.Group != last)
    {
      last = parameter.Group;
      const po::options_description options = OptionsOf(verb, last);
      if (!options.options().empty())
      {
        all.add(options);
      }
    }
  }
  return all;
}

bool NeedsImage(const std::string& option)
{
  static const std::set<std::string_view> others{ "hausdorff", "labels", "smoothing",
    "smallest-component" };
  static const std::set<std::string_view> isForAll{ "input", "threads", "stats" };
  return others.count(option) || (VerbsOf(option) == OfImages && !isForAll.count(option));
}

std::string CommandsWith(const std::string& option)
{
  std::string commands;
  for (const Verb verb : VerbsOf(option))
  {
    commands += (commands.empty() ? "'" : " and '") + CommandOf(verb) + "'";
  }
  return commands;
}

std::string ShortHelp()
{
  std::ostringstream text;
  for (const VerbText& verb : Verbs)
  {
    text << (verb.Value == Verb::Mesh ? "Usage: voxplex [mesh] "
                                      : "       " + CommandOf(verb.Value) + ' ')
         << verb.Arguments << " [options]\n";
  }
  for (const VerbText& verb : Verbs)
  {
    text << '\n' << verb.Name << ":\n" << verb.What << '\n';
  }
  text << R"(
Examples:
  voxplex knee.nrrd knee.vtu --delta 1.5          edges of 1.5 to 3 mm on the interfaces
  voxplex knee.nrrd knee.inp --elements 500000    for Abaqus or CalculiX, of about 500,000 elements
  voxplex left.nii.gz right.nii.gz both.vtu       masks, one for each structure
  voxplex measure knee.vtu knee.nrrd --hausdorff
  voxplex convert knee.vtu knee.msh
  voxplex image knee.nrrd knee2.nrrd --fill-holes 50

Options of the first that are wanted most:
  --delta LENGTH          sampling distance of the interfaces
  --elements NUMBER       in place of it: the number of elements
  --size LENGTH           upper bound of the elements' circumradii
  --labels LIST           mesh these labels only: 1,2,5-9 or Tibia,Femur
  --plc FILE              write the interfaces, too
  --stats FILE            write figures about the mesh
  --threads NUMBER        default: all cores
  --progress              show a progress bar

'voxplex --help all' has all options of the first, 'voxplex measure --help' those of the second.
)" << Ending;
  return text.str();
}

std::string Help(Verb verb)
{
  const VerbText& words = TextOf(verb);
  std::ostringstream text;
  text << "Usage: " << CommandOf(verb) << ' ' << words.Arguments << " [options]\n\n"
       << words.What << '\n'
       << OptionsOf(verb) << '\n'
       << Ending;
  return text.str();
}

} // namespace voxplex::cli
