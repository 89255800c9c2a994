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

#include <string>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace voxplex::cli
{

/** What a file holds. */
enum class Content
{
  Mesh,       ///< tetrahedra with labels (--output)
  Interfaces, ///< triangles between labels (--plc)
  Statistics  ///< --stats
};

/** Both outputs of vtkImageToTetMeshFilter; neither is null. */
struct MeshData
{
  vtkUnstructuredGrid* Tetrahedra;
  vtkPolyData* Interfaces;
  std::string Space; ///< "LPS" or "RAS"
};

/** Writes a whole file. @throws RunError */
using WriteFunction = void (*)(const MeshData& mesh, const std::string& path);

/** The extensions that content can be written to, as a phrase: ".vtu, .vtk or .mesh". */
std::string ListExtensions(Content content);

/**
 * Checks the extension of a file name; the case of letters does not matter.
 *
 * @param option the command line option that the name was given with
 * @throws UsageError: the extension is not known, or is that of another content
 */
void RequireFormat(const std::string& option, const std::string& path, Content content);

/** The writer of a mesh or its interfaces; the name must have passed RequireFormat(). */
WriteFunction FindWriter(const std::string& path, Content content);

} // namespace voxplex::cli

#endif
