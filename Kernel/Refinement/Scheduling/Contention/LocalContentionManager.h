// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LocalContentionManager.h
 * @brief After a rollback a thread waits for the winner (thesis, section 3.3.4, figure 3.2).
 */
#ifndef voxplex_LocalContentionManager_h
#define voxplex_LocalContentionManager_h

#include "Parallel/CacheLine.h"
#include "Parallel/WaitingList.h"
#include "Refinement/Scheduling/Contention/BlockingContentionManager.h"

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
 * is not idle either. A thread that becomes idle first closes its list, under its mutex, and then
 * empties it. So R runs, and it wakes a thread when it has succeeded often enough or runs out of
 * work. The reason why T waits for W does not matter. If W released the vertex long ago, T still
 * waits for a running thread. No thread waits for a thread that waits for work. So threads with
 * work never all wait, here and in the load balancer together.
 *
 * **No livelock.** Consider a period in which no thread succeeds, becomes idle or becomes busy. No
 * thread is woken in it, so fewer than n of n threads begin to wait. A thread goes on after a
 * rollback only if its winner waits or is idle, that is, holds no vertex. Consider the moment when
 * the last of the threads that will wait does so. After it each other thread can lose at most once
 * more, in the attempt that it had begun before. So there are fewer than 2 n rollbacks in all, and
 * then a thread succeeds or runs out of work. The latter happens at most n times, because gifts
 * follow successes. Hence threads succeed again and again.
 *
 * In theory one thread may starve, as in the thesis: while its winner never succeeds ten times in a
 * row. It goes on when the winner runs out of work.
 */
class LocalContentionManager final : public BlockingContentionManager
{
public:
  explicit LocalContentionManager(
    unsigned threads, LoopSharing* sharing = nullptr, unsigned successesToWake = SuccessesToWake)
    : BlockingContentionManager(threads, sharing, successesToWake)
    , Lists(threads)
  {
  }

  void BecomesIdle(unsigned thread) override;
  void BecomesBusy(unsigned thread) override;
  void Stop() override;

private:
  /** One for each thread. */
  struct alignas(CacheLineSize) List
  {
    std::mutex Mutex;   ///< guards the members below and the decision of the thread to wait
    WaitingList Losers; ///< the threads that wait for the thread
    bool Idle = false;
  };

  bool Enlist(unsigned thread, unsigned winner) override;
  void WakeOne(unsigned thread) override;

  std::vector<List> Lists;
  std::atomic<bool> Stopped{ false };
};

} // namespace voxplex

#endif
