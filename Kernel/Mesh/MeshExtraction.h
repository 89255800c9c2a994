// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshExtraction.h
 * @brief From the refined triangulation of the box to the mesh of the object.
 */
#ifndef voxplex_MeshExtraction_h
#define voxplex_MeshExtraction_h

#include "Delaunay/Triangulation.h"
#include "Image/Domain.h"
#include "Mesh/SimplexMesh.h"

namespace voxplex
{

/**
 * Collects the simplices whose circumcentre lies inside the object (the final mesh of the thesis,
 * section 2.2), each with the label found there, and the facets between different labels (definition
 * 2.6). Numbers points along a Hilbert curve and sorts simplices by their points.
 *
 * @param mesh receives the mesh; what it held is lost
 * @throws std::bad_alloc
 */
template <int D>
void ExtractMesh(
  const Triangulation<D>& triangulation, const Domain<D>& image, SimplexMesh<D>& mesh);

extern template void ExtractMesh<3>(const Triangulation<3>&, const Domain<3>&, SimplexMesh<3>&);
extern template void ExtractMesh<4>(const Triangulation<4>&, const Domain<4>&, SimplexMesh<4>&);

} // namespace voxplex

#endif
