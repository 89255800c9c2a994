// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/ImageFrame.h"

#include "Base/Error.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMatrix3x3.h"

#include <algorithm>
#include <cmath>
#include <sstream>

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

/** The columns of direction * diag(spacing). */
Columns VoxelSteps(vtkImageData* image, const std::string& what)
{
  double spacing[3];
  image->GetSpacing(spacing);
  double origin[3];
  image->GetOrigin(origin);
  vtkMatrix3x3* direction = image->GetDirectionMatrix();
  Columns columns;
  for (int c = 0; c < 3; ++c)
  {
    if (!(spacing[c] > 0.0) || !std::isfinite(spacing[c]))
    {
      std::ostringstream text;
      text << "The spacing of the " << what << " is (" << spacing[0] << ", " << spacing[1] << ", "
           << spacing[2] << "): each component must be positive and finite.";
      throw InputError(text.str());
    }
    if (!std::isfinite(origin[c]))
    {
      std::ostringstream text;
      text << "The origin of the " << what << " is (" << origin[0] << ", " << origin[1] << ", "
           << origin[2] << "): each component must be finite.";
      throw InputError(text.str());
    }
    for (int r = 0; r < 3; ++r)
    {
      const double cosine = direction->GetElement(r, c);
      if (!std::isfinite(cosine))
      {
        throw InputError(
          "The direction matrix of the " + what + " has elements that are not finite.");
      }
      columns[static_cast<std::size_t>(c)][static_cast<std::size_t>(r)] = cosine * spacing[c];
    }
  }
  return columns;
}

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

double Determinant(const Columns& m)
{
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
    m[1][0] * (m[0][1] * m[2][2] - m[0][2] * m[2][1]) +
    m[2][0] * (m[0][1] * m[1][2] - m[0][2] * m[1][1]);
}

} // namespace

ImageFrame MakeImageFrame(vtkImageData* image, bool cells, const std::string& what)
{
  ImageFrame frame;
  int extent[6];
  image->GetExtent(extent);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const std::int64_t points =
      static_cast<std::int64_t>(extent[2 * axis + 1]) - extent[2 * axis] + 1;
    if (points < 1)
    {
      throw InputError("The " + what + " is empty.");
    }
    // VTK takes an image that is one point thick for one layer of cells.
    frame.Grid.Dimensions[axis] = cells ? std::max<std::int64_t>(points - 1, 1) : points;
  }

  const Columns steps = VoxelSteps(image, what);
  Columns q{};
  for (Point<3>& row : frame.Grid.IndexToFrame)
  {
    row.fill(0.0);
  }
  Decompose(steps, what, q, frame.Grid.IndexToFrame);
  GridGeometry<3>::Matrix& upper = frame.Grid.IndexToFrame;
  for (std::size_t r = 0; r < 3; ++r)
  {
    for (std::size_t c = r + 1; c < 3; ++c)
    {
      if (std::abs(upper[r][c]) <= OrthogonalTolerance * std::min(upper[r][r], upper[c][c]))
      {
        upper[r][c] = 0.0;
      }
    }
  }
  frame.LeftHanded = Determinant(q) < 0.0;

  image->GetOrigin(frame.Origin.data());
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const bool centred = cells && extent[2 * axis + 1] > extent[2 * axis];
    const double first = extent[2 * axis] + (centred ? 0.5 : 0.0);
    for (std::size_t i = 0; i < 3; ++i)
    {
      frame.Origin[i] += first * steps[axis][i];
      frame.Rotation[i][axis] = q[axis][i];
    }
  }
  return frame;
}

double FindVoxelVolume(vtkInformation* input)
{
  if (input == nullptr || !input->Has(vtkDataObject::SPACING()))
  {
    return 0.0;
  }
  const double* const spacing = input->Get(vtkDataObject::SPACING());
  double volume = spacing[0] * spacing[1] * spacing[2];
  if (input->Has(vtkDataObject::DIRECTION()))
  {
    volume *= std::abs(vtkMatrix3x3::Determinant(input->Get(vtkDataObject::DIRECTION())));
  }
  return volume > 0.0 && std::isfinite(volume) ? volume : 0.0;
}

} // namespace voxplex
