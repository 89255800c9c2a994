// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PentatopeShape.h
 * @brief Measures of the shape of a pentatope.
 */
#ifndef voxplex_PentatopeShape_h
#define voxplex_PentatopeShape_h

#include "Geometry/Circumball.h"
#include "Geometry/Point.h"
#include "Geometry/SimplexQuality.h"

#include <array>
#include <limits>

namespace voxplex
{

/** What one pentatope is worth. */
struct PentatopeShape
{
  double Quality; ///< normalized volume; 0 if it is not positively oriented
  double Ratio;   ///< radius-edge ratio
  Circumball<4> Ball;
};

inline PentatopeShape ShapeOf(const std::array<const Point<4>*, 5>& points)
{
  PentatopeShape shape;
  if (!(SignedVolume<4>(points.data()) > 0.0))
  {
    return { 0.0, std::numeric_limits<double>::infinity(), {} };
  }
  if (!ComputeCircumball<4>(points.data(), shape.Ball))
  {
    ComputeCircumballExactly<4>(points.data(), shape.Ball);
  }
  shape.Quality = NormalizedVolume<4>(points.data(), shape.Ball.Radius2);
  shape.Ratio = RadiusEdgeRatio<4>(points.data(), shape.Ball.Radius2);
  return shape;
}

/** The score of a pentatope: its normalized volume. */
struct PentatopeScore
{
  double operator()(const Point<4>& a, const Point<4>& b, const Point<4>& c, const Point<4>& d,
    const Point<4>& e) const
  {
    return ShapeOf({ &a, &b, &c, &d, &e }).Quality;
  }
};

} // namespace voxplex

#endif
