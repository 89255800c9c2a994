// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeScore.h
 * @brief One number for the shape of a tetrahedron, relative to its bounds.
 */
#ifndef voxplex_ShapeScore_h
#define voxplex_ShapeScore_h

#include "Geometry/Determinants.h"
#include "Geometry/Point.h"
#include "Geometry/SimplexQuality.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace voxplex
{

/** The measures that shape bounds apply to. */
struct ShapeExtremes
{
  /**
   * For dihedral angles: cosine times its absolute value, which is monotone and needs no square
   * root.
   */
  double SmallestCosine;
  double LargestCosine;
  double EdgeRadiusRatio2; ///< the square of shortest edge over circumradius
};

/** False, with nothing written, if abcd is not positively oriented in double. */
inline bool MeasureShape(
  const Point<3>& a, const Point<3>& b, const Point<3>& c, const Point<3>& d, ShapeExtremes& shape)
{
  const Point<3> ab = Subtract(b, a);
  const Point<3> ac = Subtract(c, a);
  const Point<3> ad = Subtract(d, a);
  // Inward normals of the facets opposite to each vertex.
  const Point<3> normalB = Cross(ac, ad);
  const double determinant = Dot(ab, normalB);
  if (!(determinant > 0.0))
  {
    return false;
  }
  const Point<3> normalC = Cross(ad, ab);
  const Point<3> normalD = Cross(ab, ac);
  const Point<3> normalA = { -normalB[0] - normalC[0] - normalD[0],
    -normalB[1] - normalC[1] - normalD[1], -normalB[2] - normalC[2] - normalD[2] };
  const double perA = 1.0 / Dot(normalA, normalA);
  const double perB = 1.0 / Dot(normalB, normalB);
  const double perC = 1.0 / Dot(normalC, normalC);
  const double perD = 1.0 / Dot(normalD, normalD);
  const auto signedSquare = [](double x) { return x * std::abs(x); };
  // The cosine of the angle between two facets is minus the cosine between their normals.
  const double ofAB = signedSquare(Dot(normalC, normalD)) * perC * perD;
  const double ofAC = signedSquare(Dot(normalB, normalD)) * perB * perD;
  const double ofAD = signedSquare(Dot(normalB, normalC)) * perB * perC;
  const double ofBC = signedSquare(Dot(normalA, normalD)) * perA * perD;
  const double ofBD = signedSquare(Dot(normalA, normalC)) * perA * perC;
  const double ofCD = signedSquare(Dot(normalA, normalB)) * perA * perB;
  shape.LargestCosine =
    -std::min({ std::min(ofAB, ofAC), std::min(ofAD, ofBC), std::min(ofBD, ofCD) });
  shape.SmallestCosine =
    -std::max({ std::max(ofAB, ofAC), std::max(ofAD, ofBC), std::max(ofBD, ofCD) });

  const double ab2 = Dot(ab, ab);
  const double ac2 = Dot(ac, ac);
  const double ad2 = Dot(ad, ad);
  const double shortest2 = std::min({ std::min(ab2, ac2), std::min(ad2, Distance2(b, c)),
    std::min(Distance2(b, d), Distance2(c, d)) });
  // The vector from a to the centre of the circumball, times twice the determinant.
  Point<3> centre;
  for (std::size_t k = 0; k < 3; ++k)
  {
    centre[k] = ab2 * normalB[k] + ac2 * normalC[k] + ad2 * normalD[k];
  }
  shape.EdgeRadiusRatio2 = 4.0 * shortest2 * determinant * determinant / Dot(centre, centre);
  return true;
}

/**
 * @brief The smallest of three ratios: for the lower and the upper bound of dihedral angles, and
 * for the bound of the radius-edge ratio. A ratio is 1 if its bound is just met, and larger if the
 * shape is better.
 *
 * Angles are compared by the squares of their sines, which needs no square root. Let s be the
 * cosine times its absolute value. Then 1 - s is the squared sine of an angle up to 90 degrees, and
 * 1 + s is the squared sine of a larger angle. Both are monotone over 0 to 180 degrees. The score
 * is 0 for a flat tetrahedron, and positive for all positively oriented ones. So operations that
 * only raise the smallest score near them keep the orientation.
 *
 * If a tetrahedron violates the bound of the radius-edge ratio, its score is a thousand times
 * smaller. So better angles are not bought with a worse ratio. A violation can arise only next to
 * tetrahedra with an angle of less than half a degree; the new tetrahedra are then poor and are
 * improved in turn.
 */
class ShapeScore
{
public:
  /** The score of a tetrahedron that is not positively oriented. */
  static constexpr double Inverted = -1.0;
  /** Factor of the score beyond the bound of the radius-edge ratio. */
  static constexpr double RadiusEdgePenalty = 1e-3;

  /**
   * @param smallest, largest bounds of dihedral angles in degrees: 0 < smallest < 60, 90 < largest
   *   < 180
   */
  ShapeScore(double smallest, double largest, double radiusEdge)
    : PerSmallAngle(1.0 / Square(std::sin(smallest / DegreesPerRadian)))
    , PerLargeAngle(1.0 / Square(std::sin(largest / DegreesPerRadian)))
    , RadiusEdge2(Square(radiusEdge))
  {
  }

  /** Score of the tetrahedron abcd. */
  double operator()(
    const Point<3>& a, const Point<3>& b, const Point<3>& c, const Point<3>& d) const
  {
    ShapeExtremes shape;
    return MeasureShape(a, b, c, d, shape) ? this->Of(shape) : Inverted;
  }

  double Of(const ShapeExtremes& shape) const
  {
    const double angles = std::min((1.0 - shape.LargestCosine) * this->PerSmallAngle,
      (1.0 + shape.SmallestCosine) * this->PerLargeAngle);
    const double radiusEdge = this->RadiusEdge2 * shape.EdgeRadiusRatio2;
    return std::min(angles, radiusEdge) * (radiusEdge < 1.0 ? RadiusEdgePenalty : 1.0);
  }

private:
  static constexpr double Square(double x) { return x * x; }

  double PerSmallAngle;
  double PerLargeAngle;
  double RadiusEdge2;
};

} // namespace voxplex

#endif
