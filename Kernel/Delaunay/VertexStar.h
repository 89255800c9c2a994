// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VertexStar.h
 * @brief The tetrahedra at a vertex, in a triangulation that no thread changes.
 */
#ifndef voxplex_VertexStar_h
#define voxplex_VertexStar_h

#include "Delaunay/Triangulation.h"

#include <algorithm>
#include <vector>

namespace voxplex
{

/**
 * The star of a vertex: all simplices that have this vertex. The simplex `from` comes first.
 * The time is quadratic in their number, which is about 24 in 3D and 150 in 4D.
 *
 * @param from a simplex of the star
 */
template <int D>
std::vector<SimplexId> StarOf(const Triangulation<D>& triangulation, VertexId v, SimplexId from)
{
  std::vector<SimplexId> star{ from };
  for (std::size_t k = 0; k < star.size(); ++k)
  {
    const auto& simplex = triangulation.GetSimplex(star[k]);
    for (unsigned i = 0; i <= static_cast<unsigned>(D); ++i)
    {
      const SimplexId n = simplex.N[i];
      if (simplex.V[i] != v && n != None && std::find(star.begin(), star.end(), n) == star.end())
      {
        star.push_back(n);
      }
    }
  }
  return star;
}

} // namespace voxplex

#endif
