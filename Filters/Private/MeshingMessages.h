// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingMessages.h
 * @brief What the meshing filters refuse, and what they warn of, for InTermsOf() (MeshingParameters.h).
 */
#ifndef voxplex_MeshingMessages_h
#define voxplex_MeshingMessages_h

#include "Mesher/MeshingStatistics.h"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

class vtkFieldData;

namespace voxplex
{

/** Throws InputError unless low <= value <= high; `must` says what it must be. */
void CheckRange(double value, double low, double high, const char* name, const char* must);

/**
 * Throws InputError if the value is not in the range that the table of parameters has.
 * @param name in the table
 * @param force whether limits that Force lifts are lifted
 */
void CheckValue(const char* name, double value, bool force = false);

/** At most 20 labels, separated by commas. */
std::string ListLabels(std::span<const std::int64_t> labels);

/**
 * Throws InputError if a label was given a size but is not among those of the image.
 * @param method by which it was given
 * @param selected whether a part of the image's labels is meshed
 */
void CheckSizedLabels(std::span<const std::int64_t> sized, const std::string& method, bool selected,
  std::span<const std::int64_t> labels);

/** The names that an image's field data (arrays LabelValues, LabelNames) gives to labels. */
std::map<std::int64_t, std::string> LabelNames(vtkFieldData* fields);

/**
 * How the mesh differs from what was asked for, a sentence or two each.
 * @param names of labels
 * @param contentionManager the one that was asked for
 * @param exactComponents whether ExactComponents was asked for: no warning suggests it then
 */
std::vector<std::string> WarningsOf(const MeshingStatistics& run,
  const std::map<std::int64_t, std::string>& names, const std::string& contentionManager,
  bool exactComponents);

} // namespace voxplex

#endif
