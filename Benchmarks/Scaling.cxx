// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Scaling.cxx
 * @brief voxplexScaling: meshes one image with one thread, with several, and with more threads than
 * cores.
 *
 * Every run is a separate child process. All configurations take turns.
 */
#include "CommandLine.h"
#include "MeshComparison.h"
#include "MeshReport.h"
#include "Parallel/ParallelFor.h"
#include "ScalingOptions.h"
#include "ScalingTables.h"
#include "VoxplexRun.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

using namespace voxplex;
using namespace voxplex::benchmarks;

namespace
{

const char* NameOf(ContentionPolicy policy)
{
  return ContentionPolicyNames[static_cast<std::size_t>(policy)].data();
}

const char* NameOf(BalancePolicy policy)
{
  return BalancePolicyNames[static_cast<std::size_t>(policy)].data();
}

/** The configurations to run, and the table of each series. */
class Experiment
{
public:
  Experiment(const ScalingOptions& options, LabelVolume& image)
    : Opts(options)
    , Runs(image)
  {
    this->Baseline = this->Runs.Add(this->With(1));
    if (options.Strong)
    {
      this->AddStrong();
    }
    if (options.Synchronise)
    {
      Configuration what = this->With(1);
      what.Synchronise = true;
      this->Synchronised = this->Runs.Add(what);
    }
    if (options.Oversubscribe > 0)
    {
      this->AddOversubscribed();
    }
    if (options.Ceiling)
    {
      this->AddCeiling();
    }
    if (options.Weak)
    {
      this->AddWeak();
    }
  }

  void Run() { this->Runs.Run(this->Opts.Repeat); }
  void Print() const;
  void WriteJson(std::ostream& stream) const { this->Tables().WriteJson(stream); }

private:
  ScalingTables Tables() const { return { this->Runs, this->Baseline }; }

  /**
   * Uses the first manager and the first balancer of the lists. One thread uses the sequential
   * code.
   */
  Configuration With(unsigned threads) const
  {
    Configuration what;
    what.Delta = this->Opts.Delta;
    what.Threads = threads;
    what.Contention = this->Opts.Managers.front();
    what.Balance = this->Opts.Balancers.front();
    what.Pin = this->Opts.Pin;
    what.Seeds = !this->Opts.NoSeeds;
    return what;
  }

  /** Calls function(configuration) for every manager and balancer. */
  template <typename Function>
  void ForEachPolicy(Configuration what, Function function) const
  {
    for (const BalancePolicy balance : this->Opts.Balancers)
    {
      for (const ContentionPolicy contention : this->Opts.Managers)
      {
        what.Balance = balance;
        what.Contention = contention;
        function(what);
      }
    }
  }

  void AddStrong()
  {
    for (const unsigned threads : this->Opts.Threads)
    {
      if (threads > 1)
      {
        this->ForEachPolicy(this->With(threads),
          [&](const Configuration& what) { this->Strong.push_back(this->Runs.Add(what)); });
      }
    }
  }

  void AddOversubscribed()
  {
    this->ForEachPolicy(this->With(this->Opts.Oversubscribe),
      [&](const Configuration& many)
      {
        Configuration few = many;
        few.Threads = NumberOfThreads(0);
        this->Oversubscribed.emplace_back(this->Runs.Add(many), this->Runs.Add(few));
      });
  }

  void AddCeiling()
  {
    for (const unsigned copies : this->Opts.Threads)
    {
      Configuration what = this->With(1);
      what.Copies = copies;
      this->Ceiling.push_back(this->Runs.Add(what));
    }
  }

