// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NonBlockingContentionManager.h
 * @brief What the managers that promise no progress have in common.
 */
#ifndef voxplex_NonBlockingContentionManager_h
#define voxplex_NonBlockingContentionManager_h

#include "Parallel/CacheLine.h"
#include "Refinement/Contention/LocalContentionManager.h"

#include <atomic>
#include <vector>

namespace voxplex
{

/**
 * @brief Counts rollbacks in a row; when one thread has too many, all threads go over to the local
 * manager for good.
 *
 * The aggressive and the random manager do livelock (thesis, table 3.1); this bounds how long.
 * Threads notice the change at their next call. That they do not notice at once is harmless: the
 * local manager knows from the start who is idle, and one that has not noticed yet is one that does
 * not wait; it wakes those that wait for it once it has.
 */
class NonBlockingContentionManager : public ContentionManager
{
public:
  bool RollbackOccurred(unsigned thread, unsigned winner) override;
  void RollbackNotOccurred(unsigned thread) override
  {
    // Relaxed, here and below: any moment is good enough to go over.
    if (this->Switched.load(std::memory_order_relaxed))
    {
      this->Local.RollbackNotOccurred(thread);
      return;
    }
    this->Slots[thread].Rollbacks = 0;
  }
  void BecomesIdle(unsigned thread) override { this->Local.BecomesIdle(thread); }
  void BecomesBusy(unsigned thread) override { this->Local.BecomesBusy(thread); }
  void Stop() override { this->Local.Stop(); }
  bool SwitchedToLocal() const override { return this->Switched.load(std::memory_order_relaxed); }

protected:
  /**
   * @param rollbackLimit more rollbacks in a row of one thread than this end the attempt
   * @param sharing where those who wait in the local manager help, or null
   */
  NonBlockingContentionManager(unsigned threads, unsigned rollbackLimit, LoopSharing* sharing);

  /**
   * What the thread does after its n-th rollback in a row.
   * @return true if it waited
   */
  virtual bool Pause(unsigned thread, unsigned rollbacks) = 0;

private:
  struct alignas(CacheLineSize) Slot
  {
    unsigned Rollbacks = 0; ///< in a row; touched by its thread only
  };

  const unsigned RollbackLimit;
  std::vector<Slot> Slots;
  LocalContentionManager Local;
  alignas(CacheLineSize) std::atomic<bool> Switched{ false }; ///< written once
};

} // namespace voxplex

#endif
