// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Rooms.h
 * @brief Small parts of a complex, around some of its tetrahedra.
 */
#ifndef voxplex_Rooms_h
#define voxplex_Rooms_h

#include "Optimisation/Complex.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voxplex
{

/**
 * @brief Disjoint sets of vertices, the rooms. They can be the blocks of patches (Patch).
 *
 * A room has the vertices of one tetrahedron or more, and those that a number of edges lead to. If
 * two tetrahedra reach a common vertex, they have one room.
 */
struct Rooms
{
  std::uint32_t Number = 0;
  std::vector<std::uint32_t> OfVertex; ///< by vertex; Number if it is in no room

  bool Contain(const TetrahedralComplex::Vertices& v) const
  {
    const std::uint32_t room = this->OfVertex[v[0]];
    return room != this->Number && this->OfVertex[v[1]] == room && this->OfVertex[v[2]] == room &&
      this->OfVertex[v[3]] == room;
  }
};

/**
 * The rooms around some tetrahedra, with the vertices that `edges` edges or fewer lead to. Rooms are
 * numbered in the order of their first vertices. Complexity: linear in the complex, for each edge.
 */
Rooms RoomsAround(
  const TetrahedralComplex& complex, std::span<const std::uint32_t> cells, unsigned edges);

} // namespace voxplex

#endif
