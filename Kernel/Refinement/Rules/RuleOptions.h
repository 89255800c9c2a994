// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RuleOptions.h
 * @brief The user's options for the rules of refinement.
 */
#ifndef voxplex_RuleOptions_h
#define voxplex_RuleOptions_h

#include <cstdint>

namespace voxplex
{

/** In 4D: which rules come first. */
enum class RuleOrder
{
  RadiusEdgeFirst, ///< section 4.6.1 of the thesis: radius-edge, sample spacing, ball
  SurfaceFirst     ///< section 4.2: sample spacing, ball, radius-edge
};

/**
 * Largest TetSliverOptions::Angle without Force: with it the mesh of the knee atlas grew by about a
 * quarter.
 */
inline constexpr double LargestSliverAngle = 15.0;

/** In 3D: the removal of slivers (sliver rule). */
struct TetSliverOptions
{
  /**
   * A tetrahedron with a dihedral angle below this, or above 180 minus this, is a sliver. Degrees;
   * 0 leaves slivers alone; above LargestSliverAngle with Force only. The thesis bounds the mean
   * ratio by 0.06, which a flat square reaches at 0.9 degrees.
   */
  double Angle = 9.0;
  /**
   * If this is less than Angle, slivers with larger angles than this are left to optimisation.
   * Slivers wedged between interfaces are split all the same, because optimisation cannot improve
   * them.
   */
  double AngleInside = 90.0;
  /** Radius of picking regions over that of the ball, 0 to 1. */
  double PickingRadius = 0.5;
  /** Largest number of points that are tried in a picking region. */
  unsigned Picks = 20;
  /** Seed of the pseudo-random points. */
  std::uint64_t Seed = 0;
};

/** Bounds of the shapes of elements and interface facets. */
struct ShapeOptions
{
  /**
   * rho-bar: upper bound of circumradius / shortest edge. Below 1.93 (SmallestRadiusEdgeRatio)
   * meshes can become very large.
   */
  double RadiusEdgeRatio = 2.0;
  /** Lower bound of the angles of interface facets, degrees, 0 to 30; 3D only. */
  double FacetAngle = 30.0;
  /** 3D only; for 4D see SpaceTimeRuleOptions. */
  TetSliverOptions Slivers;
};

/**
 * The largest bound of the normalized volume of slivers with which meshes stayed of moderate size.
 */
inline constexpr double LargestSliverBound = 0.03;

/** In 4D: the removal of slivers (thesis, sections 4.1 to 4.3 and 4.5). */
struct SliverOptions
{
  bool Fight = true;
  /**
   * zeta: radius of picking regions over that of the ball, 0 to 1; the facet rule takes 0.5 at
   * most.
   */
  double PickingRadius = 0.5;
  /** b: a new sliver is small if its circumradius is below this times the radius of the ball. */
  double RadiusFactor = 4.0;
  /**
   * An element whose normalized volume is below this is a sliver; above LargestSliverBound with
   * Force only.
   */
  double VolumeBound = 0.01;
  /** Largest number of points that are tried in a picking region. */
  unsigned Picks = 10;
  /** Seed of the pseudo-random points. */
  std::uint64_t Seed = 0;
};

/** In 4D. */
struct SpaceTimeRuleOptions
{
  RuleOrder Order = RuleOrder::RadiusEdgeFirst;
  SliverOptions Slivers;
};

} // namespace voxplex

#endif
