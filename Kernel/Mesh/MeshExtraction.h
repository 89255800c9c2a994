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

#include <cstdint>
#include <span>
#include <stop_token>

namespace voxplex
{

/**
 * Collects the simplices that have a label, and the facets between different labels (definition
 * 2.6). Points are numbered along a Hilbert curve. Simplices are sorted by their smallest point,
 * then by their id in the triangulation. The mesh does not depend on the number of threads.
 *
 * No thread may change the triangulation meanwhile.
 *
 * @param labels of each simplex id
 * @param mesh receives the mesh; its old contents are lost; it is empty if this throws
 * @param threads 0 means all cores
 * @param positions of each vertex id, in place of those of the triangulation; or empty
 * @param numbers receives the point of each vertex id, None if it is not in the mesh; may be null
 * @param spare the mesh gets room for so many more points and simplices
 * @throws Cancelled if a stop was requested before the end
 * @throws std::bad_alloc
 */
template <int D>
void ExtractMesh(const Triangulation<D>& triangulation, const Domain<D>& image,
  std::span<const LabelId> labels, SimplexMesh<D>& mesh, unsigned threads = 1,
  const std::stop_token& stop = {}, std::span<const Point<D>> positions = {},
  UninitialisedVector<std::uint32_t>* numbers = nullptr, std::size_t spare = 0);

/** The same with the labels of LabelSimplices(). */
template <int D>
void ExtractMesh(const Triangulation<D>& triangulation, const Domain<D>& image,
  SimplexMesh<D>& mesh, unsigned threads = 1, const std::stop_token& stop = {});

extern template void ExtractMesh<3>(const Triangulation<3>&, const Domain<3>&,
  std::span<const LabelId>, SimplexMesh<3>&, unsigned, const std::stop_token&,
  std::span<const Point<3>>, UninitialisedVector<std::uint32_t>*, std::size_t);
extern template void ExtractMesh<4>(const Triangulation<4>&, const Domain<4>&,
  std::span<const LabelId>, SimplexMesh<4>&, unsigned, const std::stop_token&,
  std::span<const Point<4>>, UninitialisedVector<std::uint32_t>*, std::size_t);
extern template void ExtractMesh<3>(
  const Triangulation<3>&, const Domain<3>&, SimplexMesh<3>&, unsigned, const std::stop_token&);
extern template void ExtractMesh<4>(
  const Triangulation<4>&, const Domain<4>&, SimplexMesh<4>&, unsigned, const std::stop_token&);

} // namespace voxplex

#endif
