// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ScalingTables.h
 * @brief What runs in many configurations tell: tables in Markdown, and JSON.
 *
 * Numbers are medians over rounds. A speed-up is the median over rounds of the number of tetrahedra a
 * second over that of one thread (the sequential code) in the same round: tetrahedra(n) time(1) /
 * (time(n) tetrahedra(1)), as in section 3.4.3 of the thesis. Meshes of one delta differ in size by
 * less than a percent, so that this is the ratio of times there.
 */
#ifndef voxplex_ScalingTables_h
#define voxplex_ScalingTables_h

#include "ScalingRuns.h"

#include <cstddef>
#include <ostream>
#include <utility>
#include <vector>

namespace voxplex::benchmarks
{

/** Series by their place in ScalingRuns::All(). */
using Selection = std::vector<std::size_t>;

class ScalingTables
{
public:
  /** @param baseline one thread; what all speed-ups are against */
  ScalingTables(const ScalingRuns& runs, std::size_t baseline)
    : Runs(runs)
    , Baseline(runs[baseline])
  {
  }

  /** Sizes, times, speed-ups. */
  void PrintTimes(const Selection& series) const;
  /** The three overheads in seconds for each thread, and what threads gave each other. */
  void PrintOverheads(const Selection& series) const;

  /** Contention managers side by side, in the order of the enumerators, overheads of all threads together: table 3.1 of the thesis. */
  void PrintManagers(const Selection& series) const;
  /** Load balancers side by side, by number of threads: figure 3.5 of the thesis. */
  void PrintBalancers(const Selection& series) const;
  /** Numbers of threads side by side: table 3.4 of the thesis. */
  void PrintWeak(const Selection& series) const;

  /** The code for several threads with one thread, against the sequential code. */
  void PrintSynchronised(std::size_t synchronised) const;
  /** Independent processes: what the machine gives at best. */
  void PrintCeiling(const Selection& series) const;
  /** More threads than cores against as many: pairs (over-subscribed, as many as cores). */
  void PrintOversubscribed(const std::vector<std::pair<std::size_t, std::size_t>>& pairs) const;

  /** A JSON array with all series: what was run, medians, speed-ups, runs. */
  void WriteJson(std::ostream& stream) const;

private:
  /** Median over rounds of the ratio of `series` to `reference`. */
  template <typename Value>
  static double Ratio(const Series& series, const Series& reference, Value value);
  double SpeedUp(const Series& series) const;
  double TotalSpeedUp(const Series& series) const;

  const ScalingRuns& Runs;
  const Series& Baseline;
};

} // namespace voxplex::benchmarks

#endif
