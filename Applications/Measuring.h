// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Measuring.h
 * @brief --quality and --hausdorff: the mesh beside its image.
 */
#ifndef voxplex_cli_Measuring_h
#define voxplex_cli_Measuring_h

#include "Meshing.h"
#include "Parameters.h"

#include <nlohmann/json.hpp>

#include <string>

class vtkSimplexMeshQuality;
class vtkUnstructuredGrid;

namespace voxplex::cli
{

/** What measures a mesh as `parameters` ask for. It has no input yet. */
vtkSmartPointer<vtkSimplexMeshQuality> MakeQualityFilter(
  const Parameters& parameters, const LabelSelection& selection);

/**
 * Executes it.
 * @return its ToJSON(); null if progress stopped it
 * @throws RunError if the mesh cannot be measured
 */
nlohmann::ordered_json Execute(vtkSimplexMeshQuality* filter, const ProgressFunction& progress);

/**
 * Measures a mesh of tetrahedra as `parameters` ask for, against the image that it was made from.
 *
 * @param progress as for Mesh()
 * @return what vtkSimplexMeshQuality::ToJSON() says; null if progress stopped it
 * @throws RunError if it cannot be measured
 */
nlohmann::ordered_json Measure(const Parameters& parameters, const MeshingInput& input,
  vtkUnstructuredGrid* mesh, const ProgressFunction& progress);

/** Adds what was measured to the report: "topology", "image", "hausdorff", and more about "labels". */
void AddMeasurement(const nlohmann::ordered_json& measurement, nlohmann::ordered_json& report);

/** Lines for people, of a report to which a measurement was added. */
std::string SummarizeMeasurement(const nlohmann::ordered_json& report);

} // namespace voxplex::cli

#endif
