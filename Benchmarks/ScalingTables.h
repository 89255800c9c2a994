// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ScalingTables.h
 * @brief The results of runs in many configurations, as Markdown tables and as JSON.
 *
 * Numbers are medians over rounds. For a speed-up, the rate of a round, in tetrahedra per second,
 * is divided by the rate of one thread (the sequential code) in the same round: tetrahedra(n)
 * time(1) / (time(n) tetrahedra(1)), as in section 3.4.3 of the thesis. The speed-up is the median
 * of these ratios. Meshes with the same delta differ in size by less than a percent, so their
 * speed-up is the ratio of times.
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

/** Series by their index in ScalingRuns::All(). */
using Selection = std::vector<std::size_t>;

class ScalingTables
{
public:
  /** @param baseline the series of one thread, which all speed-ups refer to */
  ScalingTables(const ScalingRuns& runs, std::size_t baseline)
    : Runs(runs)
    , Baseline(runs[baseline])
  {
  }

  /** Prints sizes, times and speed-ups. */
  void PrintTimes(const Selection& series) const;
  /**
   * Prints the three overheads in seconds for each thread, and the work that threads gave to
   * others.
   */
  void PrintOverheads(const Selection& series) const;

  /**
   * Prints contention managers side by side, in the order of the enumerators, with the overheads of
   * all threads together: table 3.1 of the thesis.
   */
  void PrintManagers(const Selection& series) const;
  /** Prints load balancers side by side, by number of threads: figure 3.5 of the thesis. */
  void PrintBalancers(const Selection& series) const;
  /** Prints numbers of threads side by side: table 3.4 of the thesis. */
  void PrintWeak(const Selection& series) const;

  /** Compares the code for several threads, run by one thread, with the sequential code. */
  void PrintSynchronised(std::size_t synchronised) const;
  /** Prints independent processes: the upper limit of the machine. */
  void PrintCeiling(const Selection& series) const;
  /**
   * Compares more threads than cores with as many threads as cores.
   * @param pairs (over-subscribed, as many as cores)
   */
  void PrintOversubscribed(const std::vector<std::pair<std::size_t, std::size_t>>& pairs) const;

  /** Writes a JSON array of all series: configuration, medians, speed-ups, runs. */
  void WriteJson(std::ostream& stream) const;

private:
  /** The median over rounds of the ratio of `series` to `reference`. */
  template <typename Value>
  static double Ratio(const Series& series, const Series& reference, Value value);
  double SpeedUp(const Series& series) const;
  double TotalSpeedUp(const Series& series) const;

  const ScalingRuns& Runs;
  const Series& Baseline;
};

} // namespace voxplex::benchmarks

#endif
