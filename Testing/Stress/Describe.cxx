// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Describes a case in words, and as a command line of the program voxplex.
#include "Findings.h"
#include "StressCase.h"

#include <sstream>
#include <type_traits>

namespace voxplex::stress
{

namespace
{

/** Flags of the program, and the options for which it has no flag. */
class CommandWriter
{
public:
  explicit CommandWriter(std::vector<std::string>& missing)
    : Missing(missing)
  {
  }

  /** Adds a flag if the value is not the default. */
  template <typename T>
  void Flag(const std::string& flag, T value, T usual)
  {
    if (value != usual)
    {
      this->Text << ' ' << flag << ' ' << Exactly(value);
    }
  }
  void Word(const std::string& words) { this->Text << ' ' << words; }
  void Word(const std::string& words, bool given)
  {
    if (given)
    {
      this->Word(words);
    }
  }
  template <typename T>
  void Unavailable(const std::string& name, T value, T usual)
  {
    if (value != usual)
    {
      this->Missing.push_back(name + " " + Exactly(value));
    }
  }
  std::string Result() const { return this->Text.str(); }

private:
  template <typename T>
  static std::string Exactly(T value)
  {
    if constexpr (std::is_integral_v<T>)
    {
      return std::to_string(value);
    }
    else
    {
      return stress::Text(value, 17);
    }
  }

