// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandLine.h"

#include "EditDistance.h"
#include "Errors.h"
#include "OptionValues.h"
#include "OutputFormats.h"
#include "ParameterChecks.h"
#include "SliceFiles.h"
#include "Version.h"

#include <boost/program_options.hpp>

#include <algorithm>
#include <limits>
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

struct OptionGroups
{
  po::options_description Files{ "Files" };
  po::options_description Isosurface{ "Grey-value images" };
  po::options_description Mesh{ "Density and quality of the mesh" };
  po::options_description Selection{ "Labels and coordinates" };
  po::options_description SpaceTime{ "Space-time images (four dimensions, the last is time)" };
  po::options_description Run{ "Running" };

  po::options_description All() const
  {
    po::options_description all;
    all.add(this->Files).add(this->Isosurface).add(this->Mesh).add(this->Selection);
    all.add(this->SpaceTime).add(this->Run);
    return all;
  }
};

OptionGroups DeclareOptions()
{
  const auto text = [](const char* name) { return po::value<std::string>()->value_name(name); };
  OptionGroups groups;
  groups.Files.add_options() //
    ("input", text("FILE"),
      "the label image, of three or four dimensions: any file that ITK reads (NRRD, NIfTI, "
      "MetaImage, ...) or a folder that holds a DICOM series; 0 is background; or a grey-value "
      "image "
      "(--isovalue)")                                                          //
    ("series", text("UID"), "which DICOM series, if the folder holds several") //
    ("output", text("FILE"),
      ("the tetrahedra; the extension chooses the format: " +
        ListExtensions(OutputOption::Output, 3) +
        "; of a space-time image the pentatopes: " + ListExtensions(OutputOption::Output, 4))
        .c_str()) //
    ("plc", text("FILE"),
      ("the triangles between labels: " + ListExtensions(OutputOption::Interfaces, 3) +
        "; of a space-time image the tetrahedra: " + ListExtensions(OutputOption::Interfaces, 4))
        .c_str())                                                        //
    ("stats", text("FILE"), "figures about the mesh and the run: .json") //
    ("quality",
      "measure the mesh against the image and print it: histograms of angles, junctions, "
      "non-manifold edges, volumes, what is lost; --stats has all of it, for each label, too; not "
      "of "
      "space-time images") //
    ("hausdorff",
      "as --quality, and the symmetric Hausdorff distance between the interfaces of the mesh and "
      "of the image");
  groups.Isosurface.add_options() //
    ("isovalue", text("VALUE"),
      "the input has grey values, not labels: mesh what the isosurface at this value bounds") //
    ("inside", text("above|below"),
      "on which side of the isosurface the object lies (default above: greater values)") //
    ("inside-label", text("LABEL"), "the label of its elements (default 1)");
  groups.Mesh.add_options() //
    ("delta", text("LENGTH"),
      "sampling density of the interfaces: their triangles' edges are about one to two times as "
      "long; the number of elements grows with the square of 1/delta (default: derived from the "
      "spacing)") //
    ("grading", text("uniform|lfs"),
      "sample interfaces with delta everywhere (uniform, default), or more coarsely where their "
      "shape allows it, by the local feature size (lfs): the distance to the medial axis, half the "
      "thickness of a tissue") //
    ("feature-ratio", text("RATIO"),
      "with --grading lfs: sampling density over local feature size where that gives more than "
      "delta (default 1)") //
    ("largest-feature", text("VOXELS"),
      "with --grading lfs: larger local feature sizes count as this (lambda, default 12)") //
    ("elements", text("NUMBER"),
      "solve for the delta that makes so many elements, to within a tenth, instead of --delta; it "
      "takes two or three times as long") //
    ("interface-size",
      po::value<std::vector<std::string>>()->composing()->value_name("LABELS=LENGTH"),
      "sampling density of the interfaces of one label, 3=0.5, or of the interface between two, "
      "3,7=0.5 or Tibia,0=2 (0: background), in place of delta, smaller or larger; may be "
      "repeated")                                                                    //
    ("size", text("LENGTH"), "upper bound of the elements' circumradii, everywhere") //
    ("label-size", po::value<std::vector<std::string>>()->composing()->value_name("LABEL=LENGTH"),
      "the same in one label, given by number or name; may be repeated") //
    ("size-image", text("FILE"),
      "the same from an image whose values are lengths, 0 where there is no bound") //
    ("gradation", text("SLOPE"),
      "how much sizes and interface sizes may change over a unit of length (default 0.3; 0: no "
      "limit)") //
    ("radius-edge", text("RATIO"),
      "upper bound of circumradius over shortest edge (default 2; below 1.932 only with --force)") //
    ("facet-angle", text("DEGREES"),
      "lower bound of the angles of triangles on the interfaces (default 30, at most 30); not of "
      "space-time images") //
    ("sliver-angle", text("DEGREES"),
      "dihedral angle below which, or above 180 less which, a tetrahedron is a sliver and split "
      "(default 9; 0: leave slivers; above 15 only with --force); most above 3 degrees are left to "
      "optimisation") //
    ("no-optimise",
      "leave shapes as refinement makes them: Delaunay, radius-edge ratios below 2; otherwise "
      "they are improved to dihedral angles of 15 to 155 degrees but for a few, with ratios up to "
      "2.5") //
    ("optimise-seconds", text("SECONDS"),
      "stop improving shapes after so long, wherever that is (default: no limit)") //
    ("no-junctions",
      "do not sample the curves where three labels or more meet before all else: they zigzag") //
    ("interface-rounds", text("NUMBER"),
      "how often, at most, to refine again where an interface of the image is farther than 1.5 "
      "delta from the mesh's, or a label's boundary is not manifold (default 8; 0: never)") //
    ("no-manifold",
      "leave edges where more than two triangles of a label's boundary meet; otherwise there are "
      "none, and where it took pieces of tetrahedra the mesh is not Delaunay") //
    ("smallest-component", text("VOXELS"),
      "connected components of at least so many voxels, and the largest of each label, get "
      "tetrahedra whatever delta (default 8; 0: as it comes)") //
    ("exact-components",
      "sample these components as finely as they are thin, whatever delta; otherwise those that "
      "are "
      "thin beside delta have a few tetrahedra") //
    ("min-component-volume", text("VOLUME"),
      "leave out connected components that are smaller, such as specks: they become what is around "
      "them") //
    ("smoothing", text("VOXELS"),
      "standard deviation of the smoothing of voxel stairs, or of noise in grey values; 0 switches "
      "it off (default 1; with --isovalue 0)");
  groups.Selection.add_options() //
    ("labels", po::value<std::vector<std::string>>()->composing()->value_name("LIST"),
      "mesh these labels only, such as 1,2,5 or Tibia,Femur; the others become background; may be "
      "repeated") //
    ("label-table", text("FILE"),
      "text file with the names of the labels, and perhaps colours: that of FreeSurfer, ITK-SNAP "
      "or "
      "3D Slicer, or lines like '3 Tibia' or '3,Tibia,220,216,20' (default: the names that the "
      "image has, or those in FILE.nii.txt beside FILE.nii.gz)") //
    ("space", text("lps|ras"), "coordinates of the mesh (default lps, ITK's physical space)");
  groups.SpaceTime.add_options() //
    ("time-scale", text("LENGTH"),
      "the length that one unit of time counts as much as (default 1: the image's own time step "
      "beside its spacing)") //
    ("slices", text("PREFIX"),
      "write the mesh as it is at several times: PREFIX0.vtu, PREFIX1.vtu, ... and a .pvd file "
      "that ParaView plays") //
    ("slice-count", text("NUMBER"),
      "so many slices, equally spaced from the first to the last time, both included (default: one "
      "for each frame of the image)") //
    ("rule-order", text("radius-edge|surface"),
      "which rules come first: those that bound the radius-edge ratio (default), or those that "
      "sample the interfaces")                                                              //
    ("no-picking", "do not fight slivers with picking regions: faster, with flat elements") //
    ("picks", text("NUMBER"), "random points to try in a picking region (default 10)")      //
    ("sliver-bound", text("RATIO"),
      "normalized volume below which an element is a sliver (default 0.01; above 0.03 only with "
      "--force)")                                                     //
    ("seed", text("NUMBER"), "seed of the random points (default 0)") //
    ("no-fine-grained", "do not let waiting threads help others to expand cavities");
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
      "refuse meshes estimated to need more, such as 8G (default: the machine's memory)") //
    ("force",
      "go on although the mesh is estimated not to fit, the labels look like grey values, "
      "--radius-edge is too low, or --sliver-angle or --sliver-bound too high") //
    ("progress", "show a progress bar, if standard error is a terminal")        //
    ("help", "print this text")                                                 //
    ("version", "print the version");
  return groups;
}