  /**
   * Makes one run with delta n^(-1/3), to find how the number of tetrahedra depends on delta for
   * this image. The dependence is between delta^(-2), as for interfaces, and delta^(-3), as for
   * volumes.
   */
  void AddWeak()
  {
    const double one = this->Runs.Try(this->With(1)).Tetrahedra;
    this->Weak.push_back(this->Baseline);
    for (const unsigned threads : this->Opts.Threads)
    {
      if (threads > 1)
      {
        Configuration what = this->With(threads);
        what.Delta = this->Opts.Delta * std::pow(threads, -1.0 / 3.0);
        const double measured = this->Runs.Try(what).Tetrahedra;
        const double exponent = std::log(measured / one) / std::log(this->Opts.Delta / what.Delta);
        what.Delta = this->Opts.Delta * std::pow(threads, -1.0 / std::clamp(exponent, 1.0, 4.0));
        this->ForEachPolicy(
          what, [&](const Configuration& each) { this->Weak.push_back(this->Runs.Add(each)); });
      }
    }
  }

  /** The members of a selection for which condition(configuration) holds. */
  template <typename Condition>
  Selection Select(const Selection& from, Condition condition) const
  {
    Selection result;
    std::copy_if(from.begin(), from.end(), std::back_inserter(result),
      [&](std::size_t i) { return condition(this->Runs[i].What); });
    return result;
  }

  void PrintPolicies(const Selection& strong) const;

