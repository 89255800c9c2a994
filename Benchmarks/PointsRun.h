// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointsRun.h
 * @brief Delaunay triangulation of given points, ours and CGAL's.
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
  double Seconds = 0.0;    ///< insertion alone; the points come sorted
  double CpuSeconds = 0.0; ///< processor time of the same
  std::uint64_t Simplices = 0;
  std::uint64_t PeakBytes = 0;
};

/**
 * Sorts points of the unit cube so that neighbours are near each other.
 * @param rounds biased random insertion order (CGAL::spatial_sort): Hilbert curves through random
 *   halves; else one Hilbert curve through all
 */
template <int D>
void SortSpatially(std::vector<Point<D>>& points, bool rounds);

/** Voxplex: the unit cube as the box, each point located by a walk from the one before. */
template <int D>
PointsRun TriangulateWithVoxplex(const std::vector<Point<D>>& points);

/**
 * CGAL::Delaunay_triangulation_3 (D = 3) or CGAL::Delaunay_triangulation (D = 4), with the corners
 * of the unit cube inserted first, so that both triangulate the same points. Each point has the one
 * before as a hint, which is what CGAL's insertion of a range does after sorting. GPL: never to be
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
