// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NumberText.h
 * @brief Formats numbers for messages.
 */
#ifndef voxplex_NumberText_h
#define voxplex_NumberText_h

#include <cstdio>
#include <string>

namespace voxplex
{

/** The number as text, with at most `digits` significant digits. */
inline std::string NumberText(double x, int digits = 6)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.*g", digits, x);
  return text;
}

} // namespace voxplex

#endif
