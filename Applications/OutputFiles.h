// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OutputFiles.h
 * @brief Output files of a program that may be interrupted, and meshes among them.
 *
 * An interrupted program leaves all files or none, and no temporary file.
 */
#ifndef voxplex_cli_OutputFiles_h
#define voxplex_cli_OutputFiles_h

#include <string>

class vtkDataObject;

namespace voxplex::io
{
class WholeFiles;
}

namespace voxplex::cli
{

// An empty path stands for no file: nothing happens.

/** Announces a file that is no mesh. @throws io::OutputError */
void AnnounceFile(io::WholeFiles& files, const std::string& path);

/** Announces a mesh or its interfaces: two files if the format has two. @throws io::OutputError */
void AnnounceMesh(io::WholeFiles& files, const std::string& path);

/**
 * Has vtkSimplexMeshWriter write a mesh or its interfaces, which must have been announced.
 *
 * @param interfaces may be null
 * @param content of vtkSimplexMeshWriter
 * @param slab the only one to write; -1: the whole mesh
 * @param compress .vtu and .vtp files
 * @throws io::FileError with the writer's reason
 */
void WriteMeshFile(vtkDataObject* mesh, vtkDataObject* interfaces, int content,
  const std::string& path, const io::WholeFiles& files, int slab = -1, bool compress = true);

/** Moves all files to their places. @throws io::OutputError */
void CommitFiles(io::WholeFiles& files);

} // namespace voxplex::cli

#endif
