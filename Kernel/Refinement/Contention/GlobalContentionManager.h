// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GlobalContentionManager.h
 * @brief After a rollback a thread waits in one list for all threads (thesis, section 3.3.3).
 */
#ifndef voxplex_GlobalContentionManager_h
#define voxplex_GlobalContentionManager_h

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
 * @brief After a rollback a thread waits in one list, unless it is the only active thread. After
 * every SuccessesToWake successes in a row a thread wakes the first of the list.
 *
 * A thread is active if it neither waits here nor is idle. The thread that wakes another counts it
 * as active at once, so the count never misses a running thread.
 *
 * **No deadlock.** While any thread waits, at least one thread is active. All decisions are made
 * under one mutex. A thread waits only if another is active, and the only active thread wakes
 * another before it becomes idle. An active thread runs until it has succeeded often enough to wake
 * another, or is idle.
 *
 * **No livelock.** Consider a period in which no thread succeeds, becomes idle or becomes busy. No
 * thread is woken in it, and each rollback makes one more thread wait, until one is active. That
 * thread may lose once more, in the attempt that it had begun before. In the next attempt it meets
 * no other thread, because waiting and idle threads hold no vertex. So there are at most n
 * rollbacks, and then a thread succeeds or runs out of work. The latter happens at most n times,
 * because gifts follow successes.
 *
 * **Help.** The proofs stay valid if waiting threads help at a shared loop: see LoopSharing.
 */
class GlobalContentionManager final : public ContentionManager
{
public:
  static constexpr unsigned SuccessesToWake = 10; ///< s+ of the thesis, the default

  /**
   * @param sharing the loops at which waiting threads help, or null
   * @param successesToWake number of successes in a row after which a thread wakes another
   */
  explicit GlobalContentionManager(
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
      if (this->SomeoneWaits.load(std::memory_order_relaxed))
      {
        const std::scoped_lock lock(this->Mutex);
        this->WakeFirst();
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
    alignas(CacheLineSize) ParkingSpot Spot;
    unsigned NextInList = WaitingList::Nobody;
  };

  /** Call this under the mutex. */
  void WakeFirst();

  const unsigned Threshold; ///< successes in a row
  std::vector<Slot> Slots;
  LoopSharing* const Sharing;
  alignas(CacheLineSize) std::atomic<bool> SomeoneWaits{ false }; ///< Losers is not empty
  alignas(CacheLineSize) std::mutex Mutex;                        ///< guards the members below
  WaitingList Losers;
  unsigned Active;
  bool Stopped = false;
};

} // namespace voxplex

#endif
