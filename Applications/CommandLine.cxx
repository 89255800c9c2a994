// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandLine.h"

#include "EditDistance.h"
#include "Errors.h"
#include "OptionValues.h"
#include "OutputFormats.h"
#include "ParameterChecks.h"
#include "SpaceTimeFiles.h"

#include <voxplexVersion.h>

#include <boost/program_options.hpp>

#include <algorithm>
#include <array>
#include <set>
#include <sstream>
#include <string_view>

namespace po = boost::program_options;

namespace voxplex::cli
{
namespace
{

/** Collects arguments that are neither a flag nor the value of one. */
constexpr const char* Stray = "stray-arguments";

constexpr const char* Examples = R"(Examples:
  Mesh with triangles of about 1.5 mm on the interfaces:
    voxplex --input knee.nrrd --delta 1.5 --output knee.vtu

  How good the mesh is, and how far its interfaces are from those of the image:
    voxplex --input knee.nrrd --delta 1.5 --output knee.vtu --hausdorff

  A mesh that is there already: how good it is, and the same mesh for Gmsh:
    voxplex --mesh knee.vtu --input knee.nrrd --hausdorff
    voxplex --mesh knee.vtu --interfaces knee.vtp --output knee.msh

  The interfaces between labels as a surface, and figures about the mesh:
    voxplex --input knee.nrrd --delta 1.5 --output knee.vtu --plc knee.vtp --stats knee.json

  About 500,000 tetrahedra, finer where the labels Tibia and Femur touch:
    voxplex --input knee.nrrd --elements 500000 --interface-size Tibia,Femur=0.5 --output knee.vtu

  An atlas whose labels have names, in a table beside it or in one that is given:
    voxplex --input aal.nii.gz --labels Hippocampus_L,Hippocampus_R --delta 1 --output h.vtu
    voxplex --input aparc+aseg.nii.gz --label-table FreeSurferColorLUT.txt --output brain.vtu

  What is denser than 300 in a CT, as one tissue:
    voxplex --input ct.nrrd --isovalue 300 --delta 1.5 --output bone.vtu

  Two labels only, label 3 finer than the rest, for Gmsh:
    voxplex --input knee.nrrd --labels 3,7 --delta 2 --size 4 --label-size 3=1 --output knee.msh

  A beating heart as one mesh of space and time, and what it looks like at 30 times, for ParaView:
    voxplex --input beating.nrrd --delta 5 --output heart.vtu --slices heart_ --slice-count 30

  What is suspicious in a segmentation, and a repaired one, without a mesh:
    voxplex --input knee.nrrd --check-image
    voxplex --input knee.nrrd --fill-holes 50 --min-thickness Meniscus=2 --save-image knee2.nrrd

