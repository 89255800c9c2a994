// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FeatureSeed.h
 * @brief A feature point that is inserted before refinement begins.
 */
#ifndef voxplex_FeatureSeed_h
#define voxplex_FeatureSeed_h

#include "Geometry/Point.h"

namespace voxplex
{

template <int D>
struct FeatureSeed
{
  Point<D> Position;
  double Delta; ///< the point is left out if a feature vertex is nearer than this
};

} // namespace voxplex

#endif
