// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Errors.h
 * @brief The two ways in which the program ends badly, each with a one-line message for the user.
 */
#ifndef voxplex_cli_Errors_h
#define voxplex_cli_Errors_h

#include <stdexcept>

namespace voxplex::cli
{

/** Exit statuses of the program; after a signal it is 128 + the signal's number. */
enum ExitStatus
{
  ExitSuccess = 0,
  ExitFailure = 1, ///< the input or the processing failed (RunError)
  ExitUsage = 2    ///< the command line is wrong (UsageError)
};

/** The command line is wrong. */
class UsageError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/** The input cannot be meshed, or the output cannot be written. */
class RunError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

} // namespace voxplex::cli

#endif