  A DICOM series, in the RAS coordinates of 3D Slicer's scene, with a progress bar:
    voxplex --input dicom-folder --space ras --progress --output ct.vtu
)";

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

po::typed_value<std::string>* Text(const char* name)
{
  return po::value<std::string>()->value_name(name);
}

po::options_description DescribeFiles()
{
  po::options_description options("Files");
  options.add_options() //
    ("input", po::value<std::vector<std::string>>()->multitoken()->composing()->value_name("FILE"),
      "the label image, of three or four dimensions: NRRD, NIfTI, MetaImage, "
      "DICOM, TIFF, VTK, MGH, GIPL, MRC, or a folder that holds a DICOM series; 0 is background; "
      "or a "
      "grey-value image (--isovalue). Several files, or a folder of them, are masks, which become "
      "labels 1, 2, ... with the names of their files") //
    ("overlap", Text("smallest|order"),
      "which of the masks that have a voxel gets it: the smallest (the default; of equals the "
      "first), or the first. Also of segments of a .seg.nrrd file, and of DICOM segmentations") //
    ("mask-threshold", Text("NUMBER"),
      "above which probabilities, from 0 to 1, are inside: of masks, and of DICOM segmentations "
      "(default 0.5)") //
    ("resample-masks",
      "resample masks whose grids differ by more than whole voxels to the smallest voxels, by "
      "nearest neighbour") //
    ("mesh", Text("FILE"),
      "a mesh that is there already, in place of making one: a .vtu file of tetrahedra with the "
      "cell array Label, or of pentatopes, which also have the point array Time. It is measured, "
      "beside the image if --input gives one, and written in other formats") //
    ("interfaces", Text("FILE"),
      "the interfaces of --mesh (.vtp or .vtu; of pentatopes .vtu); without it they are made from "
      "the labels. --plc writes them in another format, also without --mesh")        //
    ("series", Text("UID"), "the DICOM series to read, if the folder holds several") //
    ("spacing", Text("X,Y,Z"),
      "the distances of voxels along the axes of the image, in place of what its file says: for "
      "formats that do not know them (TIFF)") //
    ("origin", Text("X,Y,Z"),
      "the place of the first voxel, in place of what the file says, in the coordinates of --space") //
    ("direction", Text("NUMBERS"),
      "the directions of the axes of the image, in place of what the file says, in the coordinates "
      "of --space: nine numbers, row by row, of a matrix whose columns they are, each of length 1, "
      "such as 1,0,0,0,1,0,0,0,1") //
    ("data-files-anywhere",
      "lets the header of an image (.nhdr, .mhd, .hdr) name data files that are not in its folder "
      "or below; only for headers that you trust") //
    ("output", Text("FILE"),
      ("the tetrahedra; the extension chooses the format: " +
        ListExtensions(OutputOption::Output, 3) +
        "; of a space-time image the pentatopes: " + ListExtensions(OutputOption::Output, 4))
        .c_str()) //
    ("plc", Text("FILE"),
      ("the triangles between labels: " + ListExtensions(OutputOption::Interfaces, 3) +
        "; of a space-time image the tetrahedra: " + ListExtensions(OutputOption::Interfaces, 4))
        .c_str()) //
    ("uncompressed",
      "write .vtu and .vtp files without compression: they are larger, and faster to write and to "
      "read")                                                            //
    ("stats", Text("FILE"), "figures about the mesh and the run: .json") //
    ("save-image", Text("FILE"),
      "in place of a mesh: the label image as it was read, with its place, its times and the names "
      "of its labels: .nrrd") //
    ("quality",
      "measure the mesh against the image and print it: histograms of angles, junctions, "
      "non-manifold edges, volumes, what is lost; --stats has all of it, for each label, too. Of a "
      "space-time mesh the cuts at the times of the frames are measured") //
    ("hausdorff",
      "like --quality, and the symmetric Hausdorff distance between the interfaces of the mesh and "
      "of the image");
  return options;
}

/** What is the program's own, beside the parameters of the group. */
void AddOwn(po::options_description& options, ParameterGroup group)
{
  if (group == ParameterGroup::Labels)
  {
    options.add_options() //
      ("label-table", Text("FILE"),
        "text file with the names of the labels, and perhaps colours: that of FreeSurfer, ITK-SNAP "
        "or 3D Slicer, or lines like '3 Tibia' or '3,Tibia,220,216,20' (default: the names that "
        "the image has, or those in FILE.nii.txt beside FILE.nii.gz)") //
      ("space", Text("lps|ras"), "coordinates of the mesh (default lps, those of DICOM and ITK)");
  }
  if (group == ParameterGroup::SpaceTime)
  {
    options.add_options() //
      ("time-planes", Text("TIME,...|frames"),
        "times of planes that the mesh conforms to, or frames for the time of each frame: no "
        "element has points "
        "before and after a plane") //
      ("slabs", Text("PREFIX"),
        "write each slab between two time planes alone: PREFIX0.vtu, PREFIX1.vtu, ..., or in the "
        "format of --output") //
      ("slices", Text("PREFIX"),
        "write the mesh as it is at several times: PREFIX0.vtu, PREFIX1.vtu, ... and a .pvd file "
        "that ParaView plays") //
      ("slice-count", Text("NUMBER"),
        "number of slices, equally spaced from the first to the last time, both included (default: "
        "one for each frame of the image)");
  }
  if (group == ParameterGroup::Running)
  {
    options.add_options() //
      ("progress",
        "show a progress bar; if standard error is no terminal, print a line for each new percent, "
        "such as '37 % Meshing'") //
      ("messages", Text("shell|python"),
        "for programs that start this one: the names that errors and warnings have for options "
        "(default shell)")        //
      ("help", "print this text") //
      ("version", "print the version");
  }
}

/** Whether the option may come again. */
bool IsRepeatable(ParameterKind kind)
{
  return kind == ParameterKind::Labels || kind == ParameterKind::LabelSizes ||
    kind == ParameterKind::InterfaceSizes;
}

/** What --help has for the value. */
std::string ValueName(const MeshingParameter& parameter)
{
  std::string name = parameter.Unit;
  for (const std::string& word : name.empty() ? parameter.Words : std::vector<std::string>())
  {
    name += (name.empty() ? "" : "|") + word;
  }
  return name;
}

void Add(po::options_description& options, const MeshingParameter& parameter)
{
  const std::string name = NameIn(UserInterface::CommandLine, parameter);
  const std::string help = Describe(UserInterface::CommandLine, parameter);
  const std::string value = ValueName(parameter);
  if (parameter.Kind == ParameterKind::Flag)
  {
    options.add_options()(name.c_str(), help.c_str());
  }
  else if (IsRepeatable(parameter.Kind))
  {
    options.add_options()(name.c_str(),
      po::value<std::vector<std::string>>()->composing()->value_name(value), help.c_str());
  }
  else
  {
    options.add_options()(name.c_str(), Text(value.c_str()), help.c_str());
  }
}

po::options_description DeclareOptions()
{
  po::options_description all;
  all.add(DescribeFiles());
  const auto& parameters = MeshingParameters();
  for (auto p = parameters.begin(); p != parameters.end();)
  {
    const ParameterGroup group = p->Group;
    po::options_description options(TitleOf(group));
    for (; p != parameters.end() && p->Group == group; ++p)
    {
      if (!NameIn(UserInterface::CommandLine, *p).empty())
      {
        Add(options, *p);
      }
    }
    AddOwn(options, group);
    all.add(options);
  }
  return all;
}

std::string HelpText(const po::options_description& options)
{
  std::ostringstream text;
  text
    << "Usage: voxplex --input FILE [--delta LENGTH] [--output FILE] [--plc FILE] [options]\n\n"
       "Turns a segmented 3D image into a conforming mesh of tetrahedra for finite elements, and\n"
       "one of space and time (4D) into a mesh of pentatopes. With --isovalue, it meshes the\n"
       "region that an isosurface of a grey-value image bounds.\n"
       "Lengths are in the unit of the image, usually millimetres.\n"
    << options << '\n'
    << Examples
    << "\n"
       "Exit status: 0 done; 1 the image cannot be meshed or a file not be read or written;\n"
       "2 wrong command line; 130 interrupted with Ctrl-C. Output files appear whole or not at "
       "all.\n";
  return text.str();
}

/**
 * An option that needs a value and is followed by another option, which would be taken for the value. A value that
 * begins with two dashes can be given after an equals sign.
 */
void RequireValues(int argc, const char* const* argv, const po::options_description& all)
{
  for (int i = 1; i + 1 < argc; ++i)
  {
    const std::string_view argument = argv[i];
    if (!argument.starts_with("--") || argument == "--" ||
      !std::string_view(argv[i + 1]).starts_with("--"))
    {
      continue;
    }
    const auto* const option = all.find_nothrow(std::string(argument.substr(2)), false);
    if (option != nullptr && option->semantic()->min_tokens() > 0)
    {
      throw UsageError(
        Quoted(argument) + " needs a value, but " + Quoted(argv[i + 1]) + " follows it");
    }
  }
}

po::variables_map ParseOptions(
  int argc, const char* const* argv, const po::options_description& all)
{
  namespace style = po::command_line_style;
  po::options_description recognised;
  recognised.add(all).add_options()(Stray, po::value<std::vector<std::string>>());
  RequireValues(argc, argv, all);
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

std::string ParseName(const std::string& option, const std::string& text)
{
  if (text.empty())
  {
    throw UsageError("--" + option + ": the name is empty");
  }
  return text;
}

std::vector<std::string> AllGiven(const po::variables_map& values, const char* name)
{
  return values.count(name) ? values[name].as<std::vector<std::string>>()
                            : std::vector<std::string>();
}

/** Numbers, words and flags of the table. */
void TakeValues(const po::variables_map& given, ParameterValues& values)
{
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    const std::string option = NameIn(UserInterface::CommandLine, parameter);
    if (option.empty() || !given.count(option))
    {
      continue;
    }
    if (parameter.Kind == ParameterKind::Flag)
    {
      values[parameter.Name] = parameter.IsOnByDefault() ? 0.0 : 1.0;
    }
    else if (parameter.IsNumber() || parameter.Kind == ParameterKind::Word)
    {
      values[parameter.Name] =
        ParseParameter(option, given[option].as<std::string>(), parameter, parameter.Range);
    }
  }
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    if (!parameter.StandsFor.empty() && values.count(parameter.Name) && values.count("isovalue"))
    {
      values[parameter.StandsFor] = values[parameter.Name];
    }
  }
}

