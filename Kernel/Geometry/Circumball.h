// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Circumball.h
 * @brief Circumcentre and squared circumradius of a simplex, with a certificate of their accuracy.
 *
 * Let a_i = v_i - v_0, i = 1 ... D, be the edges. The centre c relative to v_0 solves
 * a_i . c = |a_i|^2 / 2. By Cramer's rule c = N / (2 det), where N_k is det(a) with column k
 * replaced by the |a_i|^2.
 *
 * Error bound. Let u = 2^-53, r_i = |a_i|, R the circumradius, and e the error of the stored
 * centre. Roundings are counted as in Predicates.h. A monomial of N meets k_N roundings: 2 + 3
 * (difference and sums of |a_i|^2), those of a cofactor (2 + 2 in 3D, 3 + 5 in 4D), those of a
 * product and of the sum over rows (2). A monomial of det meets k_det roundings, 8 in 3D and 12 in
 * 4D:
 *
 *   |       | k_N | k_det | g_D     | c_D       |
 *   | D = 3 | 12  | 8     | sqrt(2) | 2/sqrt(3) |
 *   | D = 4 | 16  | 12    | 2       | 3/2       |
 *
 * The absolute monomials of the vector N sum to at most g_D (prod r_i) (sum r_i) in norm. Proof:
 * for one row i they are r_i^2 times the permanents of the other rows without column k. Each
 * permanent is at most c_{D-1} prod_{j != i} |a_j without column k|. The norm of these over k is
 * largest if the other rows lie along one axis; then D - 1 of the k contribute. So
 * g_D = c_{D-1} sqrt(D - 1), with c_2 = 1. Edges are chords, so sum r_i <= 2 D R. The absolute
 * monomials of det sum to at most c_D prod r_i. Hence
 *
 *   |e| / R <= u (k_N g_D D + k_det c_D) (prod r_i) / |det| + 2 u + u |centre| / R.
 *
 * The term 2 u covers the division. The term u |centre| / R covers the rounding of the centre's
 * coordinates. The factor in brackets is 60.2 in 3D and 146 in 4D.
 *
 * Radius2 is |centre - v_0|^2 of the stored centre. Then for any e and every p
 *
 *   |p - centre|^2 - Radius2 = (|p - c|^2 - R^2) - 2 e . (p - v_0).
 *
 * If the left side and the bracket differ in sign, then |p - v_0| <= 2 R (1 + small). Squared
 * distances are computed in double, with 7 u of roundings on each side. So the sign of the left
 * side is right if its absolute value exceeds CircumballTolerance x Radius2 and
 * |e| / R <= CircumballTolerance / 4 - 4 u. The certificate requires that each of the two large
 * terms is at most 0.12 CircumballTolerance. This leaves 4 % of slack for second-order terms.
 */
#ifndef voxplex_Circumball_h
#define voxplex_Circumball_h

#include "Geometry/Determinants.h"
#include "Geometry/ExactPredicates.h"
#include "Geometry/Point.h"

#include <array>
#include <cstddef>
#include <limits>

