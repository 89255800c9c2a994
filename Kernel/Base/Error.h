// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Error.h
 * @brief The exceptions of the kernel.
 *
 * The kernel never prints, exits or aborts. If the input is wrong, it throws an Error. The message
 * says what is wrong, where it is, and how to correct it. Callers (filters, command line) show it.
 */
#ifndef voxplex_Error_h
#define voxplex_Error_h

#include <exception>
#include <stdexcept>
#include <string>

namespace voxplex
{

/** Base class of all errors that the kernel throws. */
class Error : public std::runtime_error
{
public:
  explicit Error(const std::string& what)
    : std::runtime_error(what)
  {
  }
};

/** The image cannot be meshed, or a parameter is out of range. */
class InputError : public Error
{
public:
  using Error::Error;
};

/**
 * By estimate, the requested mesh does not fit in memory. LimitOptions::Force skips this check.
 */
class TooLargeError : public Error
{
public:
  using Error::Error;
};

/**
 * The run was cancelled. Functions of the kernel throw it if a stop was requested through their
 * std::stop_token. A cancelled run is not a failure, so this class is not an Error. It never leaves
 * ImageMesher::Run(), which returns MeshingOutcome::Cancelled instead.
 */
class Cancelled : public std::exception
{
public:
  const char* what() const noexcept override { return "the run was cancelled"; }
};

} // namespace voxplex

#endif
