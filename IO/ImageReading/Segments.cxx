// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Segments.h"

#include "Text.h"
#include "TextHeader.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

namespace voxplex::io
{
namespace
{

/** NRRD writes a backslash and a line end as two characters. */
std::string Unescaped(const std::string& text)
{
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    const bool isEscape = text[i] == '\\' && i + 1 < text.size();
    if (isEscape && text[i + 1] == 'n')
    {
      result += ' ';
      ++i;
    }
    else
    {
      i += isEscape && text[i + 1] == '\\';
      result += text[i];
    }
  }
  return result;
}

/** The fields of one segment. */
class Segment
{
public:
  Segment(const TextHeader& header, int number)
    : Header(header)
    , Number(number)
  {
  }

  std::string Name() const
  {
    const std::string* name = this->Find("name");
    return Unescaped(name && !name->empty() ? *name : *this->Find("id"));
  }

  std::int64_t Label() const { return this->Integer("labelvalue", 1); }
  std::int64_t Layer() const { return this->Integer("layer", this->Number); }

  std::optional<std::array<double, 3>> Color() const
  {
    const std::string* color = this->Find("color");
    color = color ? color : this->Find("defaultcolor");
    const std::vector<double> parts = color ? ParseNumbers(*color) : std::vector<double>();
    const bool isColor = parts.size() == 3 &&
      std::all_of(parts.begin(), parts.end(), [](double part) { return part >= 0 && part <= 1; });
    return isColor ? std::optional(std::array<double, 3>{ parts[0], parts[1], parts[2] })
                   : std::nullopt;
  }

private:
  const std::string* Find(const char* key) const
  {
    return this->Header.FindPair("segment" + std::to_string(this->Number) + "_" + key);
  }

  /** 0 if it is not a whole number. */
  std::int64_t Integer(const char* key, std::int64_t missing) const
  {
    const std::string* text = this->Find(key);
    return text ? ToNumber<std::int64_t>(*text).value_or(0) : missing;
  }

  const TextHeader& Header;
  int Number;
};

/** In the order of their numbers, which may have gaps. */
std::vector<Segment> ListSegments(const TextHeader& header)
{
  constexpr std::string_view before = "segment";
  constexpr std::string_view after = "_id";
  std::set<int> numbers;
  for (const auto& [key, value] : header.AllPairs())
  {
    const std::size_t around = before.size() + after.size();
    const bool isSegment = key.starts_with(before) && key.ends_with(after) && key.size() > around;
    const std::optional<int> number = ToNumber<int>(
      isSegment ? std::string_view(key).substr(before.size(), key.size() - around) : "");
    if (number && *number >= 0)
    {
      numbers.insert(*number);
    }
  }
  std::vector<Segment> segments;
  for (const int number : numbers)
  {
    segments.emplace_back(header, number);
  }
  return segments;
}

} // namespace

LabelTable ReadSegments(const TextHeader& header, std::vector<std::string>& warnings)
{
  LabelTable table;
  for (const Segment& segment : ListSegments(header))
  {
    if (segment.Label() <= 0)
    {
      warnings.push_back("the segment '" + Excerpt(segment.Name()) +
        "' has a value that is not a label, and its name is not used");
    }
    else
    {
      table.Entries.emplace(segment.Label(), LabelTable::Entry{ segment.Name(), segment.Color() });
    }
  }
  LeaveOutOtherTexts(table, warnings);
  return table;
}

std::string DescribeLayers(const TextHeader& header)
{
  std::map<std::int64_t, std::string> layers;
  for (const Segment& segment : ListSegments(header))
  {
    std::string& names = layers[segment.Layer()];
    names += (names.empty() ? "" : ", ") + Excerpt(segment.Name());
  }
  std::string text;
  for (const auto& [layer, names] : layers)
  {
    text += (text.empty() ? "" : ", ") + std::to_string(layer + 1) + " (" + names + ")";
  }
  return text;
}

} // namespace voxplex::io
