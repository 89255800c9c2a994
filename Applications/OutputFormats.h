// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OutputFormats.h
 * @brief Checks the extensions of output files.
 */
#ifndef voxplex_cli_OutputFormats_h
#define voxplex_cli_OutputFormats_h

#include <optional>
#include <string>

namespace voxplex::cli
{

/** The options that name output files. */
enum class OutputOption
{
  Output,     ///< --output: tetrahedra or pentatopes
  Interfaces, ///< --plc: triangles or tetrahedra between labels
  Statistics  ///< --stats
};

/** The extensions that an option takes for a 3D or 4D image: ".vtu, .vtk or .mesh". */
std::string ListExtensions(OutputOption option, int dimension);

/**
 * Checks the extension of a file name; the case of letters does not matter.
 *
 * @param dimension of the mesh, 3 or 4; missing as long as it is not known
 * @throws UsageError: the extension is not known, or is that of another option or dimension
 */
void RequireFormat(
  OutputOption option, const std::string& path, std::optional<int> dimension = std::nullopt);

} // namespace voxplex::cli

#endif
