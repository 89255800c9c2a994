// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Workers.h
 * @brief Cases in forked processes, so that a crash or a hang of one is a result like others.
 */
#ifndef voxplex_stress_Workers_h
#define voxplex_stress_Workers_h

#include "CaseRun.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace voxplex::stress
{

/** Which cases of a family. */
struct CaseRange
{
  Family Kind = Family::Space;
  std::uint64_t Seed = 0;
  std::uint64_t First = 0;
  std::uint64_t Count = 0; ///< 0: no end
  double Seconds = 0.0;    ///< no case begins later than this; 0: no limit
};

/**
 * Runs cases in `jobs` worker processes, each case after case. Where one dies, its case has failed (cause crash, with
 * the signal), and another goes on. A case that neither ends nor can be cancelled is killed (cause hang). Call it while
 * this process has one thread.
 *
 * @param take receives each result, in the order in which cases end
 * @throws std::runtime_error if no process can be started
 */
void RunInWorkers(const CaseRange& range, unsigned jobs, const RunLimits& limits,
  const std::function<void(const CaseId&, const CaseResult&)>& take);

/** Runs one case in a process of its own. @param wallLimit seconds after which it counts as hanging */
CaseResult RunInChild(const std::function<CaseResult()>& run, double wallLimit);

} // namespace voxplex::stress

#endif
