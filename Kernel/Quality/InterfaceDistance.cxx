// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/InterfaceDistance.h"

#include "Geometry/BoundingTree.h"
#include "Geometry/Triangle.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace voxplex
{
namespace
{

/** Points measured at a time. Fixed, so that sums do not depend on the number of threads. */
constexpr std::size_t Grain = 4096;

/** A percentile, interpolated between ranks. Changes the order of the values. */
double Percentile(std::vector<double>& values, double fraction)
{
  const double rank = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), at, values.end());
  const double low = *at;
  const double weight = rank - static_cast<double>(below);
  if (weight == 0.0 || below + 1 == values.size() || std::isinf(low))
  {
    return low;
  }
  return low + weight * (*std::min_element(at + 1, values.end()) - low);
}

/**
 * Figures of distanceAt(point, hint) over all points. A search of the tree starts from the hint.
 */
template <typename DistanceAt>
DistanceFigures Measure(const std::vector<Point<3>>& points, unsigned threads,
  const std::stop_token& stop, DistanceAt&& distanceAt)
{
  DistanceFigures figures;
  figures.Points = points.size();
  if (points.empty())
  {
    return figures;
  }
  std::vector<double> distances(points.size());
  std::vector<double> sums((points.size() - 1) / Grain + 1);
  ParallelFor(
    0, points.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      std::uint32_t hint = 0;
      double part = 0.0;
      for (std::size_t i = first; i < last; ++i)
      {
        distances[i] = distanceAt(points[i], hint);
        part += distances[i];
      }
      sums[first / Grain] = part;
    },
    stop);
  double sum = 0.0;
  for (const double part : sums)
  {
    sum += part;
  }
  const auto largest = std::max_element(distances.begin(), distances.end());
  figures.Maximum = *largest;
  figures.Place = points[static_cast<std::size_t>(largest - distances.begin())];
  figures.Mean = sum / static_cast<double>(points.size());
  figures.Percentile99 = Percentile(distances, 0.99);
  return figures;
}

/** The vertices and the centroids of the interfaces. */
std::vector<Point<3>> MakeSamples(const SimplexMesh<3>& mesh)
{
  std::vector<char> isUsed(mesh.Points.size());
  for (const auto& facet : mesh.Facets)
  {
    for (const std::uint32_t point : facet)
    {
      isUsed[point] = 1;
    }
  }
  std::vector<Point<3>> samples;
  for (std::size_t i = 0; i < isUsed.size(); ++i)
  {
    if (isUsed[i])
    {
      samples.push_back(mesh.Points[i]);
    }
  }
  for (const auto& facet : mesh.Facets)
  {
    Point<3> centroid;
    for (std::size_t k = 0; k < 3; ++k)
    {
      centroid[k] =
        (mesh.Points[facet[0]][k] + mesh.Points[facet[1]][k] + mesh.Points[facet[2]][k]) / 3.0;
    }
    samples.push_back(centroid);
  }
  return samples;
}

/** The distance from p to the interface point that the domain finds; infinite if it finds none. */
double DistanceFrom(const Domain<3>& domain, const Point<3>& p)
{
  Point<3> z;
  return domain.ClosestSurfacePoint(p, domain.Label(p), z)
    ? Distance(p, z)
    : std::numeric_limits<double>::infinity();
}

} // namespace

double HausdorffFigures::Distance() const
{
  const double one = this->MeshToImage.Maximum;
  const double other = this->ImageToMesh.Maximum;
  return std::isnan(one) || std::isnan(other) ? DistanceFigures::NotApplicable
                                              : std::max(one, other);
}

HausdorffFigures MeasureHausdorff(const SimplexMesh<3>& mesh, const std::vector<Point<3>>& image,
  const Domain<3>* domain, unsigned threads, const std::stop_token& stop)
{
  HausdorffFigures figures;
  {
    const BoundingTree<Triangle> triangles(TrianglesOf(mesh), threads, stop);
    figures.ImageToMesh = Measure(image, threads, stop,
      [&](const Point<3>& p, std::uint32_t& hint)
      { return std::sqrt(triangles.Distance2To(p, hint)); });
  }
  const BoundingTree<Point<3>> points(image, threads, stop);
  figures.MeshToImage = Measure(MakeSamples(mesh), threads, stop,
    [&](const Point<3>& p, std::uint32_t& hint)
    {
      const double distance = std::sqrt(points.Distance2To(p, hint));
      return domain ? std::min(distance, DistanceFrom(*domain, p)) : distance;
    });
  return figures;
}

} // namespace voxplex
