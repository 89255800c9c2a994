// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshReading.h
 * @brief --mesh and --interfaces: a mesh that is there already.
 */
#ifndef voxplex_cli_MeshReading_h
#define voxplex_cli_MeshReading_h

#include <vtkSmartPointer.h>

#include <string>

class vtkDataObject;
class vtkUnstructuredGrid;

namespace voxplex::cli
{

/** A mesh and its interfaces. */
struct MeshWithInterfaces
{
  vtkSmartPointer<vtkUnstructuredGrid> Mesh; ///< may be null
  vtkSmartPointer<vtkDataObject> Interfaces;
  bool IsChanged = false; ///< is not as it was read: elements were turned, or points left out
  std::string Warning;    ///< may be empty

  int Dimension() const; ///< 4 if the mesh has pentatopes, else 3
};

/**
 * Reads files that strangers may have made. What they claim is checked before VTK's readers see them. Cells and
 * arrays are checked afterwards, and the mesh is put right (vtkSimplexMeshInterfaces), so that the rest of the program
 * can rely on it.
 *
 * @param mesh a .vtu file of tetrahedra or pentatopes, as vtkSimplexMeshWriter writes them; empty: interfaces alone
 * @param interfaces of that mesh: a .vtp or .vtu file of triangles, or a .vtu file of tetrahedra. They are made if it is
 *   empty, or if the mesh was changed
 * @throws io::FileError that names the file and says what is wrong
 */
MeshWithInterfaces ReadMeshFiles(const std::string& mesh, const std::string& interfaces);

} // namespace voxplex::cli

#endif
