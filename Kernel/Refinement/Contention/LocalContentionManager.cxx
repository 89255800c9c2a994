// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Contention/LocalContentionManager.h"

#include <algorithm>
#include <cassert>

namespace voxplex
{

LocalContentionManager::LocalContentionManager(
  unsigned threads, LoopSharing* sharing, unsigned successesToWake)
  : Threshold(successesToWake)
  , Slots(threads)
  , Sharing(sharing)
{
}

bool LocalContentionManager::RollbackOccurred(unsigned thread, unsigned winner)
{
  assert(thread != winner && winner < this->Slots.size());
  Slot& own = this->Slots[thread];
  Slot& other = this->Slots[winner];
  own.Successes = 0;
  {
    // The lower number always comes first, so that two threads that lose to each other do not
    // deadlock.
    const std::scoped_lock lower(this->Slots[std::min(thread, winner)].Mutex);
    const std::scoped_lock higher(this->Slots[std::max(thread, winner)].Mutex);
    // Relaxed: see Stop().
    if (this->Stopped.load(std::memory_order_relaxed) || other.Idle || other.Spot.IsTaken())
    {
      return false;
    }
    own.Spot.Prepare();
    other.Losers.Append(this->Slots, thread);
    other.SomeoneWaits.store(true, std::memory_order_relaxed);
  }
  WaitAndHelp(own.Spot, this->Sharing, thread);
  return true;
}

void LocalContentionManager::WakeFirst(Slot& own)
{
  unsigned first = WaitingList::Nobody;
  {
    const std::scoped_lock lock(own.Mutex);
    first = own.Losers.TakeFirst(this->Slots);
    own.SomeoneWaits.store(!own.Losers.IsEmpty(), std::memory_order_relaxed);
  }
  if (first != WaitingList::Nobody)
  {
    // Without the mutex of `first`: a thread that still sees it waiting does not wait for it, which
    // is harmless.
    this->Slots[first].Spot.Wake();
  }
}

void LocalContentionManager::BecomesIdle(unsigned thread)
{
  Slot& own = this->Slots[thread];
  WaitingList losers;
  {
    const std::scoped_lock lock(own.Mutex);
    own.Idle = true; // from now on no thread enters the list
    std::swap(losers, own.Losers);
    own.SomeoneWaits.store(false, std::memory_order_relaxed);
  }
  // A thread that is taken out has not been woken yet, so it cannot enter another list before.
  for (unsigned loser = losers.TakeFirst(this->Slots); loser != WaitingList::Nobody;
       loser = losers.TakeFirst(this->Slots))
  {
    this->Slots[loser].Spot.Wake();
  }
}

void LocalContentionManager::BecomesBusy(unsigned thread)
{
  Slot& own = this->Slots[thread];
  const std::scoped_lock lock(own.Mutex);
  own.Idle = false;
}

void LocalContentionManager::Stop()
{
  // A thread that decides to wait holds its mutex. If it decides before the mutex is locked here,
  // it is woken here. If it decides later, it sees that the manager has stopped. The lists are left
  // unchanged.
  this->Stopped.store(true, std::memory_order_relaxed);
  for (Slot& slot : this->Slots)
  {
    const std::scoped_lock lock(slot.Mutex);
    slot.Spot.Wake();
  }
}

} // namespace voxplex
