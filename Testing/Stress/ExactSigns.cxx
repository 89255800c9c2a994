// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Signs of determinants in whole numbers. Coordinates are doubles, that is, whole multiples of one
// power of two.
#include "SimplexGeometry.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <cstdint>

namespace voxplex::stress
{

namespace
{

using Whole = boost::multiprecision::cpp_int;

template <std::size_t N>
using WholeMatrix = std::array<std::array<Whole, N>, N>;

template <std::size_t N>
Whole WholeDeterminant(const WholeMatrix<N>& m)
{
  if constexpr (N == 1)
  {
    return m[0][0];
  }
  else
  {
    Whole sum = 0;
    for (std::size_t c = 0; c < N; ++c)
    {
      WholeMatrix<N - 1> minor;
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
      const Whole term = m[0][c] * WholeDeterminant<N - 1>(minor);
      sum += c % 2 == 0 ? term : Whole(-term);
    }
    return sum;
  }
}

/** The smallest exponent of the last bits of the coordinates. */
template <int D>
int LeastExponent(const Vector<D>& p, int least)
{
  for (const double x : p)
  {
    int exponent = 0;
    std::frexp(x, &exponent);
    least = x != 0.0 ? std::min(least, exponent - 53) : least;
  }
  return least;
}

Whole ToWhole(double x, int exponent)
{
  int own = 0;
  const double fraction = std::frexp(x, &own);
  const Whole mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 53));
  return x == 0.0 ? Whole(0) : Whole(mantissa << (own - 53 - exponent));
}

template <int D>
int OrientationInWholes(const std::array<Vector<D>, static_cast<std::size_t>(D + 1)>& points)
{
  constexpr std::size_t N = static_cast<std::size_t>(D);
  int exponent = 1024;
  for (const Vector<D>& p : points)
  {
    exponent = LeastExponent<D>(p, exponent);
  }
  WholeMatrix<N> m;
  for (std::size_t r = 0; r < N; ++r)
  {
    for (std::size_t c = 0; c < N; ++c)
    {
      m[r][c] = ToWhole(points[r + 1][c], exponent) - ToWhole(points[0][c], exponent);
    }
  }
  return WholeDeterminant<N>(m).sign();
}

template <int D>
int InSphereInWholes(
  const std::array<Vector<D>, static_cast<std::size_t>(D + 1)>& points, const Vector<D>& p)
{
  constexpr std::size_t N = static_cast<std::size_t>(D + 1);
  int exponent = LeastExponent<D>(p, 1024);
  for (const Vector<D>& q : points)
  {
    exponent = LeastExponent<D>(q, exponent);
  }
  WholeMatrix<N> m;
  for (std::size_t r = 0; r < N; ++r)
  {
    m[r][N - 1] = 0;
    for (std::size_t c = 0; c + 1 < N; ++c)
    {
      m[r][c] = ToWhole(points[r][c], exponent) - ToWhole(p[c], exponent);
      m[r][N - 1] += m[r][c] * m[r][c];
    }
  }
  const int sign = WholeDeterminant<N>(m).sign();
  return D % 2 == 0 ? sign : -sign;
}

} // namespace

int ExactOrientation(const std::array<Vector<3>, 4>& points)
{
  return OrientationInWholes<3>(points);
}

int ExactOrientation(const std::array<Vector<4>, 5>& points)
{
  return OrientationInWholes<4>(points);
}

int ExactInSphere(const std::array<Vector<3>, 4>& points, const Vector<3>& p)
{
  return InSphereInWholes<3>(points, p);
}

int ExactInSphere(const std::array<Vector<4>, 5>& points, const Vector<4>& p)
{
  return InSphereInWholes<4>(points, p);
}

} // namespace voxplex::stress
