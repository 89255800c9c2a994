// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingJson.h
 * @brief The figures of a meshing run in JSON; the keys are documented in Documentation/Reference.md.
 */
#ifndef voxplex_MeshingJson_h
#define voxplex_MeshingJson_h

#include "Private/MeshingFigures.h"

#include <nlohmann/json_fwd.hpp>

namespace voxplex
{

nlohmann::ordered_json FiguresToJson(const vtkMeshingStatistics::Figures& figures);

} // namespace voxplex

#endif
