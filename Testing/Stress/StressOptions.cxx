// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "StressOptions.h"

#include <functional>
#include <map>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>

namespace voxplex::stress
{

const char* const StressHelp = R"(Usage: voxplexStress [options]

Meshes random images with random options and checks every invariant of the meshes, by code that is
independent of the kernel. The same dimension, seed and number give the same case.

  --dimension LIST        3, 4, iso (grey-value images), all, or several with commas (default 3)
  --seed SEED             seed of the cases (default 1)
  --fresh                 a seed that nobody has seen before; it is printed
  --first NUMBER          the first case (default 0)
  --cases NUMBER          cases of each dimension (default 1000; 0: no end)
  --seconds SECONDS       time for all dimensions; no case begins later
  --jobs NUMBER           processes that work at the same time (default 1)
  --case NUMBER           this case only, with a description
  --image FILE            with --case: writes the image (NRRD)
  --reduce                with --case: makes it smaller as long as it fails for the same cause, and describes it
  --reduce-seconds NUMBER time for --reduce (default 300)
  --in-process            with --case: runs it in this process, for a debugger
  --work-limit NUMBER     more insertions and removals for each vertex fail a case (default 25; 0: no limit)
  --time-limit SECONDS    processor time for each case (default: depends on its size)
  --time-factor FACTOR    multiplies the limits by size (for sanitizers)
  --help                  prints this

Exit status: 0 if no case failed, 1 if one did, 2 for a wrong command line.
)";

namespace
{

/** Seeds below this are for work: see README.md. */
constexpr std::uint64_t FirstFreshSeed = 1000;

double Number(const std::string& text)
{
  std::istringstream stream(text);
  double number = 0.0;
  if (!(stream >> number) || !stream.eof() || !(number >= 0.0))
  {
    throw std::invalid_argument("a number is needed, not " + text);
  }
  return number;
}

std::uint64_t Whole(const std::string& text)
{
  if (text.empty() || text.find_first_not_of("0123456789") != std::string::npos || text.size() > 19)
  {
    throw std::invalid_argument("a whole number is needed, not " + text);
  }
  return std::stoull(text);
}

std::vector<Family> FamiliesOf(const std::string& text)
{
  std::vector<Family> families;
  std::istringstream stream(text == "all" ? "3,4,iso" : text);
  for (std::string name; std::getline(stream, name, ',');)
  {
    const std::size_t before = families.size();
    for (const Family family : { Family::Space, Family::SpaceTime, Family::Isosurface })
    {
      if (name == NameOf(family))
      {
        families.push_back(family);
      }
    }
    if (families.size() == before)
    {
      throw std::invalid_argument("a dimension is 3, 4 or iso, not " + name);
    }
  }
  return families;
}

} // namespace

//------------------------------------------------------------------------------------------------
StressOptions ReadStressOptions(int argc, char** argv)
{
  StressOptions o;
  const std::map<std::string, std::function<void(const std::string&)>> withValue = {
    { "--dimension", [&](const std::string& v) { o.Families = FamiliesOf(v); } },
    { "--seed", [&](const std::string& v) { o.Seed = Whole(v); } },
    { "--first", [&](const std::string& v) { o.First = Whole(v); } },
    { "--cases", [&](const std::string& v) { o.Cases = Whole(v); } },
    { "--seconds", [&](const std::string& v) { o.Seconds = Number(v); } },
    { "--jobs", [&](const std::string& v) { o.Jobs = static_cast<unsigned>(Whole(v)); } },
    { "--case", [&](const std::string& v) { o.Case = Whole(v); } },
    { "--image", [&](const std::string& v) { o.Image = v; } },
    { "--reduce-seconds", [&](const std::string& v) { o.ReductionSeconds = Number(v); } },
    { "--work-limit", [&](const std::string& v) { o.Limits.OperationsPerVertex = Number(v); } },
    { "--time-limit", [&](const std::string& v) { o.Limits.Seconds = Number(v); } },
    { "--time-factor", [&](const std::string& v) { o.Limits.TimeFactor = Number(v); } },
  };
  const std::map<std::string, std::function<void()>> flags = {
    { "--fresh", [&] { o.Seed = FirstFreshSeed + std::random_device{}(); } },
    { "--reduce", [&] { o.IsReduced = true; } },
    { "--in-process", [&] { o.InProcess = true; } },
    { "--help", [&] { o.Help = true; } },
  };
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = argv[i];
    if (const auto flag = flags.find(argument); flag != flags.end())
    {
      flag->second();
      continue;
    }
    const auto option = withValue.find(argument);
    if (option == withValue.end() || i + 1 == argc)
    {
      throw std::invalid_argument(
        (option == withValue.end() ? "unknown argument: " : "a value is missing: ") + argument);
    }
    option->second(argv[++i]);
  }
  if (o.Jobs == 0 || o.Families.empty())
  {
    throw std::invalid_argument("at least one job and one dimension are needed");
  }
  return o;
}

} // namespace voxplex::stress
