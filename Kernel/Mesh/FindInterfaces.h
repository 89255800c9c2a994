// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FindInterfaces.h
 * @brief The interfaces of a mesh that is given by its tetrahedra and their labels alone.
 */
#ifndef voxplex_FindInterfaces_h
#define voxplex_FindInterfaces_h

#include "Mesh/SimplexMesh.h"

#include <cstdint>
#include <stop_token>

namespace voxplex
{

/**
 * Sets Facets and FacetLabels from Points, Simplices and Labels: the faces of one tetrahedron, and those
 * between two of different labels; a face of three or more tetrahedra, which no conforming mesh has, is
 * left out. They come in the order of their smallest, middle and largest point, and do not depend on the
 * number of threads. Tetrahedra must be positively oriented for the normals to be as SimplexMesh says.
 *
 * Time O(n log n) at worst, linear for meshes in which few tetrahedra share a point; 64 bytes a
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