/** What is said of the file of the image. */
void TakeReading(const po::variables_map& values, ReadingOptions& reading)
{
  Take(values, "series", ParseName, reading.Series);
  Take(
    values, "overlap",
    [](const std::string& option, const std::string& text) {
      return ParseWord(option, text, { "smallest", "order" });
    },
    reading.Overlap);
  Take(
    values, "mask-threshold",
    [](const std::string& option, const std::string& text)
    { return ParseReal(option, text, { .Low = 0.0, .High = 1.0 }); },
    reading.MaskThreshold);
  reading.ResampleMasks = values.count("resample-masks") > 0;
  Take(values, "label-table", ParseName, reading.LabelTable);
  Take(values, "frame-times", ParseFrameTimes, reading.FrameTimes);
  Take(values, "spacing", ParseSpacing, reading.Spacing);
  Take(values, "origin", ParseOrigin, reading.Origin);
  Take(values, "direction", ParseDirection, reading.Direction);
  Take(values, "space", ParseSpace, reading.Space);
  reading.DataFilesAnywhere = values.count("data-files-anywhere") > 0;
}

/** Labels, and sizes of labels and interfaces. */
void TakeLists(const po::variables_map& values, Parameters& p)
{
  for (const std::string& text : AllGiven(values, "interface-size"))
  {
    p.InterfaceSizeTexts.push_back(ParseInterfaceSize("interface-size", text));
  }
  for (const std::string& text : AllGiven(values, "label-size"))
  {
    p.LabelSizeTexts.push_back(ParseLabelSize("label-size", text));
  }
  for (const std::string& text : AllGiven(values, "min-thickness"))
  {
    p.ThicknessTexts.push_back(ParseLabelSize("min-thickness", text));
  }
  for (const std::string& text : AllGiven(values, "shell"))
  {
    p.ShellTexts.push_back(ParseLabelSize("shell", text, true));
  }
  p.LabelTexts = AllGiven(values, "labels");
  for (const std::string& text : p.LabelTexts)
  {
    for (const std::string& label : SplitAtCommas(text))
    {
      ParseLabelNumber("labels", label);
    }
  }
}

