// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VoxelBox.h
 * @brief Boxes of voxels, and blocks of them.
 */
#ifndef voxplex_VoxelBox_h
#define voxplex_VoxelBox_h

#include "Image/GridGeometry.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace voxplex
{

using VoxelIndex = GridGeometry<3>::Index;

inline std::size_t Unsigned(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

inline VoxelIndex Plus(const VoxelIndex& a, const VoxelIndex& b)
{
  return { a[0] + b[0], a[1] + b[1], a[2] + b[2] };
}

inline VoxelIndex Minus(const VoxelIndex& a, const VoxelIndex& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

/** A box of voxels, from First to Last. */
struct VoxelBox
{
  VoxelIndex First{};
  VoxelIndex Last{};

  /** Without voxels, for Include(). */
  static VoxelBox Empty()
  {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    return { { most, most, most }, { -1, -1, -1 } };
  }

  void Include(const VoxelIndex& voxel)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      this->First[a] = std::min(this->First[a], voxel[a]);
      this->Last[a] = std::max(this->Last[a], voxel[a]);
    }
  }

  VoxelIndex Size() const
  {
    return { this->Last[0] - this->First[0] + 1, this->Last[1] - this->First[1] + 1,
      this->Last[2] - this->First[2] + 1 };
  }

  /** Larger by a length on all sides, within the grid. */
  VoxelBox Grown(double length, const Point<3>& spacing, const VoxelIndex& dimensions) const
  {
    VoxelBox box;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const auto margin = static_cast<std::int64_t>(
        std::ceil(std::min(length / spacing[a], static_cast<double>(dimensions[a]))));
      box.First[a] = std::max<std::int64_t>(this->First[a] - margin, 0);
      box.Last[a] = std::min(this->Last[a] + margin, dimensions[a] - 1);
    }
    return box;
  }

  template <typename Visit>
  void ForEachVoxel(Visit&& visit) const
  {
    for (std::int64_t k = this->First[2]; k <= this->Last[2]; ++k)
    {
      for (std::int64_t j = this->First[1]; j <= this->Last[1]; ++j)
      {
        for (std::int64_t i = this->First[0]; i <= this->Last[0]; ++i)
        {
          visit(VoxelIndex{ i, j, k });
        }
      }
    }
  }

  /**
   * Calls visit(block) for blocks that cover the box. Maps of distances of one block fit into memory, where those of the
   * whole image might not.
   * @param margin what will be added around a block; small blocks would be margin for the most part
   */
  template <typename Visit>
  void ForEachBlock(double margin, const Point<3>& spacing, Visit&& visit) const
  {
    VoxelIndex edge;
    for (std::size_t a = 0; a < 3; ++a)
    {
      edge[a] = static_cast<std::int64_t>(std::clamp(2.0 * margin / spacing[a], 64.0, 1e9));
    }
    for (std::int64_t k = this->First[2]; k <= this->Last[2]; k += edge[2])
    {
      for (std::int64_t j = this->First[1]; j <= this->Last[1]; j += edge[1])
      {
        for (std::int64_t i = this->First[0]; i <= this->Last[0]; i += edge[0])
        {
          visit(VoxelBox{ { i, j, k },
            { std::min(i + edge[0] - 1, this->Last[0]), std::min(j + edge[1] - 1, this->Last[1]),
              std::min(k + edge[2] - 1, this->Last[2]) } });
        }
      }
    }
  }
};

/** Whether a test is true for a voxel, or one that shares a face, an edge or a corner with it. */
template <typename Test>
bool IsAnyAround(const VoxelIndex& voxel, Test&& test)
{
  bool isAny = false;
  VoxelBox{ Plus(voxel, { -1, -1, -1 }), Plus(voxel, { 1, 1, 1 }) }.ForEachVoxel(
    [&](const VoxelIndex& other) { isAny = isAny || test(other); });
  return isAny;
}

} // namespace voxplex

#endif
