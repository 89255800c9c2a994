// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FinestSpacing.h
 * @brief The finest spacing at which checks sample interfaces.
 */
#ifndef voxplex_FinestSpacing_h
#define voxplex_FinestSpacing_h

#include "Image/GridGeometry.h"

#include <algorithm>
#include <cmath>

namespace voxplex
{

/**
 * A fraction of the smallest voxel spacing: the label field has no finer features. In 4D half the
 * spacing makes about ten times as many elements. So it is 2.5 times as large there, and the smallest
 * spacing counts as at least half of the mean one: the step between frames may be short.
 */
template <int D>
double FinestSpacing(const GridGeometry<D>& grid, double fraction)
{
  if constexpr (D == 3)
  {
    return fraction * grid.SmallestSpacing();
  }
  else
  {
    const double mean = std::pow(grid.VoxelVolume(), 1.0 / D);
    return 2.5 * fraction * std::max(grid.SmallestSpacing(), 0.5 * mean);
  }
}

} // namespace voxplex

#endif
