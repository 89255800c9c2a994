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
 * tetrahedron, and the faces between two tetrahedra with different labels. A face of three or more
 * tetrahedra, which no conforming mesh has, is left out. The facets are sorted by their smallest,
 * middle and largest point. The result does not depend on the number of threads. If the tetrahedra
 * are positively oriented, the normals are as SimplexMesh describes them.
 *
 * Takes O(n log n) time at worst, and linear time if few tetrahedra share a point; 64 bytes a
 * tetrahedron.
 *
 * @param threads 0 means all cores
 * @return the number of faces of three or more tetrahedra
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
std::uint64_t FindInterfaces(
  SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop = {});

} // namespace voxplex

#endif
