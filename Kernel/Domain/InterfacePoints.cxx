// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Domain/InterfacePoints.h"

#include "Parallel/ParallelFor.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace voxplex
{
namespace
{

using Index = GridGeometry<3>::Index;

/**
 * Returns pointOf(upper voxel, its label, label of the voxel before it, axis) for each face between
 * different labels. The upper voxels are those of the crop and of the layer behind it.
 */
template <typename PointOf>
std::vector<Point<3>> ForEachFace(
  const LabelImage<3>& image, unsigned threads, const std::stop_token& stop, PointOf&& pointOf)
{
  const Index& n = image.CropDimensions();
  std::vector<Point<3>> points;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    Index end = n;
    ++end[axis];
    std::vector<std::vector<Point<3>>> slabs(static_cast<std::size_t>(end[2]));
    const auto fillSlab = [&](std::size_t slab)
    {
      Index voxel;
      voxel[2] = static_cast<std::int64_t>(slab);
      for (voxel[1] = 0; voxel[1] < end[1]; ++voxel[1])
      {
        for (voxel[0] = 0; voxel[0] < end[0]; ++voxel[0])
        {
          Index before = voxel;
          --before[axis];
          const LabelId upper = image.At(voxel);
          const LabelId lower = image.At(before);
          if (upper != lower)
          {
            slabs[slab].push_back(pointOf(voxel, upper, lower, axis));
          }
        }
      }
    };
    ParallelFor(
      0, slabs.size(), 1, threads, [&](std::size_t first, std::size_t) { fillSlab(first); }, stop);
    for (std::vector<Point<3>>& slab : slabs)
    {
      points.insert(points.end(), slab.begin(), slab.end());
      std::vector<Point<3>>().swap(slab);
    }
  }
  return points;
}

/**
 * Where the label ends on the line from a voxel that has it (0) to a neighbour (1). Margins are
 * piecewise linear there, so regula falsi needs few steps.
 */
double FindCrossing(
  const LabelField<3>& field, const Point<3>& from, const Point<3>& to, LabelId label)
{
  constexpr double tolerance = 1e-3;
  constexpr int manySteps = 64;
  double inside = 0.0;
  double outside = 1.0;
  double marginInside = field.MarginAt(from, label);
  double marginOutside = field.MarginAt(to, label);
  for (int step = 0; step < manySteps && outside - inside > tolerance; ++step)
  {
    // Every third step halves the interval, in case one end does not move.
    const double fraction = step % 3 == 2 ? 0.5 : marginInside / (marginInside - marginOutside);
    const double t = inside + fraction * (outside - inside);
    const double margin = field.MarginAt(Interpolate(from, to, t), label);
    if (std::abs(margin) < 1e-4 * tolerance)
    {
      return t;
    }
    (margin > 0.0 ? inside : outside) = t;
    (margin > 0.0 ? marginInside : marginOutside) = margin;
  }
  return 0.5 * (inside + outside);
}

} // namespace

std::vector<Point<3>> VoxelFaceCentres(
  const LabelImage<3>& image, unsigned threads, const std::stop_token& stop)
{
  const Index& origin = image.CropOrigin();
  return ForEachFace(image, threads, stop,
    [&](const Index& voxel, LabelId, LabelId, std::size_t axis)
    {
      Point<3> index;
      for (std::size_t a = 0; a < 3; ++a)
      {
        index[a] = static_cast<double>(origin[a] + voxel[a]) - (a == axis ? 0.5 : 0.0);
      }
      return image.Grid().ToFrame(index);
    });
}

std::vector<Point<3>> SmoothInterfacePoints(const LabelImage<3>& image, const LabelField<3>& field,
  unsigned threads, const std::stop_token& stop)
{
  return ForEachFace(image, threads, stop,
    [&](const Index& voxel, LabelId upper, LabelId, std::size_t axis)
    {
      Point<3> from; // lattice coordinates; the lattice begins one layer before the crop
      for (std::size_t a = 0; a < 3; ++a)
      {
        from[a] = static_cast<double>(voxel[a] + 1);
      }
      Point<3> to = from;
      to[axis] -= 1.0;
      return field.ToFrame(Interpolate(from, to, FindCrossing(field, from, to, upper)));
    });
}

} // namespace voxplex
