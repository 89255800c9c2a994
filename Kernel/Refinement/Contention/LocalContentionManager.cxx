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
    // Always the lower number first: two threads that lose to each other do not lock crosswise.
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
    // Without the mutex of `first`: who reads too late that it waits only does not wait for it.
    this->Slots[first].Spot.Wake();
  }
}

void LocalContentionManager::BecomesIdle(unsigned thread)
{
  Slot& own = this->Slots[thread];
  WaitingList losers;
  {
    const std::scoped_lock lock(own.Mutex);
    own.Idle = true; // from now on nobody enters the list
    std::swap(losers, own.Losers);
    own.SomeoneWaits.store(false, std::memory_order_relaxed);
  }
  // Who is taken out has not been woken yet and so enters no other list before that.
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
  // A thread that decides to wait holds its mutex. Either it does so before we lock that: then it
  // is woken here; or after: then it sees that we have stopped. The lists are left as they are.
  this->Stopped.store(true, std::memory_order_relaxed);
  for (Slot& slot : this->Slots)
  {
    const std::scoped_lock lock(slot.Mutex);
    slot.Spot.Wake();
  }
}

} // namespace voxplex
