// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceRules.h
 * @brief Rules for changes of the triangles between two labels.
 */
#ifndef voxplex_InterfaceRules_h
#define voxplex_InterfaceRules_h

#include "Geometry/Point.h"
#include "Geometry/SimplexQuality.h"

#include <algorithm>
#include <cmath>

namespace voxplex
{

/**
 * Bounds on changes of an interface. A triangle that already violates a bound must not get worse.
 */
struct InterfaceRules
{
  double FacetCosine;    ///< of the smallest planar angle
  double JunctionCosine; ///< the same, if three or more labels meet at a vertex of the triangle
  double CreaseCosine; ///< of the largest angle between two triangles whose common edge is flipped

  InterfaceRules(double facetAngle, double junctionAngle, double creaseAngle)
    : FacetCosine(std::cos(facetAngle / DegreesPerRadian))
    , JunctionCosine(std::cos(junctionAngle / DegreesPerRadian))
    , CreaseCosine(std::cos(creaseAngle / DegreesPerRadian))
  {
  }
};

/**
 * Bounds for triangles that replace others in an interface. A new angle may be as small as the
 * replaced ones. Off junctions, only replaced triangles off junctions count.
 */
class FacetBounds
{
public:
  explicit FacetBounds(const InterfaceRules& rules)
    : LargestCosine(rules.FacetCosine)
    , LargestJunctionCosine(rules.JunctionCosine)
  {
  }

  /** Adds a replaced triangle. @param cosine of its smallest angle */
  void Replace(double cosine, bool isAtJunction)
  {
    this->LargestJunctionCosine = std::max(this->LargestJunctionCosine, cosine);
    this->LargestCosine = std::max(this->LargestCosine, isAtJunction ? -1.0 : cosine);
  }
  /** Whether a new triangle is allowed. @param cosine of its smallest angle */
  bool Allow(double cosine, bool isAtJunction) const
  {
    return cosine <= (isAtJunction ? this->LargestJunctionCosine : this->LargestCosine);
  }

private:
  double LargestCosine;
  double LargestJunctionCosine;
};

inline double CosineBetween(const Point<3>& a, const Point<3>& b)
{
  return Dot(a, b) / std::sqrt(Dot(a, a) * Dot(b, b));
}

} // namespace voxplex

#endif
