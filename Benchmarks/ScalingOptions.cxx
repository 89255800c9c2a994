// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ScalingOptions.h"

#include "CommandLine.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace voxplex::benchmarks
{

const char* const ScalingUsage =
  R"(usage: voxplexScaling IMAGE --delta D [mode...] [options]

Meshes a label image with several numbers of threads and prints tables in Markdown. Speed-ups are
against one thread in the same round.

modes (default: --strong):
  --strong           one delta; the times, the three overheads, managers and balancers side by side
  --weak             delta such that each thread has as many tetrahedra as one thread with D
  --synchronise      one thread: the code for several threads against the sequential code
  --oversubscribe N  N threads against as many as there are cores
  --ceiling          independent processes at once: what the machine gives at best
  --quality N        quality of N meshes next to that of one thread; with the most threads of the
                     list, and with those of --oversubscribe

options:
  --delta D          sampling distance, in the unit of the image's spacing
  --elements N       tetrahedra to aim at: delta is tuned (from D, if given)
  --threads LIST     default: 1, 2, 4, ... and all cores; 1 is always run
  --contention LIST  default: local,global,random,aggressive; the first where one is enough
  --balance LIST     default: hws,rws; the first where one is enough
  --repeat K         rounds (default 3); medians are printed
  --pin              keeps each refinement thread on a core of its own
  --no-seeds         starts several threads from the box alone, as the thesis does
  --json FILE        also writes all runs to FILE
)";

namespace
{

std::vector<std::string> Split(const std::string& list)
{
  std::vector<std::string> items;
  std::istringstream stream(list);
  for (std::string item; std::getline(stream, item, ',');)
  {
    items.push_back(item);
  }
  return items;
}

template <typename Policy, std::size_t N>
std::vector<Policy> ParsePolicies(
  const std::string& list, const std::array<std::string_view, N>& names)
{
  std::vector<Policy> policies;
  for (const std::string& item : Split(list))
  {
    const auto name = std::find(names.begin(), names.end(), item);
    if (name == names.end())
    {
      throw std::invalid_argument("no such policy: " + item);
    }
    policies.push_back(static_cast<Policy>(name - names.begin()));
  }
  return policies;
}

std::vector<unsigned> DefaultThreads()
{
  const unsigned cores = NumberOfThreads(0);
  std::vector<unsigned> threads;
  for (unsigned n = 1; n < cores; n *= 2)
  {
    threads.push_back(n);
  }
  threads.push_back(cores);
  return threads;
}

/** Sets the options that the arguments left open, and checks all options. */
void Complete(ScalingOptions& options)
{
  if (options.Threads.empty())
  {
    options.Threads = DefaultThreads();
  }
  options.Threads.push_back(1);
  std::sort(options.Threads.begin(), options.Threads.end());
  options.Threads.erase(
    std::unique(options.Threads.begin(), options.Threads.end()), options.Threads.end());
  options.Strong |= !options.Weak && !options.Synchronise && !options.Ceiling &&
    options.Oversubscribe == 0 && options.Quality == 0;
  if (options.Image.empty() || !(options.Delta > 0.0 || options.Elements > 0.0))
  {
    throw std::invalid_argument("an image and --delta or --elements are needed");
  }
  if (options.Managers.empty() || options.Balancers.empty())
  {
    throw std::invalid_argument("a contention manager and a load balancer are needed");
  }
}

} // namespace

ScalingOptions ParseScalingOptions(int argc, char** argv)
{
  ScalingOptions options;
  using Text = const std::string&;
  ArgumentTable table;
  table.WithValue = {
    { "--delta", [&](Text value) { options.Delta = ParseNumber(value); } },
    { "--elements", [&](Text value) { options.Elements = ParseNumber(value); } },
    { "--repeat", [&](Text value) { options.Repeat = static_cast<int>(ParseCount(value)); } },
    { "--quality", [&](Text value) { options.Quality = static_cast<int>(ParseCount(value)); } },
    { "--oversubscribe", [&](Text value) { options.Oversubscribe = ParseCount(value); } },
    { "--threads",
      [&](Text value)
      {
        for (const std::string& item : Split(value))
        {
          options.Threads.push_back(ParseCount(item));
        }
      } },
    { "--contention",
      [&](Text value)
      { options.Managers = ParsePolicies<ContentionPolicy>(value, ContentionPolicyNames); } },
    { "--balance",
      [&](Text value)
      { options.Balancers = ParsePolicies<BalancePolicy>(value, BalancePolicyNames); } },
    { "--json", [&](Text value) { options.Json = value; } },
  };
  table.Flags = {
    { "--strong", [&] { options.Strong = true; } },
    { "--weak", [&] { options.Weak = true; } },
    { "--synchronise", [&] { options.Synchronise = true; } },
    { "--ceiling", [&] { options.Ceiling = true; } },
    { "--pin", [&] { options.Pin = true; } },
    { "--no-seeds", [&] { options.NoSeeds = true; } },
  };
  table.File = &options.Image;
  ReadArguments(argc, argv, table);
  Complete(options);
  return options;
}

} // namespace voxplex::benchmarks
