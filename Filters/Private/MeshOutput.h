// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshOutput.h
 * @brief The kernel's mesh as VTK data in physical space.
 */
#ifndef voxplex_MeshOutput_h
#define voxplex_MeshOutput_h

#include "Mesh/SimplexMesh.h"
#include "Private/ImageFrame.h"

class vtkPolyData;
class vtkUnstructuredGrid;

namespace voxplex
{

/**
 * Fills both outputs of vtkImageToTetMeshFilter, see there for the arrays. The mesh is taken apart
 * on the way, so that it never lies twice in memory as a whole.
 *
 * For left-handed axes the map to the world is a reflection; two vertices of every tetrahedron and
 * triangle change places, so that tetrahedra stay positive and normals keep their side.
 *
 * @param threads 0 means all cores
 */
void MoveToOutput(SimplexMesh<3>&& mesh, const ImageFrame& frame, vtkUnstructuredGrid* tetrahedra,
  vtkPolyData* interfaces, unsigned threads);

} // namespace voxplex

#endif
