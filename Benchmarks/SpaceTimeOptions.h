// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeOptions.h
 * @brief The command line of voxplexSpaceTime.
 */
#ifndef voxplex_SpaceTimeOptions_h
#define voxplex_SpaceTimeOptions_h

#include "Refinement/Rules/RuleOptions.h"
#include "Sizing/Grading/GradingOptions.h"

#include <cstdint>
#include <string>
#include <vector>

namespace voxplex::benchmarks
{

extern const char* const SpaceTimeUsage;

struct SpaceTimeOptions
{
  std::string Phantom = "beating-ventricle";
  std::int64_t Coarsening = 1; ///< coarsening of the ventricle
  double TimeScale = 1.0;
  double Delta = 0.0; ///< 0: derived from the spacing
  GradingOptions Grading;
  std::vector<unsigned> Threads; ///< increasing; includes 1
  int Repeat = 3;
  std::vector<bool> Picking = { false };
  std::vector<RuleOrder> Orders = { RuleOrder::RadiusEdgeFirst };
  bool NoFineGrained = false;
  unsigned FrameSteps = 0; ///< 0: as many as the motion asks for
  bool NoFit = false;
  bool NoOptimise = false;
  bool Periodic = false; ///< the phantom runs back, and the mesh is periodic
  bool Frames = false;
  bool Row = false; ///< print one row of a table, with the worst errors of the first series
};

/** @throws std::exception with a message if the arguments are wrong */
SpaceTimeOptions ParseSpaceTimeOptions(int argc, char** argv);

} // namespace voxplex::benchmarks

#endif
