// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Predicates.h
 * @brief Orientation and in-sphere tests with exact answers, for D = 3 and D = 4.
 *
 * There are three stages, from the cheapest to the most expensive. A stage answers only if its
 * answer is certain:
 *   1. static filter: compares the determinant in double with a constant that depends on the box;
 *   2. semi-static filter: compares it with a bound computed from the rows of this determinant;
 *   3. exact arithmetic (ExactPredicates.h).
 *
 * Error bounds. Let u = 2^-53. A computed determinant is the sum of its exact monomials, each times
 * at most k factors (1 + d), |d| <= u. Here k is the number of roundings that a monomial meets. So
 * the error is at most gamma S, with gamma = k u / (1 - k u) and S the sum of the absolute
 * monomials (Higham, Accuracy and Stability, lemma 3.1). k counts the roundings in Determinants.h,
 * plus one for each difference of coordinates in the monomial:
 *
 *   |                     | differences | lift | determinant | k  |
 *   | orientation, D = 3  | 3           |      | 5           | 8  |
 *   | orientation, D = 4  | 4           |      | 8           | 12 |
 *   | in-sphere,   D = 3  | 3 + 2       | 3    | 8           | 16 |
 *   | in-sphere,   D = 4  | 4 + 2       | 3    | 12          | 21 |
 *
 * S is a permanent of absolute values. Let r_i be the Euclidean norms of the rows, and
 * c_D = D! / D^(D/2), which is 2/sqrt(3) for D = 3 and 3/2 for D = 4. Then per|rows| <= c_D prod
 * r_i (Carlen, Lieb, Loss 2006). Hence
 *
 *   orientation: S <= c_D prod r_i, over the D rows;
 *   in-sphere:   S <= sum_i r_i^2 c_D prod_{j != i} r_j = c_D (prod r_i) (sum r_i), over the D + 1
 *                rows.
 *
 * The semi-static filter compares squares, so that it needs no root. It uses
 * (sum r_i)^2 <= (D + 1) sum r_i^2. With L_i = r_i^2:
 *
 *   orientation certain if  det^2 > (k u c_D)^2 prod L_i;
 *   in-sphere   certain if  det^2 > (k u c_D)^2 (D + 1) (sum L_i) (prod L_i).
 *
 * The static filter replaces each r_i by the diagonal of the box, which is an upper bound.
 * FilterSlack, a factor 1 + 1e-6, covers the difference between gamma and k u, the rounding of the
 * rows, and the roundings of the bound. FilterFloor covers underflow: if coordinates are below
 * 1e12, all underflows in the determinant and in its bound add less than 1e-106. Determinants below
 * 1e-100 go to exact arithmetic. Overflow makes the bound infinite or NaN, and both compare as
 * uncertain.
 */
#ifndef voxplex_Predicates_h
#define voxplex_Predicates_h

