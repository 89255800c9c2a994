// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Determinants.h
 * @brief The two polynomials of Delaunay triangulation, for floating-point and exact numbers.
 *
 * T is double in the filters (Predicates.h), and an exact number type in ExactPredicates.cxx. The
 * polynomials are homogeneous, and every sum below adds terms of the same degree. So T may also be
 * a family of types, one for each degree (fixed-width integers whose products are wider).
 *
 * Each function states the largest number of roundings that a monomial meets if T is double. The
 * error bounds in Predicates.h and Circumball.h depend on these numbers. If you reorder a sum,
 * count the roundings again.
 */
#ifndef voxplex_Determinants_h
#define voxplex_Determinants_h

#include <array>
#include <cstddef>

namespace voxplex
{

/** x0 * y1 - x1 * y0. Roundings: 2. */
template <class T>
inline auto Minor2(const T& x0, const T& y0, const T& x1, const T& y1)
{
  return x0 * y1 - x1 * y0;
}

/** Squared Euclidean norm of a row. Roundings: 3 (D = 3 and D = 4). */
template <class T>
inline auto SquaredNorm(const std::array<T, 3>& a)
{
  return (a[0] * a[0] + a[1] * a[1]) + a[2] * a[2];
}

template <class T>
inline auto SquaredNorm(const std::array<T, 4>& a)
{
  return (a[0] * a[0] + a[1] * a[1]) + (a[2] * a[2] + a[3] * a[3]);
}

/** det of three rows. Roundings: 5 (2 in a minor, 1 product, 2 sums). */
template <class T>
inline auto Determinant(const std::array<std::array<T, 3>, 3>& m)
{
  const auto& [a, b, c] = m;
  return (Minor2(a[0], a[1], b[0], b[1]) * c[2] + Minor2(b[0], b[1], c[0], c[1]) * a[2]) +
    Minor2(c[0], c[1], a[0], a[1]) * b[2];
}

/** det of four rows, by Laplace expansion along the column pairs. Roundings: 8 (2 + 2, 1, 3). */
template <class T>
inline auto Determinant(const std::array<std::array<T, 4>, 4>& m)
{
  const auto& [a, b, c, d] = m;
  return ((Minor2(a[0], a[1], b[0], b[1]) * Minor2(c[2], c[3], d[2], d[3]) +
            Minor2(c[0], c[1], d[0], d[1]) * Minor2(a[2], a[3], b[2], b[3])) +
           (Minor2(a[0], a[1], d[0], d[1]) * Minor2(b[2], b[3], c[2], c[3]) +
             Minor2(b[0], b[1], c[0], c[1]) * Minor2(a[2], a[3], d[2], d[3]))) -
    (Minor2(a[0], a[1], c[0], c[1]) * Minor2(b[2], b[3], d[2], d[3]) +
      Minor2(b[0], b[1], d[0], d[1]) * Minor2(a[2], a[3], c[2], c[3]));
}

/**
 * det of the rows (m_i, lift_i), where the lifts are the last column, in 3D.
 * Roundings without those of the lifts: 8 (2 in a minor, 1 + 2 in a 3x3 minor, 1 product, 2 sums).
 */
template <class T, class Lift>
inline auto LiftedDeterminant(
  const std::array<std::array<T, 3>, 4>& m, const std::array<Lift, 4>& lift)
{
  const auto& [a, b, c, d] = m;
  const auto ab = Minor2(a[0], a[1], b[0], b[1]);
  const auto bc = Minor2(b[0], b[1], c[0], c[1]);
  const auto cd = Minor2(c[0], c[1], d[0], d[1]);
  const auto da = Minor2(d[0], d[1], a[0], a[1]);
  const auto ac = Minor2(a[0], a[1], c[0], c[1]);
  const auto bd = Minor2(b[0], b[1], d[0], d[1]);
  const auto abc = (ab * c[2] + bc * a[2]) - ac * b[2];
  const auto bcd = (bc * d[2] + cd * b[2]) - bd * c[2];
  const auto cda = (cd * a[2] + da * c[2]) + ac * d[2];
  const auto dab = (da * b[2] + ab * d[2]) + bd * a[2];
  return (abc * lift[3] - dab * lift[2]) + (cda * lift[1] - bcd * lift[0]);
}

/**
 * det of the rows (m_i, lift_i), where the lifts are the last column, in 4D.
 * Roundings without those of the lifts: 12 (2 + 2 in the minors, 1 + 3 in a 4x4 minor, 1 product, 3
 * sums).
 */
template <class T, class Lift>
inline auto LiftedDeterminant(
  const std::array<std::array<T, 4>, 5>& m, const std::array<Lift, 5>& lift)
{
  const auto& [a, b, c, d, e] = m;
  // 2x2 minors of the columns 0 and 1 (XY), and of the columns 2 and 3 (ZW).
  const auto abXY = Minor2(a[0], a[1], b[0], b[1]);
  const auto acXY = Minor2(a[0], a[1], c[0], c[1]);
  const auto adXY = Minor2(a[0], a[1], d[0], d[1]);
  const auto aeXY = Minor2(a[0], a[1], e[0], e[1]);
  const auto bcXY = Minor2(b[0], b[1], c[0], c[1]);
  const auto bdXY = Minor2(b[0], b[1], d[0], d[1]);
  const auto beXY = Minor2(b[0], b[1], e[0], e[1]);
  const auto cdXY = Minor2(c[0], c[1], d[0], d[1]);
  const auto ceXY = Minor2(c[0], c[1], e[0], e[1]);
  const auto deXY = Minor2(d[0], d[1], e[0], e[1]);
  const auto abZW = Minor2(a[2], a[3], b[2], b[3]);
  const auto acZW = Minor2(a[2], a[3], c[2], c[3]);
  const auto adZW = Minor2(a[2], a[3], d[2], d[3]);
  const auto aeZW = Minor2(a[2], a[3], e[2], e[3]);
  const auto bcZW = Minor2(b[2], b[3], c[2], c[3]);
  const auto bdZW = Minor2(b[2], b[3], d[2], d[3]);
  const auto beZW = Minor2(b[2], b[3], e[2], e[3]);
  const auto cdZW = Minor2(c[2], c[3], d[2], d[3]);
  const auto ceZW = Minor2(c[2], c[3], e[2], e[3]);
  const auto deZW = Minor2(d[2], d[3], e[2], e[3]);
  // 4x4 minors, named after their four rows.
  const auto bcde =
    ((bcXY * deZW + deXY * bcZW) + (beXY * cdZW + cdXY * beZW)) - (bdXY * ceZW + ceXY * bdZW);
  const auto acde =
    ((acXY * deZW + deXY * acZW) + (aeXY * cdZW + cdXY * aeZW)) - (adXY * ceZW + ceXY * adZW);
  const auto abde =
    ((abXY * deZW + deXY * abZW) + (aeXY * bdZW + bdXY * aeZW)) - (adXY * beZW + beXY * adZW);
  const auto abce =
    ((abXY * ceZW + ceXY * abZW) + (aeXY * bcZW + bcXY * aeZW)) - (acXY * beZW + beXY * acZW);
  const auto abcd =
    ((abXY * cdZW + cdXY * abZW) + (adXY * bcZW + bcXY * adZW)) - (acXY * bdZW + bdXY * acZW);
  return ((bcde * lift[0] - acde * lift[1]) + (abde * lift[2] - abce * lift[3])) + abcd * lift[4];
}

} // namespace voxplex

#endif
