// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SpaceTimeOptions.h"

#include "CommandLine.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>

namespace voxplex::benchmarks
{

const char* const SpaceTimeUsage = R"(usage: voxplexSpaceTime [options]

Meshes a space-time phantom into pentatopes and prints tables in Markdown: sizes, quality and rates of one
thread (tables 4.2 and 4.3 of the thesis), and of several. Every run is a process of its own; all take turns.

  --phantom NAME     beating-ventricle (default), four-ball (radius 12), merging-balls, rotating-sheet,
                     opening-tube, fast-ball or small-and-large
  --coarsening N     N times fewer voxels of the ventricle along x, y and z (default 1)
  --time-scale S     length of a unit of time (default 1)
  --delta D          sampling distance, in the unit of the spacing (default: derived from the spacing)
  --feature-ratio R  grade interfaces by the local feature size: sampling distance over it (default: uniform)
  --largest-feature V  upper bound of the local feature size, in voxels (default 12)
  --picking WHAT     picking regions against slivers: off (default), on or both
  --rule-order WHAT  radius-edge (default), surface or both
  --no-fine-grained  waiting threads do not help to expand cavities
  --frame-steps N    steps between two frames (default: as many as the motion asks for; 1: no frames are added)
  --no-fit           vertices of interfaces stay where refinement put them
  --no-optimise      shapes stay as refinement makes them
  --periodic         the phantom's frames run back to the first one, and the mesh is periodic
  --threads LIST     also run with these numbers of threads, e.g. 2,4 (default: 1 only)
  --repeat K         rounds (default 3); medians are printed
  --frames           also compare volumes with the image, frame by frame
  --row              print one row of Benchmarks/measure-space-time's table instead
)";

namespace
{

template <typename Value>
Value Choose(const std::string& text, const std::map<std::string, Value>& choices)
{
  const auto found = choices.find(text);
  if (found == choices.end())
  {
    throw std::invalid_argument("no such choice: " + text);
  }
  return found->second;
}

std::vector<unsigned> ParseThreads(const std::string& list)
{
  std::vector<unsigned> threads = { 1 };
  std::istringstream stream(list);
  for (std::string item; std::getline(stream, item, ',');)
  {
    threads.push_back(ParseCount(item));
  }
  std::sort(threads.begin(), threads.end());
  threads.erase(std::unique(threads.begin(), threads.end()), threads.end());
  return threads;
}

} // namespace

SpaceTimeOptions ParseSpaceTimeOptions(int argc, char** argv)
{
  SpaceTimeOptions options;
  options.Threads = { 1 };
  using Text = const std::string&;
  ArgumentTable table;
  table.WithValue = {
    { "--phantom", [&](Text value) { options.Phantom = value; } },
    { "--coarsening", [&](Text value) { options.Coarsening = ParseCount(value); } },
    { "--time-scale", [&](Text value) { options.TimeScale = ParseNumber(value); } },
    { "--delta", [&](Text value) { options.Delta = ParseNumber(value); } },
    { "--feature-ratio",
      [&](Text value)
      {
        options.Grading.Mode = GradingMode::LocalFeatureSize;
        options.Grading.Ratio = ParseNumber(value);
      } },
    { "--largest-feature", [&](Text value) { options.Grading.Lambda = ParseNumber(value); } },
    { "--picking",
      [&](Text value)
      {
        options.Picking = Choose<std::vector<bool>>(
          value, { { "off", { false } }, { "on", { true } }, { "both", { false, true } } });
      } },
    { "--rule-order",
      [&](Text value)
      {
        options.Orders = Choose<std::vector<RuleOrder>>(value,
          { { "radius-edge", { RuleOrder::RadiusEdgeFirst } },
            { "surface", { RuleOrder::SurfaceFirst } },
            { "both", { RuleOrder::RadiusEdgeFirst, RuleOrder::SurfaceFirst } } });
      } },
    { "--frame-steps",
      [&](Text value) { options.FrameSteps = static_cast<unsigned>(ParseCount(value)); } },
    { "--threads", [&](Text value) { options.Threads = ParseThreads(value); } },
    { "--repeat", [&](Text value) { options.Repeat = static_cast<int>(ParseCount(value)); } },
  };
  table.Flags = {
    { "--no-fine-grained", [&] { options.NoFineGrained = true; } },
    { "--no-fit", [&] { options.NoFit = true; } },
    { "--no-optimise", [&] { options.NoOptimise = true; } },
    { "--periodic", [&] { options.Periodic = true; } },
    { "--frames", [&] { options.Frames = true; } },
    { "--row", [&] { options.Row = true; } },
  };
  ReadArguments(argc, argv, table);
  if (options.Coarsening > 11)
  {
    throw std::invalid_argument("a coarsening of at most 11 is needed");
  }
  return options;
}

} // namespace voxplex::benchmarks
