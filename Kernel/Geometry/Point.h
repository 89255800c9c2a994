// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Point.h
 * @brief Points in the mesher's frame, and the vector operations that the kernel needs.
 *
 * A point is D doubles in the mesher's frame (see GridGeometry). Lengths are in the unit of the
 * image's spacing. All functions are pure and thread-safe.
 */
#ifndef voxplex_Point_h
#define voxplex_Point_h

#include <array>
#include <cmath>
#include <cstddef>

namespace voxplex
{

template <int D>
using Point = std::array<double, static_cast<std::size_t>(D)>;

/** a - b. */
template <std::size_t D>
inline std::array<double, D> Subtract(
  const std::array<double, D>& a, const std::array<double, D>& b)
{
  std::array<double, D> r;
  for (std::size_t i = 0; i < D; ++i)
  {
    r[i] = a[i] - b[i];
  }
  return r;
}

/** a + t * (b - a). The result is exactly a if t = 0. */
template <std::size_t D>
inline std::array<double, D> Interpolate(
  const std::array<double, D>& a, const std::array<double, D>& b, double t)
{
  std::array<double, D> r;
  for (std::size_t i = 0; i < D; ++i)
  {
    r[i] = a[i] + t * (b[i] - a[i]);
  }
  return r;
}

template <std::size_t D>
inline double Dot(const std::array<double, D>& a, const std::array<double, D>& b)
{
  double s = a[0] * b[0];
  for (std::size_t i = 1; i < D; ++i)
  {
    s += a[i] * b[i];
  }
  return s;
}

template <std::size_t D, std::size_t N>
inline std::array<double, D> Centroid(const std::array<const std::array<double, D>*, N>& points)
{
  std::array<double, D> r{};
  for (const std::array<double, D>* p : points)
  {
    for (std::size_t i = 0; i < D; ++i)
    {
      r[i] += (*p)[i] / static_cast<double>(N);
    }
  }
  return r;
}

/** Squared Euclidean distance. */
template <std::size_t D>
inline double Distance2(const std::array<double, D>& a, const std::array<double, D>& b)
{
  const std::array<double, D> d = Subtract(a, b);
  return Dot(d, d);
}

/** Euclidean distance. */
template <std::size_t D>
inline double Distance(const std::array<double, D>& a, const std::array<double, D>& b)
{
  return std::sqrt(Distance2(a, b));
}

} // namespace voxplex

#endif
