// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshFile.h
 * @brief Has vtkSimplexMeshWriter write what OutputFiles has announced.
 */
#ifndef voxplex_cli_MeshFile_h
#define voxplex_cli_MeshFile_h

#include <string>

class vtkDataObject;

namespace voxplex::cli
{

class OutputFiles;

/**
 * Writes a mesh or its interfaces. If the format has two files, both must have been announced.
 *
 * @param interfaces may be null
 * @param content of vtkSimplexMeshWriter
 * @throws RunError with the writer's reason
 */
void WriteMeshFile(vtkDataObject* mesh, vtkDataObject* interfaces, int content,
  const std::string& path, const OutputFiles& files);

} // namespace voxplex::cli

#endif
