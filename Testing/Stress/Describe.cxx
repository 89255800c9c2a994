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

void WriteSpaceFlags(const MeshingOptions<3>& options, CommandWriter& to)
{
  const MeshingOptions<3> usual;
  to.Flag("--facet-angle", options.FacetAngle, usual.FacetAngle);
  to.Flag("--sliver-angle", options.TetSlivers.Angle, usual.TetSlivers.Angle);
  to.Flag("--smallest-component", options.SmallestComponent, usual.SmallestComponent);
  to.Word("--exact-components", options.ExactComponents);
  to.Flag("--interface-rounds", options.Interfaces.Rounds, usual.Interfaces.Rounds);
  to.Word("--no-manifold", !options.Interfaces.Manifold);
  to.Word("--no-junctions", !options.SampleJunctions);
  to.Word("--no-optimise", !options.Optimise);
  to.Flag("--optimise-seconds", options.OptimisationSeconds, usual.OptimisationSeconds);
  if (options.Grading.Mode == GradingMode::LocalFeatureSize)
  {
    to.Word("--grading lfs");
    to.Flag("--feature-ratio", options.Grading.Ratio, usual.Grading.Ratio);
    to.Flag("--largest-feature", options.Grading.Lambda, usual.Grading.Lambda);
  }
  to.Flag("--elements", options.Elements, usual.Elements);
  to.Unavailable(
    "TetSlivers.PickingRadius", options.TetSlivers.PickingRadius, usual.TetSlivers.PickingRadius);
  to.Unavailable("TetSlivers.Picks", options.TetSlivers.Picks, usual.TetSlivers.Picks);
  to.Unavailable("TetSlivers.Seed", options.TetSlivers.Seed, usual.TetSlivers.Seed);
}

void WriteSpaceTimeFlags(const StressCase<4>& of, CommandWriter& to)
{
  const MeshingOptions<4>& options = of.Options;
  const MeshingOptions<4> usual;
  to.Flag("--time-scale", of.Image.Axes[3][3], 1.0);
  to.Word("--rule-order surface", options.Order == RuleOrder::SurfaceFirst);
  to.Word("--no-picking", !options.Slivers.Fight);
  to.Flag("--picks", options.Slivers.Picks, usual.Slivers.Picks);
  to.Flag("--sliver-bound", options.Slivers.VolumeBound, usual.Slivers.VolumeBound);
  to.Flag("--seed", options.Slivers.Seed, usual.Slivers.Seed);
  to.Unavailable(
    "Slivers.PickingRadius", options.Slivers.PickingRadius, usual.Slivers.PickingRadius);
  to.Unavailable("Slivers.RadiusFactor", options.Slivers.RadiusFactor, usual.Slivers.RadiusFactor);
}

template <int D>
void WriteSizes(const StressCase<D>& of, CommandWriter& to)
{
  for (const InterfaceSize& size : of.Options.InterfaceSizes)
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
  to.Word("--threads " + std::to_string(options.Threads));
  to.Word("--contention " + std::string(ContentionPolicyNames[std::size_t(options.Contention)]),
    options.Contention != usual.Contention);
  to.Word("--balance " + std::string(BalancePolicyNames[std::size_t(options.Balance)]),
    options.Balance != usual.Balance);
  to.Word("--pin", options.PinThreads);
  to.Word("--no-fine-grained", D == 4 && !options.FineGrained);
  to.Unavailable("Synchronise", options.Synchronise, usual.Synchronise);
  to.Unavailable("RemoveEagerly", options.RemoveEagerly, usual.RemoveEagerly);
  to.Unavailable("SeedsPerThread", options.SeedsPerThread, usual.SeedsPerThread);
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
  to.Flag("--delta", options.Delta, 0.0);
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
  to.Flag("--radius-edge", options.RadiusEdgeRatio, usual.RadiusEdgeRatio);
  to.Word("--force", options.Force);
  to.Flag("--gradation", options.Gradation, usual.Gradation);
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
