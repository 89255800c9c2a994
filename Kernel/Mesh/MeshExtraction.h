// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshExtraction.h
 * @brief Makes the mesh of the object from the refined triangulation of the box.
 */
#ifndef voxplex_MeshExtraction_h
#define voxplex_MeshExtraction_h

#include "Base/UninitialisedVector.h"
#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"
#include "Mesh/SimplexLabels.h"
#include "Mesh/SimplexMesh.h"
#include "Mesh/Subdivision.h"

#include <cstdint>
#include <span>
#include <stop_token>

namespace voxplex
{

/** How a mesh differs from the simplices of its triangulation. */
template <int D>
struct MeshChanges
{
  std::span<const Point<D>>
    Positions = {};          ///< of each vertex id; empty: those of the triangulation
  Subdivision<D> Parts = {}; ///< its points are where the mesh has them
};

/**
 * Collects the simplices that have a label, and the facets between different labels (definition
 * 2.6). Points and simplices have the order of their ids in the triangulation; those of pieces come
 * last. The mesh does not depend on the number of threads.
 *
 * No thread may change the triangulation meanwhile. Linear time, and O(k log k) for k pieces.
 *
 * @param labels of each simplex id
 * @param mesh receives the mesh; its old contents are lost; it is empty if this throws
 * @param threads 0 means all cores
 * @param numbers receives the point of each vertex id, then of each point of the subdivision; None
 *   if it is not in the mesh. May be null.
 * @throws Cancelled if a stop was requested before the end
 * @throws std::bad_alloc
 */
template <int D>
void ExtractMesh(const Triangulation<D>& triangulation, const Domain<D>& image,
  std::span<const LabelId> labels, SimplexMesh<D>& mesh, unsigned threads = 1,
  const std::stop_token& stop = {}, const MeshChanges<D>& changes = {},
  UninitialisedVector<std::uint32_t>* numbers = nullptr);

/** The same with the labels of LabelSimplices(). */
template <int D>
void ExtractMesh(const Triangulation<D>& triangulation, const Domain<D>& image,
  SimplexMesh<D>& mesh, unsigned threads = 1, const std::stop_token& stop = {});

extern template void ExtractMesh<3>(const Triangulation<3>&, const Domain<3>&,
  std::span<const LabelId>, SimplexMesh<3>&, unsigned, const std::stop_token&,
  const MeshChanges<3>&, UninitialisedVector<std::uint32_t>*);
extern template void ExtractMesh<4>(const Triangulation<4>&, const Domain<4>&,
  std::span<const LabelId>, SimplexMesh<4>&, unsigned, const std::stop_token&,
  const MeshChanges<4>&, UninitialisedVector<std::uint32_t>*);
extern template void ExtractMesh<3>(
  const Triangulation<3>&, const Domain<3>&, SimplexMesh<3>&, unsigned, const std::stop_token&);
extern template void ExtractMesh<4>(
  const Triangulation<4>&, const Domain<4>&, SimplexMesh<4>&, unsigned, const std::stop_token&);

} // namespace voxplex

#endif
