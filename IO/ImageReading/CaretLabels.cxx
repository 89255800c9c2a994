// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "CaretLabels.h"

#include "FileError.h"
#include "Text.h"
#include "XMLParser.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

namespace voxplex::io
{
namespace
{

/** Red, green and blue of 0 to 1. */
std::optional<std::array<double, 3>> ColorOf(const TextFields& attributes)
{
  std::array<double, 3> color;
  for (std::size_t i = 0; i < 3; ++i)
  {
    constexpr std::array<const char*, 3> names{ "Red", "Green", "Blue" };
    color[i] = ToNumber<double>(TextOf(attributes, names[i])).value_or(-1.0);
  }
  const auto [least, most] = std::ranges::minmax(color);
  return least >= 0.0 && most <= 1.0 ? std::optional(color) : std::nullopt;
}

} // namespace

LabelTable ParseCaretLabels(std::string_view text)
{
  text = Trim(text, std::string_view(" \t\r\n\0", 5)); // what fills up the extension
  if (text.find("<CaretExtension") == text.npos)
  {
    return {};
  }
  LabelTable table;
  LabelTable::Entry entry;
  std::optional<std::int64_t> label; ///< of the element that is open
  std::size_t volumes = 0;
  XMLParser parser({
    [&](std::string_view name, const TextFields& attributes)
    {
      volumes += name == "VolumeInformation";
      label.reset();
      if (name == "Label" && volumes == 1)
      {
        label = ToNumber<std::int64_t>(TextOf(attributes, "Key"));
        RefuseIf(!label, "a label has the key '", Excerpt(TextOf(attributes, "Key")), "'");
        entry = { "", ColorOf(attributes) };
      }
    },
    [&]
    {
      entry.Name = Trim(entry.Name);
      if (label.value_or(0) > 0 && !entry.Name.empty())
      {
        table.Entries[*label] = entry;
      }
      label.reset();
    },
    [&](std::string_view part) { entry.Name.append(label ? part : ""); },
  });
  if (!parser.Parse(text, true))
  {
    RefuseIf(parser.HasDocumentType(), "it has a document type");
    Refuse(parser.Error());
  }
  return table;
}

} // namespace voxplex::io
