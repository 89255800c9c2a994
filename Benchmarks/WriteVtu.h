// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WriteVtu.h
 * @brief Writes a mesh to a file that the measuring programs can read.
 */
#ifndef voxplex_WriteVtu_h
#define voxplex_WriteVtu_h

#include "Mesh/SimplexMesh.h"

#include <string>

namespace voxplex::benchmarks
{

/**
 * Writes points, tetrahedra and the cell array Label as a VTK XML file with appended, uncompressed
 * binary data. For little-endian machines.
 * @throws std::runtime_error if the file cannot be written
 */
void WriteVtu(const SimplexMesh<3>& mesh, const std::string& fileName);

} // namespace voxplex::benchmarks

#endif
