// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/ImageFrame.h"

#include "Base/Error.h"
#include "Geometry/Determinants.h"

#include <algorithm>
#include <cmath>

namespace voxplex
{

namespace
{

/** Off-diagonal entries of R below this fraction of a voxel are rounding errors of a file's header.
 */
constexpr double OrthogonalTolerance = 1e-5;
/** Axes are dependent if the parallelepiped of their unit vectors has a volume below this. */
constexpr double SingularTolerance = 1e-6;

using Columns = std::array<Point<3>, 3>;

/** M = Q R by Gram-Schmidt, each column orthogonalised twice; the diagonal of R is positive. */
void Decompose(
  const Columns& steps, const std::string& what, Columns& q, GridGeometry<3>::Matrix& upper)
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    const double length = std::sqrt(Dot(steps[c], steps[c]));
    Point<3> v = steps[c];
    for (int pass = 0; pass < 2; ++pass)
    {
      for (std::size_t r = 0; r < c; ++r)
      {
        const double along = Dot(q[r], v);
        upper[r][c] += along;
        for (std::size_t i = 0; i < 3; ++i)
        {
          v[i] -= along * q[r][i];
        }
      }
    }
    const double rest = std::sqrt(Dot(v, v));
    if (!(rest > SingularTolerance * length))
    {
      throw InputError("The direction matrix of the " + what +
        " is singular: two of its axes coincide, or all three lie in a plane.");
    }
    upper[c][c] = rest;
    for (std::size_t i = 0; i < 3; ++i)
    {
      q[c][i] = v[i] / rest;
    }
  }
}

} // namespace

ImageFrame MakeImageFrame(const GridGeometry<3>::Index& dimensions, const Columns& steps,
  const Point<3>& origin, const std::string& what)
{
  ImageFrame frame;
  frame.Grid.Dimensions = dimensions;
  frame.Origin = origin;
  GridGeometry<3>::Matrix& upper = frame.Grid.IndexToFrame;
  Columns q{};
  Decompose(steps, what, q, upper);
  for (std::size_t r = 0; r < 3; ++r)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      frame.Rotation[r][c] = q[c][r];
      if (c > r &&
        std::abs(upper[r][c]) <= OrthogonalTolerance * std::min(upper[r][r], upper[c][c]))
      {
        upper[r][c] = 0.0;
      }
    }
  }
  frame.LeftHanded = Determinant(q) < 0.0;
  return frame;
}

} // namespace voxplex
