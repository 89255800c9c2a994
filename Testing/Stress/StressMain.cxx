// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// voxplexStress: random images, random options, every invariant of the mesh.
#include "Report.h"
#include "StressOptions.h"
#include "Workers.h"

#include <cstdio>
#include <exception>

using namespace voxplex::stress;

namespace
{

template <int D>
void PrintCase(const CaseId& id, const RunLimits& limits)
{
  const StressCase<D> made = MakeCase<D>(id);
  std::printf("%s\n  limit of time: %.3g s\n", Describe(made).c_str(), TimeLimit(made, limits));
}

/** One case, in words and with its figures. */
int RunOne(const StressOptions& options)
{
  const CaseId id{ options.Families.front(), options.Seed, *options.Case };
  IsSpaceTime(id) ? PrintCase<4>(id, options.Limits) : PrintCase<3>(id, options.Limits);
  std::fflush(stdout);
  Report report;
  if (options.InProcess)
  {
    report.Add(id, RunById(id, options.Limits));
  }
  else
  {
    CaseRange range{ id.Kind, id.Seed, id.Number, 1, 0.0 };
    RunInWorkers(range, 1, options.Limits,
      [&](const CaseId& which, const CaseResult& result) { report.Add(which, result); });
  }
  report.Print();
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
    return options.Case ? RunOne(options) : RunAll(options);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "voxplexStress: %s\n", error.what());
    return 2;
  }
}
