// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SimplexGeometry.h
 * @brief Signs, volumes, balls and angles of simplices, independent of the kernel.
 *
 * Arithmetic is in long double, and in whole numbers where long double does not decide.
 */
#ifndef voxplex_stress_SimplexGeometry_h
#define voxplex_stress_SimplexGeometry_h

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace voxplex::stress
{

using Real = long double;

template <int D>
using Vector = std::array<double, static_cast<std::size_t>(D)>;

template <std::size_t N>
using RealMatrix = std::array<std::array<Real, N>, N>;

/** By expansion along the first row. */
template <std::size_t N>
Real Determinant(const RealMatrix<N>& m)
{
  if constexpr (N == 1)
  {
    return m[0][0];
  }
  else if constexpr (N == 2)
  {
    return m[0][0] * m[1][1] - m[0][1] * m[1][0];
  }
  else
  {
    Real sum = 0;
    for (std::size_t c = 0; c < N; ++c)
    {
      RealMatrix<N - 1> minor;
      for (std::size_t r = 1; r < N; ++r)
      {
        for (std::size_t k = 0, to = 0; k < N; ++k)
        {
          if (k != c)
          {
            minor[r - 1][to++] = m[r][k];
          }
        }
      }
      sum += (c % 2 == 0 ? m[0][c] : -m[0][c]) * Determinant<N - 1>(minor);
    }
    return sum;
  }
}

/**
 * A bound of the error of a determinant whose matrix entries are exact to about ten roundings. It
 * is based on the product of the rows' sums, which is above the sum of all products.
 */
template <std::size_t N>
Real DeterminantError(const RealMatrix<N>& m)
{
  Real product = 1;
  for (const auto& row : m)
  {
    Real sum = 0;
    for (const Real x : row)
    {
      sum += std::abs(x);
    }
    product *= sum;
  }
  return 100 * std::numeric_limits<Real>::epsilon() * product;
}

///@{
/** Computed in whole numbers; slow. */
int ExactOrientation(const std::array<Vector<3>, 4>& points);
int ExactOrientation(const std::array<Vector<4>, 5>& points);
int ExactInSphere(const std::array<Vector<3>, 4>& points, const Vector<3>& p);
int ExactInSphere(const std::array<Vector<4>, 5>& points, const Vector<4>& p);
///@}

template <int D>
RealMatrix<static_cast<std::size_t>(D)> EdgeMatrix(
  const std::array<Vector<D>, static_cast<std::size_t>(D + 1)>& points)
{
  RealMatrix<static_cast<std::size_t>(D)> m;
  for (std::size_t r = 0; r < m.size(); ++r)
  {
    for (std::size_t c = 0; c < m.size(); ++c)
    {
      m[r][c] = static_cast<Real>(points[r + 1][c]) - static_cast<Real>(points[0][c]);
    }
  }
  return m;
}

/** Positive, negative or 0, without error: the sign of det(p1 - p0, ..., pD - p0). */
template <int D>
int Orientation(const std::array<Vector<D>, static_cast<std::size_t>(D + 1)>& points)
{
  const auto m = EdgeMatrix<D>(points);
  const Real determinant = Determinant(m);
  const Real error = DeterminantError(m);
  return determinant > error ? 1 : determinant < -error ? -1 : ExactOrientation(points);
}

/** 1 if p is inside of the circumball of a positively oriented simplex, 0 on it, -1 outside; without error. */
template <int D>
int InSphere(
  const std::array<Vector<D>, static_cast<std::size_t>(D + 1)>& points, const Vector<D>& p)
{
  constexpr std::size_t N = static_cast<std::size_t>(D + 1);
  RealMatrix<N> m;
  for (std::size_t r = 0; r < N; ++r)
  {
    m[r][N - 1] = 0;
    for (std::size_t c = 0; c + 1 < N; ++c)
    {
      m[r][c] = static_cast<Real>(points[r][c]) - static_cast<Real>(p[c]);
      m[r][N - 1] += m[r][c] * m[r][c];
    }
  }
  // Rows are the points from p, lifted. The sign for p inside is that of a simplex around the origin: (-1)^D.
  const Real determinant = D % 2 == 0 ? Determinant(m) : -Determinant(m);
  const Real error = DeterminantError(m);
  return determinant > error ? 1 : determinant < -error ? -1 : ExactInSphere(points, p);
}

template <int D>
Real VolumeOf(const std::array<Vector<D>, static_cast<std::size_t>(D + 1)>& points)
{
  return Determinant(EdgeMatrix<D>(points)) / (D == 3 ? 6 : 24);
}

/** Computed by Cramer's rule. The radius is infinite if the simplex is flat. */
template <int D>
Real CircumcentreOf(const std::array<Vector<D>, static_cast<std::size_t>(D + 1)>& points,
  std::array<Real, static_cast<std::size_t>(D)>& centre)
{
  const auto m = EdgeMatrix<D>(points);
  const Real determinant = Determinant(m);
  Real radius2 = 0;
  for (std::size_t c = 0; c < m.size(); ++c)
  {
    auto replaced = m;
    for (std::size_t r = 0; r < m.size(); ++r)
    {
      Real square = 0;
      for (const Real x : m[r])
      {
        square += x * x;
      }
      replaced[r][c] = square / 2;
    }
    const Real offset = Determinant(replaced) / determinant;
    centre[c] = static_cast<Real>(points[0][c]) + offset;
    radius2 += offset * offset;
  }
  return std::isfinite(radius2) ? std::sqrt(radius2) : std::numeric_limits<Real>::infinity();
}

template <int D>
Real DistanceOf(const Vector<D>& a, const Vector<D>& b)
{
  Real sum = 0;
  for (std::size_t c = 0; c < a.size(); ++c)
  {
    const Real x = static_cast<Real>(a[c]) - static_cast<Real>(b[c]);
    sum += x * x;
  }
  return std::sqrt(sum);
}

template <int D>
Real ShortestEdgeOf(const std::array<Vector<D>, static_cast<std::size_t>(D + 1)>& points)
{
  Real shortest = std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      shortest = std::min(shortest, DistanceOf<D>(points[i], points[j]));
    }
  }
  return shortest;
}

