// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Refuse.h
 * @brief How images and files are refused.
 */
#ifndef voxplex_Refuse_h
#define voxplex_Refuse_h

#include "Base/Error.h"

#include <locale>
#include <sstream>

namespace voxplex
{

/** Throws an InputError with these texts and numbers. A decimal comma of the host's does not change it. */
template <typename... TParts>
[[noreturn]] void Refuse(const TParts&... parts)
{
  std::ostringstream message;
  message.imbue(std::locale::classic());
  (message << ... << parts);
  throw InputError(message.str());
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

} // namespace voxplex

#endif
