// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTime.cxx
 * @brief voxplexSpaceTime: pentatope meshes of phantoms, with and without picking regions, in both
 * orders of the rules, with several threads.
 *
 * Every run is a separate child process. All configurations take turns.
 */
#include "ChildProcess.h"
#include "CommandLine.h"
#include "MarkdownTable.h"
#include "Quality/FrameVolumes.h"
#include "SpaceTimeOptions.h"
#include "SpaceTimeRun.h"
#include "Statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

using namespace voxplex;
using namespace voxplex::benchmarks;

namespace
{

/** One way to mesh the phantom, and its runs. */
struct Series
{
  RuleOrder Order;
  bool Picking;
  unsigned Threads;
  std::vector<SpaceTimeRecord> Records;

  std::string Name() const
  {
    const std::string order = this->Order == RuleOrder::SurfaceFirst ? "surface" : "radius-edge";
    return order + " first, picking " + (this->Picking ? "on" : "off");
  }
  template <typename Value>
  double Median(Value value) const
  {
    return MedianOf(this->Records, value);
  }
};

using Value = std::function<double(const SpaceTimeRecord&)>;

/** The frames of a phantom, and then the same ones back to the first. */
phantoms::SpaceTimePhantom ThereAndBack(const phantoms::SpaceTimePhantom& phantom)
{
  phantoms::SpaceTimePhantom both = phantom;
  const std::int64_t last = phantom.Grid.Dimensions[3] - 1;
  both.Grid.Dimensions[3] = 2 * last + 1;
  const double step = phantom.Grid.IndexToFrame[3][3];
  both.Label = [label = phantom.Label, last, step](Point<4> p)
  {
    const std::int64_t frame = std::llround(p[3] / step);
    p[3] = frame > last ? static_cast<double>(2 * last - frame) * step : p[3];
    return label(p);
  };
  return both;
}

phantoms::SpaceTimePhantom MakePhantom(const SpaceTimeOptions& options)
{
  const std::map<std::string, std::function<phantoms::SpaceTimePhantom()>> phantoms = {
    { "beating-ventricle", [&] { return phantoms::BeatingVentricle(options.Coarsening); } },
    { "four-ball", [] { return phantoms::FourBall(12.0); } },
    { "merging-balls", [] { return phantoms::MergingBalls(); } },
    { "rotating-sheet", [] { return phantoms::RotatingSheet(); } },
    { "opening-tube", [] { return phantoms::OpeningTube(); } },
    { "fast-ball", [] { return phantoms::FastBall(); } },
    { "small-and-large", [] { return phantoms::SmallAndLarge(); } },
  };
  const auto found = phantoms.find(options.Phantom);
  if (found == phantoms.end())
  {
    throw std::invalid_argument("no such phantom: " + options.Phantom);
  }
  const phantoms::SpaceTimePhantom phantom =
    phantoms::WithTimeScale(found->second(), options.TimeScale);
  return options.Periodic ? ThereAndBack(phantom) : phantom;
}

/** All configurations, those of one thread first. */
std::vector<Series> ListSeries(const SpaceTimeOptions& options)
{
  std::vector<Series> series;
  for (const unsigned threads : options.Threads)
  {
    for (const RuleOrder order : options.Orders)
    {
      for (const bool picking : options.Picking)
      {
        series.push_back({ order, picking, threads, {} });
      }
    }
  }
  return series;
}

void RunAll(const SpaceTimeOptions& options, double delta, const std::vector<std::uint8_t>& scalars,
  const GridGeometry<4>& grid, std::vector<Series>& all)
{
  for (int round = 0; round < options.Repeat; ++round)
  {
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      Series& series = all[(i + static_cast<std::size_t>(round)) % all.size()];
      MeshingOptions<4> meshing;
      meshing.Sampling.Delta = delta;
      meshing.Sampling.Grading = options.Grading;
      meshing.Team.Threads = series.Threads;
      meshing.SpaceTime.Order = series.Order;
      meshing.SpaceTime.Slivers.Fight = series.Picking;
      meshing.Team.FineGrained = !options.NoFineGrained;
      meshing.Interfaces.Fit = !options.NoFit;
      meshing.Optimisation.Run = !options.NoOptimise;
      meshing.FrameSteps = options.FrameSteps;
      meshing.Planes.Periodic = options.Periodic;
      // One thread makes the same mesh in every round.
      const bool fit = (options.Frames || options.Row) && (series.Threads > 1 || round == 0);
      const SpaceTimeRecord record =
        RunInChild([&] { return MeshPhantom(scalars, grid, meshing, fit); });
      std::fprintf(stderr,
        "  round %d, %s, %u thread(s): %.0f pentatopes, %.3f s (grading %.3f s, %.0f samples), "
        "%.0f MB\n",
        round + 1, series.Name().c_str(), series.Threads, record.Pentatopes,
        record.RefinementSeconds, record.GradingSeconds, record.GradingSamples,
        static_cast<double>(record.PeakBytes) / 1e6);
      series.Records.push_back(record);
    }
  }
}

