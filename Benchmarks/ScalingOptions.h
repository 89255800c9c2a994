// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ScalingOptions.h
 * @brief The command line of voxplexScaling.
 */
#ifndef voxplex_ScalingOptions_h
#define voxplex_ScalingOptions_h

#include "Parallel/Policies.h"

#include <string>
#include <vector>

namespace voxplex::benchmarks
{

extern const char* const ScalingUsage;

struct ScalingOptions
{
  std::string Image;
  std::string Json;
  double Delta = 0.0;    ///< 0: tuned
  double Elements = 0.0; ///< 0: determined by delta
  int Repeat = 3;
  int Quality = 0;
  unsigned Oversubscribe = 0;
  std::vector<unsigned> Threads; ///< increasing; includes 1
  std::vector<ContentionPolicy> Managers = { ContentionPolicy::Local, ContentionPolicy::Global,
    ContentionPolicy::Random, ContentionPolicy::Aggressive };
  std::vector<BalancePolicy> Balancers = { BalancePolicy::Hierarchical, BalancePolicy::Random };
  bool Strong = false;
  bool Weak = false;
  bool Synchronise = false;
  bool Ceiling = false;
  bool Pin = false;
  bool NoSeeds = false;
};

/** @throws std::exception with a message if the arguments are wrong */
ScalingOptions ParseScalingOptions(int argc, char** argv);

} // namespace voxplex::benchmarks

#endif
