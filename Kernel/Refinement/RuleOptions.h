// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RuleOptions.h
 * @brief What a user may choose about the rules of space-time meshes.
 */
#ifndef voxplex_RuleOptions_h
#define voxplex_RuleOptions_h

#include <cstdint>

namespace voxplex
{

/** In 4D: which rules come first. */
enum class RuleOrder
{
  RadiusEdgeFirst, ///< section 4.6.1 of the thesis: R3, then R1, R2, R4, R5
  SurfaceFirst     ///< section 4.2: R1 to R5
};

/** The largest TetSliverOptions::Angle for which the mesh of the knee atlas grew by about a quarter. */
inline constexpr double LargestSliverAngle = 15.0;

/** In 3D: how slivers are fought (rule R7). */
struct TetSliverOptions
{
  /**
   * Tetrahedra with a dihedral angle below this, or above 180 less this, are slivers; degrees, 0 leaves
   * them alone, above LargestSliverAngle with Force only. The thesis bounds the mean ratio by 0.06, which
   * a square lying flat reaches at 0.9 degrees.
   */
  double Angle = 9.0;
  /**
   * If less than Angle: slivers that are better than this are left alone, for optimisation to mend, but for those wedged
   * between interfaces, which it cannot.
   */
  double AngleInside = 90.0;
  /** Radius of picking regions over that of the ball, 0 to 1. */
  double PickingRadius = 0.5;
  /** Points that are tried in a picking region, at most. */
  unsigned Picks = 20;
  /** Of the pseudo-random points. */
  std::uint64_t Seed = 0;
};

/** The largest bound of the normalized volume of slivers for which meshes stayed of moderate size. */
inline constexpr double LargestSliverBound = 0.03;

/** In 4D: how slivers are fought (thesis, sections 4.1 to 4.3 and 4.5). */
struct SliverOptions
{
  bool Fight = true;
  /** zeta: radius of picking regions over that of the ball, 0 to 1. */
  double PickingRadius = 0.5;
  /** b: new slivers are small if their circumradius is below this times that of the old one. */
  double RadiusFactor = 4.0;
  /** Elements whose normalized volume is below this are slivers; above LargestSliverBound with Force only. */
  double VolumeBound = 0.01;
  /** Points that are tried in a picking region, at most. */
  unsigned Picks = 10;
  /** Of the pseudo-random points. */
  std::uint64_t Seed = 0;
};

} // namespace voxplex

#endif
