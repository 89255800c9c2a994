// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CompareMesh3.cxx
 * @brief voxplexCompareMesh3: compares Voxplex and CGAL Mesh_3 on one image, with about the same
 * number of tetrahedra.
 *
 * Every run is a separate child process. The two meshers take turns, so that changes in the
 * machine's speed affect both equally. The same routine measures the quality of both meshes. GPL
 * because of CGAL: never installed.
 */
#include "CommandLine.h"
#include "MeshComparison.h"
#include "MeshReport.h"
#include "Statistics.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

using namespace voxplex::benchmarks;

namespace
{

constexpr const char* Usage =
  R"(usage: voxplexCompareMesh3 IMAGE --delta D [options]

Meshes a label image with Voxplex and with CGAL Mesh_3 and prints both, side by side.

  --delta D        sampling distance of Voxplex, in the unit of the image's spacing
  --elements N     tetrahedra to aim at: delta is tuned (from D, if given), and CGAL's size
                   (default: as many as Voxplex makes with D)
  --cgal-size S    bound of CGAL's surface Delaunay balls; default: tuned to 3 % of the number of
                   tetrahedra of Voxplex
  --cgal-parallel  CGAL's Parallel_tag on one thread too (it orders its work differently)
  --repeat K       runs of each (default 3); medians are printed
  --threads T      threads of each (default 1; CGAL takes Parallel_tag for more than one)
  --plain          Voxplex leaves slivers and small components alone, as CGAL's refinement does
  --no-cgal        Voxplex only
  --only-cgal      CGAL only; needs --elements or --cgal-size
  --json FILE      also writes medians, ratios and all runs to FILE
)";

struct Options
{
  std::string Image;
  std::string Json;
  double Delta = 0.0;
  double CgalSize = 0.0;
  double Elements = 0.0;
  int Repeat = 3;
  unsigned Threads = 1;
  bool CgalParallel = false;
  Care How = Care::Default;
  bool Voxplex = true;
  bool Cgal = true;
};

Options ParseArguments(int argc, char** argv)
{
  Options options;
  using Text = const std::string&;
  ArgumentTable table;
  table.WithValue = {
    { "--delta", [&](Text value) { options.Delta = ParseNumber(value); } },
    { "--elements", [&](Text value) { options.Elements = ParseNumber(value); } },
    { "--cgal-size", [&](Text value) { options.CgalSize = ParseNumber(value); } },
    { "--repeat", [&](Text value) { options.Repeat = static_cast<int>(ParseCount(value)); } },
    { "--threads", [&](Text value) { options.Threads = ParseCount(value); } },
    { "--json", [&](Text value) { options.Json = value; } },
  };
  table.Flags = {
    { "--cgal-parallel", [&] { options.CgalParallel = true; } },
    { "--plain", [&] { options.How = Care::Plain; } },
    { "--no-cgal", [&] { options.Cgal = false; } },
    { "--only-cgal", [&] { options.Voxplex = false; } },
  };
  table.File = &options.Image;
  ReadArguments(argc, argv, table);
  const bool sized =
    options.Elements > 0.0 || (options.Voxplex ? options.Delta > 0.0 : options.CgalSize > 0.0);
  if (options.Image.empty() || !sized)
  {
    throw std::invalid_argument("an image and a size are needed");
  }
  if (!(options.Voxplex || options.Cgal))
  {
    throw std::invalid_argument("nothing to run");
  }
  return options;
}

/** Chooses the sizes of both meshers so that they make about the same number of tetrahedra. */
void SettleSizes(
  const Options& options, const LabelVolume& image, Contestant& voxplex, Contestant& cgal)
{
  // The default start of a search is twice the mean spacing.
  const double meanSpacing = std::cbrt(image.Spacing[0] * image.Spacing[1] * image.Spacing[2]);
  const double start = options.Delta > 0.0 ? options.Delta : 2.0 * meanSpacing;
  const bool tuneCgal = options.Cgal && options.CgalSize == 0.0;
  double wanted = options.Elements;
  voxplex.Size = options.Delta;
  cgal.Size = options.CgalSize;
  if (options.Voxplex && wanted > 0.0)
  {
    wanted = TuneSize(voxplex, start, wanted);
  }
  else if (options.Voxplex && tuneCgal)
  {
    wanted = CountTetrahedra(voxplex, voxplex.Size);
  }
  if (tuneCgal)
  {
    TuneSize(cgal, options.Voxplex ? voxplex.Size : start, wanted);
  }
}

/** Warns if the meshes differ in size. Their times are then not comparable. */
void WarnIfUnlike(const Contestant& voxplex, const Contestant& cgal)
{
  const double ratio =
    MedianPair(voxplex.Records, cgal.Records, [](const Record& r) { return r.Tetrahedra(); }).Ratio;
  if (ratio > 0.0 && std::abs(ratio - 1.0) > SizeTolerance)
  {
    std::fprintf(
      stderr, "warning: the meshes differ in size by more than %.0f %%\n", 100.0 * SizeTolerance);
  }
}

void WriteJsonFile(const Options& options, const Contestant& voxplex, const Contestant& cgal)
{
  std::ofstream file(options.Json);
  file.precision(10);
  file << "{\n  \"threads\": " << options.Threads << ",\n  \"cgal_tag\": \""
       << (options.CgalParallel || options.Threads > 1 ? "Parallel_tag" : "Sequential_tag") << "\"";
  for (const Contestant* contestant : { &voxplex, &cgal })
  {
    file << ",\n  \"" << contestant->Name << "\": ";
    WriteJson(file, *contestant);
  }
  file << ",\n  \"ratios\":\n      ";
  WriteRatios(file, voxplex, cgal);
  file << "\n}\n";
  if (!file.flush())
  {
    throw std::runtime_error("cannot write " + options.Json);
  }
}

void Compare(const Options& options)
{
  LabelVolume image = ReadLabelVolume(options.Image);
  const LabelVolumes volumes = VolumesOf(image);
  Contestant voxplex{ "Voxplex", [&](double delta) {
                       return RunVoxplex(std::move(image), delta, options.Threads, options.How);
                     } };
  Contestant cgal{ "CGAL Mesh_3",
    [&](double size) { return RunCgal(image, size, options.Threads, options.CgalParallel); } };
  SettleSizes(options, image, voxplex, cgal);
  for (int i = 0; i < options.Repeat; ++i)
  {
    if (options.Voxplex)
    {
      AddRun(voxplex, volumes);
    }
    if (options.Cgal)
    {
      AddRun(cgal, volumes);
    }
  }
  std::printf("%s, %u thread(s), medians of %d%s\n\n", options.Image.c_str(), options.Threads,
    options.Repeat, options.CgalParallel || options.Threads > 1 ? ", CGAL with Parallel_tag" : "");
  PrintTable(voxplex, cgal);
  WarnIfUnlike(voxplex, cgal);
  if (!options.Json.empty())
  {
    WriteJsonFile(options, voxplex, cgal);
  }
}

} // namespace

int main(int argc, char** argv)
{
  return RunProgram(argc, argv, Usage, ParseArguments, Compare);
}
