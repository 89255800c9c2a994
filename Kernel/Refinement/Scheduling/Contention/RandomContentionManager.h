// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RandomContentionManager.h
 * @brief A thread with several rollbacks in a row sleeps for a random time (thesis, section 3.3.2).
 */
#ifndef voxplex_RandomContentionManager_h
#define voxplex_RandomContentionManager_h

#include "Parallel/CacheLine.h"
#include "Refinement/Scheduling/Contention/NonBlockingContentionManager.h"

#include <condition_variable>
#include <mutex>
#include <random>
#include <vector>

namespace voxplex
{

/**
 * @brief After more than RollbacksBeforeSleep rollbacks in a row, a thread sleeps after each
 * further rollback, for 1 to RollbacksBeforeSleep milliseconds, until the local manager takes over.
 *
 * A sleeping thread does not help others. The seeds depend on the threads' numbers only.
 */
class RandomContentionManager final : public NonBlockingContentionManager
{
public:
  static constexpr unsigned RollbacksBeforeSleep = 5; ///< r+ of the thesis
  static constexpr unsigned SleepsToSwitch = 200;     ///< of one thread in a row, about 0.6 s

  explicit RandomContentionManager(unsigned threads, LoopSharing* sharing = nullptr);

  void Stop() override;

private:
  struct alignas(CacheLineSize) Slot
  {
    std::minstd_rand Generator; ///< touched by its thread only
  };

  bool Pause(unsigned thread, unsigned rollbacks) override;

  std::vector<Slot> Slots;
  std::mutex Mutex;
  std::condition_variable Stopping;
  bool Stopped = false;
};

} // namespace voxplex

#endif
