// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ContentionManager.h
 * @brief Decides whether a thread waits after a rollback (thesis, section 3.3).
 */
#ifndef voxplex_ContentionManager_h
#define voxplex_ContentionManager_h

#include "Parallel/Policies.h"

#include <cstdint>
#include <memory>

namespace voxplex
{

class LoopSharing;

/**
 * @brief Every thread reports its rollbacks and successes; the manager may make it wait after a
 * rollback.
 *
 * Threads are numbered from 0. A thread calls the methods with its own number. Any thread may call
 * Stop() and SwitchedToLocal() at any time. A thread that reports a rollback or becomes idle may
 * have to wait, so it must hold no vertex.
 *
 * The policies rely on three conditions:
 * - Every thread that was announced runs: at first all count as busy.
 * - A thread leaves for good only if it is idle or after Stop(). A thread that ends with an
 *   exception calls Stop().
 * - An idle thread gets work only from a thread that has made progress since it last gave work
 *   away: it did an operation, or found an element that needs none.
 *
 * Under these conditions the global and the local policy neither deadlock nor livelock; their
 * classes give the proofs. The other policies end in the local one.
 */
class ContentionManager
{
public:
  virtual ~ContentionManager() = default;

  /**
   * An operation of `thread` was given up because `winner` held a vertex. May wait. The winner may
   * have released the vertex long ago, and may itself wait or be idle by now.
   * @param winner another thread than `thread`
   * @return true if the thread waited
   */
  virtual bool RollbackOccurred(unsigned thread, unsigned winner) = 0;

  /**
   * An operation of the thread succeeded. Costs a few instructions on memory of the thread's own.
   */
  virtual void RollbackNotOccurred(unsigned thread) = 0;

  /**
   * The thread has no work left and is about to wait for some. No thread may go on waiting for it.
   */
  virtual void BecomesIdle(unsigned thread) = 0;

  /** The thread got work after BecomesIdle(). */
  virtual void BecomesBusy(unsigned thread) = 0;

  /** Wakes all threads; from now on no thread waits. */
  virtual void Stop() = 0;

  /** True if the chosen policy made no progress and the local policy took over. */
  virtual bool SwitchedToLocal() const { return false; }
};

/**
 * @param threads number of threads, at least 1
 * @param sharing the loops at which threads help while they wait in lists, or null; must outlive
 *   the manager
 * @param successesToWake global and local: number of successes in a row after which a thread wakes
 *   another (s+ of the thesis)
 */
std::unique_ptr<ContentionManager> MakeContentionManager(ContentionPolicy policy, unsigned threads,
  LoopSharing* sharing = nullptr, unsigned successesToWake = 10);

} // namespace voxplex

#endif
