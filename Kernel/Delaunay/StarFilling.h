// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StarFilling.h
 * @brief The new simplices in the star of a vertex that is removed, before they have ids.
 */
#ifndef voxplex_StarFilling_h
#define voxplex_StarFilling_h

#include "Delaunay/LinkCoordinates.h"
#include "Delaunay/RidgeTable.h"
#include "Delaunay/Stack.h"
#include "Delaunay/Stores.h"

#include <array>
#include <cstdint>

namespace voxplex
{

template <int D>
struct FillingSimplex
{
  struct Neighbour
  {
    std::uint32_t
      Id; ///< of a simplex outside the star, or None; if InFilling, a number in the filling
    std::uint32_t Index;
    bool InFilling;
  };
  std::array<VertexId, static_cast<std::size_t>(D + 1)> V;
  std::array<Neighbour, static_cast<std::size_t>(D + 1)> Neighbours;
  Circumball<D> Ball; ///< as in SimplexRecord
};

/** @brief Scratch space of a removal. Each worker has its own. */
template <int D>
struct StarFilling
{
  Stack<FillingSimplex<D>> Simplices;
  FacetTable<D> Front;            ///< open facets, as numbers in Worker::Boundary
  LinkCoordinates<D> Coordinates; ///< of the vertices in Worker::Link
};

} // namespace voxplex

#endif
