// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceVoxels.h
 * @brief Internal to ImageDomain: the surface voxels, which are the sites of the feature transform.
 */
#ifndef voxplex_SurfaceVoxels_h
#define voxplex_SurfaceVoxels_h

#include "Image/BitMask.h"
#include "Image/LabelImage.h"

#include <algorithm>
#include <stop_token>

namespace voxplex
{

/** Moves a lattice index beyond a flat end of a space-time image to the nearest frame. */
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
 * Finds the surface voxels: voxels of the lattice with a face neighbour of another label. The
 * lattice is the crop with one more layer around it. This layer is background; at a flat end it
 * repeats the frame.
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
BitMask<D> FindSurfaceVoxels(
  const LabelImage<D>& image, unsigned threads, const std::stop_token& stop);

} // namespace voxplex

#endif
