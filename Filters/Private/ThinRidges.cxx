// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/ThinRidges.h"

namespace voxplex
{

namespace
{

/**
 * A ridge of distances: they grow by less than this over a unit of length, as between parallel faces, and faces at an angle
 * of 17 degrees. With 0.5, half voxels beside the middle of oblique sheets are ridges, too, and the sheets become up to two
 * voxels thicker than asked for; with 0.15, half a voxel.
 */
constexpr double RidgeSlope = 0.15;

} // namespace

FeatureTransform<3> HalfVoxels::DistancesTo(const std::vector<unsigned char>& sites) const
{
  BitMask<3> mask(this->Size);
  VoxelBox{ {}, Minus(this->Size, { 1, 1, 1 }) }.ForEachVoxel(
    [&](const VoxelIndex& half)
    {
      if (sites[this->At(half)] != 0)
      {
        mask.Set(half);
      }
    });
  return { mask, this->Spacing, { 1, 1, 1 }, this->Threads };
}

bool HalfVoxels::IsRidge(const VoxelIndex& half, const FeatureTransform<3>& distances) const
{
  const double own = distances.Distance(this->At(half));
  for (int step = 0; step < 27; ++step)
  {
    const VoxelIndex move{ step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1 };
    VoxelIndex other = half;
    double length = 0.0;
    bool isInside = true;
    for (std::size_t a = 0; a < 3; ++a)
    {
      other[a] += move[a];
      length += std::pow(static_cast<double>(move[a]) * this->Spacing[a], 2);
      isInside = isInside && other[a] >= 0 && other[a] < this->Size[a];
    }
    if (isInside && length > 0.0 &&
      distances.Distance(this->At(other)) - own > RidgeSlope * std::sqrt(length))
    {
      return false;
    }
  }
  return true;
}

std::vector<unsigned char> HalfVoxels::ThinRidges(
  const std::vector<unsigned char>& outside, double radius) const
{
  const FeatureTransform<3> distances = this->DistancesTo(outside);
  const double fits = radius * (1.0 - DistanceRounding);
  std::vector<unsigned char> ridges(this->Count(), 0);
  std::vector<unsigned char> fitting(this->Count(), 0);
  bool isAnyRidge = false;
  bool isAnyFitting = false;
  VoxelIndex half;
  for (half[2] = 0; half[2] < this->Size[2]; ++half[2])
  {
    for (half[1] = 0; half[1] < this->Size[1]; ++half[1])
    {
      for (half[0] = 0; half[0] < this->Size[0]; ++half[0])
      {
        const std::size_t at = this->At(half);
        fitting[at] = distances.Distance(at) >= fits ? 1 : 0;
        ridges[at] = outside[at] == 0 && fitting[at] == 0 && this->IsRidge(half, distances);
        isAnyRidge = isAnyRidge || ridges[at] != 0;
        isAnyFitting = isAnyFitting || fitting[at] != 0;
      }
    }
  }
  if (!isAnyRidge)
  {
    return {};
  }
  if (isAnyFitting)
  {
    const FeatureTransform<3> away = this->DistancesTo(fitting);
    for (std::size_t at = 0; at < ridges.size(); ++at)
    {
      ridges[at] = ridges[at] != 0 && away.Distance(at) > 2.0 * radius ? 1 : 0;
    }
  }
  return std::count(ridges.begin(), ridges.end(), 1) == 0 ? std::vector<unsigned char>() : ridges;
}

} // namespace voxplex
