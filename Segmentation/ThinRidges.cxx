// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ThinRidges.h"

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

/** Whether a mask has something between two half voxels. */
bool IsBetween(const BitMask<3>& mask, const VoxelIndex& from, const VoxelIndex& to)
{
  const VoxelIndex way = Minus(to, from);
  const std::int64_t steps = std::max({ std::abs(way[0]), std::abs(way[1]), std::abs(way[2]) });
  bool isOne = false;
  for (std::int64_t step = 1; step < steps && !isOne; ++step)
  {
    VoxelIndex at = from;
    for (std::size_t a = 0; a < 3; ++a)
    {
      at[a] += std::lround(static_cast<double>(way[a] * step) / static_cast<double>(steps));
    }
    isOne = mask.Test(at);
  }
  return isOne;
}

} // namespace

/** From the middle of each half voxel to that of the nearest site. */
FeatureTransform<3> HalfVoxels::DistancesTo(const BitMask<3>& sites) const
{
  return { sites, this->Spacing, { 1, 1, 1 }, this->Threads };
}

/** Whether distances grow slowly around a half voxel. */
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

/**
 * The middle of thin places: ridges where balls of the radius do not fit, and farther than their diameter from where they
 * do. Nearer are corners, and bumps of thick parts.
 */
std::vector<VoxelIndex> HalfVoxels::ThinRidges(const BitMask<3>& outside, double radius) const
{
  const VoxelBox all{ {}, Minus(this->Size, { 1, 1, 1 }) };
  std::vector<VoxelIndex> ridges;
  BitMask<3> fitting(this->Size);
  bool isAnyFitting = false;
  {
    const FeatureTransform<3> distances = this->DistancesTo(outside);
    all.ForEachVoxel(
      [&](const VoxelIndex& half)
      {
        if (distances.Distance(this->At(half)) >= radius * (1.0 - DistanceRounding))
        {
          fitting.Set(half);
          isAnyFitting = true;
        }
        else if (!outside.Test(half) && this->IsRidge(half, distances))
        {
          ridges.push_back(half);
        }
      });
  }
  if (isAnyFitting && !ridges.empty())
  {
    const FeatureTransform<3> away = this->DistancesTo(fitting);
    std::erase_if(ridges,
      [&](const VoxelIndex& half) { return away.Distance(this->At(half)) <= 2.0 * radius; });
  }
  return ridges;
}

void HalfVoxels::MoveCentres(
  std::vector<VoxelIndex>& centres, const BitMask<3>& blocked, double radius) const
{
  BitMask<3> isFree(this->Size);
  {
    const FeatureTransform<3> distances = this->DistancesTo(blocked);
    const auto fits = [&](const VoxelIndex& half)
    { return distances.Distance(this->At(half)) >= radius * (1.0 - DistanceRounding); };
    if (std::all_of(centres.begin(), centres.end(), fits))
    {
      return;
    }
    VoxelBox{ {}, Minus(this->Size, { 1, 1, 1 }) }.ForEachVoxel(
      [&](const VoxelIndex& half) { fits(half) ? isFree.Set(half) : void(); });
  }
  const FeatureTransform<3> nearest = this->DistancesTo(isFree);
  for (VoxelIndex& centre : centres)
  {
    const std::size_t at = this->At(centre);
    if (nearest.Distance(at) > FarthestMove * radius)
    {
      continue;
    }
    const VoxelIndex to = nearest.IndexOf(nearest.Site(at));
    centre = IsBetween(blocked, centre, to) ? centre : to;
  }
}

std::optional<BitMask<3>> HalfVoxels::Thickened(
  const BitMask<3>& outside, const BitMask<3>* blocked, double radius, const VoxelBox& box) const
{
  std::vector<VoxelIndex> middle = this->ThinRidges(outside, radius);
  if (middle.empty())
  {
    return {};
  }
  if (blocked)
  {
    this->MoveCentres(middle, *blocked, radius);
  }
  BitMask<3> centres(this->Size);
  std::for_each(middle.begin(), middle.end(), [&](const VoxelIndex& half) { centres.Set(half); });
  const FeatureTransform<3> nearest = this->DistancesTo(centres);
  std::optional<BitMask<3>> balls(this->Size);
  box.ForEachVoxel(
    [&](const VoxelIndex& half)
    {
      const std::size_t at = this->At(half);
      if (nearest.Distance(at) < radius * (1.0 - DistanceRounding) &&
        (!blocked || blocked->Test(half) ||
          !IsBetween(*blocked, half, nearest.IndexOf(nearest.Site(at)))))
      {
        balls->Set(half);
      }
    });
  return balls;
}

} // namespace voxplex