  std::ostringstream Text;
  std::vector<std::string>& Missing;
};

template <int D>
void WriteCheckFlags(const MeshingOptions<D>& options, CommandWriter& to)
{
  const MeshingOptions<D> usual;
  to.Flag("--smallest-component", options.Components.Smallest, usual.Components.Smallest);
  to.Word("--exact-components", options.Components.Exact);
  to.Flag("--interface-rounds", options.Interfaces.Rounds, usual.Interfaces.Rounds);
}

void WriteGrading(const GradingOptions& grading, CommandWriter& to)
{
  const GradingOptions usual;
  if (grading.Mode == GradingMode::LocalFeatureSize)
  {
    to.Word("--grading lfs");
    to.Flag("--feature-ratio", grading.Ratio, usual.Ratio);
    to.Flag("--largest-feature", grading.Lambda, usual.Lambda);
  }
}

void WriteSpaceFlags(const MeshingOptions<3>& options, CommandWriter& to)
{
  const MeshingOptions<3> usual;
  to.Flag("--facet-angle", options.Shape.FacetAngle, usual.Shape.FacetAngle);
  to.Flag("--sliver-angle", options.Shape.Slivers.Angle, usual.Shape.Slivers.Angle);
  WriteCheckFlags(options, to);
  to.Word("--no-manifold", !options.Interfaces.Manifold);
  to.Word("--no-junctions", !options.Interfaces.SampleJunctions);
  to.Word("--no-optimise", !options.Optimisation.Run);
  to.Flag("--optimise-seconds", options.Optimisation.Seconds, usual.Optimisation.Seconds);
  WriteGrading(options.Sampling.Grading, to);
  to.Flag("--elements", options.Sampling.Elements, usual.Sampling.Elements);
  to.Unavailable("Shape.Slivers.PickingRadius", options.Shape.Slivers.PickingRadius,
    usual.Shape.Slivers.PickingRadius);
  to.Unavailable("Shape.Slivers.Picks", options.Shape.Slivers.Picks, usual.Shape.Slivers.Picks);
  to.Unavailable("Shape.Slivers.Seed", options.Shape.Slivers.Seed, usual.Shape.Slivers.Seed);
}

void WriteSpaceTimeFlags(const StressCase<4>& of, CommandWriter& to)
{
  const MeshingOptions<4>& options = of.Options;
  const MeshingOptions<4> usual;
  to.Flag("--time-scale", of.Image.Axes[3][3], 1.0);
  std::string times;
  for (const double time : options.Planes.Times)
  {
    times += (times.empty() ? "" : ",") + Text(time / of.Image.Axes[3][3], 17);
  }
  to.Word("--time-planes " + times, !times.empty());
  to.Word("--periodic", options.Planes.Periodic);
  WriteCheckFlags(options, to);
  to.Flag("--frame-steps", options.FrameSteps, usual.FrameSteps);
  to.Word("--no-fit", !options.Interfaces.Fit);
  WriteGrading(options.Sampling.Grading, to);
  to.Word("--no-manifold", !options.Interfaces.Manifold);
  to.Word("--no-optimise", !options.Optimisation.Run);
  to.Word("--rule-order surface", options.SpaceTime.Order == RuleOrder::SurfaceFirst);
  to.Word("--no-picking", !options.SpaceTime.Slivers.Fight);
  to.Flag("--picks", options.SpaceTime.Slivers.Picks, usual.SpaceTime.Slivers.Picks);
  to.Flag(
    "--sliver-bound", options.SpaceTime.Slivers.VolumeBound, usual.SpaceTime.Slivers.VolumeBound);
  to.Flag("--seed", options.SpaceTime.Slivers.Seed, usual.SpaceTime.Slivers.Seed);
  to.Unavailable("Slivers.PickingRadius", options.SpaceTime.Slivers.PickingRadius,
    usual.SpaceTime.Slivers.PickingRadius);
  to.Unavailable("Slivers.RadiusFactor", options.SpaceTime.Slivers.RadiusFactor,
    usual.SpaceTime.Slivers.RadiusFactor);
}

template <int D>
void WriteSizes(const StressCase<D>& of, CommandWriter& to)
{
  for (const InterfaceSize& size : of.Options.Sampling.InterfaceSizes)
  {
    to.Word("--interface-size " + std::to_string(size.Label) +
      (size.Other == InterfaceSize::AnyLabel ? "" : "," + std::to_string(size.Other)) + "=" +
      Text(size.Size, 17));
  }
  to.Flag("--size", of.Size.Everywhere, 0.0);
  if (of.Size.OfLabel > 0.0)
  {
    to.Word("--label-size " + std::to_string(of.Size.Label) + "=" + Text(of.Size.OfLabel, 17));
  }
  if (of.Size.IsGiven())
  {
    to.Unavailable("sizes that grow along the first axis by", of.Size.Slope, 0.0);
  }
}

template <int D>
void WriteThreads(const MeshingOptions<D>& options, CommandWriter& to)
{
  const MeshingOptions<D> usual;
  to.Word("--threads " + std::to_string(options.Team.Threads));
  to.Word(
    "--contention " + std::string(ContentionPolicyNames[std::size_t(options.Team.Contention)]),
    options.Team.Contention != usual.Team.Contention);
  to.Word("--balance " + std::string(BalancePolicyNames[std::size_t(options.Team.Balance)]),
    options.Team.Balance != usual.Team.Balance);
  to.Word("--reproducible", options.Team.Reproducible);
  to.Word("--pin", options.Team.Pin);
  to.Word("--no-fine-grained", D == 4 && !options.Team.FineGrained);
  to.Unavailable("Synchronise", options.Team.Synchronise, usual.Team.Synchronise);
  to.Unavailable("RemoveEagerly", options.Team.RemoveEagerly, usual.Team.RemoveEagerly);
  to.Unavailable("SeedsPerThread", options.Team.SeedsPerThread, usual.Team.SeedsPerThread);
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
std::string ShellCommand(
  const StressCase<D>& of, const std::string& file, std::vector<std::string>& missing)
{
  CommandWriter to(missing);
  const MeshingOptions<D>& options = of.Options;
  const MeshingOptions<D> usual;
  to.Flag("--delta", options.Sampling.Delta, 0.0);
  double usualSmoothing = usual.SmoothingSigma;
  double smoothing = options.SmoothingSigma;
  if (of.Image.Surface)
  {
    to.Word("--isovalue " + Text(of.Image.Surface->Value, 17));
    to.Word("--inside below", !of.Image.Surface->InsideIsAbove);
    to.Flag("--inside-label", of.Image.Surface->Label, std::int64_t{ 1 });
    usualSmoothing = 0.0;
    smoothing = of.Image.Surface->SmoothingSigma;
  }
  to.Flag("--smoothing", smoothing, usualSmoothing);
  to.Flag("--radius-edge", options.Shape.RadiusEdgeRatio, usual.Shape.RadiusEdgeRatio);
  to.Word("--force", options.Limits.Force);
  to.Flag("--gradation", options.Sampling.Gradation, usual.Sampling.Gradation);
  WriteSizes(of, to);
  if constexpr (D == 3)
  {
    WriteSpaceFlags(options, to);
  }
  else
  {
    WriteSpaceTimeFlags(of, to);
  }
  WriteThreads(options, to);
  return "voxplex --input " + file + to.Result();
}

//------------------------------------------------------------------------------------------------
template <int D>
std::string Describe(const StressCase<D>& of)
{
  std::ostringstream text;
  text << of.Kind << ", ";
  for (std::size_t a = 0; a < of.Image.Dimensions.size(); ++a)
  {
    text << (a > 0 ? " x " : "") << of.Image.Dimensions[a];
  }
  text << " voxels of ";
  for (std::size_t a = 0; a < of.Image.Dimensions.size(); ++a)
  {
    text << (a > 0 ? " x " : "") << Text(of.Image.Spacing(a), 4);
  }
  const auto& axes = of.Image.Axes;
  const bool sheared = axes[0][1] != 0.0 || axes[0][2] != 0.0 || axes[1][2] != 0.0;
  text << (sheared ? ", sheared" : "") << ", " << of.Image.LabelValues().size() << " labels; delta "
       << Text(of.Delta(), 4);
  std::vector<std::string> missing;
  const std::string command = ShellCommand(of, "IMAGE", missing);
  text << "\n  " << command;
  for (const std::string& entry : missing)
  {
    text << "\n  no flag for: " << entry;
  }
  return text.str();
}

template std::string ShellCommand<3>(
  const StressCase<3>&, const std::string&, std::vector<std::string>&);
template std::string ShellCommand<4>(
  const StressCase<4>&, const std::string&, std::vector<std::string>&);
template std::string Describe<3>(const StressCase<3>&);
template std::string Describe<4>(const StressCase<4>&);

} // namespace voxplex::stress
