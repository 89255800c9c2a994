// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeBounds.h
 * @brief Bounds for the shape of a mesh's tetrahedra and interface triangles.
 */
#ifndef voxplex_ShapeBounds_h
#define voxplex_ShapeBounds_h

#include <algorithm>

namespace voxplex
{

/** Angles are in degrees. */
struct ShapeBounds
{
  /** Smallest planar angle of interface triangles with a vertex where three or more labels meet. */
  static constexpr double DefaultJunctionFacetAngle = 20.0;

  double RadiusEdgeRatio = 2.0; ///< upper bound of circumradius / shortest edge of an element
  double FacetAngle = 30.0;     ///< lower bound of the planar angles of interface triangles
  double JunctionFacetAngle = DefaultJunctionFacetAngle; ///< the same bound at junctions

  /** The bound at junctions is never larger than the bound for other interface triangles. */
  static ShapeBounds With(double radiusEdgeRatio, double facetAngle)
  {
    return { radiusEdgeRatio, facetAngle, std::min(DefaultJunctionFacetAngle, facetAngle) };
  }
};

} // namespace voxplex

#endif
