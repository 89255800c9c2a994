// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BlockingContentionManager.h
 * @brief The base of the managers that guarantee progress.
 */
#ifndef voxplex_BlockingContentionManager_h
#define voxplex_BlockingContentionManager_h

#include "Parallel/CacheLine.h"
#include "Parallel/LoopSharing.h"
#include "Parallel/ParkingSpot.h"
#include "Parallel/WaitingList.h"
#include "Refinement/Scheduling/ContentionManager.h"

#include <cassert>
#include <vector>

namespace voxplex
{

/**
 * @brief After a rollback a thread waits in a list, if the manager allows it. After every
 * SuccessesToWake successes in a row a thread wakes one waiting thread.
 *
 * The derived classes give the proofs of progress. These stay valid if waiting threads help at a
 * shared loop: see LoopSharing.
 */
class BlockingContentionManager : public ContentionManager
{
public:
  static constexpr unsigned SuccessesToWake = 10; ///< s+ of the thesis, the default

  bool RollbackOccurred(unsigned thread, unsigned winner) final
  {
    assert(thread != winner && winner < this->Slots.size());
    Slot& own = this->Slots[thread];
    own.Successes = 0;
    if (!this->Enlist(thread, winner))
    {
      return false;
    }
    WaitAndHelp(own.Spot, this->Sharing, thread);
    return true;
  }

  /** Inline; nine times out of ten it only increments a counter of the thread's own. */
  void RollbackNotOccurred(unsigned thread) final
  {
    Slot& own = this->Slots[thread];
    if (++own.Successes >= this->Threshold)
    {
      own.Successes = 0;
      this->WakeOne(thread);
    }
  }

  /** True if the thread waits now; for tests and for observers of a run. */
  bool IsWaiting(unsigned thread) const { return this->Slots[thread].Spot.IsTaken(); }

protected:
  struct alignas(CacheLineSize) Slot
  {
    unsigned Successes = 0; ///< since the last rollback or wake-up; touched by its thread only
    alignas(CacheLineSize) ParkingSpot Spot;
    unsigned NextInList = WaitingList::Nobody;
  };

  /**
   * @param sharing the loops at which waiting threads help, or null
   * @param successesToWake number of successes in a row after which a thread wakes another
   */
  BlockingContentionManager(unsigned threads, LoopSharing* sharing, unsigned successesToWake)
    : Slots(threads)
    , Threshold(successesToWake)
    , Sharing(sharing)
  {
  }

  /**
   * Prepares the thread's spot and puts the thread into a list.
   * @return false if the thread must not wait
   */
  virtual bool Enlist(unsigned thread, unsigned winner) = 0;

  /** Wakes the first thread of the list that `thread` serves. */
  virtual void WakeOne(unsigned thread) = 0;

  std::vector<Slot> Slots;

private:
  const unsigned Threshold; ///< successes in a row
  LoopSharing* const Sharing;
};

} // namespace voxplex

#endif
