// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ShownText.h"

#include <algorithm>
#include <array>

namespace voxplex
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

std::string_view Cut(std::string_view text, std::size_t size)
{
  for (int back = 0; back < 3 && size > 0 && IsInsideCharacter(text, size); ++back)
  {
    --size;
  }
  return text.substr(0, size);
}

} // namespace voxplex
