// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RunMesh3.cxx
 * @brief voxplexRunMesh3: meshes a label image with CGAL Mesh_3, without and with perturbation and
 * exudation.
 *
 * Benchmarks/measure-quality compares with these meshes. Coordinates are indices times spacing. GPL
 * because of CGAL: never installed.
 */
#include "CommandLine.h"
#include "MeshComparison.h"
#include "WriteVtu.h"

#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>

using namespace voxplex::benchmarks;

namespace
{

constexpr const char* Usage =
  R"(usage: voxplexRunMesh3 IMAGE (--size S | --elements N) --prefix P [--no-meshes]

Meshes a label image with CGAL Mesh_3 on one thread, then perturbs and exudes the mesh. Writes
P-refined.vtu and P-optimised.vtu, and sizes and seconds to P.json.

  --size S       bound of the surface Delaunay balls
  --elements N   tetrahedra to aim at: the size is tuned until their number is within 3 %
  --no-meshes    P.json only, to repeat a measurement of time
)";

struct Options
{
  std::string Image;
  std::string Prefix;
  double Size = 0.0;
  double Elements = 0.0;
  bool Meshes = true;
};

Options ParseArguments(int argc, char** argv)
{
  Options options;
  using Text = const std::string&;
  ArgumentTable table;
  table.WithValue = {
    { "--size", [&](Text value) { options.Size = ParseNumber(value); } },
    { "--elements", [&](Text value) { options.Elements = ParseNumber(value); } },
    { "--prefix", [&](Text value) { options.Prefix = value; } },
  };
  table.Flags = { { "--no-meshes", [&] { options.Meshes = false; } } };
  table.File = &options.Image;
  ReadArguments(argc, argv, table);
  if (options.Image.empty() || options.Prefix.empty())
  {
    throw std::invalid_argument("an image and a prefix are needed");
  }
  if ((options.Size > 0.0) == (options.Elements > 0.0))
  {
    throw std::invalid_argument("either a size or a number of elements is needed");
  }
  return options;
}

void Run(const Options& options)
{
  const LabelVolume image = ReadLabelVolume(options.Image);
  double size = options.Size;
  if (options.Elements > 0.0)
  {
    Contestant cgal{ "CGAL Mesh_3", [&](double s) { return RunCgal(image, s, 1, false); } };
    const double meanSpacing = std::cbrt(image.Spacing[0] * image.Spacing[1] * image.Spacing[2]);
    TuneSize(cgal, 2.0 * meanSpacing, options.Elements);
    size = cgal.Size;
  }
  Optimisation optimisation;
  const MesherRun run = RunCgalAndOptimise(image, size, optimisation);
  if (options.Meshes)
  {
    WriteVtu(run.Mesh, options.Prefix + "-refined.vtu");
    WriteVtu(optimisation.Mesh, options.Prefix + "-optimised.vtu");
  }
  std::ofstream file(options.Prefix + ".json");
  file.precision(10);
  file << "{ \"size\": " << size << ", \"elements\": " << run.Mesh.Simplices.size()
       << ", \"elements_optimised\": " << optimisation.Mesh.Simplices.size()
       << ", \"refinement_seconds\": " << run.RefinementSeconds
       << ", \"perturb_seconds\": " << optimisation.PerturbSeconds
       << ", \"exude_seconds\": " << optimisation.ExudeSeconds << " }\n";
  if (!file.flush())
  {
    throw std::runtime_error("cannot write " + options.Prefix + ".json");
  }
}

} // namespace

int main(int argc, char** argv)
{
  return RunProgram(argc, argv, Usage, ParseArguments, Run);
}
