// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// voxplexStress: random images, random options, every invariant of the mesh.
#include "NrrdFile.h"
#include "Reduction.h"
#include "Report.h"
#include "StressOptions.h"
#include "Workers.h"

#include <cstdio>
#include <exception>

using namespace voxplex::stress;

namespace
{

template <int D>
void PrintCase(const StressCase<D>& of, const StressOptions& options)
{
  std::printf("%s\n  limit of time: %.3g s\n", Describe(of).c_str(), TimeLimit(of, options.Limits));
  std::fflush(stdout);
}

/** Finds a smaller case that fails for the same first cause, describes it and writes its image. */
template <int D>
void PrintReduced(const StressCase<D>& of, const CaseResult& result, const StressOptions& options)
{
  const std::string cause = result.Failures.front().Cause;
  ReductionLimits limits;
  limits.Seconds = options.ReductionSeconds;
  const StressCase<D> smaller = Reduce(of, cause, options.Limits, limits);
  const std::string file = options.Image.empty() ? "reduced.nrrd" : options.Image;
  WriteNrrd(smaller.Image, file);
  std::vector<std::string> missing;
  std::printf("\nReduced (%s):\n", cause.c_str());
  PrintCase(smaller, options);
  std::printf(
    "Image written to %s:\n  %s\n", file.c_str(), ShellCommand(smaller, file, missing).c_str());
}

/** Runs one case, and prints it in words and with its figures. */
template <int D>
int RunOne(const CaseId& id, const StressOptions& options)
{
  const StressCase<D> of = MakeCase<D>(id);
  PrintCase(of, options);
  if (!options.Image.empty())
  {
    WriteNrrd(of.Image, options.Image);
  }
  Report report;
  CaseResult result;
  const auto take = [&](const CaseId& which, const CaseResult& outcome)
  {
    report.Add(which, outcome);
    result = outcome;
  };
  if (options.InProcess)
  {
    take(id, RunCase(of, options.Limits));
  }
  else
  {
    RunInWorkers({ id.Kind, id.Seed, id.Number, 1, 0.0 }, 1, options.Limits, take);
  }
  report.Print();
  if (options.IsReduced && result.Status == CaseStatus::Failed)
  {
    PrintReduced(of, result, options);
  }
  return report.Failed() > 0 ? 1 : 0;
}

int RunAll(const StressOptions& options)
{
  std::uint64_t failed = 0;
  for (const Family family : options.Families)
  {
    CaseRange range{ family, options.Seed, options.First, options.Cases,
      options.Seconds / static_cast<double>(options.Families.size()) };
    std::printf("Dimension %s, seed %llu, cases from %llu\n", NameOf(family).data(),
      static_cast<unsigned long long>(options.Seed),
      static_cast<unsigned long long>(options.First));
    std::fflush(stdout);
    Report report;
    RunInWorkers(range, options.Jobs, options.Limits,
      [&](const CaseId& id, const CaseResult& result) { report.Add(id, result); });
    report.Print();
    failed += report.Failed();
  }
  return failed > 0 ? 1 : 0;
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const StressOptions options = ReadStressOptions(argc, argv);
    if (options.Help)
    {
      std::printf("%s", StressHelp);
      return 0;
    }
    if (!options.Case)
    {
      return RunAll(options);
    }
    const CaseId id{ options.Families.front(), options.Seed, *options.Case };
    return IsSpaceTime(id) ? RunOne<4>(id, options) : RunOne<3>(id, options);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "voxplexStress: %s\n", error.what());
    return 2;
  }
}
