// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NonBlockingContentionManager.h
 * @brief The base of the managers that do not guarantee progress.
 */
#ifndef voxplex_NonBlockingContentionManager_h
#define voxplex_NonBlockingContentionManager_h

#include "Parallel/CacheLine.h"
#include "Refinement/Scheduling/Contention/LocalContentionManager.h"

#include <atomic>
#include <vector>

namespace voxplex
{

/**
 * @brief Counts rollbacks in a row. If one thread has too many, all threads change to the local
 * manager for good.
 *
 * The aggressive and the random manager can livelock (thesis, table 3.1); the limit bounds how
 * long. Threads notice the change at their next call. The delay is harmless. The local manager
 * knows from the start which threads are idle. A thread that has not noticed the change does not
 * wait, and once it has, it wakes the threads that wait for it.
 */
class NonBlockingContentionManager : public ContentionManager
{
public:
  bool RollbackOccurred(unsigned thread, unsigned winner) override;
  void RollbackNotOccurred(unsigned thread) override
  {
    // Relaxed, here and below: the change may happen at any moment.
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
   * @param rollbackLimit if a thread has more rollbacks in a row, the local manager takes over
   * @param sharing the loops at which threads help while they wait in the local manager, or null
   */
  NonBlockingContentionManager(unsigned threads, unsigned rollbackLimit, LoopSharing* sharing);

  /**
   * Called after the n-th rollback of a thread in a row.
   * @return true if the thread waited
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
