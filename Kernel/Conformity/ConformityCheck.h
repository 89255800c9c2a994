// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ConformityCheck.h
 * @brief The interface of checks that run when refinement has nothing more to do.
 */
#ifndef voxplex_ConformityCheck_h
#define voxplex_ConformityCheck_h

#include "Mesh/LabelledTriangulation.h"
#include "Mesh/SimplexMesh.h"
#include "Refinement/FeatureSeed.h"

#include <vector>

namespace voxplex
{

/** The result of a check: whether and how refinement is resumed. */
template <int D>
struct Remedy
{
  bool IsNeeded = false; ///< false: nothing is wrong, or nothing more can be done
  std::vector<FeatureSeed<D>>
    Points; ///< to be inserted; the check may also have lowered local bounds
};

/**
 * @brief Checks a property of the mesh that the refinement rules alone do not guarantee.
 *
 * After each refinement, all checks inspect the triangulation, in order, then the elements that will
 * be extracted from it, and then the mesh. If any of them needs a remedy at one of these steps,
 * inspection stops after the step, and refinement is resumed for all of them together. A check that
 * needed nothing before may be left out then. Each check gives up after a limited number of
 * remedies, so the run ends.
 *
 * All functions may throw Cancelled and std::bad_alloc.
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
  virtual Remedy<D> InspectElements(const LabelledTriangulation<D>&) { return {}; }
  virtual Remedy<D> InspectMesh(const SimplexMesh<D>&) { return {}; }

  double& Seconds;
};

} // namespace voxplex

#endif
