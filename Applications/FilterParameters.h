// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** @file FilterParameters.h @brief From the values of parameters to the properties of the filters. */
#ifndef voxplex_cli_FilterParameters_h
#define voxplex_cli_FilterParameters_h

#include "MeshingParameters.h"

class vtkImageToSimplexMeshFilter;

namespace voxplex::cli
{

/** Sets what the values say, which are for images of the filter's dimension; lists of labels and sizes are left to the caller. */
void SetParameters(vtkImageToSimplexMeshFilter* filter, const ParameterValues& values);

} // namespace voxplex::cli

#endif
