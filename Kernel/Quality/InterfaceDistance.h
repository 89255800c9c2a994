// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceDistance.h
 * @brief Hausdorff distances between the interfaces of a mesh and those of an image.
 */
#ifndef voxplex_InterfaceDistance_h
#define voxplex_InterfaceDistance_h

#include "Domain/Domain.h"
#include "Geometry/Point.h"
#include "Mesh/SimplexMesh.h"

#include <cstdint>
#include <limits>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** Distances of many points, in the unit of length of the frame; NaN without points. */
struct DistanceFigures
{
  static constexpr double NotApplicable = std::numeric_limits<double>::quiet_NaN();

  double Maximum = NotApplicable; ///< infinite if there is nothing to measure to
  double Mean = NotApplicable;
  double Percentile99 = NotApplicable; ///< interpolated linearly between the two nearest ranks
  Point<3> Place{};                    ///< the first point with the largest distance
  std::uint64_t Points = 0;
};

/** Both directions. The symmetric Hausdorff distance is the larger of the two maxima. */
struct HausdorffFigures
{
  DistanceFigures MeshToImage;
  DistanceFigures ImageToMesh;

  /** NaN if either is. */
  double Distance() const;
};

/**
 * Measures the distances between the interfaces of a mesh (Facets) and points all over the
 * interfaces of an image (InterfacePoints.h).
 *
 * - From the image to the mesh: the distance of each point to the nearest triangle, exact up to
 *   rounding.
 * - From the mesh to the image: the distance of each vertex and each centroid of the triangles to
 *   the nearest point of the image. Each triangle has one centroid, however large it is.
 *
 * O((n + m) log(n + m)) for n triangles and m points. The result does not depend on the number of
 * threads.
 *
 * @param image in the mesh's frame; fewer than 2^32
 * @param domain if given, the distance of a point of the mesh is at most the distance to the
 *   interface point that the domain finds for it (ClosestSurfacePoint). This removes the error that
 *   the image's points are a voxel apart.
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
HausdorffFigures MeasureHausdorff(const SimplexMesh<3>& mesh, const std::vector<Point<3>>& image,
  const Domain<3>* domain, unsigned threads, const std::stop_token& stop = {});

} // namespace voxplex

#endif
