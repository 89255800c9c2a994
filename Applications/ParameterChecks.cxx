// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ParameterChecks.h"

#include "Errors.h"
#include "LabelSelection.h"
#include "OptionValues.h"
#include "OutputFormats.h"

#include "Base/NumberText.h"

#include <vtkMath.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
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
    const double* const number = std::get_if<double>(&value);
    const std::string beyond = number ? BeyondLimit(parameter, *number) : "";
    RefuseIf(!beyond.empty() && !p.Has("force"), OptionOf(parameter),
      ": " + beyond + ' ' + parameter.ForceWhy + "; give --force to try all the same");
  }
}

/** The columns of the matrix are directions. */
void CheckDirection(const std::vector<double>& matrix)
{
  if (matrix.empty())
  {
    return;
  }
  constexpr double smallestDeterminant = 1e-5; // of unit vectors, as for images
  std::array<std::array<double, 3>, 3> axes{};
  std::array<double, 3> lengths{};
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    axes[axis] = { matrix[axis], matrix[3 + axis], matrix[6 + axis] };
    lengths[axis] = vtkMath::Normalize(axes[axis].data());
  }
  const double determinant =
    vtkMath::Determinant3x3(axes[0].data(), axes[1].data(), axes[2].data());
  RefuseIf(!(std::abs(determinant) >= smallestDeterminant), "--direction",
    ": the columns of the matrix are the directions of the axes, and these are not independent");
  constexpr double roundedToThreeDigits = 1e-3;
  RefuseIf(std::any_of(lengths.begin(), lengths.end(),
             [](double length) { return std::abs(length - 1.0) > roundedToThreeDigits; }),
    "--direction",
    ": the columns of the matrix must have the length 1, and these have " + NumberText(lengths[0]) +
      ", " + NumberText(lengths[1]) + " and " + NumberText(lengths[2]) +
      "; of an affine, give these lengths with --spacing, and each column divided by its length "
      "here");
}

void CheckFrameTimes(const std::vector<double>& times)
{
  const auto earlier = std::adjacent_find(times.begin(), times.end(), std::greater_equal<>());
  if (earlier != times.end())
  {
    throw UsageError("--frame-times: times must increase, but " + NumberText(earlier[1]) +
      " follows " + NumberText(*earlier));
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
  const std::vector<double> times = p.Numbers("frame-times");
  CheckFrameTimes(times);
  RefuseIf(
    hasFrames && times.size() == 1, "--frame-times: give the time of each frame, such as 0,40,80");
  RefuseIf(!hasFrames && !p.Slices.empty() && !p.SliceCount && times.empty(),
    "--slices: a mesh has no frames; give the number of slices with --slice-count, or their times "
    "with --frame-times");
}

void CheckIsosurface(const Parameters& p)
{
  RefuseIf(p.Has("isovalue") && p.Inputs.size() > 1, "--isovalue",
    ": only for one image of grey values, and several files are masks; leave one of the two out");
  RefuseIf(p.Has("isovalue") && p.Hausdorff, "--hausdorff",
    ": distances are measured from the labels of an image, and a grey-value image has none; "
    "give --quality in its place, or leave --isovalue out");
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
  const std::string clash = ClashOf(
    [&p](const MeshingParameter& parameter)
    {
      const bool isDefault = // the first of the words
        parameter.Kind == ParameterKind::Word && p.Value(parameter.Name) == 0.0;
      return p.Has(parameter.Name) && !isDefault;
    });
  RefuseIf(!clash.empty(), InTermsOf(UserInterface::CommandLine, clash));
  if (p.Action != Verb::Image)
  {
    RequireFormat(OutputOption::Output, p.Output);
  }
  RequireFormat(OutputOption::Interfaces, p.Interfaces);
  RequireFormat(OutputOption::Statistics, p.Statistics);
  CheckFiles(p);
  CheckDirection(p.Numbers("direction"));
  if (!HasNames(p))
  {
    SelectLabels(p, LabelTable());
    SelectRepairs(p, LabelTable());
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
  RefuseIf(dimension == 3 && p.Inputs.empty() && p.Has("frame-times"), "--frame-times", why);
  RequireFormat(OutputOption::Output, p.Output, dimension);
  RequireFormat(OutputOption::Interfaces, p.Interfaces, dimension);
}

} // namespace voxplex::cli
