// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AggressiveContentionManager.h
 * @brief Who loses tries again at once (thesis, section 3.3.1).
 */
#ifndef voxplex_AggressiveContentionManager_h
#define voxplex_AggressiveContentionManager_h

#include "Refinement/Contention/NonBlockingContentionManager.h"

namespace voxplex
{

/** @brief Nobody waits, until the local manager takes over. */
class AggressiveContentionManager final : public NonBlockingContentionManager
{
public:
  /** Of one thread in a row: more than it does while whoever it loses to waits for a processor. */
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
