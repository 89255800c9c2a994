// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FindInterfaces.h
 * @brief Finds the interfaces of a mesh that is given by its tetrahedra and their labels alone.
 */
#ifndef voxplex_FindInterfaces_h
#define voxplex_FindInterfaces_h

#include "Mesh/SimplexMesh.h"

#include <cstdint>
#include <stop_token>

namespace voxplex
{

/**
 * Sets Facets and FacetLabels from Points, Simplices and Labels. The facets are the faces of one
 * simplex, and the faces between two simplices with different labels. A face of three or more
 * simplices, which no conforming mesh has, is left out. The facets are sorted by their points,
 * smallest first. The result does not depend on the number of threads. If the simplices are
 * positively oriented, the normals are as SimplexMesh describes them.
 *
 * Takes O(n log n) time at worst, and linear time if few simplices share a point; 64 bytes a
 * tetrahedron, 100 a pentatope.
 *
 * @param threads 0 means all cores
 * @return the number of faces of three or more tetrahedra
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
std::uint64_t FindInterfaces(
  SimplexMesh<D>& mesh, unsigned threads, const std::stop_token& stop = {});

extern template std::uint64_t FindInterfaces<3>(SimplexMesh<3>&, unsigned, const std::stop_token&);
extern template std::uint64_t FindInterfaces<4>(SimplexMesh<4>&, unsigned, const std::stop_token&);

} // namespace voxplex

#endif