/** Prints a table with a row for each measure and a column for each series. */
void PrintSideBySide(const std::vector<const Series*>& columns,
  const std::vector<std::tuple<const char*, const char*, Value>>& rows)
{
  std::vector<std::string> header = { "" };
  for (const Series* series : columns)
  {
    header.push_back(series->Name());
  }
  MarkdownTable table(std::move(header));
  for (const auto& [name, format, value] : rows)
  {
    std::vector<std::string> row = { name };
    for (const Series* series : columns)
    {
      row.push_back(Format(series->Median(value), format));
    }
    table.Add(std::move(row));
  }
  table.Print();
}

void PrintMeshes(const std::vector<Series>& all)
{
  std::vector<const Series*> columns;
  for (const Series& series : all)
  {
    if (series.Threads == 1)
    {
      columns.push_back(&series);
    }
  }
  using R = const SpaceTimeRecord&;
  std::printf("### One thread (as tables 4.2 and 4.3 of the thesis)\n\n");
  PrintSideBySide(columns,
    {
      { "pentatopes", "", [](R r) { return r.Pentatopes; } },
      { "boundary tetrahedra", "", [](R r) { return r.BoundaryTetrahedra; } },
      { "vertices", "", [](R r) { return r.Vertices; } },
      { "shortest edge", "%.4g", [](R r) { return r.ShortestEdge; } },
      { "radius-edge ratio, largest", "%.3f", [](R r) { return r.RadiusEdgeMax; } },
      { "radius-edge ratio, mean", "%.3f", [](R r) { return r.RadiusEdgeMean; } },
      { "radius-edge ratio, deviation", "%.3f", [](R r) { return r.RadiusEdgeDeviation; } },
      { "normalized volume, smallest", "%.5f", [](R r) { return r.VolumeMin; } },
      { "normalized volume, mean", "%.3f", [](R r) { return r.VolumeMean; } },
      { "normalized volume, deviation", "%.3f", [](R r) { return r.VolumeDeviation; } },
      { "inverted pentatopes", "", [](R r) { return r.Inverted; } },
      { "slivers for which no point was found", "", [](R r) { return r.SliversKept; } },
      { "cavity, average", "%.1f", [](R r) { return r.AverageCavity; } },
      { "cavity, largest", "", [](R r) { return r.LargestCavity; } },
      { "preparation, s", "%.3f", [](R r) { return r.PreparationSeconds; } },
      { "refinement, s", "%.3f", [](R r) { return r.RefinementSeconds; } },
      { "extraction, s", "%.3f", [](R r) { return r.ExtractionSeconds; } },
      { "pentatopes/s of refinement", "", [](R r) { return r.Rate(); } },
      { "peak memory, MB", "%.1f", [](R r) { return static_cast<double>(r.PeakBytes) / 1e6; } },
    });
}

/**
 * Seconds are averages over threads. Speed-ups are medians of the ratios of rates in each round.
 */
void PrintThreads(const std::vector<Series>& all, std::size_t perThreads)
{
  std::printf("### Several threads; overheads of each thread, on average\n\n");
  MarkdownTable table({ "", "threads", "pentatopes", "refinement, s", "pentatopes/s", "speed-up",
    "contention, s", "load balance, s", "rollback, s", "rollbacks", "peak memory, MB" });
  using R = const SpaceTimeRecord&;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    const Series& series = all[i];
    const PairedMedians speedUp =
      MedianPair(series.Records, all[i % perThreads].Records, [](R r) { return r.Rate(); });
    table.Add({ series.Name(), Format(series.Threads),
      Format(series.Median([](R r) { return r.Pentatopes; })),
      Format(series.Median([](R r) { return r.RefinementSeconds; }), "%.3f"),
      Format(series.Median([](R r) { return r.Rate(); })), Format(speedUp.Ratio, "%.2f"),
      Format(series.Median([](R r) { return r.ContentionSeconds; }), "%.3f"),
      Format(series.Median([](R r) { return r.LoadBalanceSeconds; }), "%.3f"),
      Format(series.Median([](R r) { return r.RollbackSeconds; }), "%.3f"),
      Format(series.Median([](R r) { return r.Rollbacks; })),
      Format(series.Median([](R r) { return static_cast<double>(r.PeakBytes) / 1e6; }), "%.1f") });
  }
  table.Print();
}

