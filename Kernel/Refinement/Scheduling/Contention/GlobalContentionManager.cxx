// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Scheduling/Contention/GlobalContentionManager.h"

namespace voxplex
{

bool GlobalContentionManager::Enlist(unsigned thread, unsigned)
{
  const std::scoped_lock lock(this->Mutex);
  if (this->Stopped || this->Active <= 1)
  {
    return false;
  }
  --this->Active;
  this->Slots[thread].Spot.Prepare();
  this->Losers.Append(this->Slots, thread);
  return true;
}

void GlobalContentionManager::WakeOne(unsigned)
{
  // Without the mutex this is only a hint. A thread that is overlooked now is seen ten successes
  // later, or by BecomesIdle().
  if (!this->Losers.IsEmpty())
  {
    const std::scoped_lock lock(this->Mutex);
    this->WakeFirst();
  }
}

void GlobalContentionManager::WakeFirst()
{
  const unsigned first = this->Losers.TakeFirst(this->Slots);
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
