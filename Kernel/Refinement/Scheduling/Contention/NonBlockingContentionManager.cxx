// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Scheduling/Contention/NonBlockingContentionManager.h"

#include <cassert>

namespace voxplex
{

NonBlockingContentionManager::NonBlockingContentionManager(
  unsigned threads, unsigned rollbackLimit, LoopSharing* sharing)
  : RollbackLimit(rollbackLimit)
  , Slots(threads)
  , Local(threads, sharing)
{
}

bool NonBlockingContentionManager::RollbackOccurred(unsigned thread, unsigned winner)
{
  assert(thread != winner && winner < this->Slots.size());
  if (!this->Switched.load(std::memory_order_relaxed))
  {
    const unsigned rollbacks = ++this->Slots[thread].Rollbacks;
    if (rollbacks <= this->RollbackLimit)
    {
      return this->Pause(thread, rollbacks);
    }
    this->Switched.store(true, std::memory_order_relaxed);
  }
  return this->Local.RollbackOccurred(thread, winner);
}

} // namespace voxplex
