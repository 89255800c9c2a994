// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Scheduling/Contention/LocalContentionManager.h"

#include <algorithm>

namespace voxplex
{

bool LocalContentionManager::Enlist(unsigned thread, unsigned winner)
{
  // The lower number always comes first, so that two threads that lose to each other do not
  // deadlock.
  const std::scoped_lock lower(this->Lists[std::min(thread, winner)].Mutex);
  const std::scoped_lock higher(this->Lists[std::max(thread, winner)].Mutex);
  List& other = this->Lists[winner];
  // Relaxed: see Stop().
  if (this->Stopped.load(std::memory_order_relaxed) || other.Idle ||
    this->Slots[winner].Spot.IsTaken())
  {
    return false;
  }
  this->Slots[thread].Spot.Prepare();
  other.Losers.Append(this->Slots, thread);
  return true;
}

void LocalContentionManager::WakeOne(unsigned thread)
{
  List& own = this->Lists[thread];
  // Without the mutex this is only a hint. A thread that is overlooked now is seen ten successes
  // later, or by BecomesIdle().
  if (own.Losers.IsEmpty())
  {
    return;
  }
  unsigned first = WaitingList::Nobody;
  {
    const std::scoped_lock lock(own.Mutex);
    first = own.Losers.TakeFirst(this->Slots);
  }
  // Without the mutex of `first`: a thread that still sees it waiting does not wait for it, which
  // is harmless. Only this thread takes threads out of its list, so there is a first one.
  this->Slots[first].Spot.Wake();
}

void LocalContentionManager::BecomesIdle(unsigned thread)
{
  List& own = this->Lists[thread];
  {
    const std::scoped_lock lock(own.Mutex);
    own.Idle = true; // from now on no thread enters the list
  }
  while (!own.Losers.IsEmpty())
  {
    this->WakeOne(thread);
  }
}

void LocalContentionManager::BecomesBusy(unsigned thread)
{
  List& own = this->Lists[thread];
  const std::scoped_lock lock(own.Mutex);
  own.Idle = false;
}

void LocalContentionManager::Stop()
{
  // A thread that decides to wait holds its mutex. If it decides before the mutex is locked here,
  // it is woken here. If it decides later, it sees that the manager has stopped. The lists are left
  // unchanged.
  this->Stopped.store(true, std::memory_order_relaxed);
  for (std::size_t t = 0; t < this->Slots.size(); ++t)
  {
    const std::scoped_lock lock(this->Lists[t].Mutex);
    this->Slots[t].Spot.Wake();
  }
}

} // namespace voxplex
