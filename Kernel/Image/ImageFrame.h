// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageFrame.h
 * @brief How an image lies in the world, split into what the mesher takes and what takes its result
 * there.
 *
 * A voxel (i, j, k) lies at origin + M (i, j, k). The columns of M are the steps from one voxel to the
 * next along the axes. The mesher wants its grid in a frame of its own (GridGeometry): M = Q R, R upper
 * triangular with a positive diagonal. R goes to the mesher; Q, which is orthogonal, and the position
 * of the first voxel take its mesh to the world. Q is a rigid map, so lengths, angles and volumes are
 * the same on both sides; its determinant is -1 for left-handed axes.
 */
#ifndef voxplex_ImageFrame_h
#define voxplex_ImageFrame_h

#include "Geometry/Point.h"
#include "Image/GridGeometry.h"

#include <array>
#include <string>

namespace voxplex
{

/** Without an image: the frame of the world itself. */
struct ImageFrame
{
  GridGeometry<3> Grid; ///< dimensions and R
  std::array<Point<3>, 3> Rotation{ Point<3>{ 1.0, 0.0, 0.0 }, Point<3>{ 0.0, 1.0, 0.0 },
    Point<3>{ 0.0, 0.0, 1.0 } }; ///< rows of Q
  Point<3> Origin{};             ///< world position of the frame's origin, the first voxel
  bool LeftHanded = false;       ///< det(Q) < 0

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
 * @param dimensions of the image, in voxels
 * @param steps from one voxel to the next along each axis, finite
 * @param origin the first voxel's position
 * @param what what the image is called in messages
 * @throws InputError if the steps are linearly dependent
 *
 * If only the rounding of a file's header keeps axes from being orthogonal, they are made exactly
 * so. An entry of R above the diagonal is dropped if it is below 1e-5 of a voxel's width (six digits
 * of text, or single precision). In an image 500 voxels wide, this moves no voxel by more than 0.005
 * voxel.
 */
ImageFrame MakeImageFrame(const GridGeometry<3>::Index& dimensions,
  const std::array<Point<3>, 3>& steps, const Point<3>& origin, const std::string& what);

} // namespace voxplex

#endif
