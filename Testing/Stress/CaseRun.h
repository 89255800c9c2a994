// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CaseRun.h
 * @brief Meshes one case through ImageMesher, with limits, and checks the mesh.
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

/** Limits of a run: beyond them it fails or is ended. */
struct RunLimits
{
  double TimeFactor = 1.0;           ///< factor of the time limits by size
  double Seconds = 0.0;              ///< limit of processor time; 0: limit by size
  double OperationsPerVertex = 25.0; ///< more operations are a failure; 0: no limit
};

enum class CaseStatus
{
  Passed,
  Refused, ///< InputError or TooLargeError, with a message
  Failed
};

/** The result of a case. */
struct CaseResult
{
  CaseStatus Status = CaseStatus::Passed;
  std::string Refusal; ///< the message
  std::vector<Finding> Failures;
  std::string Kind;
  std::uint64_t Elements = 0;
  std::uint64_t Vertices = 0; ///< of the mesh, or of the triangulation if those are more
  std::uint64_t Created = 0;
  std::uint64_t Operations = 0; ///< insertions and removals
  std::uint64_t NonManifold = 0;
  std::uint64_t Lost = 0;
  double Seconds = 0.0;      ///< processor time of meshing, all threads
  double CheckSeconds = 0.0; ///< processor time of the checks

  bool Has(const std::string& cause) const;
};

/** Seconds of processor time after which a case counts as endless. */
template <int D>
double TimeLimit(const StressCase<D>& of, const RunLimits& limits);

/** Throws only std::bad_alloc, and only if its own memory fails. */
template <int D>
CaseResult RunCase(const StressCase<D>& of, const RunLimits& limits);

} // namespace voxplex::stress

#endif
