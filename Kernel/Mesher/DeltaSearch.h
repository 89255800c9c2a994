// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DeltaSearch.h
 * @brief Which delta to try next for a mesh of a given number of elements.
 */
#ifndef voxplex_DeltaSearch_h
#define voxplex_DeltaSearch_h

#include "Mesher/MeshingStatistics.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace voxplex
{

/**
 * @brief Solves count(delta) = target from runs of the mesher.
 *
 * The count falls about with delta^-(D-1) where interfaces are what is sampled, and levels off where delta is large: small
 * components and sizes keep their elements. Near two runs log(count) is taken for linear in log(delta), with the exponent kept
 * within reason; once counts above and below the target are known delta stays between theirs, and
 * the interval is halved if it did not shrink to half of itself in two runs.
 *
 * A run within `Aim` of the target ends the search; from run `GoodEnough` on one within `Tolerance` does; after
 * `MostRuns` the search gives up. It gives up before that if the largest delta has too many elements or the smallest one too
 * few, if one twice as large as another has as many, or if the interval is as good as empty. Deltas have four digits but for the
 * largest. It knows nothing of meshes: the same counts give the same deltas.
 */
class DeltaSearch
{
public:
  static constexpr double Aim = 0.05;       ///< of the target
  static constexpr double Tolerance = 0.10; ///< of the target
  static constexpr std::size_t GoodEnough = 4;
  static constexpr std::size_t MostRuns = 12;

  /**
   * @param target elements, at least 1
   * @param guess the first delta
   * @param exponent about how the count falls with delta
   * @param smallest, largest deltas that may be tried
   */
  DeltaSearch(std::uint64_t target, double guess, double exponent, double smallest = 0.0,
    double largest = std::numeric_limits<double>::infinity());

  /** The delta to try; nothing if the search is over. */
  std::optional<double> Next() const { return this->NextDelta; }

  /** What came of a run with Next(). */
  void Add(std::uint64_t elements);

  /** Whether the best run is within the tolerance. */
  bool Found() const;

  /** The run nearest to the target, of two that are as near the first; there must be one. */
  const MeshingRun& Best() const;

  const std::vector<MeshingRun>& Runs() const { return this->All; }

private:
  double Deviation(const MeshingRun& run) const;
  double LogRatio(const MeshingRun& run) const;
  bool IsOutOfReach() const;
  std::optional<double> Choose();

  double Target;
  double Exponent;
  double Smallest;
  double Largest;
  std::optional<double> NextDelta;
  std::vector<MeshingRun> All;
  std::optional<MeshingRun> Above; ///< the largest delta known to have too many elements
  std::optional<MeshingRun> Below; ///< the smallest delta known to have too few
  double LastWidth;                ///< log of their ratio two runs ago
};

} // namespace voxplex

#endif
