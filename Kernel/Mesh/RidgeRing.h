// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RidgeRing.h
 * @brief The simplices around a ridge: an edge of tetrahedra, a triangle of pentatopes.
 */
#ifndef voxplex_RidgeRing_h
#define voxplex_RidgeRing_h

#include "Delaunay/Stores.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <vector>

namespace voxplex
{

/** Cells[k] has the ridge, Link[k] and Link[k + 1]. */
struct RidgeRing
{
  bool Closed = false; ///< true: Link[0] follows the last vertex; false: the mesh ends at both ends
  std::vector<std::uint32_t> Link;
  std::vector<std::uint32_t> Cells; ///< as long as Link; one shorter if not closed
};

/**
 * Gathers a ring, which begins with t if it is closed. Takes the time of a step for each simplex.
 *
 * @param t a simplex at the ridge
 * @param r, s its vertices that are not in the ridge, in the order that they are to have
 * @param simplexOf simplexOf(t) has V and N: the vertices, and the neighbours opposite to them
 * @param mayHave mayHave(next) says whether the ring may have a simplex
 * @return false if one was refused
 */
template <typename SimplexOf, typename MayHave>
bool GatherRing(std::uint32_t t, std::uint32_t r, std::uint32_t s, const SimplexOf& simplexOf,
  const MayHave& mayHave, RidgeRing& ring)
{
  const auto sumOf = [&](std::uint32_t cell)
  {
    const auto& v = simplexOf(cell).V;
    return std::accumulate(v.begin(), v.end(), std::uint32_t{ 0 }, std::bit_xor<>());
  };
  const std::uint32_t ridge = sumOf(t) ^ r ^ s;
  ring.Closed = false;
  ring.Link.assign({ r, s });
  ring.Cells.assign({ t });
  for (unsigned direction = 0; direction < 2; ++direction)
  {
    for (std::uint32_t behind = direction == 0 ? r : s;;)
    {
      const auto& last = simplexOf(ring.Cells.back());
      const auto place = std::find(last.V.begin(), last.V.end(), behind) - last.V.begin();
      const std::uint32_t next = last.N[static_cast<std::size_t>(place)];
      if (next == None)
      {
        break;
      }
      if (next == t)
      {
        ring.Closed = true;
        ring.Link.pop_back();
        return true;
      }
      if (!mayHave(next))
      {
        return false;
      }
      behind = ring.Link.back();
      ring.Cells.push_back(next);
      ring.Link.push_back(sumOf(next) ^ ridge ^ behind); // the one that is left
    }
    // To the other end from t, which is the last one then; and back.
    std::reverse(ring.Link.begin(), ring.Link.end());
    std::reverse(ring.Cells.begin(), ring.Cells.end());
  }
  return true;
}

} // namespace voxplex

#endif
