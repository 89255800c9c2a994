// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VertexStar.h
 * @brief The simplices at a vertex, in a triangulation that no thread changes.
 */
#ifndef voxplex_VertexStar_h
#define voxplex_VertexStar_h

#include "Delaunay/Triangulation.h"

#include <boost/container/small_vector.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace voxplex
{

/**
 * Whether a condition holds for a simplex of the star of a vertex: the simplices that have this
 * vertex. They are visited from one to those beside it, until it holds.
 * The time is quadratic in their number, which is about 24 in 3D and 150 in 4D.
 *
 * @param from the simplex of the star that is visited first
 * @param condition condition(s) is called at most once for each simplex
 */
template <int D, typename Condition>
bool AnyInStar(
  const Triangulation<D>& triangulation, VertexId v, SimplexId from, const Condition& condition)
{
  constexpr std::size_t UsualLength = D == 3 ? 64 : 256;
  boost::container::small_vector<SimplexId, UsualLength> star{ from };
  if (condition(from))
  {
    return true;
  }
  for (std::size_t k = 0; k < star.size(); ++k)
  {
    const auto& simplex = triangulation.GetSimplex(star[k]);
    for (unsigned i = 0; i <= static_cast<unsigned>(D); ++i)
    {
      const SimplexId n = simplex.N[i];
      if (simplex.V[i] != v && n != None && std::find(star.begin(), star.end(), n) == star.end())
      {
        if (condition(n))
        {
          return true;
        }
        star.push_back(n);
      }
    }
  }
  return false;
}

/** The star of a vertex, the simplex `from` first. See AnyInStar(). */
template <int D>
std::vector<SimplexId> StarOf(const Triangulation<D>& triangulation, VertexId v, SimplexId from)
{
  constexpr std::size_t UsualLength = D == 3 ? 32 : 192;
  std::vector<SimplexId> star;
  star.reserve(UsualLength);
  AnyInStar(triangulation, v, from,
    [&star](SimplexId s)
    {
      star.push_back(s);
      return false;
    });
  return star;
}

/** The vertices of some simplices, ascending. */
template <int D>
std::vector<VertexId> VerticesOf(
  const Triangulation<D>& triangulation, const std::vector<SimplexId>& simplices)
{
  std::vector<VertexId> vertices;
  vertices.reserve(simplices.size() * (D + 1));
  for (const SimplexId s : simplices)
  {
    const auto& v = triangulation.GetSimplex(s).V;
    vertices.insert(vertices.end(), v.begin(), v.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

} // namespace voxplex

#endif
