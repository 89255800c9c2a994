// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Compares meshes of a digital ball, and of grey-value images of the same ball, with the exact
// sphere, for several values of smoothing and delta. Benchmarks/Notebook.md has figures of it.
#include "Mesher/ImageMesher.h"

#include "../Testing/Kernel/Support/MeshChecks.h"
#include "../Testing/Kernel/Support/Phantoms.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <set>
#include <vector>

using namespace voxplex;

namespace
{

struct Accuracy
{
  double Distance = 0.0; ///< mean distance of interface vertices from the sphere, voxels
  double Farthest = 0.0; ///< the largest such distance
  double Normal = 0.0;   ///< mean error of facet normals, degrees
  double Volume = 0.0;   ///< relative error
  std::size_t Elements = 0;
};

/** Meshes a ball in the middle of a cube of voxels, and measures its accuracy. */
template <typename Image>
Accuracy Measure(
  const Image& image, const GridGeometry<3>& grid, double radius, double sigma, double delta)
{
  MeshingOptions<3> options;
  options.Sampling.Delta = delta;
  options.SmoothingSigma = sigma;
  ImageMesher<3> mesher(options);
  SimplexMesh<3> mesh;
  mesher.Run(image, mesh);

  const double c = 0.5 * static_cast<double>(grid.Dimensions[0] - 1);
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
    const double distance = std::abs(Distance(mesh.Points[v], centre) - radius);
    accuracy.Distance += distance / static_cast<double>(vertices.size());
    accuracy.Farthest = std::max(accuracy.Farthest, distance);
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

/** The fraction of a voxel that is in the ball, to 1/512. */
double PartInside(const Point<3>& voxel, const Point<3>& centre, double radius)
{
  const double r = Distance(voxel, centre);
  if (std::abs(r - radius) > 1.0)
  {
    return r < radius ? 1.0 : 0.0;
  }
  int inside = 0;
  for (int i = 0; i < 512; ++i)
  {
    Point<3> p = voxel;
    for (std::size_t a = 0; a < 3; ++a)
    {
      p[a] += (((i >> (3 * a)) & 7) + 0.5) / 8.0 - 0.5;
    }
    inside += Distance(p, centre) < radius;
  }
  return inside / 512.0;
}

/** A grey-value image of a ball: the value of each voxel, and the isovalue. */
struct GreyBall
{
  const char* Name;
  std::function<double(const Point<3>& voxel, const Point<3>& centre)> Value;
  double Isovalue;
};

void MeasureGrey(const GreyBall& ball, const GridGeometry<3>& grid, double radius)
{
  const double c = 0.5 * static_cast<double>(grid.Dimensions[0] - 1);
  std::vector<float> values;
  for (std::int64_t k = 0; k < grid.Dimensions[2]; ++k)
  {
    for (std::int64_t j = 0; j < grid.Dimensions[1]; ++j)
    {
      for (std::int64_t i = 0; i < grid.Dimensions[0]; ++i)
      {
        const Point<3> voxel = { static_cast<double>(i), static_cast<double>(j),
          static_cast<double>(k) };
        values.push_back(static_cast<float>(ball.Value(voxel, { c, c, c })));
      }
    }
  }
  const auto image = IsosurfaceImage<3>::FromScalars<float>(values, grid, { ball.Isovalue });
  const Accuracy a = Measure(image, grid, radius, 0.0, 2.0);
  std::printf("%-20s %8.3f  %8.3f  %11.2f  %9.2f  %8zu\n", ball.Name, a.Distance, a.Farthest,
    a.Normal, 100.0 * a.Volume, a.Elements);
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
  std::printf("ball of radius %g voxels\nsigma  delta  distance   at most  normal, deg  volume, %% "
              " elements\n",
    radius);
  for (const double sigma : { 0.0, 0.7, 1.0, 1.3 })
  {
    for (const double delta : { 2.0, 1.0 })
    {
      const Accuracy a = Measure(image, image.Grid(), radius, sigma, delta);
      std::printf("%5.1f  %5.1f  %8.3f  %8.3f  %11.2f  %9.2f  %8zu\n", sigma, delta, a.Distance,
        a.Farthest, a.Normal, 100.0 * a.Volume, a.Elements);
    }
  }
  std::printf("grey values, delta 2  distance   at most  normal, deg  volume, %%  elements\n");
  const std::vector<GreyBall> balls = {
    { "signed distance",
      [=](const Point<3>& p, const Point<3>& centre) { return radius - Distance(p, centre); },
      0.0 },
    { "blurred by 1 voxel",
      [=](const Point<3>& p, const Point<3>& centre)
      { return 0.5 * (1.0 + std::erf((radius - Distance(p, centre)) / std::numbers::sqrt2)); },
      0.5 },
    { "part inside",
      [=](const Point<3>& p, const Point<3>& centre) { return PartInside(p, centre, radius); },
      0.5 },
    { "the same in 8 bits",
      [=](const Point<3>& p, const Point<3>& centre)
      { return std::round(255.0 * PartInside(p, centre, radius)); },
      127.5 },
  };
  for (const GreyBall& ball : balls)
  {
    MeasureGrey(ball, image.Grid(), radius);
  }
  return 0;
}
