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
 * Cuts the mesh at the time of each frame, splits the cut into tetrahedra, and measures it beside the
 * frame. The result is a list with an object for each frame: its time and what
 * vtkSimplexMeshQuality::ToJSON() has. Returns null if cancelled.
 * @throws RunError
 */
nlohmann::ordered_json MeasureFrames(const Parameters& parameters, const MeshingInput& input,
  vtkUnstructuredGrid* mesh, const ProgressFunction& progress);

/**
 * Adds what was measured to the report: "frames", and of "labels" the hypervolume in the image.
 */
void AddFrames(nlohmann::ordered_json frames, nlohmann::ordered_json& report);

/** Lines for people, of a report to which frames were added. */
std::string SummarizeFrames(const nlohmann::ordered_json& report);

} // namespace voxplex::cli

#endif
