// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FileError.h
 * @brief What reading and writing files throws.
 */
#ifndef voxplex_io_FileError_h
#define voxplex_io_FileError_h

#include <locale>
#include <sstream>
#include <stdexcept>

namespace voxplex::io
{

/** A file cannot be read or written; the message has one line, for the user. */
class FileError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/** Throws a FileError with these texts and numbers. A decimal comma of the host's does not change it. */
template <typename... TParts>
[[noreturn]] void Refuse(const TParts&... parts)
{
  std::ostringstream message;
  message.imbue(std::locale::classic());
  (message << ... << parts);
  throw FileError(message.str());
}

/** The same, if something is wrong. All parts are evaluated before, whether it is or not. */
template <typename... TParts>
void RefuseIf(bool isWrong, const TParts&... parts)
{
  if (isWrong)
  {
    Refuse(parts...);
  }
}

} // namespace voxplex::io

#endif
