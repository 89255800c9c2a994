// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NumberText.h
 * @brief Formats numbers for messages.
 */
#ifndef voxplex_NumberText_h
#define voxplex_NumberText_h

#include <array>
#include <charconv>
#include <string>

namespace voxplex
{

/** The number as text, with at most `digits` significant digits. */
inline std::string NumberText(double x, int digits = 6)
{
  std::array<char, 64> text;
  const std::to_chars_result end = std::to_chars(
    text.data(), text.data() + text.size(), x, std::chars_format::general, digits);
  return { text.data(), end.ptr };
}

} // namespace voxplex

#endif
