// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Measuring.h
 * @brief --quality and --hausdorff: the mesh, beside its image if there is one.
 */
#ifndef voxplex_cli_Measuring_h
#define voxplex_cli_Measuring_h

#include "Meshing.h"
#include "Parameters.h"

#include <nlohmann/json.hpp>

#include <string>

class vtkUnstructuredGrid;

namespace voxplex::cli
{

/**
 * Measures a mesh as `parameters` ask for, beside the image that it was made from, if there is one; one of pentatopes
 * also by its cuts at the times of the frames.
 *
 * @param progress as for Mesh()
 * @return what vtkSimplexMeshQuality::ToJSON() says; null if progress stopped it
 * @throws RunError if it cannot be measured
 */
nlohmann::ordered_json Measure(const Parameters& parameters, const MeshingInput& input,
  vtkUnstructuredGrid* mesh, const ProgressFunction& progress);

/**
 * Adds what was measured to the report: "image", more about "labels", and "topology" and "hausdorff", or of pentatopes
 * "worst_elements" and "frames".
 */
void AddMeasurement(const nlohmann::ordered_json& measurement, nlohmann::ordered_json& report);

/** Lines for people, of a measurement, or of a report to which one was added. */
std::string SummarizeMeasurement(const nlohmann::ordered_json& report);

} // namespace voxplex::cli

#endif
