// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ScalingRuns.h"

#include "ChildProcess.h"
#include "VoxplexRun.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace voxplex::benchmarks
{
namespace
{

ThreadStatistics SumOf(const std::vector<ThreadStatistics>& threads)
{
  ThreadStatistics sum;
  for (const ThreadStatistics& thread : threads)
  {
    sum.Insertions += thread.Insertions;
    sum.Removals += thread.Removals;
    sum.Rollbacks += thread.Rollbacks;
    sum.Waits += thread.Waits;
    sum.ContentionSeconds += thread.ContentionSeconds;
    sum.LoadBalanceSeconds += thread.LoadBalanceSeconds;
    sum.RollbackSeconds += thread.RollbackSeconds;
    for (std::size_t level = 0; level < StealingLevels; ++level)
    {
      sum.Received[level] += thread.Received[level];
    }
    sum.ReceivedElements += thread.ReceivedElements;
  }
  return sum;
}

/** Runs in a child, and consumes its copy of the image. */
ScalingRecord RunOnce(LabelVolume&& image, const Configuration& what)
{
  MeshingOptions<3> options;
  options.Sampling.Delta = what.Delta;
  options.Team.Threads = what.Threads;
  options.Team.Contention = what.Contention;
  options.Team.Balance = what.Balance;
  options.Team.Synchronise = what.Synchronise;
  options.Team.Pin = what.Pin;
  options.Team.SeedsPerThread = what.Seeds ? options.Team.SeedsPerThread : 0;
  const VoxplexRun result = RunVoxplex(std::move(image), options);

  ScalingRecord record;
  record.Tetrahedra = static_cast<double>(result.Run.Mesh.Simplices.size());
  record.RefinementSeconds = result.Run.RefinementSeconds;
  record.ExtractionSeconds = result.Statistics.Times.Extraction;
  record.TotalSeconds = result.Run.TotalSeconds;
  record.CpuSeconds = result.Run.CpuSeconds;
  record.SeedingSeconds = result.Statistics.SeedingSeconds;
  record.PeakBytes = result.Run.PeakBytes;
  record.Threads = std::max(1.0, static_cast<double>(result.Statistics.Threads.size()));
  record.Sum = SumOf(result.Statistics.Threads);
  record.SwitchedToLocal = result.Statistics.SwitchedToLocal;
  return record;
}

ScalingRecord Together(const std::vector<ScalingRecord>& copies)
{
  ScalingRecord result = copies.front();
  const auto harmonicMean = [&](double ScalingRecord::*seconds)
  {
    double inverses = 0.0;
    for (const ScalingRecord& copy : copies)
    {
      inverses += 1.0 / (copy.*seconds);
    }
    return static_cast<double>(copies.size()) / inverses;
  };
  result.Tetrahedra *= static_cast<double>(copies.size()); // one thread each, so all are the same
  result.RefinementSeconds = harmonicMean(&ScalingRecord::RefinementSeconds);
  result.ExtractionSeconds = harmonicMean(&ScalingRecord::ExtractionSeconds);
  result.TotalSeconds = harmonicMean(&ScalingRecord::TotalSeconds);
  return result;
}

void ReportProgress(const Configuration& what, const ScalingRecord& record)
{
  std::fprintf(stderr,
    "  delta %.4g, %u x %u thread(s)%s, %s, %s: %.0f tetrahedra, %.3f s of %.3f s\n", what.Delta,
    what.Copies, what.Threads, what.Synchronise ? " synchronised" : "",
    ContentionPolicyNames[static_cast<std::size_t>(what.Contention)].data(),
    BalancePolicyNames[static_cast<std::size_t>(what.Balance)].data(), record.Tetrahedra,
    record.RefinementSeconds, record.TotalSeconds);
}

} // namespace

std::size_t ScalingRuns::Add(const Configuration& what)
{
  const auto found = std::find_if(this->List.begin(), this->List.end(),
    [&](const Series& series) { return series.What == what; });
  if (found != this->List.end())
  {
    return static_cast<std::size_t>(found - this->List.begin());
  }
  this->List.push_back({ what, {} });
  return this->List.size() - 1;
}

ScalingRecord ScalingRuns::Try(const Configuration& what) const
{
  const ScalingRecord record =
    Together(RunInChildren(what.Copies, [&] { return RunOnce(std::move(this->Image), what); }));
  ReportProgress(what, record);
  return record;
}

void ScalingRuns::Run(int repeat)
{
  for (int round = 0; round < repeat; ++round)
  {
    std::fprintf(stderr, "round %d of %d\n", round + 1, repeat);
    for (std::size_t i = 0; i < this->List.size(); ++i)
    {
      Series& series = this->List[(i + static_cast<std::size_t>(round)) % this->List.size()];
      series.Records.push_back(this->Try(series.What));
    }
  }
}

} // namespace voxplex::benchmarks
