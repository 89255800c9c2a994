// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Segments.h"

#include "MaskUnion.h"
#include "Readers.h"
#include "Text.h"
#include "TextHeader.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <unordered_map>

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

bool IsLabel(const Segment& segment, std::vector<std::string>& warnings)
{
  const bool isLabel = segment.Label() > 0;
  if (!isLabel)
  {
    warnings.push_back("the segment '" + Excerpt(segment.Name()) +
      "' has a value that is not a label, and its name is not used");
  }
  return isLabel;
}

} // namespace

LabelTable ReadSegments(const TextHeader& header, std::vector<std::string>& warnings)
{
  LabelTable table;
  for (const Segment& segment : ListSegments(header))
  {
    if (IsLabel(segment, warnings))
    {
      table.Entries.emplace(segment.Label(), LabelTable::Entry{ segment.Name(), segment.Color() });
    }
  }
  LeaveOutOtherTexts(table, warnings);
  return table;
}

bool HasSegments(const TextHeader& header)
{
  return !ListSegments(header).empty();
}

ScalarImage CombineLayers(const TextHeader& header, const ScalarImage& layers, Reading& reading)
{
  MaskUnion segments(layers, reading.Allocate, "segments");
  std::map<std::int64_t, std::unordered_map<std::int64_t, std::uint32_t>> numbers; // of each layer
  for (const Segment& segment : ListSegments(header))
  {
    if (IsLabel(segment, reading.Warnings))
    {
      const std::uint32_t number = segments.AddName(segment.Name());
      numbers[segment.Layer()].emplace(segment.Label(), number);
      reading.Labels.Entries[number] = { segment.Name(), segment.Color() };
    }
  }
  for (int layer = 0; layer < layers.Frames; ++layer)
  {
    segments.AddLayer(layers, layer, numbers[layer]);
  }
  LeaveOutOtherTexts(reading.Labels, reading.Warnings);
  return segments.Finish(reading.Request.Rule, reading.Warnings);
}

} // namespace voxplex::io