std::string HelpText(const OptionGroups& groups)
{
  std::ostringstream text;
  text
    << "Usage: voxplex --input FILE [--delta LENGTH] [--output FILE] [--plc FILE] [options]\n\n"
       "Turns a segmented 3D image into a conforming mesh of tetrahedra for finite elements, and\n"
       "one of space and time (4D) into a mesh of pentatopes. What an isosurface of a grey-value\n"
       "image bounds is meshed with --isovalue.\n"
       "Lengths are in the unit of the image, usually millimetres.\n"
    << groups.All() << '\n'
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

/** The text of an option, or null. */
const std::string* Given(const po::variables_map& values, const char* name)
{
  return values.count(name) ? &values[name].as<std::string>() : nullptr;
}

SpaceTimeParameters ToSpaceTimeParameters(const po::variables_map& values)
{
  SpaceTimeParameters p;
  if (const auto* text = Given(values, "time-scale"))
  {
    p.TimeScale = ParsePositive("time-scale", *text);
  }
  if (const auto* text = Given(values, "slices"))
  {
    p.Slices = *text;
    CheckSlicePrefix(*text);
  }
  if (const auto* text = Given(values, "slice-count"))
  {
    p.SliceCount = ParseWhole("slice-count", *text, 2, 10000);
  }
  if (const auto* text = Given(values, "rule-order"))
  {
    p.RuleOrder = ParseWord("rule-order", *text, RuleOrders);
  }
  p.NoPicking = values.count("no-picking") > 0;
  if (const auto* text = Given(values, "picks"))
  {
    p.Picks = ParseWhole("picks", *text, 1, 1000000);
  }
  if (const auto* text = Given(values, "sliver-bound"))
  {
    p.SliverBound = ParseRange("sliver-bound", *text, 0, 0.999);
  }
  if (const auto* text = Given(values, "seed"))
  {
    p.Seed = ParseWhole("seed", *text, 0, std::numeric_limits<int>::max());
  }
  p.NoFineGrained = values.count("no-fine-grained") > 0;
  return p;
}

Parameters ToParameters(const po::variables_map& values)
{
  Parameters p;
  const auto given = [&values](const char* name) { return Given(values, name); };
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
  file("label-table", p.LabelTable);
  if (const auto* text = given("isovalue"))
  {
    constexpr double largest = std::numeric_limits<double>::max();
    p.Isovalue = ParseRange("isovalue", *text, -largest, largest);
  }
  if (const auto* text = given("inside"))
  {
    p.Inside = ParseWord("inside", *text, Sides);
  }
  if (const auto* text = given("inside-label"))
  {
    p.InsideLabel = ParseWhole("inside-label", *text, 1, std::numeric_limits<int>::max());
  }
  if (const auto* text = given("delta"))
  {
    p.Delta = ParsePositive("delta", *text, "; leave --delta out to derive it from the spacing");
  }
  if (const auto* text = given("grading"))
  {
    p.Grading = ParseWord("grading", *text, GradingModes);
  }
  if (const auto* text = given("feature-ratio"))
  {
    p.FeatureRatio = ParsePositive("feature-ratio", *text);
  }
  if (const auto* text = given("largest-feature"))
  {
    p.LargestFeature = ParsePositive("largest-feature", *text);
  }
  if (const auto* text = given("elements"))
  {
    p.Elements = ParseWhole("elements", *text, 1, std::numeric_limits<int>::max());
  }
  if (values.count("interface-size"))
  {
    for (const std::string& text : values["interface-size"].as<std::vector<std::string>>())
    {
      p.InterfaceSizeTexts.push_back(ParseInterfaceSize("interface-size", text));
    }
  }
  if (const auto* text = given("gradation"))
  {
    p.Gradation = ParseRange("gradation", *text, 0, 1000);
  }
  if (const auto* text = given("size"))
  {
    p.Size = ParsePositive("size", *text);
  }
  if (values.count("label-size"))
  {
    for (const std::string& text : values["label-size"].as<std::vector<std::string>>())
    {
      p.LabelSizeTexts.push_back(ParseLabelSize("label-size", text));
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
  if (const auto* text = given("sliver-angle"))
  {
    p.SliverAngle = ParseRange("sliver-angle", *text, 0, 59);
  }
  p.NoOptimise = values.count("no-optimise") > 0;
  if (const auto* text = given("optimise-seconds"))
  {
    p.OptimiseSeconds = ParsePositive("optimise-seconds", *text);
  }
  p.NoJunctions = values.count("no-junctions") > 0;
  if (const auto* text = given("interface-rounds"))
  {
    p.InterfaceRounds = ParseWhole("interface-rounds", *text, 0, 100);
  }
  p.NoManifold = values.count("no-manifold") > 0;
  p.ExactComponents = values.count("exact-components") > 0;
  if (const auto* text = given("smallest-component"))
  {
    p.SmallestComponent =
      ParseWhole("smallest-component", *text, 0, std::numeric_limits<int>::max());
  }
  if (const auto* text = given("min-component-volume"))
  {
    p.MinimumComponentVolume = ParsePositive("min-component-volume", *text);
  }
  if (const auto* text = given("smoothing"))
  {
    p.SmoothingSigma = ParseRange("smoothing", *text, 0, 10);
  }
  if (values.count("labels"))
  {
    p.LabelTexts = values["labels"].as<std::vector<std::string>>();
    for (const std::string& text : p.LabelTexts)
    {
      for (const std::string& label : SplitAtCommas(text))
      {
        ParseLabelNumber("labels", label);
      }
    }
  }
  if (const auto* text = given("space"))
  {
    p.OutputSpace = ParseSpace("space", *text);
  }
  if (const auto* text = given("threads"))
  {
    p.Threads = ParseWhole("threads", *text, 0, 4096);
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
  p.Hausdorff = values.count("hausdorff") > 0;
  p.Quality = p.Hausdorff || values.count("quality") > 0;
  p.SpaceTime = ToSpaceTimeParameters(values);
  return p;
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
