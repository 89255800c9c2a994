// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeasuringFrames.h
 * @brief --quality and --hausdorff of a space-time mesh: its cuts beside the frames of the image.
 */
#ifndef voxplex_cli_MeasuringFrames_h
#define voxplex_cli_MeasuringFrames_h

#include "Meshing.h"
#include "Parameters.h"

#include <nlohmann/json.hpp>

#include <string>

class vtkUnstructuredGrid;

namespace voxplex::cli
{

/**
 * Measures the mesh and its cuts at the times of the frames, beside the frames.
 * @return what vtkSimplexMeshQuality::ToJSON() says; null if progress stopped it
 * @throws RunError if it cannot be measured
 */
nlohmann::ordered_json MeasureFrames(const Parameters& parameters, const MeshingInput& input,
  vtkUnstructuredGrid* mesh, const ProgressFunction& progress);

/**
 * Adds what was measured to the report: "worst_elements", "image", "frames", and more about "labels".
 */
void AddFrames(const nlohmann::ordered_json& measurement, nlohmann::ordered_json& report);

/** Lines for people, of a report to which frames were added. */
std::string SummarizeFrames(const nlohmann::ordered_json& report);

} // namespace voxplex::cli

#endif
