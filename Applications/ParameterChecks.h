// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParameterChecks.h
 * @brief Whether parameters go together, and with the image.
 */
#ifndef voxplex_cli_ParameterChecks_h
#define voxplex_cli_ParameterChecks_h

#include "Parameters.h"

namespace voxplex::cli
{

/**
 * Checks what no single option can tell.
 *
 * @throws UsageError: options that exclude each other or lack another, values that need --force, output names
 * whose extension is not known
 */
void CheckTogether(const Parameters& parameters);

/**
 * Checks what depends on the dimension of the image that is to be meshed, or of the mesh that is there: 3 or 4.
 *
 * @throws UsageError: options and output formats for the other dimension
 */
void CheckDimension(const Parameters& parameters, int dimension);

} // namespace voxplex::cli

#endif
