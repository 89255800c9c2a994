// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Text.h"

#include <algorithm>
#include <array>
#include <utility>

namespace voxplex::io
{

std::string EscapeForXML(std::string_view text)
{
  constexpr std::array<std::pair<char, std::string_view>, 4> escapes{ { { '&', "&amp;" },
    { '<', "&lt;" }, { '>', "&gt;" }, { '"', "&quot;" } } };
  std::string escaped;
  for (const char character : text)
  {
    const auto escape = std::find_if(escapes.begin(), escapes.end(),
      [character](const auto& one) { return one.first == character; });
    escaped += escape == escapes.end() ? std::string_view(&character, 1) : escape->second;
  }
  return escaped;
}

std::string LowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

std::string_view Trim(std::string_view text, std::string_view blanks)
{
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

std::vector<std::string_view> Words(std::string_view text, std::string_view blanks)
{
  std::vector<std::string_view> words;
  for (std::size_t at = 0; (at = text.find_first_not_of(blanks, at)) != text.npos;)
  {
    const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

std::vector<std::string> Split(std::string_view text, char separator)
{
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < text.size();)
  {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    parts.emplace_back(Trim(text.substr(at, end - at)));
    at = end + 1;
  }
  return parts;
}

} // namespace voxplex::io
