// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CaretLabels.h
 * @brief The table of labels in an extension of a NIfTI header: XML of Connectome Workbench, which TotalSegmentator writes, too.
 */
#ifndef voxplex_io_CaretLabels_h
#define voxplex_io_CaretLabels_h

#include "LabelTable.h"

#include <string>
#include <string_view>

namespace voxplex::io
{

/**
 * The names and colours of the first volume.
 *
 * @param text of one extension
 * @return empty if it is of another kind
 * @throws FileError: XML that is not well-formed, keys that are no numbers
 */
LabelTable ParseCaretLabels(std::string_view text);

} // namespace voxplex::io

#endif
