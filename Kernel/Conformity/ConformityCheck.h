// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ConformityCheck.h
 * @brief What is looked at when refinement has nothing more to do.
 */
#ifndef voxplex_ConformityCheck_h
#define voxplex_ConformityCheck_h

#include "Mesh/SimplexMesh.h"
#include "Refinement/FeatureSeed.h"

#include <vector>

namespace voxplex
{

/** How refinement goes on. */
template <int D>
struct Remedy
{
  bool IsNeeded = false; ///< false: all is well, or nothing more can be done
  std::vector<FeatureSeed<D>>
    Points; ///< to be inserted; local bounds may have been lowered besides
};

/**
 * @brief A property of the mesh that the rules of refinement do not give by themselves.
 *
 * After each refinement all checks inspect the triangulation, then the mesh that is extracted from it, in their order. The
 * first that needs a remedy ends this, and refinement goes on. A check ends by itself: it gives up after so many
 * remedies.
 *
 * All may throw Cancelled and std::bad_alloc.
 */
template <int D>
class ConformityCheck
{
public:
  /** @param seconds receives the wall-clock time of inspections */
  explicit ConformityCheck(double& seconds)
    : Seconds(seconds)
  {
  }
  virtual ~ConformityCheck() = default;

  virtual Remedy<D> InspectTriangulation() { return {}; }
  virtual Remedy<D> InspectMesh(const SimplexMesh<D>&) { return {}; }

  double& Seconds;
};

} // namespace voxplex

#endif
