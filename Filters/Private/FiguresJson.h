// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FiguresJson.h
 * @brief What is known of runs, in JSON; the keys are documented in Documentation/Reference.md.
 *
 * Sources with vtkDataArray.h cannot include it: the VTK of ParaView 5.13 renames its copy of the same library.
 */
#ifndef voxplex_FiguresJson_h
#define voxplex_FiguresJson_h

#include "Image/DropComponents.h"
#include "Mesher/MeshingStatistics.h"
#include "Quality/MeshQuality.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <vector>

namespace voxplex
{

/** All figures of a run. */
nlohmann::ordered_json FiguresToJson(const MeshingStatistics& figures);

/** The object "quality". */
nlohmann::ordered_json QualityToJson(const MeshQuality& quality);

/** A list of what describe() makes of each item. */
template <typename Items, typename Describe>
nlohmann::ordered_json ListToJson(const Items& items, Describe&& describe)
{
  auto list = nlohmann::ordered_json::array();
  for (const auto& item : items)
  {
    list.push_back(describe(item));
  }
  return list;
}

/** An object with label, voxels and the index of a voxel. */
nlohmann::ordered_json ComponentToJson(const ComponentReport& component);
nlohmann::ordered_json ComponentsToJson(const std::vector<ComponentReport>& components);

/**
 * Appends the figures of a label, which must not be there yet. operator[] would compare the new key
 * with all others: 10 s for 60,000 labels, instead of 0.1 s.
 */
void AppendLabel(
  nlohmann::ordered_json& labels, std::int64_t label, nlohmann::ordered_json figures);

} // namespace voxplex

#endif
