// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The options of a case, once: what the program calls them, and how they become simpler.
#ifndef voxplex_stress_CaseOptions_h
#define voxplex_stress_CaseOptions_h

#include "StressCase.h"

namespace voxplex::stress
{

/**
 * Calls visit(name, member, without...) for the options that matter in this case. The name is the program's flag,
 * or not one if the program has none; that of a boolean is given where it is true, and where it is false if it
 * begins with --no. The member's value in a new case is the usual one; `without` leaves a stage out.
 */
template <int D, typename Visit>
void VisitOptions(const StressCase<D>& of, Visit&& visit)
{
#define VOXPLEX_OPTION(path)                                                                       \
  [](auto& c) -> auto&                                                                             \
  {                                                                                                \
    return c.Options.path;                                                                         \
  }
  visit("--radius-edge", VOXPLEX_OPTION(Shape.RadiusEdgeRatio));
  visit("--force", VOXPLEX_OPTION(Limits.Force));
  visit("--gradation", VOXPLEX_OPTION(Sampling.Gradation));
  visit("--contention", VOXPLEX_OPTION(Team.Contention));
  visit("--balance", VOXPLEX_OPTION(Team.Balance));
  visit("--reproducible", VOXPLEX_OPTION(Team.Reproducible));
  visit("--pin", VOXPLEX_OPTION(Team.Pin));
  visit("Synchronise", VOXPLEX_OPTION(Team.Synchronise));
  visit("SeedsPerThread", VOXPLEX_OPTION(Team.SeedsPerThread));
  visit("--smallest-component", VOXPLEX_OPTION(Components.Smallest), 0);
  visit("--exact-components", VOXPLEX_OPTION(Components.Exact));
  visit("--interface-rounds", VOXPLEX_OPTION(Interfaces.Rounds), 0);
  visit("--no-manifold", VOXPLEX_OPTION(Interfaces.Manifold));
  visit("--no-fit", VOXPLEX_OPTION(Interfaces.Fit), false);
  visit("--no-optimise", VOXPLEX_OPTION(Optimisation.Run), false);
  visit("--grading", VOXPLEX_OPTION(Sampling.Grading.Mode));
  if (of.Options.Sampling.Grading.Mode == GradingMode::LocalFeatureSize)
  {
    visit("--feature-ratio", VOXPLEX_OPTION(Sampling.Grading.Ratio));
    visit("--largest-feature", VOXPLEX_OPTION(Sampling.Grading.Lambda));
  }
  if constexpr (D == 3)
  {
    visit("--facet-angle", VOXPLEX_OPTION(Shape.FacetAngle));
    visit("--sliver-angle", VOXPLEX_OPTION(Shape.Slivers.Angle), 0.0);
    visit("Shape.Slivers.PickingRadius", VOXPLEX_OPTION(Shape.Slivers.PickingRadius));
    visit("Shape.Slivers.Picks", VOXPLEX_OPTION(Shape.Slivers.Picks));
    visit("Shape.Slivers.Seed", VOXPLEX_OPTION(Shape.Slivers.Seed));
    visit("--no-junctions", VOXPLEX_OPTION(Interfaces.SampleJunctions), false);
    visit("--optimise-seconds", VOXPLEX_OPTION(Optimisation.Seconds));
    visit("--elements", VOXPLEX_OPTION(Sampling.Elements));
  }
  else
  {
    visit("--periodic", VOXPLEX_OPTION(Planes.Periodic));
    visit("--frame-steps", VOXPLEX_OPTION(FrameSteps), 1);
    visit("--rule-order", VOXPLEX_OPTION(SpaceTime.Order));
    visit("--no-fine-grained", VOXPLEX_OPTION(Team.FineGrained));
    visit("--no-picking", VOXPLEX_OPTION(SpaceTime.Slivers.Fight), false);
    if (of.Options.SpaceTime.Slivers.Fight)
    {
      visit("--picks", VOXPLEX_OPTION(SpaceTime.Slivers.Picks));
      visit("--sliver-bound", VOXPLEX_OPTION(SpaceTime.Slivers.VolumeBound));
      visit("--seed", VOXPLEX_OPTION(SpaceTime.Slivers.Seed));
      visit("Slivers.PickingRadius", VOXPLEX_OPTION(SpaceTime.Slivers.PickingRadius));
      visit("Slivers.RadiusFactor", VOXPLEX_OPTION(SpaceTime.Slivers.RadiusFactor));
    }
  }
#undef VOXPLEX_OPTION
}

} // namespace voxplex::stress

#endif