/** Prints the fit of the first run of a series. */
void PrintFit(const Series& series)
{
  const Fit& fit = series.Records.front().Image;
  std::printf(
    "### Volumes against the image: %s, %u thread(s)\n\n", series.Name().c_str(), series.Threads);
  MarkdownTable table(
    { "frame", "label 1, image", "mesh", "error, %", "label 2, image", "mesh", "error, %" });
  std::array<double, MostLabels> worst{};
  const auto cells = [&](const char* name, const std::function<Compared(std::size_t)>& of)
  {
    std::vector<std::string> row = { name };
    for (std::size_t label = 0; label < MostLabels; ++label)
    {
      const Compared c = of(label);
      row.push_back(Format(c.Image));
      row.push_back(Format(c.Mesh));
      row.push_back(Format(100.0 * c.Error(), "%.2f"));
    }
    table.Add(std::move(row));
  };
  for (std::size_t frame = 0; frame < fit.Frames; ++frame)
  {
    cells(
      std::to_string(frame).c_str(), [&](std::size_t label) { return fit.Volume[label][frame]; });
    for (std::size_t label = 0; label < MostLabels; ++label)
    {
      worst[label] = std::max(worst[label], std::abs(fit.Volume[label][frame].Error()));
    }
  }
  cells("hypervolume", [&](std::size_t label) { return fit.Hypervolume[label]; });
  table.Print();
  std::printf(
    "Worst error in a frame: label 1 %.2f %%, label 2 %.2f %%. Lateral boundary tetrahedra with a "
    "vertex off the interface: %.0f of %.0f.\n\n",
    100.0 * worst[0], 100.0 * worst[1], fit.FacetsOffInterface, fit.LateralFacets);
}

/** The error that is the farthest from 0. */
double WorstError(const std::vector<Compared>& all)
{
  double worst = 0.0;
  for (const Compared& one : all)
  {
    worst = std::abs(one.Error()) > std::abs(worst) ? one.Error() : worst;
  }
  return worst;
}

/**
 * A row of Benchmarks/measure-space-time's table. Frames that CompareFrames() leaves out do not count.
 */
void PrintRow(const SpaceTimeOptions& options, double delta, const SpaceTimeRecord& record)
{
  const Fit& fit = record.Image;
  std::vector<Compared> frames;
  std::vector<Compared> wholes;
  for (std::size_t label = 0; label < MostLabels; ++label)
  {
    double largest = 0.0;
    for (std::size_t frame = 0; frame < fit.Frames; ++frame)
    {
      largest = std::max(largest, fit.Volume[label][frame].Image);
    }
    for (std::size_t frame = 0; frame < fit.Frames && largest > 0.0; ++frame)
    {
      const Compared& one = fit.Volume[label][frame];
      if (one.Image >= LeastShareOfLargest * largest)
      {
        frames.push_back(one);
      }
    }
    if (largest > 0.0)
    {
      wholes.push_back(fit.Hypervolume[label]);
    }
  }
  std::printf("| %s | %g | %g | %.0f | %+.2f | %+.2f | %.0f | %.4f | %.3f | %.2f | %.2f | %.2f |\n",
    options.Phantom.c_str(), delta, record.FrameSteps, record.Pentatopes,
    100.0 * WorstError(wholes), 100.0 * WorstError(frames), record.LostComponents, record.VolumeMin,
    record.VolumeMean, record.RadiusEdgeMax, record.RefinementSeconds, record.TotalSeconds);
}

void Measure(const SpaceTimeOptions& options, const phantoms::SpaceTimePhantom& phantom)
{
  const std::vector<std::uint8_t> scalars = phantom.Scalars();
  const auto& n = phantom.Grid.Dimensions;
  const double delta =
    options.Delta > 0.0 ? options.Delta : DefaultDelta<4>(phantom.Grid.VoxelVolume());
  std::vector<Series> all = ListSeries(options);
  RunAll(options, delta, scalars, phantom.Grid, all);

  if (options.Row)
  {
    PrintRow(options, delta, all.front().Records.front());
    return;
  }
  std::printf(
    "%s, %d x %d x %d x %d voxels, time scale %.4g, delta %.4g%s; medians of %d runs of each, in "
    "turns.\n\n",
    options.Phantom.c_str(), static_cast<int>(n[0]), static_cast<int>(n[1]), static_cast<int>(n[2]),
    static_cast<int>(n[3]), options.TimeScale, delta,
    options.NoFineGrained ? ", not fine-grained" : "", options.Repeat);
  PrintMeshes(all);
  if (options.Threads.size() > 1)
  {
    PrintThreads(all, options.Orders.size() * options.Picking.size());
  }
  if (options.Frames)
  {
    for (const Series& series : all)
    {
      PrintFit(series);
    }
  }
}

} // namespace

int main(int argc, char** argv)
{
  const auto parse = [](int count, char** arguments)
  {
    const SpaceTimeOptions options = ParseSpaceTimeOptions(count, arguments);
    return std::pair(options, MakePhantom(options));
  };
  return RunProgram(argc, argv, SpaceTimeUsage, parse,
    [](const auto& parsed) { Measure(parsed.first, parsed.second); });
}
