// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Meshing.h
 * @brief Runs the meshing filter for an image's dimension on what was read.
 */
#ifndef voxplex_cli_Meshing_h
#define voxplex_cli_Meshing_h

#include "Parameters.h"
#include "ScalarImage.h"

#include <vtkSmartPointer.h>

#include <functional>
#include <optional>
#include <string>

class vtkImageToSimplexMeshFilter;

namespace voxplex::cli
{

struct MeshingInput
{
  ScalarImage Labels;
  std::optional<ScalarImage> Sizes;
};

/** Called now and then with the fraction done and the name of the step; returning false cancels. */
using ProgressFunction = std::function<bool(double fraction, const std::string& step)>;

/**
 * Meshes an image in the space that the parameters ask for: with vtkImageToTetMeshFilter, or with
 * vtkImageToPentatopeMeshFilter if it has several frames. Both outputs of the returned filter carry
 * the field-data array SPACE; its statistics include quality.
 *
 * @return null if cancelled
 * @throws RunError with the filter's reason
 */
vtkSmartPointer<vtkImageToSimplexMeshFilter> Mesh(
  const Parameters& parameters, const MeshingInput& input, const ProgressFunction& progress);

} // namespace voxplex::cli

#endif
