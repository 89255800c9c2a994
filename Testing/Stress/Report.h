// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Report.h
 * @brief Counts the results of cases and prints them.
 */
#ifndef voxplex_stress_Report_h
#define voxplex_stress_Report_h

#include "CaseRun.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace voxplex::stress
{

/** The command line that repeats a case. */
std::string RepeatCommand(const CaseId& id);

class Report
{
public:
  /** Prints failures at once, and the progress now and then. */
  void Add(const CaseId& id, const CaseResult& result);

  /** The summary: counts, causes, the worst cases. */
  void Print() const;

  std::uint64_t Failed() const { return this->FailedCases; }

private:
  /** The worst cases by one figure. */
  struct Ranking
  {
    std::string Title;
    std::vector<std::pair<double, std::string>> Worst; ///< descending
    void Add(double figure, const std::string& what);
  };
  struct Cause
  {
    std::uint64_t Cases = 0;
    std::vector<CaseId> First;
    std::string Message;
  };

  struct Outcomes
  {
    std::uint64_t Passed = 0;
    std::uint64_t Failed = 0;
    std::uint64_t Refused = 0;
  };

  void Rank(const CaseId& id, const CaseResult& result);

  std::uint64_t Cases = 0;
  std::uint64_t Refused = 0;
  std::uint64_t FailedCases = 0;
  std::uint64_t Elements = 0;
  std::uint64_t CasesNonManifold = 0;
  std::uint64_t NonManifold = 0;
  std::uint64_t CasesWithLost = 0;
  double Seconds = 0.0;
  double CheckSeconds = 0.0;
  double LastLine = 0.0; ///< time of the last line of progress
  std::map<std::string, Cause> Causes;
  std::map<std::string, std::uint64_t> Refusals; ///< counts by the first words of the message
  std::map<std::string, std::uint64_t> Kinds;
  std::map<std::string, Outcomes> Features; ///< what some cases have beside their image
  Ranking Slowest{ "seconds of processor time", {} };
  Ranking SlowestPerElement{ "microseconds per element (meshes of 300 or more)", {} };
  Ranking CreatedPerElement{ "simplices created per element (meshes of 300 or more)", {} };
  Ranking OperationsPerVertex{ "insertions and removals per vertex (meshes of 100 or more)", {} };
};

} // namespace voxplex::stress

#endif
