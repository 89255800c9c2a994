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

  // Without branches: half of them would be mispredicted, which takes twice as long.
  for (unsigned b = Bits - 1; b > 0; --b)
  {
    const std::uint32_t lower = (1u << b) - 1;
    for (unsigned a = 0; a < Axes; ++a)
    {
      // Where the bit is set the lower ones of x[0] are inverted, else exchanged with those of x[a].
      const std::uint32_t invert = 0u - ((x[a] >> b) & 1u);
      const std::uint32_t exchange = (x[0] ^ x[a]) & lower & ~invert;
      x[0] ^= (lower & invert) | exchange;
      x[a] ^= exchange;
    }
  }
  for (unsigned a = 1; a < Axes; ++a)
  {
    x[a] ^= x[a - 1]; // Gray code
  }
  std::uint32_t t = x[Axes - 1] >> 1; // of each bit, the parity of those above it
  for (const unsigned shift : { 1u, 2u, 4u, 8u, 16u })
  {
    t ^= t >> shift;
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
