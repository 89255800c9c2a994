// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Formats.h
 * @brief The file formats of meshes, chosen by extension.
 *
 * Documentation/FileFormats.md describes what each format holds.
 */
#ifndef voxplex_io_Formats_h
#define voxplex_io_Formats_h

#include <optional>
#include <string>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace voxplex::io
{

/** What a file holds. */
enum class Content
{
  Mesh,      ///< tetrahedra, or pentatopes, with labels
  Interfaces ///< triangles, or tetrahedra, between labels
};

/** Both outputs of vtkImageToTetMeshFilter; neither is null. */
struct MeshData
{
  vtkUnstructuredGrid* Tetrahedra;
  vtkPolyData* Interfaces;
  std::string Space;    ///< "LPS" or "RAS"
  bool Compress = true; ///< .vtu and .vtp files
};

/** Both outputs of vtkImageToPentatopeMeshFilter; neither is null. */
struct SpaceTimeMeshData
{
  vtkUnstructuredGrid* Pentatopes;
  vtkUnstructuredGrid* Boundary;
  std::string Space;    ///< "LPS" or "RAS"
  int Slab = -1;        ///< the only slab to write; -1: the whole mesh
  bool Compress = true; ///< .vtu files
};

/** The extension of a file name in lower case, with its dot; empty if it has none. */
std::string ExtensionOf(const std::string& path);

/**
 * Whether there is a format with this extension for this content.
 *
 * @param extension as ExtensionOf() gives it
 * @param dimension of the mesh, 3 or 4; missing as long as it is not known
 */
bool HasFormat(const std::string& extension, Content content, std::optional<int> dimension);

/**
 * The second file of a format that has two: "folder/mesh.h5" for "folder/mesh.xdmf". Empty for the
 * others.
 */
std::string CompanionOf(const std::string& name);

/** The extensions that content of a 3D or 4D mesh can be written to: ".vtu, .vtk or .mesh". */
std::string ListExtensions(Content content, int dimension);

///@{
/**
 * Writes a mesh or its interfaces.
 *
 * @param name the file's name in the end; its extension chooses the format
 * @param path where to write it for now
 * @param companionPath where to write the file CompanionOf(name), if the format has one
 * @throws FileError: no such format (see HasFormat()), or the file cannot be written
 */
void WriteFile(const MeshData& mesh, Content content, const std::string& name,
  const std::string& path, const std::string& companionPath);
void WriteFile(
  const SpaceTimeMeshData& mesh, Content content, const std::string& name, const std::string& path);
///@}

} // namespace voxplex::io

#endif