inline std::array<Real, 3> CrossProduct(const std::array<Real, 3>& a, const std::array<Real, 3>& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

inline Real AngleBetween(const std::array<Real, 3>& a, const std::array<Real, 3>& b)
{
  const auto c = CrossProduct(a, b);
  const Real sine = std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
  const Real cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return std::atan2(sine, cosine) * 180 / std::numbers::pi_v<Real>;
}

inline std::array<Real, 3> Between(const Vector<3>& a, const Vector<3>& b)
{
  return { static_cast<Real>(b[0]) - a[0], static_cast<Real>(b[1]) - a[1],
    static_cast<Real>(b[2]) - a[2] };
}

/** Degrees. */
inline Real SmallestAngleOf(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c)
{
  return std::min({ AngleBetween(Between(a, b), Between(a, c)),
    AngleBetween(Between(b, a), Between(b, c)), AngleBetween(Between(c, a), Between(c, b)) });
}

/** The smallest and the largest dihedral angle, degrees. */
inline std::array<Real, 2> DihedralAnglesOf(const std::array<Vector<3>, 4>& p)
{
  std::array<Real, 2> angles = { 180, 0 };
  for (std::size_t i = 0; i < 4; ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      // Around the edge kl between the facets that lack i and j.
      std::size_t k = 0;
      while (k == i || k == j)
      {
        ++k;
      }
      const std::size_t l = 6 - i - j - k;
      const auto edge = Between(p[k], p[l]);
      const Real angle = AngleBetween(
        CrossProduct(edge, Between(p[k], p[i])), CrossProduct(edge, Between(p[k], p[j])));
      angles = { std::min(angles[0], angle), std::max(angles[1], angle) };
    }
  }
  return angles;
}

} // namespace voxplex::stress

#endif
