// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeasuringFrames.h
 * @brief What --quality and --hausdorff print of a space-time mesh: its cuts beside the frames of the image.
 */
#ifndef voxplex_cli_MeasuringFrames_h
#define voxplex_cli_MeasuringFrames_h

#include <nlohmann/json.hpp>

#include <string>

namespace voxplex::cli
{

/** Lines for people, of a report to which frames were added. */
std::string SummarizeFrames(const nlohmann::ordered_json& report);

} // namespace voxplex::cli

#endif
