// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SymmetricEigen.h
 * @brief Eigenvalues and eigenvectors of small symmetric matrices.
 */
#ifndef voxplex_SymmetricEigen_h
#define voxplex_SymmetricEigen_h

#include "Geometry/Point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace voxplex
{

/** Row k of Vectors is the eigenvector of Values[k], of length 1. In no order. */
template <int D>
struct SymmetricEigen
{
  Point<D> Values;
  std::array<Point<D>, static_cast<std::size_t>(D)> Vectors;
};

/**
 * By cyclic Jacobi rotations. They end when the elements off the diagonal are far below the
 * rounding errors of the diagonal.
 */
template <int D>
SymmetricEigen<D> EigenOf(std::array<Point<D>, static_cast<std::size_t>(D)> m)
{
  constexpr double negligible = 1e-20;
  SymmetricEigen<D> result{};
  for (std::size_t a = 0; a < D; ++a)
  {
    result.Vectors[a][a] = 1.0;
  }
  bool rotated = true;
  for (int sweep = 0; sweep < 50 && rotated; ++sweep)
  {
    rotated = false;
    for (std::size_t p = 0; p < D; ++p)
    {
      for (std::size_t q = p + 1; q < D; ++q)
      {
        if (std::abs(m[p][q]) <= negligible * (std::abs(m[p][p]) + std::abs(m[q][q])))
        {
          continue;
        }
        rotated = true;
        const double theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1.0 / std::hypot(t, 1.0);
        const double s = t * c;
        const auto rotate = [c, s](double& a, double& b)
        {
          const double first = a;
          a = c * first - s * b;
          b = s * first + c * b;
        };
        for (std::size_t k = 0; k < D; ++k)
        {
          rotate(m[k][p], m[k][q]);
        }
        for (std::size_t k = 0; k < D; ++k)
        {
          rotate(m[p][k], m[q][k]);
          rotate(result.Vectors[p][k], result.Vectors[q][k]);
        }
      }
    }
  }
  for (std::size_t a = 0; a < D; ++a)
  {
    result.Values[a] = m[a][a];
  }
  return result;
}

template <int D>
double SmallestEigenvalue(const std::array<Point<D>, static_cast<std::size_t>(D)>& m)
{
  const Point<D> values = EigenOf<D>(m).Values;
  return *std::min_element(values.begin(), values.end());
}

} // namespace voxplex

#endif
