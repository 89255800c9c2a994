// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PentatopeOutput.h
 * @brief The kernel's 4D mesh as VTK data in physical space and time.
 */
#ifndef voxplex_PentatopeOutput_h
#define voxplex_PentatopeOutput_h

#include "Mesh/SimplexMesh.h"
#include "Private/SpaceTimeFrame.h"

#include <vector>

class vtkUnstructuredGrid;

namespace voxplex
{

/**
 * Fills both outputs of vtkImageToPentatopeMeshFilter, see there for the arrays. The mesh is taken
 * apart on the way, so that it never lies twice in memory as a whole.
 *
 * For left-handed axes the map to the world is a reflection; two vertices of every pentatope and
 * boundary tetrahedron change places, so that both keep their orientation.
 *
 * @param planes times of the planes inside of the mesh, in the mesher's frame
 * @param threads 0 means all cores
 */
void MoveToOutput(SimplexMesh<4>&& mesh, const SpaceTimeFrame& frame,
  const std::vector<double>& planes, vtkUnstructuredGrid* pentatopes, vtkUnstructuredGrid* boundary,
  unsigned threads);

} // namespace voxplex

#endif
