// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ThinRidges.h
 * @brief Where a label is thin.
 */
#ifndef voxplex_ThinRidges_h
#define voxplex_ThinRidges_h

#include "Image/FeatureTransform.h"
#include "VoxelBox.h"

#include <optional>
#include <vector>

namespace voxplex
{

/** Voxels of a block, each divided into eight, so that the middle of an even number of voxels is a point, too. */
struct HalfVoxels
{
  /** Into a corner between two faces it is the square root of 2. */
  static constexpr double FarthestMove = 1.5;

  VoxelIndex Size;
  Point<3> Spacing;
  unsigned Threads;

  std::size_t At(const VoxelIndex& half) const
  {
    return Unsigned(half[0] + this->Size[0] * (half[1] + this->Size[1] * half[2]));
  }

  /** Calls visit(half) for the eight of a voxel. */
  template <typename Visit>
  static void ForEachOf(const VoxelIndex& voxel, Visit&& visit)
  {
    const VoxelIndex first{ 2 * voxel[0], 2 * voxel[1], 2 * voxel[2] };
    VoxelBox{ first, Plus(first, { 1, 1, 1 }) }.ForEachVoxel(visit);
  }

  /**
   * Balls around the middle of thin places. Where one would reach what has to stay, it moves to the nearest place where
   * it does not, by up to FarthestMove radii: what it lacks on one side it has on the other. If there is none, it
   * stays, without what is behind.
   * @param blocked what has to stay; null if nothing has
   * @param box where the result is wanted
   * @return 1 in balls; empty if there are none
   */
  std::optional<BitMask<3>> Thickened(
    const BitMask<3>& outside, const BitMask<3>* blocked, double radius, const VoxelBox& box) const;

private:
  FeatureTransform<3> DistancesTo(const BitMask<3>& sites) const;
  bool IsRidge(const VoxelIndex& half, const FeatureTransform<3>& distances) const;
  std::vector<VoxelIndex> ThinRidges(const BitMask<3>& outside, double radius) const;
  void MoveCentres(
    std::vector<VoxelIndex>& centres, const BitMask<3>& blocked, double radius) const;
};

/** Distances are of float precision. */
inline constexpr double DistanceRounding = 1e-4;

} // namespace voxplex

#endif
