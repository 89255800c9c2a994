// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Excerpt.h"

#include "LabelTable.h"

#include <algorithm>

namespace voxplex::io
{

std::string Excerpt(std::string_view text, std::size_t longest)
{
  std::size_t length = std::min(text.size(), longest);
  const auto isMiddleOfCharacter = [&text](std::size_t at)
  { return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80; };
  for (int back = 0; back < 3 && length > 0 && isMiddleOfCharacter(length); ++back)
  {
    --length;
  }
  std::string shown(text.substr(0, length));
  const bool isUTF8 = IsUTF8(shown);
  std::replace_if(
    shown.begin(), shown.end(),
    [isUTF8](char letter)
    {
      const auto byte = static_cast<unsigned char>(letter);
      return byte < 0x20 || byte == 0x7F || (byte >= 0x80 && !isUTF8);
    },
    '?');
  return length < text.size() ? shown + "..." : shown;
}

} // namespace voxplex::io
