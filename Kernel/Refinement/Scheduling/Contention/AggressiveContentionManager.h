// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AggressiveContentionManager.h
 * @brief After a rollback a thread tries again at once (thesis, section 3.3.1).
 */
#ifndef voxplex_AggressiveContentionManager_h
#define voxplex_AggressiveContentionManager_h

#include "Refinement/Scheduling/Contention/NonBlockingContentionManager.h"

namespace voxplex
{

/** @brief No thread waits, until the local manager takes over. */
class AggressiveContentionManager final : public NonBlockingContentionManager
{
public:
  /**
   * Rollbacks of one thread in a row. A thread has fewer while the winner waits for a processor.
   */
  static constexpr unsigned RollbacksToSwitch = 200000;

  explicit AggressiveContentionManager(unsigned threads, LoopSharing* sharing = nullptr)
    : NonBlockingContentionManager(threads, RollbacksToSwitch, sharing)
  {
  }

private:
  bool Pause(unsigned, unsigned) override { return false; }
};

} // namespace voxplex

#endif