namespace voxplex
{

/** A certified ball decides only if the relative difference of squared distances exceeds this. */
constexpr double CircumballTolerance = 1e-9;

template <int D>
struct Circumball
{
  Point<D> Center;
  double Radius2; ///< squared radius
};

/**
 * The side of p with respect to a ball that ComputeCircumball certified.
 * @return +1 certainly inside, -1 certainly outside, 0 uncertain: use Predicates::InSpherePerturbed
 * Forced inline: GCC makes it a call in the cavity search, which costs more than the test.
 */
template <int D>
[[gnu::always_inline]] inline int SideOfCircumball(const Circumball<D>& ball, const Point<D>& p)
{
  const double excess = Distance2(p, ball.Center) - ball.Radius2;
  const double slack = CircumballTolerance * ball.Radius2;
  if (excess > slack)
  {
    return -1;
  }
  return excess < -slack ? 1 : 0;
}

/** N, 2 det and prod |a_i|^2 of the edges a_1, a_2, a_3, whose squared norms are l. */
inline void CircumcenterByCramer(const std::array<Point<3>, 3>& a, const Point<3>& l,
  Point<3>& numerator, double& twiceDeterminant, double& product2)
{
  const auto cross = [](const Point<3>& x, const Point<3>& y)
  {
    return Point<3>{ Minor2(x[1], x[2], y[1], y[2]), Minor2(x[2], x[0], y[2], y[0]),
      Minor2(x[0], x[1], y[0], y[1]) };
  };
  const Point<3> c0 = cross(a[1], a[2]);
  const Point<3> c1 = cross(a[2], a[0]);
  const Point<3> c2 = cross(a[0], a[1]);
  for (std::size_t k = 0; k < 3; ++k)
  {
    numerator[k] = (l[0] * c0[k] + l[1] * c1[k]) + l[2] * c2[k];
  }
  twiceDeterminant = 2.0 * ((a[0][0] * c0[0] + a[0][1] * c0[1]) + a[0][2] * c0[2]);
  product2 = l[0] * l[1] * l[2];
}

/** The same in 4D. */
inline void CircumcenterByCramer(const std::array<Point<4>, 4>& a, const Point<4>& l,
  Point<4>& numerator, double& twiceDeterminant, double& product2)
{
  // The cofactor of row i and column k is the signed 3x3 minor of the other rows and columns. It is
  // expanded along its third row. The 2x2 minors of rows 0, 1 and of rows 2, 3 are used twice.
  using Six = std::array<double, 6>; // columns 01, 02, 03, 12, 13, 23
  const auto minors = [](const Point<4>& x, const Point<4>& y)
  {
    return Six{ Minor2(x[0], x[1], y[0], y[1]), Minor2(x[0], x[2], y[0], y[2]),
      Minor2(x[0], x[3], y[0], y[3]), Minor2(x[1], x[2], y[1], y[2]),
      Minor2(x[1], x[3], y[1], y[3]), Minor2(x[2], x[3], y[2], y[3]) };
  };
  /** Generalised cross product of a row and two other rows, which are given by their minors. */
  const auto cross = [](const Point<4>& x, const Six& m)
  {
    return Point<4>{ (x[1] * m[5] - x[2] * m[4]) + x[3] * m[3],
      -((x[0] * m[5] - x[2] * m[2]) + x[3] * m[1]), (x[0] * m[4] - x[1] * m[2]) + x[3] * m[0],
      -((x[0] * m[3] - x[1] * m[1]) + x[2] * m[0]) };
  };
  const Six m01 = minors(a[0], a[1]);
  const Six m23 = minors(a[2], a[3]);
  const Point<4> c0 = cross(a[1], m23);
  const Point<4> c1 = cross(a[0], m23); // sign -
  const Point<4> c2 = cross(a[3], m01);
  const Point<4> c3 = cross(a[2], m01); // sign -
  for (std::size_t k = 0; k < 4; ++k)
  {
    numerator[k] = (l[0] * c0[k] - l[1] * c1[k]) + (l[2] * c2[k] - l[3] * c3[k]);
  }
  twiceDeterminant =
    2.0 * ((a[0][0] * c0[0] + a[0][1] * c0[1]) + (a[0][2] * c0[2] + a[0][3] * c0[3]));
  product2 = (l[0] * l[1]) * (l[2] * l[3]);
}

/**
 * The circumball of the simplex with vertices origin and origin + edges[i], in double. Branch-free.
 * @param edges vertices minus the origin, each coordinate rounded once
 * @param norms2 squared norms of the edges
 * @param ball always written; infinite or NaN for some flat simplices
 * @return true if the ball is certified. Then SideOfCircumball never contradicts the exact
 *   in-sphere test. False for nearly flat simplices (D! x volume below about 6e-5 (3D), 1.4e-4 (4D)
 *   of the product of the edge lengths), and for simplices smaller than about 1e-6 of their
 *   coordinates.
 */
template <int D>
inline bool ComputeCircumball(const Point<D>& origin,
  const std::array<Point<D>, static_cast<std::size_t>(D)>& edges, const Point<D>& norms2,
  Circumball<D>& ball)
{
  constexpr std::size_t Size = static_cast<std::size_t>(D);
  constexpr double UnitRoundoff = 0x1p-53;
  constexpr double Share = 0.12 * CircumballTolerance;
  // The bracket of the error bound, rounded up.
  constexpr double Factor = (D == 3 ? 60.3 : 146.1) * UnitRoundoff / Share;
  constexpr double Grid = UnitRoundoff / Share;

  Point<D> numerator;
  double twiceDeterminant = 0.0;
  double product2 = 0.0;
  CircumcenterByCramer(edges, norms2, numerator, twiceDeterminant, product2);
  const double inverse = 1.0 / twiceDeterminant;
  double center2 = 0.0;
  double radius2 = 0.0;
  for (std::size_t k = 0; k < Size; ++k)
  {
    const double c = origin[k] + numerator[k] * inverse;
    const double offset = c - origin[k];
    ball.Center[k] = c;
    center2 += c * c;
    radius2 += offset * offset;
  }
  ball.Radius2 = radius2;
  // Not short-circuited, so that there is no branch. Comparisons with NaN are false.
  constexpr double Floor = 1e-200; // with underflow the bounds would not hold
  const bool shape = twiceDeterminant * twiceDeterminant > 4.0 * Factor * Factor * product2 + Floor;
  const bool grid = radius2 > Grid * Grid * center2 + Floor;
  return shape & grid;
}

/**
 * The circumball of a simplex in double: the function above with origin v[0].
 * @param v D + 1 points of either orientation
 */
template <int D>
inline bool ComputeCircumball(const Point<D>* const* v, Circumball<D>& ball)
{
  std::array<Point<D>, static_cast<std::size_t>(D)> edges;
  Point<D> norms2;
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    edges[i] = Subtract(*v[i + 1], *v[0]);
    norms2[i] = SquaredNorm(edges[i]);
  }
  return ComputeCircumball<D>(*v[0], edges, norms2, ball);
}

/**
 * The circumball in exact arithmetic, rounded at the end, for simplices that ComputeCircumball
 * could not certify. It is thousands of times slower than ComputeCircumball.
 * @param ball the rounded exact ball; if the simplex is exactly flat, its radius is infinity
 * @return true if the ball is certified (see ComputeCircumball). False if the simplex is exactly
 *   flat, or too small relative to its coordinates.
 */
template <int D>
inline bool ComputeCircumballExactly(const Point<D>* const* v, Circumball<D>& ball)
{
  if (!RoundedExactCircumball<D>(v, ball))
  {
    ball.Center = *v[0];
    ball.Radius2 = std::numeric_limits<double>::infinity();
    return false;
  }
  constexpr double Grid = 0x1p-53 / (0.05 * CircumballTolerance);
  double center2 = 0.0;
  for (const double c : ball.Center)
  {
    center2 += c * c;
  }
  return ball.Radius2 > Grid * Grid * center2 + 1e-200;
}

} // namespace voxplex

#endif
