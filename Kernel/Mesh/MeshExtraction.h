// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshExtraction.h
 * @brief From the refined triangulation of the box to the mesh of the object.
 */
#ifndef voxplex_MeshExtraction_h
#define voxplex_MeshExtraction_h

#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"
#include "Mesh/SimplexLabels.h"
#include "Mesh/SimplexMesh.h"

#include <span>
#include <stop_token>

namespace voxplex
{

/**
 * Collects the simplices that have a label, and the facets between different labels (definition 2.6). Numbers points
 * along a Hilbert curve and sorts simplices by their smallest point, those with the same one by their id in the
 * triangulation. One triangulation gives one mesh, whatever the number of threads.
 *
 * Nobody may change the triangulation meanwhile.
 *
 * @param labels of each simplex id
 * @param mesh receives the mesh; what it held is lost; empty if this throws
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end
 * @throws std::bad_alloc
 */
template <int D>
void ExtractMesh(const Triangulation<D>& triangulation, const Domain<D>& image,
  std::span<const LabelId> labels, SimplexMesh<D>& mesh, unsigned threads = 1,
  const std::stop_token& stop = {});

/** The same with LabelSimplices(). */
template <int D>
void ExtractMesh(const Triangulation<D>& triangulation, const Domain<D>& image,
  SimplexMesh<D>& mesh, unsigned threads = 1, const std::stop_token& stop = {});

extern template void ExtractMesh<3>(const Triangulation<3>&, const Domain<3>&,
  std::span<const LabelId>, SimplexMesh<3>&, unsigned, const std::stop_token&);
extern template void ExtractMesh<4>(const Triangulation<4>&, const Domain<4>&,
  std::span<const LabelId>, SimplexMesh<4>&, unsigned, const std::stop_token&);
extern template void ExtractMesh<3>(
  const Triangulation<3>&, const Domain<3>&, SimplexMesh<3>&, unsigned, const std::stop_token&);
extern template void ExtractMesh<4>(
  const Triangulation<4>&, const Domain<4>&, SimplexMesh<4>&, unsigned, const std::stop_token&);

} // namespace voxplex

#endif
