// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FeatureSeed.h
 * @brief A point that is inserted before refinement begins.
 */
#ifndef voxplex_FeatureSeed_h
#define voxplex_FeatureSeed_h

#include "Delaunay/Stores.h"
#include "Geometry/Point.h"

namespace voxplex
{

template <int D>
struct FeatureSeed
{
  Point<D> Position;
  double Delta; ///< the point is left out if a feature vertex is nearer than this
  /**
   * If it is true, the point is one of a plane that two slabs share, and the other slab has it: it is inserted as it is,
   * whatever is near, and never removed.
   */
  bool IsShared = false;
  VertexKind Kind = VertexKind::Feature; ///< of a shared point; other seeds are feature points
};

} // namespace voxplex

#endif
