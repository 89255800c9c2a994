// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CaseRun.h
 * @brief Meshes one case through the kernel's front door, with limits, and checks the mesh.
 */
#ifndef voxplex_stress_CaseRun_h
#define voxplex_stress_CaseRun_h

#include "Findings.h"
#include "StressCase.h"

#include <cstdint>
#include <string>
#include <vector>

namespace voxplex::stress
{

/** What counts as a failure, and when a run is ended. */
struct RunLimits
{
  double TimeFactor = 1.0;           ///< of the limits by size
  double Seconds = 0.0;              ///< of processor time, instead of those by size; 0: by size
  double OperationsPerVertex = 40.0; ///< more are a failure; 0: no limit
  bool AllowNonManifold = false;
};

enum class CaseStatus
{
  Passed,
  Refused, ///< with a message: InputError, TooLargeError
  Failed
};

/** How a case ended. */
struct CaseResult
{
  CaseStatus Status = CaseStatus::Passed;
  std::string Refusal; ///< the message
  std::vector<Finding> Failures;
  std::string Kind;
  std::uint64_t Elements = 0;
  std::uint64_t Vertices = 0;
  std::uint64_t Created = 0;
  std::uint64_t Operations = 0; ///< insertions and removals
  std::uint64_t NonManifold = 0;
  std::uint64_t Lost = 0;
  double Seconds = 0.0;      ///< of processor time, meshing only, all threads
  double CheckSeconds = 0.0; ///< of processor time, for the checks

  bool Has(const std::string& cause) const;
};

/** Seconds of processor time after which a case counts as endless. */
template <int D>
double TimeLimit(const StressCase<D>& of, const RunLimits& limits);

/** Never throws but std::bad_alloc of its own. */
template <int D>
CaseResult RunCase(const StressCase<D>& of, const RunLimits& limits);

} // namespace voxplex::stress

#endif
