// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** @file Program.h @brief The program voxplex, for its own main() and for that of 3D Slicer's module. */
#ifndef voxplex_cli_Program_h
#define voxplex_cli_Program_h

namespace voxplex::cli
{

/**
 * Does what a command line says, as Documentation/Reference.md describes it. Once in a process: it installs handlers of
 * signals, and a signal ends the process.
 *
 * @return the exit status
 */
int RunProgram(int argc, const char* const* argv);

} // namespace voxplex::cli

#endif