  const ScalingOptions& Opts;
  ScalingRuns Runs;
  std::size_t Baseline = 0;
  Selection Strong;
  Selection Weak;
  Selection Ceiling;
  std::optional<std::size_t> Synchronised;
  std::vector<std::pair<std::size_t, std::size_t>> Oversubscribed;
};

/** Prints managers side by side for each number of threads, and balancers for the first manager. */
void Experiment::PrintPolicies(const Selection& strong) const
{
  std::vector<unsigned> numbers;
  for (const std::size_t i : strong)
  {
    numbers.push_back(this->Runs[i].What.Threads);
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  for (const unsigned threads : numbers)
  {
    std::printf("Contention managers, %u threads, %s; overheads of all threads together (as table "
                "3.1 of the thesis):\n\n",
      threads, NameOf(this->Opts.Balancers.front()));
    this->Tables().PrintManagers(this->Select(strong,
      [&](const Configuration& what)
      { return what.Threads == threads && what.Balance == this->Opts.Balancers.front(); }));
  }
  if (this->Opts.Balancers.size() > 1)
  {
    std::printf("Load balancers (as figure 3.5 of the thesis):\n\n");
    this->Tables().PrintBalancers(this->Select(strong,
      [&](const Configuration& what) { return what.Contention == this->Opts.Managers.front(); }));
  }
}

void Experiment::Print() const
{
  const ScalingTables tables = this->Tables();
  Selection strong = this->Strong;
  for (const auto& [many, few] : this->Oversubscribed)
  {
    for (const std::size_t i : { few, many })
    {
      if (std::find(strong.begin(), strong.end(), i) == strong.end())
      {
        strong.push_back(i);
      }
    }
  }
  if (!strong.empty())
  {
    Selection all = strong;
    all.insert(all.begin(), this->Baseline);
    std::printf("### Strong scaling\n\n");
    tables.PrintTimes(all);
    tables.PrintOverheads(all);
    this->PrintPolicies(strong);
  }
  if (!this->Oversubscribed.empty())
  {
    std::printf("### More threads than cores\n\n");
    tables.PrintOversubscribed(this->Oversubscribed);
  }
  if (!this->Ceiling.empty())
  {
    std::printf("### Upper limit of the machine: independent processes of one thread\n\n");
    tables.PrintCeiling(this->Ceiling);
  }
  if (this->Synchronised)
  {
    std::printf("### Cost of the code for several threads with one thread\n\n");
    tables.PrintSynchronised(*this->Synchronised);
  }
  if (!this->Weak.empty())
  {
    std::printf("### Weak scaling (as table 3.4 of the thesis)\n\n");
    this->ForEachPolicy(this->With(1),
      [&](const Configuration& policy)
      {
        std::printf("%s, %s:\n\n", NameOf(policy.Contention), NameOf(policy.Balance));
        tables.PrintWeak(this->Select(this->Weak,
          [&](const Configuration& what)
          {
            return what.Threads == 1 ||
              (what.Contention == policy.Contention && what.Balance == policy.Balance);
          }));
      });
  }
}

MeshingOptions<3> DefaultsOf(const ScalingOptions& options, unsigned threads)
{
  MeshingOptions<3> result;
  result.Team.Threads = threads;
  result.Team.Contention = options.Managers.front();
  result.Team.Balance = options.Balancers.front();
  result.Team.Pin = options.Pin;
  result.Team.SeedsPerThread = options.NoSeeds ? 0 : result.Team.SeedsPerThread;
  return result;
}

/** Compares the quality of several meshes made by several threads with that of one thread. */
void CompareQuality(
  const ScalingOptions& options, LabelVolume& image, unsigned threads, std::ostream& json)
{
  const std::string name = std::to_string(threads) + " threads";
  const auto contestant = [&](const char* title, unsigned number)
  {
    return Contestant{ title,
      [&, number](double delta)
      {
        MeshingOptions<3> meshing = DefaultsOf(options, number);
        meshing.Sampling.Delta = delta;
        return RunVoxplex(std::move(image), meshing).Run;
      },
      options.Delta };
  };
  Contestant one = contestant("one thread", 1);
  Contestant many = contestant(name.c_str(), threads);
  const LabelVolumes volumes = VolumesOf(image);
  AddRun(one, volumes); // one run is enough: the mesh is always the same
  for (int i = 0; i < options.Quality; ++i)
  {
    std::fprintf(stderr, "quality with %u threads, %d of %d\n", threads, i + 1, options.Quality);
    AddRun(many, volumes);
  }
  std::printf("### Quality of %d meshes with %u threads (%s, %s)\n\n", options.Quality, threads,
    NameOf(options.Managers.front()), NameOf(options.Balancers.front()));
  PrintSpread(one, many);
  json << "{ \"threads\": " << threads << ",\n  \"one\": ";
  WriteJson(json, one);
  json << ",\n  \"many\": ";
  WriteJson(json, many);
  json << " }";
}

/** Sets options.Delta so that the mesh has options.Elements tetrahedra. */
void Tune(ScalingOptions& options, LabelVolume& image)
{
  Contestant voxplex{ "Voxplex",
    [&](double delta)
    { return RunVoxplex(std::move(image), delta, options.Threads.back(), Care::Default); } };
  const double spacing = std::cbrt(image.Spacing[0] * image.Spacing[1] * image.Spacing[2]);
  TuneSize(voxplex, options.Delta > 0.0 ? options.Delta : 2.0 * spacing, options.Elements);
  options.Delta = voxplex.Size;
}

void Measure(ScalingOptions options)
{
  LabelVolume image = ReadLabelVolume(options.Image);
  if (options.Elements > 0.0)
  {
    Tune(options, image);
  }
  std::ostringstream json;
  json.precision(10);
  json << "{\n  \"delta\": " << options.Delta << ",\n  \"cores\": " << NumberOfThreads(0);

  std::printf("Delta %.4g, %u cores, medians of %d runs of each, in turns.\n\n", options.Delta,
    NumberOfThreads(0), options.Repeat);
  if (options.Strong || options.Weak || options.Synchronise || options.Ceiling ||
    options.Oversubscribe > 0)
  {
    Experiment experiment(options, image);
    experiment.Run();
    experiment.Print();
    json << ",\n  \"series\": ";
    experiment.WriteJson(json);
  }
  json << ",\n  \"quality\": [";
  if (options.Quality > 0)
  {
    CompareQuality(options, image, options.Threads.back(), json);
    if (options.Oversubscribe > 0)
    {
      json << ", ";
      CompareQuality(options, image, options.Oversubscribe, json);
    }
  }
  json << "]\n}\n";
  if (!options.Json.empty())
  {
    std::ofstream file(options.Json);
    file << json.str();
    if (!file.flush())
    {
      throw std::runtime_error("cannot write " + options.Json);
    }
  }
}

} // namespace

int main(int argc, char** argv)
{
  return RunProgram(argc, argv, ScalingUsage, ParseScalingOptions,
    [](const ScalingOptions& options) { Measure(options); });
}
