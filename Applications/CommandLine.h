// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CommandLine.h
 * @brief From argv to Parameters.
 */
#ifndef voxplex_cli_CommandLine_h
#define voxplex_cli_CommandLine_h

#include "Parameters.h"

#include <optional>
#include <string>

namespace voxplex::cli
{

/** Either parameters to run with, or a text (of --help or --version) to print and be done. */
struct CommandLine
{
  std::optional<Parameters> Run;
  std::string Text;
};

/**
 * Parses and checks everything that can be checked without touching the file system.
 *
 * @throws UsageError: unknown, misspelt, repeated or incomplete options; values that are not
 * numbers or out of range; output names whose extension is not known
 */
CommandLine ParseCommandLine(int argc, const char* const* argv);

/** Whose words --messages asks for. Other options may be wrong. */
UserInterface WordsOf(int argc, const char* const* argv);

} // namespace voxplex::cli

#endif
