// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageFrame.h
 * @brief How a vtkImageData lies in space, split into what the kernel takes and what the filter
 * keeps.
 *
 * A voxel (i, j, k) of the extent lies at origin + M (i, j, k), with M = direction * diag(spacing).
 * The kernel wants its grid in a frame of its own (GridGeometry): M = Q R, R upper triangular with
 * a positive diagonal. R goes to the kernel; Q, which is orthogonal, and the position of the first
 * voxel take what the kernel returns to the world. Q is a rigid map, so lengths, angles and volumes
 * are the same on both sides; its determinant is -1 for left-handed axes.
 */
#ifndef voxplex_ImageFrame_h
#define voxplex_ImageFrame_h

#include "Geometry/Point.h"
#include "Image/GridGeometry.h"

#include <array>
#include <string>

class vtkImageData;
class vtkInformation;

namespace voxplex
{

struct ImageFrame
{
  GridGeometry<3> Grid;               ///< dimensions and R
  std::array<Point<3>, 3> Rotation{}; ///< rows of Q
  Point<3> Origin{};                  ///< world position of the frame's origin, the first voxel
  bool LeftHanded = false;            ///< det(Q) < 0

  Point<3> ToWorld(const Point<3>& p) const
  {
    Point<3> x = this->Origin;
    for (std::size_t r = 0; r < 3; ++r)
    {
      x[r] += Dot(this->Rotation[r], p);
    }
    return x;
  }

  Point<3> ToFrame(const Point<3>& x) const
  {
    const Point<3> d = Subtract(x, this->Origin);
    Point<3> p;
    for (std::size_t c = 0; c < 3; ++c)
    {
      p[c] =
        this->Rotation[0][c] * d[0] + this->Rotation[1][c] * d[1] + this->Rotation[2][c] * d[2];
    }
    return p;
  }
};

/**
 * @param image the image
 * @param cells whether voxels are the image's cells (then they lie at the cell centres) or its
 * points
 * @param what what the image is called in messages
 * @throws InputError if the image is empty, the spacing is not positive and finite, the origin or
 * the direction is not finite, or the direction matrix is singular
 *
 * If only the rounding of a file's header keeps axes from being orthogonal, they are made exactly
 * so. An entry of R above the diagonal is dropped if it is below 1e-5 of a voxel's width (six digits
 * of text, or single precision). In an image 500 voxels wide, this moves no voxel by more than 0.005
 * voxel.
 */
ImageFrame MakeImageFrame(vtkImageData* image, bool cells, const std::string& what);

/**
 * The volume of a voxel of an input, as the pipeline announces it; 0 if it does not, or if it is not
 * positive and finite.
 */
double FindVoxelVolume(vtkInformation* input);

} // namespace voxplex

#endif
