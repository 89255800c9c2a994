// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HilbertOrder.h
 * @brief Position of a point along a Hilbert curve through a box.
 */
#ifndef voxplex_HilbertOrder_h
#define voxplex_HilbertOrder_h

#include "Geometry/Box.h"

#include <cstdint>

namespace voxplex
{

/**
 * @brief Distance along the Hilbert curve that fills a cube around the box; 63 / D bits per axis.
 *
 * Points that are close along the curve are close in space.
 */
template <int D>
std::uint64_t HilbertIndex(const Point<D>& p, const Box<D>& box);

extern template std::uint64_t HilbertIndex<3>(const Point<3>&, const Box<3>&);
extern template std::uint64_t HilbertIndex<4>(const Point<4>&, const Box<4>&);

} // namespace voxplex

#endif
