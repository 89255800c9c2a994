// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SmallestEigenvalue.h
 * @brief The smallest eigenvalue of a small symmetric matrix.
 */
#ifndef voxplex_SmallestEigenvalue_h
#define voxplex_SmallestEigenvalue_h

#include "Geometry/Point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace voxplex
{

/**
 * By cyclic Jacobi rotations. They end when the elements off the diagonal are far below the
 * rounding errors of the diagonal.
 */
template <int D>
double SmallestEigenvalue(std::array<Point<D>, static_cast<std::size_t>(D)> m)
{
  constexpr double negligible = 1e-20;
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
        for (std::size_t k = 0; k < D; ++k)
        {
          const double kp = m[k][p];
          const double kq = m[k][q];
          m[k][p] = c * kp - s * kq;
          m[k][q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < D; ++k)
        {
          const double pk = m[p][k];
          const double qk = m[q][k];
          m[p][k] = c * pk - s * qk;
          m[q][k] = s * pk + c * qk;
        }
      }
    }
  }
  double smallest = m[0][0];
  for (std::size_t a = 1; a < D; ++a)
  {
    smallest = std::min(smallest, m[a][a]);
  }
  return smallest;
}

} // namespace voxplex

#endif
