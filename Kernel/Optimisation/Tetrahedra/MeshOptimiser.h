// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshOptimiser.h
 * @brief Improves the shapes of a mesh's tetrahedra after refinement.
 */
#ifndef voxplex_MeshOptimiser_h
#define voxplex_MeshOptimiser_h

#include "Domain/Domain.h"
#include "Geometry/ShapeBounds.h"
#include "Optimisation/Complex.h"
#include "Optimisation/Tetrahedra/Flips.h"
#include "Optimisation/Tetrahedra/Smoother.h"

#include <cstdint>
#include <stop_token>

namespace voxplex
{

/** Angles are in degrees, lengths in the mesh's unit. */
struct OptimisationOptions
{
  /**
   * Bounds of dihedral angles. Tetrahedra that violate a bound are improved. 0 < smallest < 60, 90
   * < largest < 180.
   */
  double SmallestDihedralAngle = 18.0;
  double LargestDihedralAngle = 150.0;
  /**
   * Tetrahedra that violate the bound of the ratio are improved. Interface triangles that already
   * violate their bound do not get worse.
   */
  ShapeBounds Shape{ .RadiusEdgeRatio = 2.5 };
  /** Interface edges are flipped only between triangles that make at most this angle. */
  double CreaseAngle = 30.0;
  /**
   * How far vertices may be moved off interfaces as a last resort, unless 0.4 of their shortest edge on
   * interfaces is less. Vertices on junctions cannot move in any other way. A quarter of the sampling
   * distance is a good value; 0 means not at all.
   */
  double InterfaceTolerance = 0.0;

  /**
   * The time limit in seconds, kept approximately. The mesh reached by then is the result. 0: no
   * limit.
   */
  double Seconds = 0.0;

  /** No change that would lose one of its components is made. Null: all are. */
  ComponentGuard<3>* Guard = nullptr;
};

/** Shapes of a mesh's tetrahedra. */
struct ShapeStatistics
{
  double SmallestDihedralAngle = 180.0; ///< degrees; 180 if there are no tetrahedra
  double LargestDihedralAngle = 0.0;    ///< degrees; 0 if there are no tetrahedra
  double LargestRadiusEdgeRatio = 0.0;  ///< infinite if a tetrahedron is flat; 0 if there are none
  std::uint64_t Poor = 0;               ///< tetrahedra that violate a bound
};

struct OptimisationStatistics
{
  ShapeStatistics Before;
  ShapeStatistics After;
  FlipStatistics Flips;
  SmoothingStatistics Smoothing;
  std::uint32_t Passes = 0; ///< over the poor tetrahedra
  bool OutOfTime = false;
  double Seconds = 0.0;
};

/**
 * Brings tetrahedra within the shape bounds where possible. It uses flips (Flips) and smoothing
 * (Smoother). For the remaining poor tetrahedra, it inserts vertices inside labels, and moves
 * vertices on interfaces by small distances. If that does not help, tetrahedra around are first
 * improved beyond the bounds, which makes room.
 *
 * Only poor tetrahedra are improved. A change is made only if the smallest score (ShapeScore) of
 * the changed tetrahedra grows, so the worst shape of the mesh never gets worse. Optimisation keeps
 * - conformity, positive orientation and every label;
 * - the connected pieces of each label, except single tetrahedra;
 * - the components that OptimisationOptions::Guard guards;
 * - the bounds of planar angles of interfaces;
 * - the position of interfaces: vertices on them move only along them (except by
 *   InterfaceTolerance), and their triangles change only where they are nearly flat.
 *
 * A mesh without poor tetrahedra is unchanged. Otherwise the used points keep their order, and new
 * points come last. The cells around the object are dropped.
 *
 * Blocks of vertices are worked on side by side (BlockSchedule). One thread tries what is left. The result does
 * not depend on the number of threads, unless the time limit ends the work.
 *
 * @param complex its points sorted along a space-filling curve make it fast
 * @param domain the domain that the mesh was made from
 * @param threads 0 means all cores
 * @throws InputError if an option is out of range; Cancelled if a stop was requested;
 *   std::bad_alloc
 *
 * Complexity: linear in the size of the mesh and in the number of poor tetrahedra. A poor
 * tetrahedron takes about 100 times as long as another one.
 */
OptimisationStatistics OptimiseMesh(TetrahedralComplex& complex, const Domain<3>& domain,
  const OptimisationOptions& options, unsigned threads = 1, const std::stop_token& stop = {});

} // namespace voxplex

#endif
