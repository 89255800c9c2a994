// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Formats.h
 * @brief The file formats that the program writes, chosen by extension.
 *
 * Documentation/FileFormats.md describes what each format holds.
 */
#ifndef voxplex_cli_Formats_h
#define voxplex_cli_Formats_h

#include <optional>
#include <string>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace voxplex::cli
{

/** What a file holds. */
enum class Content
{
  Mesh,       ///< tetrahedra, or pentatopes, with labels (--output)
  Interfaces, ///< triangles, or tetrahedra, between labels (--plc)
  Statistics  ///< --stats
};

/** Both outputs of vtkImageToTetMeshFilter; neither is null. */
struct MeshData
{
  vtkUnstructuredGrid* Tetrahedra;
  vtkPolyData* Interfaces;
  std::string Space; ///< "LPS" or "RAS"
};

/** Both outputs of vtkImageToPentatopeMeshFilter; neither is null. */
struct SpaceTimeMeshData
{
  vtkUnstructuredGrid* Pentatopes;
  vtkUnstructuredGrid* Boundary;
  std::string Space; ///< "LPS" or "RAS"
};

/** The extensions that content of a 3D or 4D mesh can be written to: ".vtu, .vtk or .mesh". */
std::string ListExtensions(Content content, int dimension);

/**
 * Checks the extension of a file name; the case of letters does not matter.
 *
 * @param option the command line option that the name was given with
 * @param dimension of the mesh, 3 or 4; missing as long as it is not known
 * @throws UsageError: the extension is not known, or is that of another content or dimension
 */
void RequireFormat(const std::string& option, const std::string& path, Content content,
  std::optional<int> dimension = std::nullopt);

///@{
/**
 * Writes a mesh or its interfaces.
 *
 * @param name chooses the format; it must have passed RequireFormat()
 * @param path where to write
 * @throws RunError
 */
void WriteFile(
  const MeshData& mesh, Content content, const std::string& name, const std::string& path);
void WriteFile(
  const SpaceTimeMeshData& mesh, Content content, const std::string& name, const std::string& path);
///@}

} // namespace voxplex::cli

#endif
