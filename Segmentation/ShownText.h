// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShownText.h
 * @brief What messages show of strangers' texts, and whether these are UTF-8. No locale changes the results.
 */
#ifndef voxplex_ShownText_h
#define voxplex_ShownText_h

#include <cstddef>
#include <string>
#include <string_view>

namespace voxplex
{

/**
 * A text from a stranger's file, fit to be shown: at most `longest` bytes. Question marks stand for
 * control characters, which terminals obey, and for bytes that are not UTF-8.
 */
std::string Excerpt(std::string_view text, std::size_t longest = 80);

/** A character of UTF-8. */
struct Character
{
  static constexpr char32_t None =
    0xFFFFFFFF; ///< what is not well-formed, an overlong form or a surrogate
  char32_t Code;
  std::size_t Length; ///< in bytes
};

/** Of a text that is not empty. */
Character FirstCharacter(std::string_view text);

/** Whether a text is well-formed UTF-8, without overlong forms and surrogates. */
bool IsUTF8(std::string_view text);

/** The first bytes of a text, at most `size`, without part of a character at the end. */
std::string_view Cut(std::string_view text, std::size_t size);

} // namespace voxplex

#endif
