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

#include <stop_token>
#include <vector>

namespace voxplex
{

/** The face between a voxel and the next voxel along an axis. At least one is in the crop. */
template <int D>
struct VoxelFace
{
  using Index = typename GridGeometry<D>::Index;

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
template <int D>
Point<D> CentreOf(const VoxelFace<D>& face, const LabelImage<D>& image)
{
  return Interpolate(image.CentreOf(face.Voxel), image.CentreOf(face.Next()), 0.5);
}

/**
 * Whether an interface passes between the face's voxels: their labels differ. Before the first frame
 * and after the last one (4D) there is no interface; meshes end there.
 */
template <int D>
bool IsOfInterface(const VoxelFace<D>& face, const LabelImage<D>& image)
{
  if (image.At(face.Voxel) == image.At(face.Next()))
  {
    return false;
  }
  constexpr unsigned time = 3;
  if (D == 3 || face.Axis != time)
  {
    return true;
  }
  const std::int64_t frame = face.Voxel[D - 1] + image.CropOrigin()[D - 1];
  return frame >= 0 && frame + 1 < image.Grid().Dimensions[D - 1];
}

/** A ball in the frame. */
template <int D>
struct SearchBall
{
  Point<D> Centre;
  double Radius;
};

/**
 * Finds the faces of interfaces (IsOfInterface) whose centre is inside or on at least one of the
 * balls.
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
template <int D>
std::vector<VoxelFace<D>> FindFacesNear(const LabelImage<D>& image, const BitMask<D>& sites,
  const std::vector<SearchBall<D>>& balls, const std::stop_token& stop);

extern template std::vector<VoxelFace<3>> FindFacesNear<3>(const LabelImage<3>&, const BitMask<3>&,
  const std::vector<SearchBall<3>>&, const std::stop_token&);
extern template std::vector<VoxelFace<4>> FindFacesNear<4>(const LabelImage<4>&, const BitMask<4>&,
  const std::vector<SearchBall<4>>&, const std::stop_token&);

} // namespace voxplex

#endif
