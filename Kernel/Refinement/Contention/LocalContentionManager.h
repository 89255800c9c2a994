// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LocalContentionManager.h
 * @brief After a rollback a thread waits for the winner (thesis, section 3.3.4, figure 3.2).
 */
#ifndef voxplex_LocalContentionManager_h
#define voxplex_LocalContentionManager_h

#include "Parallel/CacheLine.h"
#include "Parallel/LoopSharing.h"
#include "Parallel/ParkingSpot.h"
#include "Parallel/WaitingList.h"
#include "Refinement/ContentionManager.h"

#include <atomic>
#include <mutex>
#include <vector>

namespace voxplex
{

/**
 * @brief After a rollback a thread waits in the winner's list, unless the winner waits itself or is
 * idle.
 *
 * A thread wakes one thread of its list after every SuccessesToWake successes in a row, and all of
 * them when it becomes idle. It does not wake its list when it begins to wait: figure 3.4 of the
 * thesis shows the livelock that would follow.
 *
 * Write T -> W if T waits in W's list. T decides under its own mutex and W's. The busy_wait flag of
 * the thesis is T.Spot.IsTaken(), and its conflicting_id is the list that T is in.
 *
 * **No deadlock.** T -> W begins at a moment when W does not wait: T sees this under W's mutex, and
 * W needs that mutex to begin to wait. So in T -> W -> X the wait of W began after that of T. These
 * times grow along every chain, so no chain closes: each ends at a thread R that does not wait. R
 * is not idle either. When it became idle, it emptied its list under its mutex, and no thread has
 * entered the list since. So R runs, and it wakes a thread when it has succeeded often enough or
 * runs out of work. The reason why T waits for W does not matter. If W released the vertex long
 * ago, T still waits for a running thread. No thread waits for a thread that waits for work. So
 * threads with work never all wait, here and in the load balancer together.
 *
 * **No livelock.** Consider a period in which no thread succeeds, becomes idle or becomes busy. No
 * thread is woken in it, so fewer than n of n threads begin to wait. A thread goes on after a
 * rollback only if its winner waits or is idle, that is, holds no vertex. Consider the moment when
 * the last of the threads that will wait does so. After it each other thread can lose at most once
 * more, in the attempt that it had begun before. So there are fewer than 2 n rollbacks in all, and
 * then a thread succeeds or runs out of work. The latter happens at most n times, because gifts
 * follow successes. Hence threads succeed again and again.
 *
 * **Help.** The proofs stay valid if waiting threads help at a shared loop: see LoopSharing.
 *
 * In theory one thread may starve, as in the thesis: while its winner never succeeds ten times in a
 * row. It goes on when the winner runs out of work.
 */
class LocalContentionManager final : public ContentionManager
{
public:
  static constexpr unsigned SuccessesToWake = 10; ///< s+ of the thesis, the default

  /**
   * @param sharing the loops at which waiting threads help, or null
   * @param successesToWake number of successes in a row after which a thread wakes another
   */
  explicit LocalContentionManager(
    unsigned threads, LoopSharing* sharing = nullptr, unsigned successesToWake = SuccessesToWake);

  bool RollbackOccurred(unsigned thread, unsigned winner) override;

  /** Inline; nine times out of ten it only increments a counter of the thread's own. */
  void RollbackNotOccurred(unsigned thread) override
  {
    Slot& own = this->Slots[thread];
    if (++own.Successes >= this->Threshold)
    {
      own.Successes = 0;
      // Relaxed: only a hint. A thread that is overlooked now is seen ten successes later, or by
      // BecomesIdle().
      if (own.SomeoneWaits.load(std::memory_order_relaxed))
      {
        this->WakeFirst(own);
      }
    }
  }

  void BecomesIdle(unsigned thread) override;
  void BecomesBusy(unsigned thread) override;
  void Stop() override;

  /** True if the thread waits now; for tests and for observers of a run. */
  bool IsWaiting(unsigned thread) const { return this->Slots[thread].Spot.IsTaken(); }

private:
  struct alignas(CacheLineSize) Slot
  {
    unsigned Successes = 0; ///< since the last rollback or wake-up; touched by its thread only

    /** Guards the members below and the decision of this thread to wait. */
    alignas(CacheLineSize) std::mutex Mutex;
    WaitingList Losers;                      ///< the threads that wait for this thread
    std::atomic<bool> SomeoneWaits{ false }; ///< Losers is not empty
    bool Idle = false;

    unsigned NextInList = WaitingList::Nobody; ///< guarded by the winner's mutex
    ParkingSpot Spot;
  };

  void WakeFirst(Slot& own);

  const unsigned Threshold; ///< successes in a row
  std::vector<Slot> Slots;
  LoopSharing* const Sharing;
  std::atomic<bool> Stopped{ false };
};

} // namespace voxplex

#endif
