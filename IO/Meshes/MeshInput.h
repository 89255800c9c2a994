// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshInput.h
 * @brief From the data of a pipeline to the mesh that the formats' writers rely on.
 */
#ifndef voxplex_io_MeshInput_h
#define voxplex_io_MeshInput_h

#include "MeshWriting/Formats.h"

#include <vtkSmartPointer.h>

#include <string>

class vtkDataObject;

namespace voxplex::io
{

/** A mesh with its interfaces; what was missing is there, without cells. */
class MeshInput
{
public:
  /**
   * @param mesh, interfaces as vtkSimplexMeshWriter describes them; either may be null
   * @param slab the only slab to write; -1: the whole mesh
   * @param compress .vtu and .vtp files
   * @throws FileError if they are of different dimensions
   */
  MeshInput(vtkDataObject* mesh, vtkDataObject* interfaces, int slab = -1, bool compress = true);

  /**
   * Checks what the format of this name relies on: cells of the one right type, and the arrays.
   *
   * @throws FileError
   */
  void Check(Content content, const std::string& name) const;

  /** Writes as voxplex::io::WriteFile() does. */
  void Write(Content content, const std::string& name, const std::string& path,
    const std::string& companionPath) const;

private:
  void CheckSlab(Content content) const;

  int Dimension;
  int Slab;
  bool Compress;
  std::string Space;
  vtkSmartPointer<vtkUnstructuredGrid> Mesh;
  vtkSmartPointer<vtkPolyData> Triangles;          ///< of a 3D mesh
  vtkSmartPointer<vtkUnstructuredGrid> Tetrahedra; ///< of a 4D mesh
};

} // namespace voxplex::io

#endif
