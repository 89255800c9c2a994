// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LibraryMessages.h
 * @brief Keeps ITK and the libraries below it from printing.
 */
#ifndef voxplex_cli_LibraryMessages_h
#define voxplex_cli_LibraryMessages_h

#include <cstdio>
#include <string>
#include <vector>

namespace voxplex::cli
{

/**
 * While one lives, ITK's warnings are collected, and so is what libraries below ITK write to
 * standard error by themselves. One at a time, main thread only.
 */
class LibraryMessages
{
public:
  LibraryMessages();
  ~LibraryMessages();
  LibraryMessages(const LibraryMessages&) = delete;
  LibraryMessages& operator=(const LibraryMessages&) = delete;

  /** The collected warnings of ITK, each on one line, each once. */
  std::vector<std::string> Warnings() const;

  /**
   * A line on standard error that tells of missing or damaged data, or an empty string. MetaIO, for
   * one, says so and goes on.
   */
  std::string DamageReport() const;

  /** The line of an ITK message that tells most, without file, line and address. */
  static std::string Summarize(const std::string& message);

private:
  int StandardError = -1;       ///< a duplicate of the real one
  std::FILE* Printed = nullptr; ///< what stands in its place
};

} // namespace voxplex::cli

#endif
