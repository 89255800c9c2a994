// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelSelection.h
 * @brief What --labels and --label-size say, once the names of the labels are known.
 */
#ifndef voxplex_cli_LabelSelection_h
#define voxplex_cli_LabelSelection_h

#include "LabelTable.h"
#include "Parameters.h"

#include <cstdint>
#include <map>
#include <vector>

namespace voxplex::cli
{

struct LabelSelection
{
  std::vector<std::int64_t> Labels; ///< to be meshed, sorted, each once; empty means all
  std::map<std::int64_t, double> Sizes;
  /** Of interfaces: the larger label first; the other is AnyLabel where all interfaces of the first are meant. */
  std::map<std::pair<std::int64_t, std::int64_t>, double> InterfaceSizes;
  static constexpr std::int64_t AnyLabel = -1;
  ///@{
  /** For vtkSegmentationRepair. */
  std::map<std::int64_t, double> Thicknesses;
  std::map<std::int64_t, double> Shells;
  ///@}
};

/** Whether a label is given by name, so that the image must be read to know which it is. */
bool HasNames(const Parameters& parameters);

/**
 * Numbers are labels; anything else is the name of one, in which the case of letters matters only if names
 * differ in nothing else. A value of --labels or --interface-size that is as a whole a name, commas included, is
 * that one. In --interface-size 0 is the background.
 *
 * @param table the names in the image
 * @throws UsageError: no label has this name, or several have; a label or an interface is given two sizes, or one
 *   although it is not to be meshed
 */
LabelSelection SelectLabels(const Parameters& parameters, const LabelTable& table);

/** As SelectLabels(), for what is done to the image before: its shells have names afterwards. */
void SelectRepairs(
  const Parameters& parameters, const LabelTable& table, LabelSelection& selection);

} // namespace voxplex::cli

#endif
