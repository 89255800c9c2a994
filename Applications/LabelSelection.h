// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelSelection.h
 * @brief The labels that parameters name, once the names of the labels are known.
 */
#ifndef voxplex_cli_LabelSelection_h
#define voxplex_cli_LabelSelection_h

#include "LabelTable.h"
#include "Parameters.h"

namespace voxplex::cli
{

/** Whether a label is given by name, so that the image must be read to know which it is. */
bool HasNames(const Parameters& parameters);

/**
 * Numbers are labels; anything else is the name of one, in which the case of letters matters only if names
 * differ in nothing else. A value of --labels or --interface-size that is as a whole a name, commas included, is
 * that one. In --interface-size 0 is the background.
 *
 * @param table the names in the image
 * @return values of the parameters that have labels; those of repair, whose shells have names afterwards, are apart
 * @throws UsageError: no label has this name, or several have; a label or an interface is given two sizes, or one
 *   although it is not to be meshed
 */
ParameterValues SelectLabels(const Parameters& parameters, const LabelTable& table);
ParameterValues SelectRepairs(const Parameters& parameters, const LabelTable& table);

} // namespace voxplex::cli

#endif
