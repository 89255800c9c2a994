// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FaceScan.h
 * @brief Searches the faces between voxels of different labels, in parallel.
 */
#ifndef voxplex_FaceScan_h
#define voxplex_FaceScan_h

#include "Base/GridIndex.h"
#include "Image/BitMask.h"
#include "Image/FacesNear.h"
#include "Image/LabelImage.h"
#include "Parallel/ParallelCollect.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * Finds the faces on the upper sides of some voxels for which is(face, hint) is true, in the order of
 * voxels, the first axis fastest.
 *
 * @param voxels voxels of the crop and the layer around it, as FindSurfaceVoxels() returns them
 * @param is called by several threads at once, for faces of interfaces (IsOfInterface). The hint is
 *   first Hint(), and is passed on between faces near each other.
 * @param threads 0 means all cores; the result does not depend on it
 * @throws Cancelled if a stop was requested before the end
 */
template <typename Hint, int D, typename Is>
std::vector<VoxelFace<D>> ScanFaces(const LabelImage<D>& image, const BitMask<D>& voxels,
  unsigned threads, const std::stop_token& stop, Is&& is)
{
  constexpr std::size_t RowsAtOnce = 64;
  constexpr std::int64_t VoxelsOfHint = 4;
  const std::size_t rows = voxels.NumberOfRows();
  const auto& n = voxels.Dimensions();
  return ParallelCollect<VoxelFace<D>>(
    rows, RowsAtOnce, threads,
    [&](std::size_t first, std::size_t last, std::vector<VoxelFace<D>>& faces)
    {
      std::vector<Hint> hints(static_cast<std::size_t>(n[0] / VoxelsOfHint + 1));
      for (std::size_t row = first; row < last; ++row)
      {
        VoxelFace<D> face{ IndexAt(row * static_cast<std::size_t>(n[0]), n), 0 };
        for (std::int64_t& c : face.Voxel)
        {
          --c; // the mask begins one layer before the crop
        }
        const auto words = voxels.Row(row);
        for (std::size_t w = 0; w < words.size(); ++w)
        {
          for (std::uint64_t bits = words[w]; bits != 0; bits &= bits - 1)
          {
            const std::int64_t x = static_cast<std::int64_t>(64 * w) + std::countr_zero(bits);
            face.Voxel[0] = x - 1;
            for (face.Axis = 0; face.Axis < D; ++face.Axis)
            {
              if (IsOfInterface(face, image) &&
                is(face, hints[static_cast<std::size_t>(x / VoxelsOfHint)]))
              {
                faces.push_back(face);
              }
            }
          }
        }
      }
    },
    stop);
}

/** The faces for which is(face, hint) is true. */
template <typename Hint, int D, typename Is>
std::vector<VoxelFace<D>> FilterFaces(const std::vector<VoxelFace<D>>& faces, Is&& is)
{
  std::vector<VoxelFace<D>> some;
  Hint hint{};
  std::copy_if(faces.begin(), faces.end(), std::back_inserter(some),
    [&](const VoxelFace<D>& face) { return is(face, hint); });
  return some;
}

} // namespace voxplex

#endif
