// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Fragments.h
 * @brief Counts the parts of a mesh that are connected through faces.
 */
#ifndef voxplex_Fragments_h
#define voxplex_Fragments_h

#include "Mesh/SimplexMesh.h"

#include <cstdint>
#include <map>
#include <stop_token>

namespace voxplex
{

/**
 * The number of fragments of each label: maximal sets of its tetrahedra that are connected through
 * faces. A finite-element model of a label holds together if it has one.
 *
 * O(n) for n tetrahedra, with 48 bytes for each, if few tetrahedra share a point.
 *
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
std::map<std::int64_t, std::uint64_t> CountFragments(
  const SimplexMesh<3>& mesh, const std::stop_token& stop = {});

} // namespace voxplex

#endif
