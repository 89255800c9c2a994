// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ComparePoints.cxx
 * @brief voxplexComparePoints: inserts random points of the unit cube, with Voxplex and CGAL in
 * turns.
 *
 * Both insert the same points in the same spatially sorted order. Sorting is not timed. Every run
 * is a separate child process. GPL because of CGAL: never installed.
 */
#include "ChildProcess.h"
#include "CommandLine.h"
#include "PointsRun.h"
#include "RandomPoints.h"
#include "Statistics.h"

#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>

using namespace voxplex::benchmarks;

namespace
{

constexpr const char* Usage =
  R"(usage: voxplexComparePoints [--dimension 3|4] [--points N] [--repeat K] [--seed S] [--hilbert]

Inserts N random points (default 500000 in 3D, 20000 in 4D) into Voxplex's and CGAL's Delaunay
triangulation, K times each in turns (default 5), and prints medians.

  --hilbert  points along one Hilbert curve; default: CGAL's biased random insertion order, which
             CGAL takes for ranges of points
)";

struct Options
{
  int Dimension = 3;
  std::size_t Points = 0;
  int Repeat = 5;
  unsigned Seed = 1;
  bool Rounds = true;
};

Options ParseArguments(int argc, char** argv)
{
  Options options;
  using Text = const std::string&;
  constexpr unsigned largest = std::numeric_limits<unsigned>::max();
  ArgumentTable table;
  table.WithValue = {
    { "--dimension", [&](Text value) { options.Dimension = static_cast<int>(ParseCount(value)); } },
    { "--points", [&](Text value) { options.Points = ParseCount(value, largest); } },
    { "--repeat", [&](Text value) { options.Repeat = static_cast<int>(ParseCount(value)); } },
    { "--seed", [&](Text value) { options.Seed = ParseCount(value, largest); } },
  };
  table.Flags = { { "--hilbert", [&] { options.Rounds = false; } } };
  ReadArguments(argc, argv, table);
  if (options.Dimension != 3 && options.Dimension != 4)
  {
    throw std::invalid_argument("the dimension is 3 or 4");
  }
  if (options.Points == 0)
  {
    options.Points = options.Dimension == 3 ? 500000 : 20000;
  }
  return options;
}

/** Prints a row of the table: the medians of both, and the median of the ratios of each turn. */
void PrintRow(const char* name, int digits, const std::vector<PointsRun>& voxplex,
  const std::vector<PointsRun>& cgal, double (*value)(const PointsRun&))
{
  const PairedMedians row = MedianPair(voxplex, cgal, value);
  std::printf("%-18s %14.*f %14.*f %10.3f\n", name, digits, row.Left, digits, row.Right, row.Ratio);
}

template <int D>
void Compare(const Options& options)
{
  std::vector<voxplex::Point<D>> points =
    RandomPoints<D>(options.Points, Cube<D>(1.0), options.Seed);
  SortSpatially<D>(points, options.Rounds);
  std::vector<PointsRun> voxplex;
  std::vector<PointsRun> cgal;
  for (int i = 0; i < options.Repeat; ++i)
  {
    voxplex.push_back(RunInChild([&] { return TriangulateWithVoxplex<D>(points); }));
    cgal.push_back(RunInChild([&] { return TriangulateWithCgal<D>(points); }));
  }

  std::printf("%zu random points in %dD, seed %u, %s, medians of %d\n\n", options.Points, D,
    options.Seed, options.Rounds ? "biased random order" : "Hilbert order", options.Repeat);
  std::printf("%-18s %14s %14s %10s\n", "", "Voxplex", "CGAL", "ratio");
  const auto row = [&](const char* name, int digits, double (*value)(const PointsRun&))
  { PrintRow(name, digits, voxplex, cgal, value); };
  row("simplices", 0, [](const PointsRun& r) { return static_cast<double>(r.Simplices); });
  row("seconds", 4, [](const PointsRun& r) { return r.Seconds; });
  row("processor time, s", 4, [](const PointsRun& r) { return r.CpuSeconds; });
  row("simplices/s", 0,
    [](const PointsRun& r) { return static_cast<double>(r.Simplices) / r.Seconds; });
  row("peak memory, MB", 1,
    [](const PointsRun& r) { return static_cast<double>(r.PeakBytes) / 1e6; });
  if (voxplex.front().Simplices != cgal.front().Simplices)
  {
    throw std::runtime_error("the two triangulations differ");
  }
}

} // namespace

int main(int argc, char** argv)
{
  return RunProgram(argc, argv, Usage, ParseArguments,
    [](const Options& options)
    { options.Dimension == 3 ? Compare<3>(options) : Compare<4>(options); });
}
