// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NotchFilling.h
 * @brief Tetrahedra that a mesh lacks at the faces where the image cuts the object.
 */
#ifndef voxplex_NotchFilling_h
#define voxplex_NotchFilling_h

#include "Delaunay/Triangulation.h"
#include "Image/Domain.h"
#include "Image/SizeFunction.h"

#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** What tetrahedra that fill notches keep to, as refinement does with the others. Angles are in degrees. */
struct NotchBounds
{
  double RadiusEdgeRatio = 2.0;          ///< below this
  double DihedralAngle = 9.0;            ///< smallest one, and 180 less the largest one
  double FacetAngle = 30.0;              ///< smallest planar angle of facets that become interfaces
  double JunctionFacetAngle = 20.0;      ///< the same where three labels or more meet at a vertex
  const SizeFunction<3>* Size = nullptr; ///< circumradii are below it, if there is one
};

/**
 * Fills notches in the faces where the image cuts the object. Where two such faces, or one of them and another
 * interface, are nearer to each other than their vertices, a tetrahedron between them may lie before a face and have its
 * circumcentre beyond, where all is background. Such a one gets the label at its centroid, unless that takes
 * something from the mesh:
 *
 * - its shape keeps the bounds;
 * - the vertices of its facets that are interfaces then are on interfaces (VertexKind::Feature), and their angles keep
 *   the bounds;
 * - at none of its edges more labels have other than two boundary facets;
 * - where three labels met at one of its vertices and no longer do, no interface has an angle below the bound for facets off
 *   junctions.
 *
 * Starts with all of them filled and takes back those that break a rule until none does. Background counts as one
 * label, wherever it is. The result does not depend on the number of threads.
 *
 * Nobody may change the triangulation meanwhile. Takes time linear in the number of tetrahedra, little for those that
 * are not in notches.
 *
 * @param domain one that is cut (Domain::IsCut)
 * @param labels of all simplex ids, 0 for what is not alive; those of the tetrahedra that fill notches are set
 * @param threads 0 means all cores
 * @return the ids of these tetrahedra, ascending
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
std::vector<SimplexId> FillNotches(const Triangulation<3>& triangulation, const Domain<3>& domain,
  const NotchBounds& bounds, std::span<LabelId> labels, unsigned threads,
  const std::stop_token& stop);

} // namespace voxplex

#endif
