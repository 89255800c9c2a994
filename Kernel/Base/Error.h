// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Error.h
 * @brief What the kernel throws.
 *
 * The kernel never prints, exits or aborts. Whatever is wrong with the input is an Error whose
 * message says what is wrong, where, and what to do; callers (filters, command line) show it.
 */
#ifndef voxplex_Error_h
#define voxplex_Error_h

#include <exception>
#include <stdexcept>
#include <string>

namespace voxplex
{

/** Base of everything that the kernel throws on purpose. */
class Error : public std::runtime_error
{
public:
  explicit Error(const std::string& what)
    : std::runtime_error(what)
  {
  }
};

/** The image or a parameter cannot be meshed as it is. */
class InputError : public Error
{
public:
  using Error::Error;
};

/**
 * The mesh that was asked for is estimated not to fit in memory; MeshingOptions::Force overrides.
 */
class TooLargeError : public Error
{
public:
  using Error::Error;
};

/**
 * A run was cancelled: thrown inside the kernel, by whatever was given a std::stop_token of which a
 * stop was requested. Nothing is wrong, so it is no Error; it never leaves ImageMesher::Run(),
 * which returns MeshingOutcome::Cancelled instead.
 */
class Cancelled : public std::exception
{
public:
  const char* what() const noexcept override { return "the run was cancelled"; }
};

} // namespace voxplex

#endif
