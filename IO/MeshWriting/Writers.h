// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Writers.h
 * @brief One function a format and dimension, in source files named after programs and formats.
 *
 * All of them write the file whole or throw FileError. Vertices and elements are numbered in the
 * order of the mesh's points and cells, from 0 in VTK's formats, MFEM's and XDMF and from 1 in the
 * others, so that the files of one run agree. Coordinates are written so that reading gives the same double again,
 * except for .stl and .ply, which hold single precision.
 */
#ifndef voxplex_io_Writers_h
#define voxplex_io_Writers_h

#include "Formats.h"

namespace voxplex::io
{

void WriteVTU(const MeshData& mesh, const std::string& path);
void WriteVTP(const MeshData& mesh, const std::string& path);
void WriteInterfacesVTU(const MeshData& mesh, const std::string& path);
void WriteLegacyVTKMesh(const MeshData& mesh, const std::string& path);
void WriteLegacyVTKInterfaces(const MeshData& mesh, const std::string& path);
void WriteSTL(const MeshData& mesh, const std::string& path);
void WritePLY(const MeshData& mesh, const std::string& path);
void WriteMEDIT(const MeshData& mesh, const std::string& path);
void WriteGmsh(const MeshData& mesh, const std::string& path);
void WriteAbaqus(const MeshData& mesh, const std::string& path);
void WriteFEBio(const MeshData& mesh, const std::string& path);
void WriteMFEM(const MeshData& mesh, const std::string& path);

/**
 * @param heavyName the name that the .h5 file will have; its folder is that of the .xdmf file
 * @param heavyPath where to write the .h5 file
 */
void WriteXDMF(const MeshData& mesh, const std::string& path, const std::string& heavyName,
  const std::string& heavyPath);

void WriteSpaceTimeVTU(const SpaceTimeMeshData& mesh, const std::string& path);
void WriteSpaceTimeBoundaryVTU(const SpaceTimeMeshData& mesh, const std::string& path);
void WriteSpaceTimeMFEM(const SpaceTimeMeshData& mesh, const std::string& path);
void WriteGMF(const SpaceTimeMeshData& mesh, const std::string& path);

/** Any grid as a .vtu file. */
void WriteGrid(vtkUnstructuredGrid* grid, bool compress, const std::string& path);

} // namespace voxplex::io

#endif
