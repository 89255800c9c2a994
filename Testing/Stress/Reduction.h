// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Reduction.h
 * @brief Makes a failing case smaller as long as it fails for the same cause.
 */
#ifndef voxplex_stress_Reduction_h
#define voxplex_stress_Reduction_h

#include "CaseRun.h"

#include <string>

namespace voxplex::stress
{

/** How far reduction goes. */
struct ReductionLimits
{
  double Seconds = 300.0; ///< wall-clock, for all attempts
  unsigned Repeats = 3;   ///< of a case with several threads before it counts as mended
};

/**
 * Crops the image, gives labels and single voxels to others, resets options to their defaults one by one, down to one
 * thread and orthogonal axes with unit voxels; each step in a process of its own.
 *
 * @param cause what must stay
 * @return the smallest case found; `of` itself if it does not fail
 */
template <int D>
StressCase<D> Reduce(const StressCase<D>& of, const std::string& cause, const RunLimits& limits,
  const ReductionLimits& reduction);

} // namespace voxplex::stress

#endif
