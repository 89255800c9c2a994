// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ParameterChecks.h"

#include "Errors.h"
#include "LabelSelection.h"
#include "OptionValues.h"
#include "OutputFormats.h"

#include <string>

namespace voxplex::cli
{
namespace
{

void RefuseIf(bool isGiven, const std::string& option, const std::string& why = "")
{
  if (isGiven)
  {
    throw UsageError(option + why);
  }
}

/** What a parameter is on the command line. */
std::string OptionOf(const MeshingParameter& parameter)
{
  return "--" + NameIn(UserInterface::CommandLine, parameter);
}

void CheckForced(const Parameters& p)
{
  if (p.Action == Verb::Measure) // bounds only count violations
  {
    return;
  }
  for (const auto& [name, value] : p.Values)
  {
    const MeshingParameter& parameter = FindParameter(name);
    const std::string beyond = BeyondLimit(parameter, value);
    RefuseIf(!beyond.empty() && !p.Has("force"), OptionOf(parameter),
      ": " + beyond + ' ' + parameter.ForceWhy + "; give --force to try all the same");
  }
}

void CheckSpaceTime(const Parameters& p)
{
  RefuseIf(p.SliceCount && p.Slices.empty(),
    "--slice-count: give the beginning of the slices' names with --slices");
  const bool hasPlanes = p.TimePlanesAtFrames || !p.TimePlanes.empty() || p.Has("periodic");
  RefuseIf(!p.Slabs.empty() && !hasPlanes && p.Mesh.empty(),
    "--slabs: there is one slab only; give the times of planes with --time-planes");
  const bool hasFrames = !p.Inputs.empty() || p.Mesh.empty();
  RefuseIf(hasFrames && p.Reading.FrameTimes.size() == 1,
    "--frame-times: give the time of each frame, such as 0,40,80");
  RefuseIf(!hasFrames && !p.Slices.empty() && !p.SliceCount && p.Reading.FrameTimes.empty(),
    "--slices: a mesh has no frames; give the number of slices with --slice-count, or their times "
    "with --frame-times");
  for (const char* name : { "picks", "sliver-bound", "seed" })
  {
    RefuseIf(p.Has("picking") && p.Has(name), OptionOf(FindParameter(name)),
      " is about picking regions, and --no-picking switches them off: leave one of the two out");
  }
}

void CheckIsosurface(const Parameters& p)
{
  if (p.Has("isovalue"))
  {
    constexpr const char* Why = ": grey-value images have no labels; leave it or --isovalue out";
    RefuseIf(!p.LabelTexts.empty(), "--labels", Why);
    RefuseIf(p.Has("fill-holes"), "--fill-holes", Why);
    RefuseIf(p.Has("remove-spikes"), "--remove-spikes", Why);
    RefuseIf(!p.ThicknessTexts.empty(), "--min-thickness", Why);
    RefuseIf(!p.ShellTexts.empty(), "--shell", Why);
    RefuseIf(p.Has("check-image"), "--check-image", Why);
    RefuseIf(p.Inputs.size() > 1, "--isovalue",
      ": only for one image of grey values, and several files are masks; leave one of the two out");
    RefuseIf(!p.Reading.LabelTable.empty(), "--label-table", Why);
    RefuseIf(p.Hausdorff, "--hausdorff",
      ": distances are measured from the labels of an image, and a grey-value image has none; "
      "give --quality in its place, or leave --isovalue out");
    return;
  }
  constexpr const char* Why = ": inside of what? Give the isosurface with --isovalue";
  RefuseIf(p.Has("inside"), "--inside", Why);
  RefuseIf(p.Has("inside-label"), "--inside-label", Why);
}

/** Options without effect unless another is given, or unless it is not. */
void CheckDependent(const Parameters& p)
{
  constexpr const char* Why =
    ": only for interfaces that are graded; give --grading lfs as well, or leave it out";
  const bool graded = // not uniform, the first of the words
    p.Value("grading").value_or(0.0) > 0.0;
  RefuseIf(!graded && p.Has("feature-ratio"), "--feature-ratio", Why);
  RefuseIf(!graded && p.Has("largest-feature"), "--largest-feature", Why);
  RefuseIf(p.Has("optimise") && p.Has("optimise-seconds"), "--optimise-seconds",
    " limits what --no-optimise switches off: leave one of the two out");
  RefuseIf(p.Has("delta") && p.Has("elements"),
    "--delta and --elements do not go together: delta is what is solved for; leave one of the two "
    "out");
}

/** Something is read, and something is written or said. */
void CheckFiles(const Parameters& p)
{
  const bool readsMesh = p.Action == Verb::Measure || p.Action == Verb::Convert;
  RefuseIf(readsMesh && p.Mesh.empty() && !p.IsAboutInterfaces(),
    "which mesh? Name it first, or with --mesh");
  RefuseIf(!readsMesh && p.Inputs.empty(), "which image? Name it first, or with --input");
  RefuseIf(p.Action == Verb::Image && !p.Output.empty() && !p.Output.ends_with(".nrrd"), "--output",
    ": images are saved as .nrrd");
  RefuseIf(p.Action == Verb::Convert && p.WritesNothing(),
    "no mesh would be written: name it last, or with --output (" +
      ListExtensions(OutputOption::Output, 3) + ")");
}

} // namespace

void CheckTogether(const Parameters& p)
{
  CheckForced(p);
  CheckSpaceTime(p);
  CheckIsosurface(p);
  CheckDependent(p);
  if (p.Action != Verb::Image)
  {
    RequireFormat(OutputOption::Output, p.Output);
  }
  RequireFormat(OutputOption::Interfaces, p.Interfaces);
  RequireFormat(OutputOption::Statistics, p.Statistics);
  CheckFiles(p);
  if (!HasNames(p))
  {
    LabelSelection selection = SelectLabels(p, LabelTable());
    SelectRepairs(p, LabelTable(), selection);
  }
}

void CheckDimension(const Parameters& p, int dimension)
{
  const std::string why = dimension == 3 && !p.Mesh.empty()
    ? ": only for meshes of pentatopes, and " + Quoted(p.Mesh) + " has tetrahedra; leave it out"
    : dimension == 3
    ? ": only for space-time images, which have four dimensions and at least two time frames; " +
      Quoted(p.InputName()) + " is a 3D image"
    : ": only for 3D images, and " + Quoted(p.InputName()) + " is a space-time image; leave it out";
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    const bool isOfOthers = parameter.Dimension != 0 && parameter.Dimension != dimension &&
      (p.Mesh.empty() || dimension == 3); // cuts of pentatopes have tetrahedra
    RefuseIf(isOfOthers && p.Has(parameter.Name), OptionOf(parameter), why);
  }
  RefuseIf(dimension == 3 && !p.Slices.empty(), "--slices", why);
  RefuseIf(dimension == 3 && !p.Slabs.empty(), "--slabs", why);
  RefuseIf(dimension == 3 && (p.TimePlanesAtFrames || !p.TimePlanes.empty()), "--time-planes", why);
  RefuseIf(
    dimension == 3 && p.Inputs.empty() && !p.Reading.FrameTimes.empty(), "--frame-times", why);
  RequireFormat(OutputOption::Output, p.Output, dimension);
  RequireFormat(OutputOption::Interfaces, p.Interfaces, dimension);
}

} // namespace voxplex::cli
