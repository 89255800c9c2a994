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
#include <array>
#include <cmath>
#include <cstddef>

namespace voxplex
{

/**
 * The measures that shape bounds apply to: of one tetrahedron, if Real is a number, or of several
 * side by side, if it is a vector of numbers.
 */
template <typename Real>
struct ShapeExtremesOf
{
  /**
   * For dihedral angles: cosine times its absolute value, which is monotone and needs no square
   * root.
   */
  Real SmallestCosine;
  Real LargestCosine;
  Real EdgeRadiusRatio2; ///< the square of shortest edge over circumradius
};
using ShapeExtremes = ShapeExtremesOf<double>;

#if defined(__GNUC__)
/** Two numbers in a vector register. Each result is that of a single number, bit for bit. */
using RealPair [[gnu::vector_size(16)]] = double;
#endif

/** The arithmetic of MeasureShape(). */
template <typename Real>
class ShapeMeasurement
{
public:
  using Vector = std::array<Real, 3>;

  ShapeMeasurement(const Vector& a, const Vector& b, const Vector& c, const Vector& d)
    : AB(Minus(b, a))
    , AC(Minus(c, a))
    , AD(Minus(d, a))
    , BC(Minus(b, c))
    , BD(Minus(b, d))
    , CD(Minus(c, d))
    , NormalB(Cross(AC, AD))
    , Volume6(Dot(AB, NormalB))
  {
  }

  /** Six times the volume. If it is not positive, the other measures are not valid. */
  const Real& Determinant() const { return this->Volume6; }

  ShapeExtremesOf<Real> Extremes() const
  {
    ShapeExtremesOf<Real> shape;
    const Vector& normalB = this->NormalB; // inward, of the facet opposite to b
    const Vector normalC = Cross(this->AD, this->AB);
    const Vector normalD = Cross(this->AB, this->AC);
    const Vector normalA = { -normalB[0] - normalC[0] - normalD[0],
      -normalB[1] - normalC[1] - normalD[1], -normalB[2] - normalC[2] - normalD[2] };
    const Real perA = 1.0 / Dot(normalA, normalA);
    const Real perB = 1.0 / Dot(normalB, normalB);
    const Real perC = 1.0 / Dot(normalC, normalC);
    const Real perD = 1.0 / Dot(normalD, normalD);
    // The cosine of the angle between two facets is minus the cosine between their normals.
    const Real ofAB = SignedSquare(Dot(normalC, normalD)) * perC * perD;
    const Real ofAC = SignedSquare(Dot(normalB, normalD)) * perB * perD;
    const Real ofAD = SignedSquare(Dot(normalB, normalC)) * perB * perC;
    const Real ofBC = SignedSquare(Dot(normalA, normalD)) * perA * perD;
    const Real ofBD = SignedSquare(Dot(normalA, normalC)) * perA * perC;
    const Real ofCD = SignedSquare(Dot(normalA, normalB)) * perA * perB;
    shape.LargestCosine = -Least(Least(Least(ofAB, ofAC), Least(ofAD, ofBC)), Least(ofBD, ofCD));
    shape.SmallestCosine = -Most(Most(Most(ofAB, ofAC), Most(ofAD, ofBC)), Most(ofBD, ofCD));

    const Real ab2 = Dot(this->AB, this->AB);
    const Real ac2 = Dot(this->AC, this->AC);
    const Real ad2 = Dot(this->AD, this->AD);
    const Real shortest2 = Least(Least(Least(ab2, ac2), Least(ad2, Dot(this->BC, this->BC))),
      Least(Dot(this->BD, this->BD), Dot(this->CD, this->CD)));
    // The vector from a to the centre of the circumball, times twice the determinant.
    Vector centre;
    for (std::size_t k = 0; k < 3; ++k)
    {
      centre[k] = ab2 * normalB[k] + ac2 * normalC[k] + ad2 * normalD[k];
    }
    shape.EdgeRadiusRatio2 = 4.0 * shortest2 * this->Volume6 * this->Volume6 / Dot(centre, centre);
    return shape;
  }

  static Real Least(const Real& x, const Real& y) { return y < x ? y : x; }

private:
  static Real Most(const Real& x, const Real& y) { return x < y ? y : x; }
  static Real SignedSquare(const Real& x) { return x * (x < 0.0 ? -x : x); }
  static Vector Minus(const Vector& x, const Vector& y)
  {
    return { x[0] - y[0], x[1] - y[1], x[2] - y[2] };
  }
  static Real Dot(const Vector& x, const Vector& y)
  {
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
  }
  static Vector Cross(const Vector& x, const Vector& y)
  {
    return { x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0] };
  }

  Vector AB, AC, AD, BC, BD, CD;
  Vector NormalB;
  Real Volume6;
};

/** False, with nothing written, if abcd is not positively oriented in double. */
inline bool MeasureShape(
  const Point<3>& a, const Point<3>& b, const Point<3>& c, const Point<3>& d, ShapeExtremes& shape)
{
  const ShapeMeasurement<double> measurement(a, b, c, d);
  if (!(measurement.Determinant() > 0.0))
  {
    return false;
  }
  shape = measurement.Extremes();
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

  /** Of the default bounds. */
  ShapeScore()
    : ShapeScore(18.0, 150.0, 2.5)
  {
  }

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

  template <typename Real>
  Real Of(const ShapeExtremesOf<Real>& shape) const
  {
    const auto least = ShapeMeasurement<Real>::Least;
    const Real angles = least((1.0 - shape.LargestCosine) * this->PerSmallAngle,
      (1.0 + shape.SmallestCosine) * this->PerLargeAngle);
    const Real radiusEdge = this->RadiusEdge2 * shape.EdgeRadiusRatio2;
    const Real score = least(angles, radiusEdge);
    return radiusEdge < 1.0 ? RadiusEdgePenalty * score : score;
  }

  /** Scores of two tetrahedra that share the vertex a. */
  std::array<double, 2> OfTwo(
    const Point<3>& a, const Point<3>* first, const Point<3>* second) const
  {
#if defined(__GNUC__)
    using Vector = std::array<RealPair, 3>;
    const auto both = [](const Point<3>& x, const Point<3>& y) {
      return Vector{ RealPair{ x[0], y[0] }, RealPair{ x[1], y[1] }, RealPair{ x[2], y[2] } };
    };
    const ShapeMeasurement<RealPair> measurement(
      both(a, a), both(first[0], second[0]), both(first[1], second[1]), both(first[2], second[2]));
    const RealPair score = this->Of(measurement.Extremes());
    const RealPair determinant = measurement.Determinant();
    return { determinant[0] > 0.0 ? score[0] : Inverted,
      determinant[1] > 0.0 ? score[1] : Inverted };
#else
    return { (*this)(a, first[0], first[1], first[2]),
      (*this)(a, second[0], second[1], second[2]) };
#endif
  }

private:
  static constexpr double Square(double x)
  {
    return x * x;
  }

  double PerSmallAngle;
  double PerLargeAngle;
  double RadiusEdge2;
};

} // namespace voxplex

#endif
