// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Errors.h
 * @brief The ways in which the program ends badly, each with a message for the user. That of files is io::FileError.
 */
#ifndef voxplex_cli_Errors_h
#define voxplex_cli_Errors_h

#include <stdexcept>
#include <string>
#include <utility>

namespace voxplex::cli
{

/** Exit statuses of the program; after a signal it is 128 + the signal's number. */
enum ExitStatus
{
  ExitSuccess = 0,
  ExitFailure = 1, ///< the image cannot be meshed, repaired or measured (RunError)
  ExitUsage = 2,   ///< the command line is wrong (UsageError)
  ExitFile = 3     ///< a file cannot be read or written (io::FileError)
};

/** The command line is wrong. */
class UsageError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/** The image cannot be meshed, repaired or measured. */
class RunError : public std::runtime_error
{
public:
  /** @param doing such as "cannot mesh 'knee.nrrd'" */
  RunError(std::string doing, const std::string& why)
    : std::runtime_error(why)
    , Doing(std::move(doing))
  {
  }

  const std::string Doing;
};

} // namespace voxplex::cli

#endif
