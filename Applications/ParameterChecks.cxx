// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ParameterChecks.h"

#include "Errors.h"
#include "LabelSelection.h"
#include "OptionValues.h"
#include "OutputFormats.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace voxplex::cli
{
namespace
{

/** Above this meshes can become very large. */
constexpr double LargestSliverAngle = 15.0;
/** Below this it is not proved that refinement ends: sqrt(sqrt(3) + 2). */
constexpr double ProvedRadiusEdgeRatio = 1.9318516525781366;
/** The ratio of the regular tetrahedron, sqrt(6) / 4: no element has a smaller one. */
constexpr double RegularRadiusEdgeRatio = 0.6123724356957945;

/** Above this meshes of space and time can become very large. */
constexpr double LargestSliverBound = 0.03;

void CheckSpaceTime(const SpaceTimeParameters& p, bool force)
{
  if (p.SliverBound && *p.SliverBound > LargestSliverBound && !force)
  {
    throw UsageError("--sliver-bound: above 0.03 meshes can become very large; give --force to try "
                     "all the same");
  }
  if (p.SliceCount && p.Slices.empty())
  {
    throw UsageError("--slice-count: of which slices? Give the beginning of their names with "
                     "--slices");
  }
  if (p.NoPicking)
  {
    const char* useless = p.Picks ? "--picks"
      : p.SliverBound             ? "--sliver-bound"
      : p.Seed                    ? "--seed"
                                  : nullptr;
    if (useless)
    {
      throw UsageError(std::string(useless) +
        " is about picking regions, and --no-picking switches "
        "them off: leave one of the two out");
    }
  }
}

void RefuseIf(bool isGiven, const char* option, const char* why)
{
  if (isGiven)
  {
    throw UsageError(std::string(option) + why);
  }
}

void CheckIsosurface(const Parameters& p)
{
  if (p.Isovalue)
  {
    constexpr const char* Why = ": grey-value images have no labels; leave it or --isovalue out";
    RefuseIf(!p.LabelTexts.empty(), "--labels", Why);
    RefuseIf(!p.LabelTable.empty(), "--label-table", Why);
    RefuseIf(p.Hausdorff, "--hausdorff",
      ": distances are measured from the labels of an image, and a grey-value image has none; "
      "give --quality in its place, or leave --isovalue out");
    return;
  }
  constexpr const char* Why = ": inside of what? Give the isosurface with --isovalue";
  RefuseIf(!p.Inside.empty(), "--inside", Why);
  RefuseIf(p.InsideLabel.has_value(), "--inside-label", Why);
}

/** Options without effect unless another is given, or unless it is not. */
void CheckDependent(const Parameters& p)
{
  if (p.Grading != "lfs")
  {
    constexpr const char* Why =
      ": only for interfaces that are graded; give --grading lfs as well, or leave it out";
    RefuseIf(p.FeatureRatio.has_value(), "--feature-ratio", Why);
    RefuseIf(p.LargestFeature.has_value(), "--largest-feature", Why);
  }
  RefuseIf(p.NoOptimise && p.OptimiseSeconds, "--optimise-seconds",
    " limits what --no-optimise switches off: leave one of the two out");
}

/** The names of the options that were given and are for several time frames only. */
std::vector<std::string> SpaceTimeOptions(const SpaceTimeParameters& p)
{
  const std::array<std::pair<const char*, bool>, 9> options{ {
    { "--time-scale", p.TimeScale.has_value() },
    { "--slices", !p.Slices.empty() },
    { "--slice-count", p.SliceCount.has_value() },
    { "--rule-order", !p.RuleOrder.empty() },
    { "--no-picking", p.NoPicking },
    { "--picks", p.Picks.has_value() },
    { "--sliver-bound", p.SliverBound.has_value() },
    { "--seed", p.Seed.has_value() },
    { "--no-fine-grained", p.NoFineGrained },
  } };
  std::vector<std::string> given;
  for (const auto& [name, isGiven] : options)
  {
    if (isGiven)
    {
      given.emplace_back(name);
    }
  }
  return given;
}

} // namespace

void CheckTogether(const Parameters& p)
{
  CheckSpaceTime(p.SpaceTime, p.Force);
  if (p.Input.empty())
  {
    throw UsageError("--input is missing: which image shall be meshed?");
  }
  CheckIsosurface(p);
  CheckDependent(p);
  if (!p.Output.empty())
  {
    RequireFormat(OutputOption::Output, p.Output);
  }
  if (!p.Interfaces.empty())
  {
    RequireFormat(OutputOption::Interfaces, p.Interfaces);
  }
  if (!p.Statistics.empty())
  {
    RequireFormat(OutputOption::Statistics, p.Statistics);
  }
  if (p.Delta && p.Elements)
  {
    throw UsageError("--delta and --elements do not go together: delta is what is solved for; "
                     "leave one of the two out");
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
  if (p.SliverAngle && *p.SliverAngle > LargestSliverAngle && !p.Force)
  {
    throw UsageError(
      "--sliver-angle: above 15 degrees meshes can become very large; give --force to "
      "try all the same");
  }
  if (!HasNames(p))
  {
    SelectLabels(p, io::LabelTable());
  }
}

void CheckDimension(const Parameters& p, int dimension)
{
  const std::vector<std::string> spaceTimeOptions = SpaceTimeOptions(p.SpaceTime);
  if (dimension == 3 && !spaceTimeOptions.empty())
  {
    throw UsageError(spaceTimeOptions.front() +
      ": only for space-time images, which have four dimensions and at least two time frames; " +
      Quoted(p.Input) + " is a 3D image");
  }
  const std::array<std::pair<const char*, bool>, 16> tetOptions{ {
    { "--hausdorff", p.Hausdorff },
    { "--quality", p.Quality },
    { "--grading", !p.Grading.empty() },
    { "--feature-ratio", p.FeatureRatio.has_value() },
    { "--largest-feature", p.LargestFeature.has_value() },
    { "--isovalue", p.Isovalue.has_value() },
    { "--facet-angle", p.FacetAngle.has_value() },
    { "--sliver-angle", p.SliverAngle.has_value() },
    { "--no-optimise", p.NoOptimise },
    { "--optimise-seconds", p.OptimiseSeconds.has_value() },
    { "--no-junctions", p.NoJunctions },
    { "--interface-rounds", p.InterfaceRounds.has_value() },
    { "--no-manifold", p.NoManifold },
    { "--smallest-component", p.SmallestComponent.has_value() },
    { "--exact-components", p.ExactComponents },
    { "--min-component-volume", p.MinimumComponentVolume.has_value() },
  } };
  for (const auto& [name, isGiven] : tetOptions)
  {
    if (dimension == 4 && isGiven)
    {
      throw UsageError(std::string(name) + ": only for 3D images, and " + Quoted(p.Input) +
        " is a space-time image; leave it out");
    }
  }
  if (!p.Output.empty())
  {
    RequireFormat(OutputOption::Output, p.Output, dimension);
  }
  if (!p.Interfaces.empty())
  {
    RequireFormat(OutputOption::Interfaces, p.Interfaces, dimension);
  }
}

} // namespace voxplex::cli
