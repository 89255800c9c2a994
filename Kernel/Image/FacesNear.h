// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacesNear.h
 * @brief The faces between voxels of different labels that lie in any of many balls.
 */
#ifndef voxplex_FacesNear_h
#define voxplex_FacesNear_h

#include "Image/BitMask.h"
#include "Image/LabelImage.h"

#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** Between a voxel of the crop, or one beside it, and the next along an axis. */
struct VoxelFace
{
  using Index = GridGeometry<3>::Index;

  Index Voxel;
  unsigned Axis;

  auto operator<=>(const VoxelFace&) const = default;
  Index Next() const
  {
    Index next = this->Voxel;
    ++next[this->Axis];
    return next;
  }
};

/** Where the line between the centres of its voxels passes through it, in the frame. */
inline Point<3> CentreOf(const VoxelFace& face, const LabelImage<3>& image)
{
  return Interpolate(image.CentreOf(face.Voxel), image.CentreOf(face.Next()), 0.5);
}

/** In the frame. */
struct SearchBall
{
  Point<3> Centre;
  double Radius;
};

/**
 * Faces between voxels of different labels whose centre is in at least one of the balls, or on its sphere.
 *
 * Halves the image again and again. A block keeps the balls that reach into it, or just one that contains it, so that
 * many balls in one place cost little more than one: n log n in the number of balls and the faces found, whatever the
 * radii.
 *
 * @param sites the image's surface voxels (FindSurfaceVoxels)
 * @return ascending, none twice
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
std::vector<VoxelFace> FindFacesNear(const LabelImage<3>& image, const BitMask<3>& sites,
  std::span<const SearchBall> balls, const std::stop_token& stop);

} // namespace voxplex

#endif
