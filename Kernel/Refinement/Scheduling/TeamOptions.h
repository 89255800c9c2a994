// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TeamOptions.h
 * @brief The number of threads, and how they cooperate in refinement.
 */
#ifndef voxplex_TeamOptions_h
#define voxplex_TeamOptions_h

#include "Parallel/Policies.h"

namespace voxplex
{

/** All but Threads concern refinement only. */
struct TeamOptions
{
  /** Threads of all stages; 0 means all cores. */
  unsigned Threads = 1;
  /** What a thread does if another thread holds a vertex that it needs. */
  ContentionPolicy Contention = ContentionPolicy::Local;
  /**
   * Global and local contention manager: number of successes in a row after which a thread wakes a
   * waiting thread (s+ of the thesis).
   */
  unsigned SuccessesToWake = 10;
  /** Which threads give work to an idle thread. */
  BalancePolicy Balance = BalancePolicy::Hierarchical;
  /**
   * One mesh for any number of threads: tiles of space are refined side by side (TiledRefiner). The
   * mesh differs from the one that a single thread makes without this. Only Threads and FineGrained
   * have an effect besides.
   */
  bool Reproducible = false;
  /** Keep each thread on a core of its own, where the system allows it. */
  bool Pin = false;
  /**
   * Run the code for several threads even with one thread, to measure the cost of its locks and
   * clocks.
   */
  bool Synchronise = false;
  /**
   * If there are several threads, but not more than processors: waiting threads help others with
   * large insertions (thesis, 4.6.2).
   */
  bool FineGrained = false;
  /**
   * Several threads: the approximate number of interface points for each thread that are inserted
   * before the threads start, so that all threads have work at once. 0: none, as in the thesis.
   */
  unsigned SeedsPerThread = 128;

  /** The defaults of a dimension. In 4D an operation takes about ten times as long. */
  template <int D>
  static constexpr TeamOptions Default()
  {
    TeamOptions team;
    team.SuccessesToWake = D == 4 ? 2 : 10;
    team.FineGrained = D == 4;
    return team;
  }
};

} // namespace voxplex

#endif
