// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MetaImageCheck.h"

#include "Excerpt.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

namespace voxplex::io
{
namespace
{

enum class Value
{
  Text,
  Number,
  Colour,
  Vector, ///< a number for each axis
  Matrix
};

struct Field
{
  std::string_view Name;
  Value Type;
};

/** What MetaIO reads; other fields are texts to it. */
constexpr std::array<Field, 38> KnownFields{ {
  { "AcquisitionDate", Value::Text },
  { "AnatomicalOrientation", Value::Text },
  { "BinaryData", Value::Text },
  { "BinaryDataByteOrderMSB", Value::Text },
  { "CenterOfRotation", Value::Vector },
  { "Color", Value::Colour },
  { "Comment", Value::Text },
  { "CompressedData", Value::Text },
  { "CompressedDataSize", Value::Number },
  { "DimSize", Value::Vector },
  { "DistanceUnits", Value::Text },
  { "ElementByteOrderMSB", Value::Text },
  { "ElementDataFile", Value::Text },
  { "ElementMax", Value::Number },
  { "ElementMin", Value::Number },
  { "ElementNBits", Value::Number },
  { "ElementNumberOfChannels", Value::Number },
  { "ElementSize", Value::Vector },
  { "ElementSpacing", Value::Vector },
  { "ElementToIntensityFunctionOffset", Value::Number },
  { "ElementToIntensityFunctionSlope", Value::Number },
  { "ElementType", Value::Text },
  { "HeaderSize", Value::Number },
  { "ID", Value::Number },
  { "ImagePosition", Value::Vector },
  { "Modality", Value::Text },
  { "NDims", Value::Number },
  { "Name", Value::Text },
  { "ObjectSubType", Value::Text },
  { "ObjectType", Value::Text },
  { "Offset", Value::Vector },
  { "Orientation", Value::Matrix },
  { "Origin", Value::Vector },
  { "ParentID", Value::Number },
  { "Position", Value::Vector },
  { "Rotation", Value::Matrix },
  { "SequenceID", Value::Vector },
  { "TransformMatrix", Value::Matrix },
} };

constexpr std::size_t LongestText = 254;
constexpr int MostAxes = 10;
constexpr std::string_view Blanks = " \t";
constexpr std::string_view Separators = "=:";

std::string Damaged(const std::string& how)
{
  return "it is damaged: " + how;
}

std::string Trim(std::string text)
{
  text.erase(text.find_last_not_of(Blanks) + 1);
  text.erase(0, text.find_first_not_of(Blanks));
  return text;
}

bool HasControlCharacter(const std::string& line)
{
  return std::any_of(
    line.begin(), line.end(), [](unsigned char c) { return (c < ' ' && c != '\t') || c == 0x7F; });
}

bool EqualButForCase(std::string_view a, std::string_view b)
{
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
    [&lower](char left, char right) { return lower(left) == lower(right); });
}

/** The first numbers of a text, as MetaIO takes them; nothing if there are fewer. */
std::optional<std::vector<double>> ReadNumbers(const std::string& text, std::size_t count)
{
  std::istringstream stream(text);
  std::vector<double> numbers(count);
  for (double& number : numbers)
  {
    stream >> number;
  }
  return stream ? std::optional(numbers) : std::nullopt;
}

/** MetaIO separates words by one blank each. */
std::vector<std::string> SplitWords(const std::string& text)
{
  std::vector<std::string> words(1);
  for (const char c : text)
  {
    if (c == ' ')
    {
      words.emplace_back();
    }
    else
    {
      words.back() += c;
    }
  }
  return words;
}

/** A number without sign that ITK can add up with int. */
std::optional<int> ParseCount(const std::string& word)
{
  constexpr std::size_t mostDigits = 9;
  const bool isNumber = !word.empty() && word.size() <= mostDigits &&
    word.find_first_not_of("0123456789") == std::string::npos;
  return isNumber ? std::optional(std::stoi(word)) : std::nullopt;
}

/** Reads a header from its beginning. Each step returns what is wrong, or an empty string. */
class HeaderWalk
{
public:
  explicit HeaderWalk(const std::string& path)
    : File(path, std::ios::binary)
  {
  }

  std::string FindFault()
  {
    std::string fault;
    for (std::string line; fault.empty() && !this->HasEnded && std::getline(this->File, line);)
    {
      if (!line.empty() && line.back() == '\r')
      {
        line.pop_back();
      }
      line = Trim(line);
      fault = line.empty() ? "" : this->TakeLine(line);
    }
    return fault;
  }

private:
  std::string TakeLine(const std::string& line)
  {
    const std::size_t separator = line.find_first_of(Separators);
    const std::string name = Trim(line.substr(0, separator));
    const std::string value =
      separator == std::string::npos ? "" : Trim(line.substr(separator + 1));
    const bool isField = separator != std::string::npos && !name.empty() &&
      value.find_first_of(Separators) != 0 && !HasControlCharacter(line);
    // What TextHeader takes for NRRD has other rules.
    if (!isField || name.starts_with("NRRD"))
    {
      return Damaged("the line '" + Excerpt(line) + "' of its header is no field");
    }
    if (name.size() > LongestText)
    {
      return Damaged(
        "its header has a field with a name of " + std::to_string(name.size()) + " bytes");
    }
    const auto known = std::find_if(KnownFields.begin(), KnownFields.end(),
      [&name](const Field& field) { return EqualButForCase(field.Name, name); });
    if (known == KnownFields.end())
    {
      return "";
    }
    if (known->Name != name)
    {
      return Damaged("its header has the field '" + name + "', which must be written " +
        std::string(known->Name));
    }
    return this->TakeField(*known, name, value);
  }

