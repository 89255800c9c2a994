// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointsRun.h
 * @brief Delaunay triangulation of given points by Voxplex and by CGAL.
 */
#ifndef voxplex_PointsRun_h
#define voxplex_PointsRun_h

#include "Geometry/Point.h"

#include <cstdint>
#include <vector>

namespace voxplex::benchmarks
{

struct PointsRun
{
  double Seconds = 0.0;    ///< insertion only, of sorted points
  double CpuSeconds = 0.0; ///< processor time of the same
  std::uint64_t Simplices = 0;
  std::uint64_t PeakBytes = 0;
};

/**
 * Sorts points of the unit cube so that consecutive points are near each other.
 * @param rounds true: biased random insertion order (CGAL::spatial_sort), with Hilbert curves
 *   through random halves; false: one Hilbert curve through all points
 */
template <int D>
void SortSpatially(std::vector<Point<D>>& points, bool rounds);

/** Voxplex. The box is the unit cube. A walk from the previous point locates each point. */
template <int D>
PointsRun TriangulateWithVoxplex(const std::vector<Point<D>>& points);

/**
 * CGAL::Delaunay_triangulation_3 (D = 3) or CGAL::Delaunay_triangulation (D = 4). The corners of
 * the unit cube are inserted first, so that both triangulate the same points. Each point has the
 * previous one as a hint, as in CGAL's insertion of a range after sorting. GPL: never to be
 * installed.
 */
template <int D>
PointsRun TriangulateWithCgal(const std::vector<Point<D>>& points);

/** The corners of the unit cube. */
template <int D>
std::vector<Point<D>> UnitCubeCorners()
{
  std::vector<Point<D>> corners(1u << D);
  for (unsigned c = 0; c < corners.size(); ++c)
  {
    for (unsigned axis = 0; axis < static_cast<unsigned>(D); ++axis)
    {
      corners[c][axis] = (c >> axis) & 1u;
    }
  }
  return corners;
}

} // namespace voxplex::benchmarks

#endif
