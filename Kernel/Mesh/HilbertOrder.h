// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HilbertOrder.h
 * @brief Position of a point along a Hilbert curve through a box.
 */
#ifndef voxplex_HilbertOrder_h
#define voxplex_HilbertOrder_h

#include "Geometry/Box.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace voxplex
{

/**
 * @brief Distance along the Hilbert curve that fills a cube around the box, with 63 / D bits per axis.
 *
 * Points that are near along the curve are near in space. J. Skilling, "Programming the Hilbert
 * curve", AIP Conf. Proc. 707 (2004): from coordinates to the transposed index.
 */
template <int D>
std::uint64_t HilbertIndex(const Point<D>& p, const Box<D>& box)
{
  constexpr unsigned Axes = static_cast<unsigned>(D);
  constexpr unsigned Bits = 63 / Axes;
  double side = 0.0;
  for (unsigned a = 0; a < Axes; ++a)
  {
    side = std::max(side, box.Max[a] - box.Min[a]);
  }
  constexpr double Largest = static_cast<double>((1u << Bits) - 1);
  std::array<std::uint32_t, Axes> x;
  for (unsigned a = 0; a < Axes; ++a)
  {
    const double t = (p[a] - box.Min[a]) / side * Largest;
    x[a] = static_cast<std::uint32_t>(std::clamp(t, 0.0, Largest));
  }

  for (std::uint32_t q = 1u << (Bits - 1); q > 1; q >>= 1)
  {
    for (unsigned a = 0; a < Axes; ++a)
    {
      if (x[a] & q)
      {
        x[0] ^= q - 1; // invert
      }
      else
      {
        const std::uint32_t t = (x[0] ^ x[a]) & (q - 1); // exchange
        x[0] ^= t;
        x[a] ^= t;
      }
    }
  }
  for (unsigned a = 1; a < Axes; ++a)
  {
    x[a] ^= x[a - 1]; // Gray code
  }
  std::uint32_t t = 0;
  for (std::uint32_t q = 1u << (Bits - 1); q > 1; q >>= 1)
  {
    if (x[Axes - 1] & q)
    {
      t ^= q - 1;
    }
  }
  for (unsigned a = 0; a < Axes; ++a)
  {
    x[a] ^= t;
  }

  std::uint64_t index = 0;
  for (unsigned b = Bits; b-- > 0;)
  {
    for (unsigned a = 0; a < Axes; ++a)
    {
      index = (index << 1) | ((x[a] >> b) & 1u);
    }
  }
  return index;
}

} // namespace voxplex

#endif
