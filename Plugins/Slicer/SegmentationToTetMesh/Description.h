// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Description.h
 * @brief The module's description in XML, as the Slicer Execution Model wants it.
 */
#ifndef voxplex_slicer_Description_h
#define voxplex_slicer_Description_h

#include <string>

namespace voxplex::slicer
{

/** What the module and its executable are called. */
inline constexpr const char* ModuleName = "SegmentationToTetMesh";

/** One sentence about it. */
extern const char* const ModuleSummary;

/**
 * From the table of parameters. Begins with `<?xml`; elements come in the order of
 * ModuleDescription.xsd of the Slicer Execution Model.
 */
std::string DescribeModule();

} // namespace voxplex::slicer

#endif
