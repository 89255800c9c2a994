// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Meshes of a digital ball against the true sphere, by smoothing and delta: the table of
// Documentation/Algorithm.md.
#include "ImageMesher.h"

#include "../Testing/Kernel/MeshChecks.h"
#include "../Testing/Kernel/Phantoms.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <set>

using namespace voxplex;

namespace
{

struct Accuracy
{
  double Distance = 0.0; ///< of interface vertices from the sphere, mean, voxels
  double Normal = 0.0;   ///< error of facet normals, mean, degrees
  double Volume = 0.0;   ///< relative error
  std::size_t Elements = 0;
};

Accuracy Measure(const LabelImage<3>& image, double radius, double sigma, double delta)
{
  MeshingOptions<3> options;
  options.Delta = delta;
  options.SmoothingSigma = sigma;
  ImageMesher<3> mesher(options);
  SimplexMesh<3> mesh;
  mesher.Run(image, mesh);

  const double c = 0.5 * static_cast<double>(image.Grid().Dimensions[0] - 1);
  const Point<3> centre = { c, c, c };
  Accuracy accuracy;
  std::set<std::uint32_t> vertices;
  for (const auto& f : mesh.Facets)
  {
    vertices.insert(f.begin(), f.end());
    const Point<3>& p = mesh.Points[f[0]];
    const Point<3> normal =
      checks::Cross(Subtract(mesh.Points[f[1]], p), Subtract(mesh.Points[f[2]], p));
    Point<3> outwards = Subtract(p, centre);
    for (std::size_t k = 0; k < 3; ++k)
    {
      outwards[k] += (mesh.Points[f[1]][k] + mesh.Points[f[2]][k] - 2.0 * p[k]) / 3.0;
    }
    const Point<3> cross = checks::Cross(normal, outwards);
    accuracy.Normal += std::atan2(std::sqrt(Dot(cross, cross)), Dot(normal, outwards)) * 180.0 /
      std::numbers::pi / static_cast<double>(mesh.Facets.size());
  }
  for (const std::uint32_t v : vertices)
  {
    accuracy.Distance +=
      std::abs(Distance(mesh.Points[v], centre) - radius) / static_cast<double>(vertices.size());
  }
  double volume = 0.0;
  for (const auto& [label, v] : checks::Volumes(mesh))
  {
    volume += v;
  }
  accuracy.Volume = volume / (4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3)) - 1.0;
  accuracy.Elements = mesh.Simplices.size();
  return accuracy;
}

} // namespace

int main(int argc, char** argv)
{
  const double radius = argc > 1 ? std::atof(argv[1]) : 20.0;
  if (argc > 2 || !(radius >= 2.0 && radius <= 200.0))
  {
    std::fprintf(
      stderr, "usage: voxplexBallAccuracy [RADIUS]\nRADIUS: 2 to 200 voxels, default 20\n");
    return 2;
  }
  const LabelImage<3> image = phantoms::Ball(radius);
  std::printf(
    "ball of radius %g voxels\nsigma  delta  distance  normal, deg  volume, %%  elements\n",
    radius);
  for (const double sigma : { 0.0, 0.7, 1.0, 1.3 })
  {
    for (const double delta : { 2.0, 1.0 })
    {
      const Accuracy a = Measure(image, radius, sigma, delta);
      std::printf("%5.1f  %5.1f  %8.3f  %11.2f  %9.2f  %8zu\n", sigma, delta, a.Distance, a.Normal,
        100.0 * a.Volume, a.Elements);
    }
  }
  return 0;
}
