// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WriteVtu.h
 * @brief A mesh as a file that the measuring programs read.
 */
#ifndef voxplex_WriteVtu_h
#define voxplex_WriteVtu_h

#include "Mesh/SimplexMesh.h"

#include <string>

namespace voxplex::benchmarks
{

/**
 * Points, tetrahedra and the cell array Label as VTK's XML file with appended binary data, not compressed;
 * on machines with the lowest byte first.
 * @throws std::runtime_error if it cannot be written
 */
void WriteVtu(const SimplexMesh<3>& mesh, const std::string& fileName);

} // namespace voxplex::benchmarks

#endif
