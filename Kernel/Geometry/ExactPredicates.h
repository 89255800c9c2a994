// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ExactPredicates.h
 * @brief Orientation, in-sphere and circumball in exact arithmetic, for D = 3 and D = 4.
 *
 * These are the fall-backs of Predicates.h and Circumball.h; hot code calls those. The header shows
 * none of CGAL: only ExactPredicates.cxx sees it.
 *
 * Algorithm, cheapest first; each stage is exact and is taken only when its numbers cannot
 * overflow:
 *   1. differences to the base point that are exact in double become integers (a common power of
 * two is taken out): voxel lattices end here, in 64- and 128-bit registers;
 *   2. otherwise the coordinates become integers and the differences are taken there; determinants
 *      in fixed-width integers of up to 12 words;
 *   3. coordinates whose bits span more than 125 places (1e-30 beside 100): CGAL's rationals.
 *
 * Coordinates must be finite. All functions are pure and safe to call from any thread; they do not
 * throw, except std::bad_alloc in stage 3.
 */
#ifndef voxplex_ExactPredicates_h
#define voxplex_ExactPredicates_h

#include "Geometry/Point.h"

namespace voxplex
{

template <int D>
struct Circumball;

/**
 * Sign of det(p1 - p0, ..., pD - p0).
 * @param points D + 1 points.
 */
template <int D>
int ExactOrientation(const Point<D>* const* points);

/**
 * Where p lies against the circumsphere of a simplex.
 * @param simplex D + 1 points, positively oriented.
 * @return +1 strictly inside, 0 on the sphere, -1 outside.
 */
template <int D>
int ExactInSphere(const Point<D>* const* simplex, const Point<D>& p);

/**
 * The circumball of a simplex, computed in rational arithmetic and then rounded: each coordinate of
 * the centre and the squared radius is within 2 ulp of the exact value.
 * @param simplex D + 1 points of either orientation.
 * @return false if the simplex is exactly flat; the ball is then left alone.
 */
template <int D>
bool RoundedExactCircumball(const Point<D>* const* simplex, Circumball<D>& ball);

} // namespace voxplex

#endif
