// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PentatopeOptimiser.h
 * @brief Improves the shapes of a mesh's pentatopes after refinement.
 */
#ifndef voxplex_PentatopeOptimiser_h
#define voxplex_PentatopeOptimiser_h

#include "Domain/Domain.h"
#include "Image/LabelImage.h"
#include "Optimisation/Complex.h"
#include "Optimisation/Pentatopes/PentatopeRules.h"

#include <array>
#include <cstdint>
#include <stop_token>

namespace voxplex
{

/** Poor pentatopes are those below the target. */
struct PentatopeStatistics
{
  double SmallestBefore = 1.0; ///< normalized volume; 1 if there are no pentatopes
  double SmallestAfter = 1.0;
  std::uint64_t PoorBefore = 0;
  std::uint64_t PoorAfter = 0;
  std::array<std::uint64_t, 3> Flips{}; ///< 2-4, 3-3, 4-2
  std::uint64_t Moves = 0;              ///< of vertices
  std::uint64_t Insertions = 0;         ///< of vertices
  std::uint64_t InsertionsTried = 0;    ///< pentatopes for which one was looked for
  std::uint32_t Passes = 0;
};

/**
 * Raises the normalized volumes of pentatopes to a target where possible, by flips (PentatopeFlip),
 * smoothing (PentatopeSmoother) and, as a last resort, new vertices (PentatopeCavity). First each
 * vertex is moved once so that those around it are better on the whole. Then poor pentatopes are improved, up
 * to twice the target at first: a change is made only if the smallest normalized volume of the
 * changed pentatopes grows. The result keeps
 * - conformity, positive orientation, labels, and the facets of interfaces;
 * - the interfaces: their vertices move along them, by a quarter of an edge or half a voxel at most.
 *   As a last resort they leave them, by PentatopeBounds::InterfaceTolerance at most;
 * - the bounds of radius-edge ratios and sizes;
 * - facets on time planes (PentatopeBounds::Planes), and those at the ends of a periodic mesh. Both ends stay
 *   congruent: a vertex and its twin (SimplexMesh::Twins) move together.
 *
 * Points keep their order; new ones come last. The result does not depend on the number of threads.
 *
 * @param complex with the pentatopes around the object; compact
 * @param surfaces the domain that the mesh was made from
 * @param image that of the domain
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested; std::bad_alloc
 *
 * Complexity: linear in the size of the mesh.
 */
PentatopeStatistics OptimisePentatopes(PentatopeComplex& complex, const Domain<4>& surfaces,
  const LabelImage<4>& image, const PentatopeBounds& bounds, unsigned threads = 1,
  const std::stop_token& stop = {});

} // namespace voxplex

#endif
