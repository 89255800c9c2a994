// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/FrameVolumes.h"

#include "Geometry/SimplexQuality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace voxplex
{

namespace
{

/** A number for each label of each frame. */
class Table
{
public:
  Table(std::int64_t frames, std::size_t labels)
    : Labels(labels)
    , Values(static_cast<std::size_t>(frames) * labels, 0.0)
  {
  }
  double& At(std::int64_t frame, std::size_t label)
  {
    return this->Values[static_cast<std::size_t>(frame) * this->Labels + label];
  }

private:
  std::size_t Labels;
  std::vector<double> Values;
};

Table VolumesOfVoxels(const LabelImage<4>& image)
{
  const auto& grid = image.Grid();
  const auto& extent = image.CropDimensions();
  Table volumes(grid.Dimensions[3], image.Values().size());
  const auto size = static_cast<std::size_t>(extent[0] * extent[1] * extent[2]);
  const double voxel = grid.VoxelVolume() / grid.IndexToFrame[3][3];
  for (std::int64_t k = 0; k < extent[3]; ++k)
  {
    for (const LabelId id : image.Ids().subspan(static_cast<std::size_t>(k) * size, size))
    {
      volumes.At(image.CropOrigin()[3] + k, id) += voxel;
    }
  }
  return volumes;
}

Table VolumesOfCuts(const SimplexMesh<4>& mesh, const LabelImage<4>& image)
{
  constexpr double Rounding = 1e-9; // of a frame
  const double step = image.Grid().IndexToFrame[3][3];
  const std::int64_t frames = image.Grid().Dimensions[3];
  const std::span<const std::int64_t> values = image.Values();
  Table volumes(frames, values.size());
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    const auto v = mesh.PointsOf(s);
    std::array<double, 5> times; // in frames
    std::transform(v.begin(), v.end(), times.begin(),
      [step](const Point<4>* p)
      {
        const double time = (*p)[3] / step;
        return std::abs(time - std::round(time)) < Rounding ? std::round(time) : time;
      });
    std::sort(times.begin(), times.end());
    const double volume = SignedVolume<4>(v.data()) / step;
    const auto id = static_cast<std::size_t>(
      std::lower_bound(values.begin(), values.end(), mesh.Labels[s]) - values.begin());
    // Where refinement gave way, an element may reach beyond the frames.
    const auto first =
      std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(times.front())));
    const auto last = std::min(frames - 1, static_cast<std::int64_t>(std::floor(times.back())));
    for (std::int64_t k = first; k <= last; ++k)
    {
      volumes.At(k, id) += volume * CutDensity(times, static_cast<double>(k), k == 0);
    }
  }
  return volumes;
}

} // namespace

//------------------------------------------------------------------------------------------------
double CutDensity(const std::array<double, 5>& t, double time, bool fromAbove)
{
  std::array<double, 4> b; // B-splines of order 1, ..., 4, by their recurrence
  for (std::size_t i = 0; i < 4; ++i)
  {
    const bool isInside =
      fromAbove ? t[i] <= time && time < t[i + 1] : t[i] < time && time <= t[i + 1];
    b[i] = isInside ? 1.0 / (t[i + 1] - t[i]) : 0.0;
  }
  for (std::size_t order = 2; order <= 4; ++order)
  {
    const double factor = static_cast<double>(order) / static_cast<double>(order - 1);
    for (std::size_t i = 0; i + order <= 4; ++i)
    {
      const double span = t[i + order] - t[i];
      b[i] = span > 0.0 ? factor * ((time - t[i]) * b[i] + (t[i + order] - time) * b[i + 1]) / span
                        : 0.0;
    }
  }
  return b[0];
}

FramesOff CompareFrames(const SimplexMesh<4>& mesh, const LabelImage<4>& image)
{
  Table voxels = VolumesOfVoxels(image);
  Table cuts = VolumesOfCuts(mesh, image);
  const std::int64_t frames = image.Grid().Dimensions[3];
  std::vector<char> isOff(static_cast<std::size_t>(frames), 0);
  FramesOff off;
  for (std::size_t id = 1; id < image.Values().size(); ++id)
  {
    double largest = 0.0;
    for (std::int64_t k = 0; k < frames; ++k)
    {
      largest = std::max(largest, voxels.At(k, id));
    }
    for (std::int64_t k = 0; k < frames; ++k)
    {
      const double whole = voxels.At(k, id);
      if (!(whole > 0.0 && whole >= LeastShareOfLargest * largest))
      {
        continue;
      }
      const double share = cuts.At(k, id) / whole;
      if (std::abs(share - 1.0) >= FrameTolerance)
      {
        isOff[static_cast<std::size_t>(k)] = 1;
      }
      if (std::abs(share - 1.0) > std::abs(off.Share - 1.0))
      {
        off.Frame = k;
        off.Label = image.Values()[id];
        off.Share = share;
      }
    }
  }
  off.Number = static_cast<std::uint64_t>(std::count(isOff.begin(), isOff.end(), 1));
  return off;
}

} // namespace voxplex
