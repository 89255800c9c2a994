// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LocalContentionManager.h
 * @brief Who loses waits for the winner (thesis, section 3.3.4, figure 3.2).
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
 * @brief A thread that loses against another waits in that thread's list, unless the winner waits
 * itself or is idle.
 *
 * A thread wakes one of its list after every SuccessesToWake successes in a row, and all of it when
 * it becomes idle. It does not wake its list when it begins to wait: the thesis' figure 3.4 shows
 * the livelock that follows.
 *
 * Write T -> W if T waits in W's list. T decides under its own mutex and W's; the thesis' busy_wait
 * flag of T is T.Spot.IsTaken(), its conflicting_id is the list that T is in.
 *
 * **No deadlock.** T -> W begins at a moment at which W does not wait: T sees that under W's mutex,
 * and W needs that mutex to begin to wait. So in T -> W -> X the wait of W began after that of T.
 * These times grow along every chain, hence no chain closes: each ends at a thread R that does not
 * wait. R is not idle either: it emptied its list under its mutex as it became idle, and nobody has
 * entered it since. So R runs, and it wakes somebody when it has succeeded often enough or runs out
 * of work. It does not matter why T waits for W: if W released the vertex long ago T waits for a
 * running thread all the same. And a thread that waits for work is waited for by nobody, so threads
 * with work never all wait, here and in the load balancer together.
 *
 * **No livelock.** Consider a time in which no thread succeeds, becomes idle or becomes busy.
 * Nobody is woken in it, so fewer than n of n threads begin to wait. A thread goes on after a
 * rollback only if its winner waits or is idle, that is, holds nothing. So once the last of those
 * that will wait does, each other thread can lose at most once more: in the attempt that it had
 * begun before. All in all there are fewer than 2 n rollbacks, and then somebody succeeds or runs
 * out of work. The latter happens at most n times, as gifts follow successes. Hence some thread
 * succeeds again and again.
 *
 * **Help.** None of this changes if those who wait help at a sharing: see LoopSharing.
 *
 * One thread may starve in theory, as in the thesis: while its winner never succeeds ten times in a
 * row. It goes on when the winner runs out of work.
 */
class LocalContentionManager final : public ContentionManager
{
public:
  static constexpr unsigned SuccessesToWake = 10; ///< s+ of the thesis, the default

  /**
   * @param sharing where those who wait help, or null
   * @param successesToWake after how many successes in a row a thread wakes another
   */
  explicit LocalContentionManager(
    unsigned threads, LoopSharing* sharing = nullptr, unsigned successesToWake = SuccessesToWake);

  bool RollbackOccurred(unsigned thread, unsigned winner) override;

  /** Inline and, nine times of ten, a counter of the thread's own. */
  void RollbackNotOccurred(unsigned thread) override
  {
    Slot& own = this->Slots[thread];
    if (++own.Successes >= this->Threshold)
    {
      own.Successes = 0;
      // Relaxed: only a hint; who is overlooked now is seen ten successes later, or by
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

  /** True if the thread waits now; for tests, and for those who watch a run. */
  bool IsWaiting(unsigned thread) const { return this->Slots[thread].Spot.IsTaken(); }

private:
  struct alignas(CacheLineSize) Slot
  {
    unsigned Successes = 0; ///< since the last rollback or wake-up; touched by its thread only

    /** Guards what follows and the decision of this thread to wait. */
    alignas(CacheLineSize) std::mutex Mutex;
    WaitingList Losers;                      ///< who waits for this thread
    std::atomic<bool> SomeoneWaits{ false }; ///< Losers is not empty
    bool Idle = false;

    unsigned NextInList = WaitingList::Nobody; ///< guarded by the mutex of whom it waits for
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
