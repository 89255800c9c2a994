// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Text.h
 * @brief Words and numbers in the texts of files. No locale changes the results.
 */
#ifndef voxplex_io_Text_h
#define voxplex_io_Text_h

#include "ShownText.h"

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace voxplex::io
{

/** For text and for values between double quotation marks: `&amp;`, `&lt;`, `&gt;`, `&quot;`. */
std::string EscapeForXML(std::string_view text);

/** Of ASCII letters. */
std::string LowerCase(std::string text);

std::string_view Trim(std::string_view text, std::string_view blanks = " \t\r\n");

/** What blanks separate. The words are parts of the text. */
std::vector<std::string_view> Words(std::string_view text, std::string_view blanks = " \t\r\n\v\f");

/** What a separator separates, without blanks around it. */
std::vector<std::string> Split(std::string_view text, char separator);

/** All of a text as a number, which a plus may precede. */
template <typename T>
std::optional<T> ToNumber(std::string_view text)
{
  text.remove_prefix(text.starts_with('+') ? 1 : 0);
  T number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool isWhole = error == std::errc() && end == text.data() + text.size();
  return isWhole ? std::optional<T>(number) : std::nullopt;
}

} // namespace voxplex::io

#endif