/** What has no effect on an image that is only saved or checked. */
void CheckOptionsOfImage(const po::variables_map& values)
{
  static const std::set<std::string_view> ofImage{ "frame-times", "threads" };
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    const std::string option = NameIn(UserInterface::CommandLine, parameter);
    if (values.count(option) && !ofImage.count(parameter.Name) && !parameter.IsOfRepair())
    {
      throw UsageError(
        "--" + option + ": only for making a mesh, and none is made; name one with --output");
    }
  }
}

/** What has no effect on a mesh that is there, or none without the image. */
void CheckOptionsOfMesh(const po::variables_map& values)
{
  static const std::set<std::string_view> measuring{ "labels", "smoothing", "facet-angle",
    "smallest-component", "radius-edge", "time-scale", "frame-times", "threads" };
  const auto refuse = [&values](const std::string& option, const std::string& why)
  {
    if (values.count(option))
    {
      throw UsageError("--" + option + why);
    }
  };
  constexpr const char* making =
    ": only for making a mesh, and --mesh gives one that is there; leave one of the two out";
  refuse("time-planes", making);
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    if (!measuring.count(parameter.Name) && !parameter.IsOfRepair())
    {
      refuse(NameIn(UserInterface::CommandLine, parameter), making);
    }
  }
  for (const char* const option :
    { "series", "overlap", "mask-threshold", "resample-masks", "spacing", "origin", "direction",
      "space", "labels", "label-table", "data-files-anywhere", "smoothing", "smallest-component",
      "hausdorff", "fill-holes", "remove-spikes", "min-thickness", "shell", "check-image" })
  {
    if (!values.count("input"))
    {
      refuse(option, ": only with an image beside the mesh; give it with --input");
    }
  }
}

