// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LibraryMessages.h
 * @brief Keeps ITK and the libraries below it from printing.
 */
#ifndef voxplex_io_LibraryMessages_h
#define voxplex_io_LibraryMessages_h

#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace voxplex::io
{

/**
 * While one lives, ITK's warnings are collected, and so is what libraries below ITK write to
 * standard error by themselves.
 *
 * Both belong to the process. One object lives at a time: a second thread waits in the constructor until
 * the first one's is gone, and what any other thread writes to standard error meanwhile is collected, too,
 * and not shown. The window for ITK's messages that was there before is put back.
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
  class PreviousWindow;

  std::unique_lock<std::mutex> Turn;
  std::unique_ptr<PreviousWindow> Previous; ///< ITK's window for messages
  int StandardError = -1;                   ///< a duplicate of the real one
  std::FILE* Printed = nullptr;             ///< what stands in its place
};

} // namespace voxplex::io

#endif
