// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ExecutionModel.h
 * @brief The program as a CLI module of 3D Slicer, by the Slicer Execution Model.
 *
 * An application asks for a description (--xml), makes a panel of it, and runs the program with all its flags. Dashes in
 * flags are underscores there. --returnparameterfile tells the program that it runs so.
 */
#ifndef voxplex_cli_ExecutionModel_h
#define voxplex_cli_ExecutionModel_h

#include "MeshingParameters.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace voxplex::io
{
class WholeFiles;
}

namespace voxplex::cli
{

/** The option that names the file of results, without dashes. */
constexpr const char* ResultsOption = "returnparameterfile";

/** `voxplex mesh` as XML: files, and the parameters of the table that 3D Slicer has a name for. */
std::string DescribeModule();

/**
 * Whether an application means no value: it gives every number and word, as the description has it by default, 0 for
 * a number that may be absent.
 */
bool IsLeftAsDescribed(const MeshingParameter& parameter, std::string_view text);

/**
 * Writes lines `name = value` for the results in the description. What was not measured has none.
 *
 * @param report see MakeReport()
 * @throws io::OutputError
 */
void WriteResults(
  const nlohmann::ordered_json& report, const std::string& path, const io::WholeFiles& files);

} // namespace voxplex::cli

#endif
