// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Meshing.h
 * @brief Runs the meshing filter for an image's dimension on what was read.
 */
#ifndef voxplex_cli_Meshing_h
#define voxplex_cli_Meshing_h

#include "FilterParameters.h"
#include "Parameters.h"

#include <vtkSmartPointer.h>

#include <vector>

class vtkImageToSimplexMeshFilter;
class vtkAlgorithmOutput;
class vtkImageData;
class vtkSegmentationReader;
class vtkSegmentationRepair;

namespace voxplex::cli
{

/** Readers that have read their files. */
struct MeshingInput
{
  vtkSmartPointer<vtkSegmentationReader> Labels; ///< null if there is only a mesh
  vtkSmartPointer<vtkSegmentationRepair>
    Repair; ///< of Labels; null if nothing is repaired or checked
  vtkSmartPointer<vtkSegmentationReader> Sizes; ///< null if there is no image of sizes
  ParameterValues Selection;                    ///< what has labels, see SelectLabels()

  int Dimension() const; ///< 4 if there are several frames, else 3
  std::vector<double> TimesOfFrames() const;
  ///@{
  /** The image as it is meshed. */
  vtkAlgorithm* Source() const;
  vtkImageData* Image() const;
  ///@}
};

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