  std::string TakeField(const Field& field, const std::string& name, const std::string& value)
  {
    if (!this->Seen.insert(field.Name).second)
    {
      return Damaged("its header gives " + name + " more than once");
    }
    if (name == "NDims")
    {
      return this->TakeNumberOfAxes(value);
    }
    if (name == "ElementDataFile")
    {
      this->HasEnded = true;
      return this->FindFaultOfDataFile(value);
    }
    if (field.Type == Value::Text)
    {
      return value.size() <= LongestText ? ""
                                         : Damaged("its header gives a text of " +
                                             std::to_string(value.size()) + " bytes for " + name);
    }
    const std::size_t count = this->CountNumbers(field.Type);
    if (count == 0)
    {
      return Damaged("its header gives " + name + " before NDims");
    }
    const std::optional<std::vector<double>> numbers = ReadNumbers(value, count);
    if (!numbers)
    {
      return Damaged("its header gives '" + Excerpt(value) + "' for " + name + ", where " +
        std::to_string(count) + (count == 1 ? " number" : " numbers") + " must be");
    }
    if (name == "DimSize")
    {
      this->Sizes = *numbers;
    }
    return "";
  }

  std::string TakeNumberOfAxes(const std::string& value)
  {
    const std::optional<std::vector<double>> number = ReadNumbers(value, 1);
    if (!number || !(number->front() >= 1 && number->front() <= MostAxes))
    {
      return Damaged(
        "its header gives '" + Excerpt(value) + "' dimensions, and the format has 1 to 10");
    }
    this->Axes = static_cast<std::size_t>(number->front());
    return "";
  }

  std::size_t CountNumbers(Value type) const
  {
    switch (type)
    {
      case Value::Colour:
        return 4;
      case Value::Vector:
        return this->Axes;
      case Value::Matrix:
        return this->Axes * this->Axes;
      default:
        return 1;
    }
  }

  std::string FindFaultOfDataFile(const std::string& value)
  {
    if (this->Sizes.empty())
    {
      return Damaged("its header does not give DimSize");
    }
    if (value.starts_with("LIST"))
    {
      return this->FindFaultOfList(value);
    }
    return value.find('%') == std::string::npos ? "" : this->FindFaultOfPattern(value);
  }

  /** "LIST", or "LIST 2" if each file has two dimensions. */
  std::string FindFaultOfList(const std::string& value)
  {
    const std::vector<std::string> words = SplitWords(value);
    const std::optional<int> axes = words.size() == 1 ? std::optional(0) : ParseCount(words[1]);
    if (words.front() != "LIST" || words.size() > 2 || !axes ||
      *axes >= static_cast<int>(this->Axes))
    {
      return Damaged("'" + Excerpt(value) + "' in its header is no list of data files");
    }
    const auto inFile = *axes == 0 ? static_cast<std::ptrdiff_t>(this->Axes) - 1 : *axes;
    const double needed = std::accumulate(
      this->Sizes.begin() + inFile, this->Sizes.end(), 1.0, std::multiplies<double>());
    std::string line;
    for (double listed = 0; listed < needed; ++listed)
    {
      // MetaIO does not take a last line that is not ended.
      if (!std::getline(this->File, line) || this->File.eof())
      {
        std::ostringstream text;
        text << "its header lists " << listed << " data files with a line each, and " << needed
             << " are needed";
        return Damaged(text.str());
      }
      if (line.find_first_not_of(" \t\r") != 0)
      {
        return Damaged("the line '" + Excerpt(line) + "' of its header names no data file");
      }
    }
    return "";
  }

  /** "slice_%03d.raw 1 40 1" */
  std::string FindFaultOfPattern(const std::string& value)
  {
    const std::vector<std::string> words = SplitWords(value);
    constexpr std::size_t all = 4;
    const bool isComplete = words.size() == all;
    const std::optional<int> first = isComplete ? ParseCount(words[1]) : std::nullopt;
    const std::optional<int> last = isComplete ? ParseCount(words[2]) : std::nullopt;
    const std::optional<int> step = isComplete ? ParseCount(words[3]) : std::nullopt;
    if (!first || !last || !step || *step == 0 || *last < *first)
    {
      return Damaged("'" + Excerpt(value) +
        "' in its header is no pattern of names such as 'a_%03d.raw 1 40 1'");
    }
    const int named = (*last - *first) / *step + 1;
    if (named < this->Sizes.back())
    {
      std::ostringstream text;
      text << "its header names " << named << " data files, and " << this->Sizes.back()
           << " are needed";
      return Damaged(text.str());
    }
    return "";
  }

  std::ifstream File;
  std::set<std::string_view> Seen;
  std::size_t Axes = 0;
  std::vector<double> Sizes;
  bool HasEnded = false;
};

} // namespace

std::string FindFaultOfMetaImage(const std::string& path)
{
  return HeaderWalk(path).FindFault();
}

} // namespace voxplex::io
