// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Workers.h
 * @brief Runs cases in forked processes, so that a crash or a hang is a result like any other.
 */
#ifndef voxplex_stress_Workers_h
#define voxplex_stress_Workers_h

#include "CaseRun.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace voxplex::stress
{

/** A range of cases of a family. */
struct CaseRange
{
  Family Kind = Family::Space;
  std::uint64_t Seed = 0;
  std::uint64_t First = 0;
  std::uint64_t Count = 0; ///< 0: no end
  double Seconds = 0.0;    ///< no case begins later than this; 0: no limit
};

/**
 * Runs cases in `jobs` worker processes. Each process runs one case after the other. If a process
 * dies, its case has failed (cause crash, with the signal), and a new process continues. If a case
 * neither ends nor can be cancelled, its process is killed (cause hang). Call this while the
 * process has only one thread.
 *
 * @param take is called with each result, in the order in which cases end
 * @throws std::runtime_error if no process can be started
 */
void RunInWorkers(const CaseRange& range, unsigned jobs, const RunLimits& limits,
  const std::function<void(const CaseId&, const CaseResult&)>& take);

/**
 * Runs one case in a process of its own. @param wallLimit wall-clock seconds after which the case
 * counts as hanging
 */
CaseResult RunInChild(const std::function<CaseResult()>& run, double wallLimit);

} // namespace voxplex::stress

#endif
