// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Scheduling/Contention/RandomContentionManager.h"

#include <chrono>

namespace voxplex
{

RandomContentionManager::RandomContentionManager(unsigned threads, LoopSharing* sharing)
  : NonBlockingContentionManager(threads, RollbacksBeforeSleep + SleepsToSwitch, sharing)
  , Slots(threads)
{
  for (unsigned t = 0; t < threads; ++t)
  {
    // The factor spreads the seeds: small seeds that differ by one give almost equal first numbers.
    this->Slots[t].Generator.seed((t + 1) * 2654435769u);
  }
}

bool RandomContentionManager::Pause(unsigned thread, unsigned rollbacks)
{
  if (rollbacks <= RollbacksBeforeSleep)
  {
    return false;
  }
  std::uniform_int_distribution<unsigned> milliseconds(1, RollbacksBeforeSleep);
  const std::chrono::milliseconds duration(milliseconds(this->Slots[thread].Generator));
  std::unique_lock lock(this->Mutex);
  if (this->Stopped)
  {
    return false;
  }
  this->Stopping.wait_for(lock, duration, [this]() { return this->Stopped; });
  return true;
}

void RandomContentionManager::Stop()
{
  {
    const std::scoped_lock lock(this->Mutex);
    this->Stopped = true;
  }
  this->Stopping.notify_all();
  this->NonBlockingContentionManager::Stop();
}

} // namespace voxplex
