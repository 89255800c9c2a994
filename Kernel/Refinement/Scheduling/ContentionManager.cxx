// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Scheduling/ContentionManager.h"

#include "Refinement/Scheduling/Contention/AggressiveContentionManager.h"
#include "Refinement/Scheduling/Contention/GlobalContentionManager.h"
#include "Refinement/Scheduling/Contention/LocalContentionManager.h"
#include "Refinement/Scheduling/Contention/RandomContentionManager.h"

namespace voxplex
{

std::unique_ptr<ContentionManager> MakeContentionManager(
  ContentionPolicy policy, unsigned threads, LoopSharing* sharing, unsigned successesToWake)
{
  switch (policy)
  {
    case ContentionPolicy::Aggressive:
      return std::make_unique<AggressiveContentionManager>(threads, sharing);
    case ContentionPolicy::Random:
      return std::make_unique<RandomContentionManager>(threads, sharing);
    case ContentionPolicy::Global:
      return std::make_unique<GlobalContentionManager>(threads, sharing, successesToWake);
    case ContentionPolicy::Local:
      break;
  }
  return std::make_unique<LocalContentionManager>(threads, sharing, successesToWake);
}

} // namespace voxplex
