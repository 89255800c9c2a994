// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSimplexMeshWriter
 * @brief   writes what the meshing filters make, in the formats of solvers and of visualization
 *
 * @par Input
 * - Port 0: the mesh, output 0 of vtkImageToTetMeshFilter or vtkImageToPentatopeMeshFilter: a
 *   vtkUnstructuredGrid of tetrahedra, or of pentatopes (`VTK_POLY_VERTEX` of 5 points), with the cell
 *   array `Label`. For .vtu any grid will do.
 * - Port 1, optional: the interfaces, output 1 of the same filter: a vtkPolyData of triangles, or for
 *   pentatopes a vtkUnstructuredGrid of tetrahedra, with the cell array `Labels` and the point array
 *   `PointIds`. Formats that hold sets of facets beside the mesh leave them out if there are none.
 *
 * Port 0 may be left empty if Content is CONTENT_INTERFACES.
 *
 * @par Output
 * One file; for .xdmf, which keeps its numbers in HDF5, two, see CompanionOf(). The extension of the name,
 * in small or capital letters, chooses the format; see ListExtensions(), and
 * Documentation/FileFormats.md for what each holds. Coordinates are written so that reading them gives the
 * same numbers, except for .stl and .ply, which hold single precision. Names of labels and the coordinate system are
 * bytes in .vtu and .vtk files of meshes, and strings in the others of VTK's.
 *
 * The file appears whole or not at all: it is written beside its place under a temporary hidden name,
 * which is then changed. If something goes wrong before, an older file of the same name stays as it was. Of two
 * files the second, the numbers, is moved to its place first, when an older first one is gone: both are never of
 * two meshes. A symbolic link is followed and stays. A file that is replaced keeps its permissions; a write-protected
 * one is not replaced.
 *
 * @par Errors
 * Write() returns 0, reports with vtkErrorMacro and sets the error code; GetErrorMessage() keeps the
 * reason: no or another extension than those for the content and dimension, a missing array or cells of other
 * types, a label that does not fit the format, a slab that is not there, a folder that does not exist or takes no
 * files, a full disk.
 *
 * @par Thread safety
 * Distinct instances may write distinct files at the same time.
 */
#ifndef vtkSimplexMeshWriter_h
#define vtkSimplexMeshWriter_h

#include "vtkVoxplexIOModule.h" // For export macro
#include "vtkWriter.h"

#include <string> // For std::string

class VTKVOXPLEXIO_EXPORT vtkSimplexMeshWriter : public vtkWriter
{
public:
  ///@{
  /** Construction, type information and printing, as in all VTK classes. */
  static vtkSimplexMeshWriter* New();
  vtkTypeMacro(vtkSimplexMeshWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  /** What goes into the file. */
  enum
  {
    CONTENT_MESH = 0,      ///< tetrahedra or pentatopes
    CONTENT_INTERFACES = 1 ///< triangles, or tetrahedra of space-time, between labels
  };

  ///@{
  /** The file to write. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /** CONTENT_MESH (default) or CONTENT_INTERFACES. */
  vtkSetClampMacro(Content, int, CONTENT_MESH, CONTENT_INTERFACES);
  vtkGetMacro(Content, int);
  ///@}

  ///@{
  /**
   * The number of the only slab to write, of a pentatope mesh with time planes, from 0 on; -1 (default): the
   * whole mesh. The file has the points that the slab uses, and their numbers in the whole mesh. With the
   * interfaces at port 1, numbers of surfaces are those of the whole mesh.
   */
  vtkSetClampMacro(Slab, int, -1, VTK_INT_MAX);
  vtkGetMacro(Slab, int);
  ///@}

  ///@{
  /**
   * Whether .vtu and .vtp files are compressed. Default on. Without compression they are larger, and faster to
   * write and to read.
   */
  vtkSetMacro(Compress, bool);
  vtkGetMacro(Compress, bool);
  vtkBooleanMacro(Compress, bool);
  ///@}

  ///@{
  /**
   * For programs that move several files to their places at once: where to write what is to become FileName,
   * which still chooses the format and stands in messages. The file stays there. Default: none, a hidden
   * name beside FileName, which is then changed.
   */
  vtkSetFilePathMacro(TemporaryFileName);
  vtkGetFilePathMacro(TemporaryFileName);
  ///@}

  ///@{
  /**
   * With TemporaryFileName, for formats of two files: where to write what is to become
   * CompanionOf(FileName). Default: none.
   */
  vtkSetFilePathMacro(TemporaryCompanionFileName);
  vtkGetFilePathMacro(TemporaryCompanionFileName);
  ///@}

  /** @return 1 if the file was written, else 0 */
  int Write() override;

  /** Why the last Write() failed; empty if it did not. */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }

  ///@{
  /**
   * The formats for a content of a mesh of dimension 3 or 4: whether the extension of a file name is that
   * of one (0 stands for either dimension), and their extensions, for people: ".vtu, .vtk or .mesh".
   */
  static bool HasFormat(const std::string& fileName, int content, int dimension);
  static std::string ListExtensions(int content, int dimension);
  ///@}

  /** The second file of a format that has two, "mesh.h5" for "mesh.xdmf"; empty for the others. */
  static std::string CompanionOf(const std::string& fileName);

protected:
  vtkSimplexMeshWriter();
  ~vtkSimplexMeshWriter() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void WriteData() override;

  char* FileName;
  char* TemporaryFileName;
  char* TemporaryCompanionFileName;
  int Content;
  int Slab;
  bool Compress;

private:
  vtkSimplexMeshWriter(const vtkSimplexMeshWriter&) = delete;
  void operator=(const vtkSimplexMeshWriter&) = delete;

  /** Reports that the file cannot be written, and why. */
  void Fail(const std::string& reason);
  void Report(const std::string& error);

  std::string ErrorMessage;
  bool Written = false;
};

#endif
