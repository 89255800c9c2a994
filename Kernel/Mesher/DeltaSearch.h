// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DeltaSearch.h
 * @brief Searches the delta that gives a mesh of a requested number of elements.
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
 * If most elements come from sampling interfaces, the count falls about as delta^-(D-1). For large
 * delta it levels off, because small components and element sizes keep their elements. Near two
 * runs, log(count) is taken as linear in log(delta), with a limited exponent. Once a delta with too
 * many and a delta with too few elements are known, the search stays between them. If this interval
 * has not shrunk to half its length in two runs, it is halved.
 *
 * A run within `Aim` of the target ends the search. From run `GoodEnough` on, a run within
 * `Tolerance` ends it. After `MostRuns` runs, the search gives up. It gives up earlier
 * - if the largest delta has too many elements, or the smallest delta too few;
 * - if a delta twice as large as another one gives the same number of elements;
 * - if the interval is nearly empty.
 *
 * Deltas have four digits, except the largest. The search does not depend on meshes: the same
 * counts give the same deltas.
 */
class DeltaSearch
{
public:
  static constexpr double Aim = 0.05;       ///< as a fraction of the target
  static constexpr double Tolerance = 0.10; ///< as a fraction of the target
  static constexpr std::size_t GoodEnough = 4;
  static constexpr std::size_t MostRuns = 12;

  /**
   * @param target number of elements, at least 1
   * @param guess the first delta
   * @param exponent approximate exponent by which the count falls with delta
   * @param smallest, largest range of the deltas to try
   */
  DeltaSearch(std::uint64_t target, double guess, double exponent, double smallest = 0.0,
    double largest = std::numeric_limits<double>::infinity());

  /** The next delta to try; nothing if the search is over. */
  std::optional<double> Next() const { return this->NextDelta; }

  /** Adds the result of a run with Next(). */
  void Add(std::uint64_t elements);

  /** Whether the best run is within the tolerance. */
  bool Found() const;

  /**
   * The run nearest to the target; the first one if several are equally near. There must be a run.
   */
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
  double LastWidth;                ///< log of the ratio of their deltas two runs ago
};

} // namespace voxplex

#endif
