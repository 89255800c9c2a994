// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshOutput.h
 * @brief The kernel's meshes as VTK data in physical space, and time.
 */
#ifndef voxplex_MeshOutput_h
#define voxplex_MeshOutput_h

#include "Image/SpaceTimeFrame.h"
#include "Mesh/SimplexMesh.h"

#include <vector>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace voxplex
{

///@{
/**
 * Fills both outputs of vtkImageToTetMeshFilter or vtkImageToPentatopeMeshFilter, see there for the
 * arrays. The mesh is taken apart on the way, so that it never lies twice in memory as a whole.
 *
 * For left-handed axes the map to the world is a reflection; two vertices of every element and every
 * facet change places, so that elements stay positive and normals keep their side.
 *
 * @param planes times of the planes inside of the mesh, in the mesher's frame
 * @param threads 0 means all cores
 */
void MoveToOutput(SimplexMesh<3>&& mesh, const ImageFrame& frame, vtkUnstructuredGrid* tetrahedra,
  vtkPolyData* interfaces, unsigned threads);
void MoveToOutput(SimplexMesh<4>&& mesh, const SpaceTimeFrame& frame,
  const std::vector<double>& planes, vtkUnstructuredGrid* pentatopes, vtkUnstructuredGrid* boundary,
  unsigned threads);
///@}

} // namespace voxplex

#endif
