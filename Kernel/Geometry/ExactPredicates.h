// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ExactPredicates.h
 * @brief Orientation, in-sphere and circumball in exact arithmetic, for D = 3 and D = 4.
 *
 * These functions are the fall-backs of Predicates.h and Circumball.h. Hot code calls those
 * headers. Only ExactPredicates.cxx includes CGAL.
 *
 * The algorithm has three exact stages, from the cheapest to the most expensive. A stage is used
 * only if its numbers cannot overflow.
 *   1. If the differences to the base point are exact in double, they become integers, after
 *      division by a common power of two. Points of voxel lattices end here, in 64-bit and 128-bit
 *      registers.
 *   2. Otherwise the coordinates become integers, and the differences are computed in integers. The
 *      determinants use fixed-width integers of up to 12 words.
 *   3. If the bits of the coordinates span more than 125 places (1e-30 beside 100), CGAL's
 *      rationals are used.
 *
 * Coordinates must be finite. All functions are pure and thread-safe. They do not throw, except
 * std::bad_alloc in stage 3.
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
 * The side of p with respect to the circumsphere of a simplex.
 * @param simplex D + 1 points, positively oriented.
 * @return +1 strictly inside, 0 on the sphere, -1 outside.
 */
template <int D>
int ExactInSphere(const Point<D>* const* simplex, const Point<D>& p);

/**
 * The circumball of a simplex, computed in rational arithmetic and then rounded. The squared radius
 * and each coordinate of the centre are within 2 ulp of the exact value.
 * @param simplex D + 1 points of either orientation.
 * @return false if the simplex is exactly flat. Then the ball is not changed.
 */
template <int D>
bool RoundedExactCircumball(const Point<D>* const* simplex, Circumball<D>& ball);

} // namespace voxplex

#endif
