// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GlobalContentionManager.h
 * @brief After a rollback a thread waits in one list for all threads (thesis, section 3.3.3).
 */
#ifndef voxplex_GlobalContentionManager_h
#define voxplex_GlobalContentionManager_h

#include "Parallel/CacheLine.h"
#include "Parallel/WaitingList.h"
#include "Refinement/Scheduling/Contention/BlockingContentionManager.h"

#include <mutex>

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
 */
class GlobalContentionManager final : public BlockingContentionManager
{
public:
  explicit GlobalContentionManager(
    unsigned threads, LoopSharing* sharing = nullptr, unsigned successesToWake = SuccessesToWake)
    : BlockingContentionManager(threads, sharing, successesToWake)
    , Active(threads)
  {
  }

  void BecomesIdle(unsigned thread) override;
  void BecomesBusy(unsigned thread) override;
  void Stop() override;

private:
  bool Enlist(unsigned thread, unsigned winner) override;
  void WakeOne(unsigned thread) override;

  /** Call this under the mutex. */
  void WakeFirst();

  alignas(CacheLineSize) WaitingList Losers; ///< guarded by the mutex, like the members below it
  alignas(CacheLineSize) std::mutex Mutex;
  unsigned Active;
  bool Stopped = false;
};

} // namespace voxplex

#endif
