// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SliceTetrahedra.h
 * @brief A slice of a pentatope mesh as a mesh of tetrahedra.
 */
#ifndef voxplex_SliceTetrahedra_h
#define voxplex_SliceTetrahedra_h

#include "Mesh/SimplexMesh.h"
#include "Mesh/TimeSlice.h"

#include <cstdint>
#include <span>

namespace voxplex
{

/**
 * @brief Splits the wedges and pyramids of a slice into tetrahedra.
 *
 * A wedge gives three tetrahedra, a pyramid two. No points are added. Each quadrilateral is split by
 * the diagonal of its smallest point, so neighbours agree (Dompierre et al. 1999, "How to subdivide
 * pyramids, prisms and hexahedra into tetrahedra"). The result conforms if the slice does, and has
 * its orientation.
 *
 * O(n) for n cells.
 * @param slice of pentatopes; polygons, the slices of tetrahedra, are left out
 * @param labels of the cells of the space-time mesh that was cut
 * @return Points as in the slice, Simplices and Labels; no Facets
 */
SimplexMesh<3> SplitIntoTetrahedra(const TimeSlice& slice, std::span<const std::int64_t> labels);

} // namespace voxplex

#endif
