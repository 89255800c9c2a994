// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Refiner.h
 * @brief The worker loop: takes poor elements until there are none (thesis, algorithm 2).
 */
#ifndef voxplex_Refiner_h
#define voxplex_Refiner_h

#include "Parallel/CacheLine.h"
#include "Parallel/CycleClock.h"
#include "Parallel/HardwareCounters.h"
#include "Refinement/RefinerBase.h"
#include "Refinement/Rules/FeatureSeed.h"
#include "Refinement/Rules/Rules3D.h"
#include "Refinement/Rules/Rules4D.h"
#include "Refinement/Scheduling/RefinementTeam.h"
#include "Refinement/Scheduling/TeamOptions.h"

#include <memory>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief Refines the triangulation of a context by a set of rules, with any number of threads.
 *
 * Rules is Rules3D or Rules4D: a class that has `static constexpr int Dimension`, a constructor
 * (context, worker), `ScreenCreated()`, `Refine(simplex)` and `RemovePending()`. The loop is the
 * same for both.
 *
 * Refinement by several threads is speculative (section 3.2). A thread locks the vertices that its
 * operation needs one by one. If another thread owns one of them, the thread gives up, releases its
 * vertices, and calls the contention manager. A thread without work waits until the load balancer
 * brings some. With TeamOptions::FineGrained waiting threads help with insertions (LoopSharing). A
 * single thread takes no locks, and its mesh is the same bit for bit in every run.
 */
template <typename Rules>
class Refiner : public RefinerBase<Rules::Dimension>
{
public:
  static constexpr int D = Rules::Dimension;

  using typename RefinerBase<D>::Monitor;

  /**
   * @param seeds feature points that are inserted before the rules are applied
   * @param start AtSeeds: the rules judge only the simplices that the seeds make, and simplices
   *   whose circumball reaches where LocalDelta has lowered a bound. No rule applies to any other
   *   simplex
   */
  explicit Refiner(RefinementContext<D>& context, const TeamOptions& options = {},
    std::vector<FeatureSeed<D>> seeds = {}, RefinementStart start = RefinementStart::Everywhere)
    : RefinerBase<D>(context)
    , Options(options)
    , Seeds(std::move(seeds))
    , Start(start)
    , Team(options)
  {
  }

  /**
   * Refines until no rule applies. Call it once.
   * @return false if goOn stopped refinement
   * @throws std::bad_alloc
   */
  bool Run(const Monitor& goOn);

  std::vector<ThreadStatistics> GetThreadStatistics() const;
  /** Time until all threads had work; 0 for one thread. */
  double GetSecondsToSeed() const { return this->SecondsToSeed; }
  bool SwitchedToLocal()
  {
    return !this->Overheads.empty() && this->Team.Contention().SwitchedToLocal();
  }

private:
  /** A thread with fewer poor elements gives none away (thesis, section 3.2.4). */
  static constexpr std::size_t GiveThreshold = 5;

  /**
   * A thread releases its vertices when it owns this many, not after every turn. Successive
   * elements of its list mostly share vertices, and taking vertices is the main cost of locks. In
   * 4D operations are ten times as large: vertices that are kept are in the way of others, and
   * taking them costs little by comparison.
   */
  static constexpr std::size_t MostKept = D == 3 ? 128 : 1;

  /** Where a thread's time went besides refining. */
  struct alignas(CacheLineSize) Overhead
  {
    CycleClock::Ticks Contention = 0;
    CycleClock::Ticks LoadBalance = 0;
    CycleClock::Ticks Rollback = 0;
    ThreadStatistics Counts;
  };

  /** For the only worker. Pushes all simplices in the order of ids, or those of StartAtSeeds(). */
  void PushAll();

  /** Pushes the simplices at the seeds, and to the first worker those at lowered bounds. */
  void StartAtSeeds();

  /** Makes the workers 1, 2 ..., each with its share of a seeded triangulation. */
  void MakeWorkers(unsigned threads);

  bool WorkAlone(const Monitor& goOn);

  void Work(unsigned thread, const Monitor& goOn);

  /** The next entry that seems to be alive; its Id is None if there is none. */
  PoorElementList::Entry NextAlive(RefinementWorker<D>& me);

  RuleOutcome Refine(RefinementWorker<D>& me, Rules& rules, const PoorElementList::Entry& e);

  static bool HasWork(RefinementWorker<D>& me)
  {
    return !me.Poor.Empty() || !me.Deferred.empty() || !me.PendingRemovals.empty();
  }

  static void TakeUpDeferred(RefinementWorker<D>& me);

  /** Waits for work; returns false if there will be none. */
  bool Beg(unsigned thread);

  /** Gives work to a beggar. */
  void Give(unsigned thread);

  /** What the thread has spent on insertions of others so far: work, not overhead. */
  CycleClock::Ticks TicksOfHelp(unsigned thread) const;

  double Seconds(CycleClock::Ticks ticks) const
  {
    return static_cast<double>(ticks) * this->SecondsPerTick;
  }

  const TeamOptions Options;
  const std::vector<FeatureSeed<D>> Seeds;
  const RefinementStart Start;
  RefinementTeam Team;
  std::vector<std::unique_ptr<Overhead>> Overheads;
  std::vector<HardwareCounters::Counts> Hardware; ///< of each thread, written at its end
  double SecondsToSeed = 0.0;
  double SecondsPerTick = 0.0;
};

extern template class Refiner<Rules3D>;
extern template class Refiner<Rules4D>;

} // namespace voxplex

#endif
