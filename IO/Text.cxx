// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Text.h"

#include "LabelTable.h"

#include <algorithm>
#include <array>
#include <utility>

namespace voxplex::io
{
namespace
{

bool IsInsideCharacter(std::string_view text, std::size_t at)
{
  return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
}

} // namespace

std::string Excerpt(std::string_view text, std::size_t longest)
{
  std::string shown(Cut(text, longest));
  const bool isUTF8 = IsUTF8(shown);
  std::replace_if(
    shown.begin(), shown.end(),
    [isUTF8](char letter)
    {
      const auto byte = static_cast<unsigned char>(letter);
      return byte < 0x20 || byte == 0x7F || (byte >= 0x80 && !isUTF8);
    },
    '?');
  return shown.size() < text.size() ? shown + "..." : shown;
}

Character FirstCharacter(std::string_view text)
{
  constexpr std::array<char32_t, 5> smallest{ 0, 0, 0x80, 0x800, 0x10000 };
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC0 ? 2 : 1;
  char32_t code = length == 1 ? first : first & (0x7FU >> length);
  bool isSound = first < 0x80 || (length > 1 && first < 0xF8);
  for (std::size_t i = 1; isSound && i < length; ++i)
  {
    isSound = IsInsideCharacter(text, i);
    code = isSound ? code << 6U | (static_cast<unsigned char>(text[i]) & 0x3FU) : code;
  }
  const bool isSurrogate = code >= 0xD800 && code < 0xE000;
  isSound = isSound && !isSurrogate && code >= smallest[length] && code <= 0x10FFFF;
  return isSound ? Character{ code, length } : Character{ Character::None, 1 };
}

bool IsUTF8(std::string_view text)
{
  while (!text.empty())
  {
    const Character first = FirstCharacter(text);
    if (first.Code == Character::None)
    {
      return false;
    }
    text.remove_prefix(first.Length);
  }
  return true;
}

void LeaveOutOtherTexts(LabelTable& table, std::vector<std::string>& warnings)
{
  std::erase_if(table.Entries,
    [&warnings](const auto& row)
    {
      constexpr char escape = '\x1b'; // ISO 2022 changes the character set with it
      const bool isText =
        IsUTF8(row.second.Name) && row.second.Name.find(escape) == std::string::npos;
      if (!isText)
      {
        warnings.push_back(
          "the name of label " + std::to_string(row.first) + " is not in UTF-8, and is not used");
      }
      return !isText;
    });
}

std::string_view Cut(std::string_view text, std::size_t size)
{
  for (int back = 0; back < 3 && size > 0 && IsInsideCharacter(text, size); ++back)
  {
    --size;
  }
  return text.substr(0, size);
}

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
