// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "DICOMSegments.h"

#include "DICOMPixels.h"
#include "FileError.h"
#include "Text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>

namespace voxplex::io
{
namespace
{

constexpr DICOMTag CharacterSet{ 0x00080005, "Specific Character Set" };
constexpr DICOMTag Padding{ 0x00280120, "Pixel Padding Value" };
constexpr std::uint32_t Descriptor = 0x00281101; ///< of red; those of green and blue follow
constexpr std::uint32_t Palette = 0x00281201;
constexpr DICOMTag SegmentationType{ 0x00620001, "Segmentation Type" };
constexpr DICOMTag SegmentSequence{ 0x00620002, "Segment Sequence" };
constexpr DICOMTag SegmentNumber{ 0x00620004, "Segment Number" };
constexpr DICOMTag SegmentLabel{ 0x00620005, "Segment Label" };
constexpr DICOMTag DisplayColor{ 0x0062000D, "Recommended Display CIELab Value" };
constexpr DICOMTag MaximumFraction{ 0x0062000E, "Maximum Fractional Value" };

using Color = std::array<double, 3>;

std::string FromLatin1(const std::string& text)
{
  std::string result;
  for (const char character : text)
  {
    const auto byte = static_cast<unsigned char>(character);
    if (byte < 0x80)
    {
      result += character;
    }
    else
    {
      result += static_cast<char>(0xC0 | byte >> 6);
      result += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return result;
}

/** sRGB of CIELab (IEC 61966-2-1). The three numbers stand for 0 to 100, and twice for -128 to 127. */
std::optional<Color> FromCIELab(const std::vector<unsigned>& stored)
{
  if (stored.size() != 3)
  {
    return std::nullopt;
  }
  constexpr double most = 65535.0;
  constexpr Color white{ 0.950456, 1.0, 1.088754 }; // D65
  constexpr std::array<Color, 3> toRGB{ { { 3.2406, -1.5372, -0.4986 }, { -0.9689, 1.8758, 0.0415 },
    { 0.0557, -0.2040, 1.0570 } } };
  const auto unfold = [](double f)
  { return f > 6.0 / 29.0 ? f * f * f : (f - 16.0 / 116.0) * 108.0 / 841.0; };
  const double y = (stored[0] * 100.0 / most + 16.0) / 116.0;
  const double x = y + (stored[1] * 255.0 / most - 128.0) / 500.0;
  const double z = y - (stored[2] * 255.0 / most - 128.0) / 200.0;
  const Color xyz{ white[0] * unfold(x), white[1] * unfold(y), white[2] * unfold(z) };
  Color color{};
  for (std::size_t i = 0; i < 3; ++i)
  {
    const double linear = toRGB[i][0] * xyz[0] + toRGB[i][1] * xyz[1] + toRGB[i][2] * xyz[2];
    const double gray =
      linear > 0.0031308 ? 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055 : 12.92 * linear;
    color[i] = std::clamp(gray, 0.0, 1.0);
  }
  return color;
}

/** Entries of a palette have 16 bits, or 8, of which two may be in a word. */
std::optional<Color> FromPalette(const DICOMDataSet& data, unsigned label)
{
  Color color{};
  for (std::uint32_t i = 0; i < 3; ++i)
  {
    const std::vector<unsigned> descriptor = data.Shorts({ Descriptor + i, "" });
    const std::vector<unsigned> words = data.Shorts({ Palette + i, "" });
    const std::size_t entries = descriptor.size() != 3 ? 0
      : descriptor[0] == 0                             ? 65536
                                                       : descriptor[0];
    const std::size_t at = entries > 0 && label >= descriptor[1] ? label - descriptor[1] : entries;
    const bool isPacked = words.size() < entries;
    if (at >= entries || (isPacked ? at / 2 : at) >= words.size())
    {
      return std::nullopt;
    }
    const unsigned entry = isPacked ? words[at / 2] >> (at % 2 * 8) & 0xFF : words[at];
    color[i] = entry / (descriptor[2] == 16 ? 65535.0 : 255.0);
  }
  return std::all_of(color.begin(), color.end(), [](double part) { return part <= 1.0; })
    ? std::optional(color)
    : std::nullopt;
}

} // namespace

std::vector<DICOMSegment> ListSegments(const DICOMDataSet& data)
{
  const std::string type = data.Text(SegmentationType);
  const bool isRight = IsLabelMap(data) ? type.empty() || type == "LABELMAP"
                                        : type == "BINARY" || type == "FRACTIONAL";
  RefuseIf(!isRight, "its ", SegmentationType, " is '", Excerpt(type), "', and must be ",
    (IsLabelMap(data) ? "LABELMAP" : "BINARY or FRACTIONAL"), ": correct its header");
  const bool isLatin1 = data.Text(CharacterSet).ends_with("IR 100");
  std::set<unsigned> numbers;
  std::vector<DICOMSegment> segments;
  for (const DICOMDataSet& item : data.Items(SegmentSequence))
  {
    const unsigned number = item.Short(SegmentNumber).value_or(0);
    RefuseIf((number == 0 && !IsLabelMap(data)) || !numbers.insert(number).second, "its ",
      SegmentSequence, " has the ", SegmentNumber, ' ', number,
      (number == 0 ? ", and they begin with 1" : " twice"), ": correct its header");
    if (number > 0)
    {
      const std::string name = item.Text(SegmentLabel);
      std::optional<Color> color = FromCIELab(item.Shorts(DisplayColor));
      segments.push_back({ static_cast<std::uint16_t>(number),
        { isLatin1 ? FromLatin1(name) : name, color ? color : FromPalette(data, number) } });
    }
  }
  return segments;
}

double FindThreshold(const DICOMDataSet& data, unsigned bits, double probability)
{
  if (data.Text(SegmentationType) != "FRACTIONAL")
  {
    return 0.0;
  }
  const unsigned most = data.Short(MaximumFraction).value_or(0);
  RefuseIf(most < 1 || most >= 1U << bits, "its ", MaximumFraction, " is ",
    (most < 1 ? "missing or 0" : std::to_string(most)), ", and its voxels have ", bits,
    " bits: correct its header");
  return probability * most;
}

std::uint16_t FindBackground(const DICOMDataSet& data)
{
  const std::vector<unsigned> values = data.Shorts(Padding);
  const unsigned value = values.size() == 1 ? values[0] : 0;
  const std::vector<DICOMDataSet> items = data.Items(SegmentSequence);
  RefuseIf(value != 0 &&
      std::any_of(items.begin(), items.end(),
        [](const DICOMDataSet& item) { return item.Short(SegmentNumber).value_or(1) == 0; }),
    "its segment 0 is not the background, which has the ", Padding, ' ', value,
    ": give its segments numbers from 1 on");
  return static_cast<std::uint16_t>(value);
}

} // namespace voxplex::io
