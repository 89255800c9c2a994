// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ContentionManager.h
 * @brief What a thread does after a rollback (thesis, section 3.3).
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
 * @brief Told by every thread of its rollbacks and successes; may make it wait after a rollback.
 *
 * Threads are numbered from 0. All methods are called by the thread they name, but for Stop() and
 * SwitchedToLocal(), which anyone may call at any time. A thread holds no vertex when it tells of a
 * rollback or becomes idle, since it may then have to wait.
 *
 * The policies rely on three things. Every thread that was announced runs: at first all count as
 * busy. A thread leaves for good only when it is idle or after Stop(); one that gives up for an
 * exception calls Stop(). And an idle thread gets work only from one that got on since it last gave
 * some away: that did an operation, or found an element that needs none. Then the global and the
 * local policy (and the others, which end in the local one) neither deadlock nor livelock; the
 * classes say why.
 */
class ContentionManager
{
public:
  virtual ~ContentionManager() = default;

  /**
   * An operation of `thread` was given up because `winner` held a vertex. May wait. The winner may
   * have released it long ago, and may wait or be idle itself by now.
   * @param winner another thread, not `thread`
   * @return true if the thread waited
   */
  virtual bool RollbackOccurred(unsigned thread, unsigned winner) = 0;

  /** An operation of the thread succeeded. A few instructions on memory of the thread's own. */
  virtual void RollbackNotOccurred(unsigned thread) = 0;

  /** The thread has no work left and is about to wait for some: nobody may go on waiting for it. */
  virtual void BecomesIdle(unsigned thread) = 0;

  /** The thread got work after BecomesIdle(). */
  virtual void BecomesBusy(unsigned thread) = 0;

  /** Wakes all; from now on nobody waits. */
  virtual void Stop() = 0;

  /** True if the policy asked for made no progress and the local one took over. */
  virtual bool SwitchedToLocal() const { return false; }
};

/**
 * @param threads how many threads there are, at least 1
 * @param sharing where threads help while they wait in lists, or null; must outlive the manager
 * @param successesToWake global and local: after how many successes in a row a thread wakes another
 *   (s+ of the thesis)
 */
std::unique_ptr<ContentionManager> MakeContentionManager(ContentionPolicy policy, unsigned threads,
  LoopSharing* sharing = nullptr, unsigned successesToWake = 10);

} // namespace voxplex

#endif
