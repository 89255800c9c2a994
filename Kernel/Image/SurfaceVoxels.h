// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceVoxels.h
 * @brief Internal to ImageDomain: the voxels next to interfaces, the sites of its feature transform.
 */
#ifndef voxplex_SurfaceVoxels_h
#define voxplex_SurfaceVoxels_h

#include "Image/BitMask.h"
#include "Image/LabelImage.h"

#include <algorithm>
#include <stop_token>

namespace voxplex
{

/** A lattice index beyond a flat end stands for the one on it. */
template <int D>
inline void ClampToCut(const LabelImage<D>& image, typename GridGeometry<D>::Index& lattice)
{
  if constexpr (D == 4)
  {
    lattice[3] = image.ReachesBorderInTime(0) ? std::max<std::int64_t>(lattice[3], 1) : lattice[3];
    lattice[3] =
      image.ReachesBorderInTime(1) ? std::min(lattice[3], image.CropDimensions()[3]) : lattice[3];
  }
}

/**
 * Voxels of the lattice (the crop and one layer of background around it, at flat ends one that repeats the
 * frame) with a face neighbour of another label.
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
BitMask<D> FindSurfaceVoxels(
  const LabelImage<D>& image, unsigned threads, const std::stop_token& stop);

} // namespace voxplex

#endif
