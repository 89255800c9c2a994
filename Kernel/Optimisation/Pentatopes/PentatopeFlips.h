// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PentatopeFlips.h
 * @brief Bistellar flips in four dimensions.
 */
#ifndef voxplex_PentatopeFlips_h
#define voxplex_PentatopeFlips_h

#include "Optimisation/Pentatopes/PentatopeRules.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxplex
{

/** Pentatopes, and others that fill the same space. */
struct PentatopeFlip
{
  std::array<std::uint32_t, 4> Old;
  std::size_t NumberOfOld = 0; ///< 2, 3 or 4; 0: there is no flip
  std::array<PentatopeComplex::Vertices, 4> New;
  std::size_t NumberOfNew = 0; ///< 6 - NumberOfOld
  double Before = 0.0;         ///< smallest quality of the old ones
  double After = 0.0;          ///< smallest quality of the new ones
};

/**
 * @brief The flip 2-4, 3-3 or 4-2 that removes a pentatope and raises the smallest quality most.
 *
 * Six points of space-time span six pentatopes. Those of one orientation fill the same space as those
 * of the other. If the mesh has all of one kind, the others can take their place: 2 pentatopes with a
 * common tetrahedron, 3 around a triangle, or 4 around an edge. All must have the same label and be on the
 * same side of all time planes, so interfaces and facets on planes stay as they are.
 */
PentatopeFlip FindFlip(
  const PentatopeComplex& complex, const PentatopeRules& rules, std::uint32_t s);

} // namespace voxplex

#endif
