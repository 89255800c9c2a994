// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Contention/GlobalContentionManager.h"

#include <cassert>

namespace voxplex
{

GlobalContentionManager::GlobalContentionManager(
  unsigned threads, LoopSharing* sharing, unsigned successesToWake)
  : Threshold(successesToWake)
  , Slots(threads)
  , Sharing(sharing)
  , Active(threads)
{
}

bool GlobalContentionManager::RollbackOccurred(unsigned thread, [[maybe_unused]] unsigned winner)
{
  assert(thread != winner && winner < this->Slots.size());
  Slot& own = this->Slots[thread];
  own.Successes = 0;
  {
    const std::scoped_lock lock(this->Mutex);
    if (this->Stopped || this->Active <= 1)
    {
      return false;
    }
    --this->Active;
    own.Spot.Prepare();
    this->Losers.Append(this->Slots, thread);
    this->SomeoneWaits.store(true, std::memory_order_relaxed);
  }
  WaitAndHelp(own.Spot, this->Sharing, thread);
  return true;
}

void GlobalContentionManager::WakeFirst()
{
  const unsigned first = this->Losers.TakeFirst(this->Slots);
  this->SomeoneWaits.store(!this->Losers.IsEmpty(), std::memory_order_relaxed);
  if (first != WaitingList::Nobody)
  {
    ++this->Active;
    this->Slots[first].Spot.Wake();
  }
}

void GlobalContentionManager::BecomesIdle(unsigned)
{
  const std::scoped_lock lock(this->Mutex);
  if (this->Active == 1)
  {
    this->WakeFirst();
  }
  --this->Active;
}

void GlobalContentionManager::BecomesBusy(unsigned)
{
  const std::scoped_lock lock(this->Mutex);
  ++this->Active;
}

void GlobalContentionManager::Stop()
{
  const std::scoped_lock lock(this->Mutex);
  this->Stopped = true;
  while (!this->Losers.IsEmpty())
  {
    this->WakeFirst();
  }
}

} // namespace voxplex