Parameters ToParameters(const po::variables_map& values)
{
  Parameters p;
  if (values.count("mesh") || (values.count("interfaces") && !values.count("input")))
  {
    CheckOptionsOfMesh(values);
  }
  const auto isGiven = [&values](const char* option) { return values.count(option) > 0; };
  constexpr std::array ofMeshes{ "mesh", "output", "plc", "stats", "slices", "slabs", "quality",
    "hausdorff" };
  if ((isGiven("save-image") || isGiven("check-image")) &&
    std::none_of(ofMeshes.begin(), ofMeshes.end(), isGiven))
  {
    CheckOptionsOfImage(values);
  }
  p.Inputs = AllGiven(values, "input");
  std::for_each(
    p.Inputs.begin(), p.Inputs.end(), [](const std::string& path) { ParseName("input", path); });
  Take(values, "mesh", ParseName, p.Mesh);
  Take(values, "interfaces", ParseName, p.MeshInterfaces);
  Take(values, "output", ParseName, p.Output);
  Take(values, "plc", ParseName, p.Interfaces);
  Take(values, "stats", ParseName, p.Statistics);
  Take(values, "save-image", ParseName, p.SavedImage);
  Take(values, "size-image", ParseName, p.SizeImage);
  TakeReading(values, p.Reading);
  TakeValues(values, p.Values);
  TakeLists(values, p);
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
  p.Progress = values.count("progress") > 0;
  p.Compress = values.count("uncompressed") == 0;
  p.Hausdorff = values.count("hausdorff") > 0;
  p.Quality = p.Hausdorff || values.count("quality") > 0;
  return p;
}

} // namespace

UserInterface WordsOf(int argc, const char* const* argv)
{
  constexpr std::string_view option = "--messages";
  for (int i = 1; i < argc; ++i)
  {
    const std::string_view argument = argv[i];
    if (argument == std::string(option) + "=python" ||
      (argument == option && i + 1 < argc && std::string_view(argv[i + 1]) == "python"))
    {
      return UserInterface::Python;
    }
  }
  return UserInterface::CommandLine;
}

CommandLine ParseCommandLine(int argc, const char* const* argv)
{
  const po::options_description options = DeclareOptions();
  if (std::any_of(argv + 1, argv + argc,
        [](std::string_view argument) { return argument == "--help" || argument == "-h"; }))
  {
    return { std::nullopt, HelpText(options) };
  }
  if (argc <= 1)
  {
    throw UsageError("--input is missing: which image shall be meshed?");
  }
  const po::variables_map values = ParseOptions(argc, argv, options);
  if (values.count("version"))
  {
    return { std::nullopt, "voxplex " VOXPLEX_VERSION "\n" };
  }
  CommandLine commandLine{ ToParameters(values), "" };
  CheckTogether(*commandLine.Run);
  return commandLine;
}

} // namespace voxplex::cli