#include "Geometry/Determinants.h"
#include "Geometry/ExactPredicates.h"
#include "Geometry/Point.h"
#include "Geometry/PredicateStatistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace voxplex
{

/**
 * Whether this translation unit does floating-point arithmetic as the error bounds assume: IEEE
 * doubles, round to nearest, no extended precision, no fused multiply-add unless the source has one
 * (-ffp-contract=off), gradual underflow. The function is static, so that each translation unit
 * tests its own compiler flags. The numbers are volatile, so that the processor computes the sums
 * at run time.
 */
[[maybe_unused]] static bool FloatingPointIsStrict()
{
  volatile double one = 1.0;
  volatile double root = 1.0 + 0x1p-27;
  volatile double square = 1.0 + 0x1p-26; // root * root rounded: 2^-54 is lost
  volatile double quarterUlp = 0x1p-54;
  volatile double threeQuartersUlp = 0x3p-54;
  volatile double smallest = 0x1p-1022;
  // To the compiler every read is a new value. It would not fuse a product that is used twice.
  const double minusSquare = root * root - square;
  const double plusSquare = square - root * root;
  const bool notFused = minusSquare == 0.0 && plusSquare == 0.0;
  const bool toNearest = one + quarterUlp == 1.0 && one + threeQuartersUlp == 1.0 + 0x1p-52 &&
    -one - quarterUlp == -1.0 && -one - threeQuartersUlp == -1.0 - 0x1p-52;
  const bool notExtended = (one + quarterUlp) - one == 0.0;
  const bool gradual = smallest * 0.5 > 0.0;
  return notFused && toNearest && notExtended && gradual;
}

/**
 * @brief The predicates for points in one box, with statistics of the stages.
 *
 * Use one instance per thread, since calls change the instance's statistics. The bounds belong to
 * the instance, so one process can make meshes of different boxes at the same time.
 *
 * All points must lie in the box that the constructor was given. Coordinates must be below 1e12.
 * FloatingPointIsStrict() must be true in the translation unit that uses this class.
 */
template <int D>
class Predicates
{
  static_assert(D == 3 || D == 4);

public:
  using PointPointers = std::array<const Point<D>*, static_cast<std::size_t>(D + 1)>;

  Predicates(const Point<D>& min, const Point<D>& max)
  {
    double diagonal2 = 0.0;
    for (std::size_t i = 0; i < max.size(); ++i)
    {
      diagonal2 += (max[i] - min[i]) * (max[i] - min[i]);
    }
    // The diagonal bounds the norm of every row. Its D-th power bounds the product of D norms.
    const double rows = std::pow(diagonal2, 0.5 * D);
    this->OrientationBound =
      FilterSlack * OrientationRoundings * UnitRoundoff * PermanentConstant * rows + FilterFloor;
    this->InSphereBound = FilterSlack * InSphereRoundings * UnitRoundoff * PermanentConstant *
        (D + 1) * rows * diagonal2 +
      FilterFloor;
  }

  /**
   * Sign of det(p1 - p0, ..., pD - p0): +1 for a positively oriented simplex, 0 for a flat one.
   * @param points D + 1 points
   */
  int Orientation(const Point<D>* const* points)
  {
    ++this->Statistics.Calls;
    std::array<Row, Size> rows;
    for (std::size_t i = 0; i < Size; ++i)
    {
      rows[i] = Subtract(*points[i + 1], *points[0]);
    }
    const double det = Determinant(rows);
    if (std::abs(det) > this->OrientationBound)
    {
      return SignOf(det);
    }
    ++this->Statistics.StaticFailures;
    double product = OrientationFactor2;
    for (const Row& row : rows)
    {
      product *= SquaredNorm(row);
    }
    if (det * det > product + FilterFloor2)
    {
      return SignOf(det);
    }
    ++this->Statistics.ExactCalls;
    return ExactOrientation<D>(points);
  }

  /**
   * The side of p with respect to the circumsphere, without perturbation.
   * @param simplex D + 1 points, positively oriented
   * @return +1 strictly inside, 0 on the sphere, -1 outside
   */
  int InSphere(const Point<D>* const* simplex, const Point<D>& p)
  {
    ++this->Statistics.Calls;
    std::array<Row, Size + 1> rows;
    std::array<double, Size + 1> lifts;
    for (std::size_t i = 0; i <= Size; ++i)
    {
      rows[i] = Subtract(*simplex[i], p);
      lifts[i] = SquaredNorm(rows[i]);
    }
    // If p is inside, the determinant is negative in odd dimensions.
    const double det = (D % 2 == 0 ? 1.0 : -1.0) * LiftedDeterminant(rows, lifts);
    if (std::abs(det) > this->InSphereBound)
    {
      return SignOf(det);
    }
    ++this->Statistics.StaticFailures;
    double product = InSphereFactor2;
    double sum = 0.0;
    for (const double lift : lifts)
    {
      product *= lift;
      sum += lift;
    }
    if (det * det > product * sum + FilterFloor2)
    {
      return SignOf(det);
    }
    ++this->Statistics.ExactCalls;
    return ExactInSphere<D>(simplex, p);
  }

  /**
   * Whether p is in conflict with the simplex: strictly inside the circumsphere after a symbolic
   * perturbation. The perturbation moves every point off all spheres through other points.
   *
   * The lifted coordinate of x becomes |x|^2 + eps_x, with eps_x > 0. If x is lexicographically
   * larger than y, eps_x is infinitely larger than eps_y (Devillers and Teillaud, Perturbations and
   * vertex removal in a 3D Delaunay triangulation, 2003; the argument does not depend on D). On a
   * tie, the point with the largest eps decides:
   *   - If it is p, then p is lifted off the paraboloid, and is outside.
   *   - If it is a vertex, lifting it tilts the hyperplane up on the vertex's side of the opposite
   *     facet. If p lies on that side, it is below the hyperplane, and in conflict. If p lies in
   *     the facet's hyperplane, the point with the next smaller eps decides.
   *
   * The answer depends only on the set of D + 2 points, not on the order of the vertices.
   *
   * @param simplex D + 1 points, positively oriented
   * @param p different from all vertices
   */
  bool InSpherePerturbed(const Point<D>* const* simplex, const Point<D>& p)
  {
    const int side = this->InSphere(simplex, p);
    if (side != 0)
    {
      return side > 0;
    }
    return this->BreakTie(simplex, p);
  }

  /** InSpherePerturbed() for a point p that lies exactly on the circumsphere. */
  bool BreakTie(const Point<D>* const* simplex, const Point<D>& p)
  {
    ++this->Statistics.Perturbed;
    PointPointers replaced;
    std::copy_n(simplex, Size + 1, replaced.begin());
    std::array<std::size_t, Size + 1> order;
    for (std::size_t i = 0; i <= Size; ++i)
    {
      order[i] = i;
    }
    std::sort(order.begin(), order.end(),
      [simplex](std::size_t a, std::size_t b) { return *simplex[b] < *simplex[a]; });
    for (const std::size_t i : order)
    {
      if (*simplex[i] < p)
      {
        return false; // p has the largest eps of the remaining points
      }
      replaced[i] = &p;
      const int side = this->Orientation(replaced.data());
      if (side != 0)
      {
        return side > 0;
      }
      replaced[i] = simplex[i];
    }
    return false; // not reached: p cannot lie in the hyperplanes of all facets
  }

  const PredicateStatistics& GetStatistics() const { return this->Statistics; }
  PredicateStatistics& GetStatistics() { return this->Statistics; }

private:
  using Row = Point<D>;
  static constexpr std::size_t Size = static_cast<std::size_t>(D);

  // The constants of the error bounds at the top of this file.
  static constexpr double UnitRoundoff = 0x1p-53;
  static constexpr int OrientationRoundings = D == 3 ? 8 : 12;
  static constexpr int InSphereRoundings = D == 3 ? 16 : 21;
  static constexpr double PermanentConstant2 = D == 3 ? 4.0 / 3.0 : 9.0 / 4.0;
  static constexpr double PermanentConstant =
    D == 3 ? 1.1547005383792517 : 1.5; // square root of PermanentConstant2, rounded up
  static constexpr double FilterSlack = 1.0 + 1e-6;
  static constexpr double FilterFloor = 1e-100;
  static constexpr double FilterFloor2 = 1e-200;
  static constexpr double OrientationFactor2 = FilterSlack * FilterSlack * PermanentConstant2 *
    (OrientationRoundings * UnitRoundoff) * (OrientationRoundings * UnitRoundoff);
  static constexpr double InSphereFactor2 = FilterSlack * FilterSlack * PermanentConstant2 *
    (D + 1) * (InSphereRoundings * UnitRoundoff) * (InSphereRoundings * UnitRoundoff);

  static int SignOf(double x) { return x > 0.0 ? 1 : -1; }

  PredicateStatistics Statistics;
  // The static filters are certain if |det| exceeds these bounds.
  double OrientationBound;
  double InSphereBound;
};

} // namespace voxplex

#endif
