// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeBounds.h
 * @brief What the tetrahedra and the interface triangles of a mesh may look like.
 */
#ifndef voxplex_ShapeBounds_h
#define voxplex_ShapeBounds_h

#include <algorithm>

namespace voxplex
{

/** Angles are in degrees. */
struct ShapeBounds
{
  /** Smallest planar angle of interface triangles with a vertex where three labels or more meet. */
  static constexpr double DefaultJunctionFacetAngle = 20.0;

  double RadiusEdgeRatio = 2.0; ///< largest circumradius / shortest edge of an element
  double FacetAngle = 30.0;     ///< smallest planar angle of interface triangles
  double JunctionFacetAngle = DefaultJunctionFacetAngle; ///< the same at junctions

  /** Junctions never ask for more than the rest of the interfaces. */
  static ShapeBounds With(double radiusEdgeRatio, double facetAngle)
  {
    return { radiusEdgeRatio, facetAngle, std::min(DefaultJunctionFacetAngle, facetAngle) };
  }
};

} // namespace voxplex

#endif
