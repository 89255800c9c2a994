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

/** Limits of a reduction. */
struct ReductionLimits
{
  double Seconds = 300.0; ///< wall-clock time of all attempts
  unsigned Repeats = 3;   ///< runs of a case with several threads before it counts as passed
};

/**
 * Crops the image, changes labels and single voxels to other labels, and resets options to their
 * defaults one by one, down to one thread and orthogonal axes with unit voxels. Each step runs in a
 * process of its own.
 *
 * @param cause the cause of failure that must stay
 * @return the smallest case found; `of` itself if it does not fail
 */
template <int D>
StressCase<D> Reduce(const StressCase<D>& of, const std::string& cause, const RunLimits& limits,
  const ReductionLimits& reduction);

} // namespace voxplex::stress

#endif
