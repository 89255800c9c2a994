// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file QualityJson.h
 * @brief What is measured of meshes, in JSON; the keys are documented in Documentation/Reference.md.
 */
#ifndef voxplex_QualityJson_h
#define voxplex_QualityJson_h

#include "Image/DropComponents.h"
#include "Private/JsonWriter.h"
#include "Quality/MeshMeasurement.h"
#include "Quality/MeshQuality.h"

#include <string>
#include <vector>

namespace voxplex
{

/** An object "quality". */
void AddQuality(JsonWriter& json, const MeshQuality& quality);

/** A list of objects with label, voxels and the index of a voxel. */
void AddComponents(
  JsonWriter& json, const std::string& name, const std::vector<ComponentReport>& components);

/** Objects "labels", "quality", "topology", and if there was an image "image" and "hausdorff". */
void AddMeasurement(JsonWriter& json, const MeshMeasurement& measurement);

} // namespace voxplex

#endif
