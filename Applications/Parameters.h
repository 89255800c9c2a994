// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Parameters.h
 * @brief What the user asked for on the command line.
 */
#ifndef voxplex_cli_Parameters_h
#define voxplex_cli_Parameters_h

#include "Space.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace voxplex::cli
{

/** What --contention and --balance take. */
inline constexpr std::array<std::string_view, 4> ContentionManagers{ "aggressive", "random",
  "global", "local" };
inline constexpr std::array<std::string_view, 2> LoadBalancers{ "rws", "hws" };

/** What --inside takes. */
inline constexpr std::array<std::string_view, 2> Sides{ "above", "below" };

/** What --rule-order takes. */
inline constexpr std::array<std::string_view, 2> RuleOrders{ "radius-edge", "surface" };

/** What --grading takes. */
inline constexpr std::array<std::string_view, 2> GradingModes{ "uniform", "lfs" };

/** What is for images with several time frames only. */
struct SpaceTimeParameters
{
  std::optional<double> TimeScale; ///< length per unit of time
  std::string Slices;              ///< the beginning of the names of slices
  std::optional<int> SliceCount;
  std::string RuleOrder; ///< one of RuleOrders
  bool NoPicking = false;
  std::optional<int> Picks;
  std::optional<double> SliverBound;
  std::optional<int> Seed;
  bool NoFineGrained = false;
};

/** A label, by number or name, and the size of its elements. */
struct LabelSizeText
{
  std::string Label;
  double Size;
};

/** An interface, by the number or name of one label or of two, and its sampling density. */
struct InterfaceSizeText
{
  std::string Labels;
  double Size;
};

/** An empty string or optional means that the option was not given. Lengths are physical. */
struct Parameters
{
  std::string Input;
  std::string Series;
  std::string Output;
  std::string Interfaces;
  std::string Statistics;
  std::string SizeImage;
  std::string LabelTable;

  std::optional<double> Isovalue; ///< the input has grey values, if given
  std::string Inside;             ///< one of Sides
  std::optional<std::int64_t> InsideLabel;

  std::optional<double> Delta;
  std::string Grading; ///< one of GradingModes
  std::optional<double> FeatureRatio;
  std::optional<double> LargestFeature; ///< voxels
  std::optional<int> Elements;
  std::optional<double> RadiusEdgeRatio;
  std::optional<double> FacetAngle;
  std::optional<double> SliverAngle;
  bool NoOptimise = false;
  std::optional<double> OptimiseSeconds;
  bool NoJunctions = false;
  std::optional<int> InterfaceRounds;
  bool NoManifold = false;
  std::optional<int> SmallestComponent;
  bool ExactComponents = false;
  std::optional<double> MinimumComponentVolume;
  std::optional<double> SmoothingSigma;
  std::optional<double> Size;
  std::vector<LabelSizeText> LabelSizeTexts;
  std::vector<InterfaceSizeText> InterfaceSizeTexts;
  std::optional<double> Gradation;
  std::vector<std::string> LabelTexts; ///< each is one label, or several with commas between them
  io::Space OutputSpace = io::Space::LPS;

  int Threads = 0;        ///< 0: all cores
  std::string Contention; ///< one of ContentionManagers
  std::string Balance;    ///< one of LoadBalancers
  bool PinThreads = false;
  bool Force = false;
  std::uint64_t MemoryLimit = 0; ///< bytes; 0: the machine's memory
  bool Progress = false;
  bool Quality = false;
  bool Hausdorff = false; ///< implies Quality

  SpaceTimeParameters SpaceTime;
};

} // namespace voxplex::cli

#endif
