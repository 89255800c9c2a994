// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GlobalContentionManager.h
 * @brief Who loses waits in one list for all (thesis, section 3.3.3).
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
 * @brief A thread that loses waits in one list unless it is the only one that is active; a thread
 * wakes the first of the list after every SuccessesToWake successes in a row.
 *
 * A thread is active if it neither waits here nor is idle. Whoever wakes a thread counts it as
 * active on its behalf, so that none that runs is ever missing.
 *
 * **No deadlock.** While anybody waits, at least one thread is active: all is decided under one
 * mutex, a thread waits only if another is active, and the only active one wakes another before it
 * becomes idle. An active thread runs, until it has succeeded often enough to wake somebody or is
 * idle.
 *
 * **No livelock.** Consider a time in which no thread succeeds, becomes idle or becomes busy.
 * Nobody is woken in it, and each rollback makes one more thread wait, until one is active. That
 * one may lose once more, in the attempt that it had begun before; in the next it meets nobody, for
 * who waits or is idle holds no vertex. So there are at most n rollbacks, and then somebody
 * succeeds or runs out of work. The latter happens at most n times, as gifts follow successes.
 *
 * **Help.** None of this changes if those who wait help at a sharing: see LoopSharing.
 */
class GlobalContentionManager final : public ContentionManager
{
public:
  static constexpr unsigned SuccessesToWake = 10; ///< s+ of the thesis, the default

  /**
   * @param sharing where those who wait help, or null
   * @param successesToWake after how many successes in a row a thread wakes another
   */
  explicit GlobalContentionManager(
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

  /** True if the thread waits now; for tests, and for those who watch a run. */
  bool IsWaiting(unsigned thread) const { return this->Slots[thread].Spot.IsTaken(); }

private:
  struct alignas(CacheLineSize) Slot
  {
    unsigned Successes = 0; ///< since the last rollback or wake-up; touched by its thread only
    alignas(CacheLineSize) ParkingSpot Spot;
    unsigned NextInList = WaitingList::Nobody;
  };

  /** Under the mutex. */
  void WakeFirst();

  const unsigned Threshold; ///< successes in a row
  std::vector<Slot> Slots;
  LoopSharing* const Sharing;
  alignas(CacheLineSize) std::atomic<bool> SomeoneWaits{ false }; ///< Losers is not empty
  alignas(CacheLineSize) std::mutex Mutex;                        ///< guards what follows
  WaitingList Losers;
  unsigned Active;
  bool Stopped = false;
};

} // namespace voxplex

#endif
