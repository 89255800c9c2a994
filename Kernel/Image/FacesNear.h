// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacesNear.h
 * @brief Finds the faces between voxels of different labels that lie in given balls.
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

/** The face between a voxel and the next voxel along an axis. At least one is in the crop. */
struct VoxelFace
{
  using Index = GridGeometry<3>::Index;

  Index Voxel;
  unsigned Axis;

  auto operator<=>(const VoxelFace&) const = default; // NOLINT(modernize-use-nullptr): not a null
  Index Next() const
  {
    Index next = this->Voxel;
    ++next[this->Axis];
    return next;
  }
};

/** The midpoint between the centres of the face's two voxels, in the frame. */
inline Point<3> CentreOf(const VoxelFace& face, const LabelImage<3>& image)
{
  return Interpolate(image.CentreOf(face.Voxel), image.CentreOf(face.Next()), 0.5);
}

/** A ball in the frame. */
struct SearchBall
{
  Point<3> Centre;
  double Radius;
};

/**
 * Finds the faces between voxels of different labels whose centre is inside or on at least one of
 * the balls.
 *
 * The image is halved recursively. Each block keeps the balls that intersect it. If a ball contains
 * the block, the block keeps only this ball. So many balls in one place cost little more than one.
 * The time is n log n, where n is the number of balls and of found faces. It does not depend on the
 * radii.
 *
 * @param sites the image's surface voxels (FindSurfaceVoxels)
 * @return the faces in ascending order, without duplicates
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
std::vector<VoxelFace> FindFacesNear(const LabelImage<3>& image, const BitMask<3>& sites,
  std::span<const SearchBall> balls, const std::stop_token& stop);

} // namespace voxplex

#endif
