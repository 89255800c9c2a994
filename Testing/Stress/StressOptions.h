// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StressOptions.h
 * @brief The command line of voxplexStress.
 */
#ifndef voxplex_stress_StressOptions_h
#define voxplex_stress_StressOptions_h

#include "CaseRun.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace voxplex::stress
{

struct StressOptions
{
  std::vector<Family> Families{ Family::Space };
  std::uint64_t Seed = 1;
  std::uint64_t First = 0;
  std::uint64_t Cases = 1000; ///< cases of each family; 0: no end
  double Seconds = 0.0;       ///< time for all families together; 0: no limit
  unsigned Jobs = 1;
  std::optional<std::uint64_t> Case; ///< run only this case
  bool InProcess = false;            ///< run the case in this process, for a debugger
  bool IsReduced = false;            ///< with Case: reduce it to a smaller case
  double ReductionSeconds = 300.0;
  std::string Image; ///< with Case: a file that receives the image
  bool Help = false;
  RunLimits Limits;
};

extern const char* const StressHelp;

/** @throws std::invalid_argument */
StressOptions ReadStressOptions(int argc, char** argv);

} // namespace voxplex::stress

#endif
