// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Describes a case in words, and as a command line of the program voxplex.
#include "CaseOptions.h"
#include "Findings.h"
#include "StressCase.h"

#include <sstream>
#include <type_traits>

namespace voxplex::stress
{

namespace
{

std::string TextOf(ContentionPolicy policy)
{
  return std::string(ContentionPolicyNames[std::size_t(policy)]);
}

std::string TextOf(BalancePolicy policy)
{
  return std::string(BalancePolicyNames[std::size_t(policy)]);
}

std::string TextOf(GradingMode mode)
{
  return mode == GradingMode::LocalFeatureSize ? "lfs" : "uniform";
}

std::string TextOf(RuleOrder order)
{
  return order == RuleOrder::SurfaceFirst ? "surface" : "radius-edge";
}

template <typename T>
  requires std::is_arithmetic_v<T>
std::string TextOf(T value)
{
  if constexpr (std::is_integral_v<T>)
  {
    return std::to_string(value);
  }
  else
  {
    return Text(value, 17);
  }
}

/** Flags of the program, and the options for which it has no flag. */
class CommandWriter
{
public:
  explicit CommandWriter(std::vector<std::string>& missing)
    : Missing(missing)
  {
  }

  /** Adds a flag, or what there is no flag for, if the value is not the default. */
  template <typename T>
  void Flag(const std::string& name, T value, T usual)
  {
    if (name.substr(0, 2) != "--")
    {
      if (value != usual)
      {
        this->Missing.push_back(name + " " + TextOf(value));
      }
    }
    else if constexpr (std::is_same_v<T, bool>)
    {
      this->Word(name, value == (name.substr(0, 4) != "--no"));
    }
    else
    {
      this->Word(name + ' ' + TextOf(value), value != usual);
    }
  }
  void Word(const std::string& words, bool given = true)
  {
    this->Text << (given ? " " + words : "");
  }
  std::string Result() const { return this->Text.str(); }

private:
  std::ostringstream Text;
  std::vector<std::string>& Missing;
};

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
    to.Flag("sizes that grow along the first axis by", of.Size.Slope, 0.0);
  }
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
  WriteSizes(of, to);
  if constexpr (D == 4)
  {
    to.Flag("--time-scale", of.Image.Axes[3][3], 1.0);
    std::string times;
    for (const double time : options.Planes.Times)
    {
      times += (times.empty() ? "" : ",") + Text(time / of.Image.Axes[3][3], 17);
    }
    to.Word("--time-planes " + times, !times.empty());
  }
  to.Word("--threads " + std::to_string(options.Team.Threads));
  const StressCase<D> other;
  VisitOptions(of,
    [&](const char* name, auto member, auto...) { to.Flag(name, member(of), member(other)); });
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
