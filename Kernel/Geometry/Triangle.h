// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Triangle.h
 * @brief The distance of a point from a triangle.
 */
#ifndef voxplex_Triangle_h
#define voxplex_Triangle_h

#include "Geometry/Point.h"

#include <algorithm>

namespace voxplex
{

/** Squared distance of p from the segment ab. The segment may be a single point. */
inline double SegmentDistance2(const Point<3>& p, const Point<3>& a, const Point<3>& b)
{
  const Point<3> ab = Subtract(b, a);
  const double length2 = Dot(ab, ab);
  const double t = length2 > 0.0 ? std::clamp(Dot(Subtract(p, a), ab) / length2, 0.0, 1.0) : 0.0;
  return Distance2(p, Interpolate(a, b, t));
}

/** A triangle in space. It may be degenerate. */
struct Triangle
{
  Point<3> A;
  Point<3> B;
  Point<3> C;
};

/**
 * Squared distance of p from a triangle, interior included.
 *
 * Finds the nearest point by the Voronoi regions of the triangle's vertices, edges and interior
 * (C. Ericson, Real-Time Collision Detection, 2005, 5.1.5). Pure.
 */
inline double Distance2(const Point<3>& p, const Triangle& t)
{
  const Point<3> ab = Subtract(t.B, t.A);
  const Point<3> ac = Subtract(t.C, t.A);
  const Point<3> ap = Subtract(p, t.A);
  const double d1 = Dot(ab, ap);
  const double d2 = Dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0)
  {
    return Dot(ap, ap);
  }
  const Point<3> bp = Subtract(p, t.B);
  const double d3 = Dot(ab, bp);
  const double d4 = Dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3)
  {
    return Dot(bp, bp);
  }
  const Point<3> cp = Subtract(p, t.C);
  const double d5 = Dot(ab, cp);
  const double d6 = Dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6)
  {
    return Dot(cp, cp);
  }
  // The projection of p forms a triangle with each edge. These are the signed areas of the three
  // triangles, times a common factor.
  const double vc = d1 * d4 - d3 * d2;
  const double vb = d5 * d2 - d1 * d6;
  const double va = d3 * d6 - d5 * d4;
  const double sum = va + vb + vc;
  if (va > 0.0 && vb > 0.0 && vc > 0.0 && sum > 0.0)
  {
    Point<3> nearest;
    for (std::size_t k = 0; k < 3; ++k)
    {
      nearest[k] = t.A[k] + ab[k] * (vb / sum) + ac[k] * (vc / sum);
    }
    return Distance2(p, nearest);
  }
  return std::min({ SegmentDistance2(p, t.A, t.B), SegmentDistance2(p, t.B, t.C),
    SegmentDistance2(p, t.C, t.A) });
}

} // namespace voxplex

#endif
