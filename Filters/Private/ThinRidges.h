// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ThinRidges.h
 * @brief Where a label is thin.
 */
#ifndef voxplex_Private_ThinRidges_h
#define voxplex_Private_ThinRidges_h

#include "Image/FeatureTransform.h"
#include "Private/VoxelBox.h"

#include <vector>

namespace voxplex
{

/** Voxels of a block, each divided into eight, so that the middle of an even number of voxels is a point, too. */
struct HalfVoxels
{
  VoxelIndex Size;
  Point<3> Spacing;
  unsigned Threads;

  std::size_t Count() const { return Unsigned(this->Size[0] * this->Size[1] * this->Size[2]); }
  std::size_t At(const VoxelIndex& half) const
  {
    return Unsigned(half[0] + this->Size[0] * (half[1] + this->Size[1] * half[2]));
  }
  std::size_t At(const VoxelIndex& voxel, unsigned corner) const
  {
    return this->At({ 2 * voxel[0] + (corner & 1u), 2 * voxel[1] + (corner >> 1 & 1u),
      2 * voxel[2] + (corner >> 2 & 1u) });
  }

  /** The distance from the middle of each half voxel to that of the nearest site. @param sites not 0 there */
  FeatureTransform<3> DistancesTo(const std::vector<unsigned char>& sites) const;

  /** Whether distances grow slowly around a half voxel. */
  bool IsRidge(const VoxelIndex& half, const FeatureTransform<3>& distances) const;

  /**
   * The middle of thin places: ridges where balls of the radius do not fit, and farther than their diameter from where
   * they do. Nearer are corners, and bumps of thick parts.
   * @param outside 1 outside of the label, which must be somewhere
   * @return 1 there; empty if there are none
   */
  std::vector<unsigned char> ThinRidges(
    const std::vector<unsigned char>& outside, double radius) const;
};

/** Distances are of float precision. */
inline constexpr double DistanceRounding = 1e-4;

} // namespace voxplex

#endif
