// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelTableLines.h"

#include "Excerpt.h"
#include "LabelTable.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <initializer_list>
#include <set>
#include <string_view>

namespace voxplex::io
{
namespace
{

using Fields = std::vector<std::string>;
constexpr std::size_t Missing = static_cast<std::size_t>(-1);

template <typename T>
std::optional<T> ToNumber(std::string_view text)
{
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool isWhole = error == std::errc() && end == text.data() + text.size();
  return isWhole ? std::optional<T>(value) : std::nullopt;
}

bool IsWholeNumber(std::string_view text)
{
  return ToNumber<std::int64_t>(text).has_value();
}

bool IsNumber(std::string_view text)
{
  return ToNumber<double>(text).has_value();
}

std::string Trimmed(std::string_view text)
{
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string_view::npos
    ? ""
    : std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

std::string LowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string WithoutQuotes(const std::string& text)
{
  const bool isQuoted =
    text.size() > 1 && text.front() == text.back() && (text.front() == '"' || text.front() == '\'');
  return isQuoted ? Trimmed(std::string_view(text).substr(1, text.size() - 2)) : text;
}

/** Label and name, checked. */
TableRow MakeRow(int line, const std::string& label, const std::string& name)
{
  const std::optional<std::int64_t> value = ToNumber<std::int64_t>(label);
  if (!value || *value < 0)
  {
    throw TableError(
      line, "'" + Excerpt(label) + "' is not a label; labels are whole numbers from 1 on");
  }
  if (name.empty())
  {
    throw TableError(line, "label " + std::to_string(*value) + " has no name");
  }
  if (!IsUTF8(name))
  {
    throw TableError(line, "the name is not in UTF-8; convert the file, with iconv for example");
  }
  return { line, *value, name, std::nullopt };
}

std::array<double, 3> MakeColor(int line, const std::array<std::string, 3>& texts)
{
  std::array<double, 3> color;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const std::optional<double> value = ToNumber<double>(texts[i]);
    if (!value || !(*value >= 0) || *value > 255)
    {
      throw TableError(line,
        "'" + Excerpt(texts[i]) +
          "' is not a part of a colour; red, green and blue are numbers of 0 to 255");
    }
    color[i] = *value;
  }
  return color;
}

// --- Words separated by blanks ---------------------------------------------------------------------

/** A line and where its words begin and end. */
struct Words
{
  std::string_view Line;
  std::vector<std::string_view> All;

  explicit Words(std::string_view line)
    : Line(line)
  {
    for (std::size_t at = 0; (at = line.find_first_not_of(" \t", at)) != std::string_view::npos;)
    {
      const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
      this->All.push_back(line.substr(at, end - at));
      at = end;
    }
  }

  /** The text from the first of some words to the last of them. */
  std::string Text(std::size_t first, std::size_t end) const
  {
    if (first >= end)
    {
      return "";
    }
    const char* begin = this->All[first].data();
    const std::string_view& last = this->All[end - 1];
    return { begin, last.data() + last.size() };
  }

  std::array<std::string, 3> Three(std::size_t first) const
  {
    return { std::string(this->All[first]), std::string(this->All[first + 1]),
      std::string(this->All[first + 2]) };
  }

  /** How many numbers there are at the end. */
  std::size_t TrailingNumbers() const
  {
    const auto isNoNumber = [](std::string_view word) { return !IsNumber(word); };
    return static_cast<std::size_t>(
      std::find_if(this->All.rbegin(), this->All.rend(), isNoNumber) - this->All.rbegin());
  }
};

/** Seven numbers and a name in quotes. */
bool IsITKSNAP(const Words& words)
{
  return words.All.size() > 7 && words.All[7].front() == '"' && words.Line.back() == '"' &&
    std::all_of(words.All.begin(), words.All.begin() + 7, IsNumber);
}

TableRow ParseLineOfWords(const TableLine& line)
{
  const Words words(line.Text);
  const std::string label(words.All.front());
  const std::size_t count = words.All.size();
  if (IsITKSNAP(words))
  {
    TableRow row = MakeRow(line.Number, label, WithoutQuotes(words.Text(7, count)));
    row.Color = MakeColor(line.Number, words.Three(1));
    return row;
  }
  // A name with red, green, blue, and perhaps an opacity.
  const std::size_t numbers = std::min<std::size_t>(words.TrailingNumbers(), 4);
  if (numbers >= 3 && count >= numbers + 2)
  {
    TableRow row = MakeRow(line.Number, label, WithoutQuotes(words.Text(1, count - numbers)));
    row.Color = MakeColor(line.Number, words.Three(count - numbers));
    return row;
  }
  return MakeRow(line.Number, label, WithoutQuotes(words.Text(1, count)));
}

/** The names without the code that mricron has in a third column; nothing if there is no such column. */
std::optional<std::vector<std::string>> NamesWithoutCodes(const std::vector<TableLine>& lines)
{
  std::vector<std::string> names;
  for (const TableLine& line : lines)
  {
    const Words words(line.Text);
    if (words.All.size() != 3 || !IsWholeNumber(words.All[2]))
    {
      return std::nullopt;
    }
    names.emplace_back(words.All[1]);
  }
  const std::set<std::string> distinct(names.begin(), names.end());
  return names.size() > 1 && distinct.size() == names.size() ? std::optional(names) : std::nullopt;
}

// --- Delimited fields ------------------------------------------------------------------------------

/** Quotes hold delimiters, and two quotes stand for one. */
Fields SplitFields(const TableLine& line, char delimiter)
{
  Fields fields(1);
  bool isQuoted = false;
  const std::string& text = line.Text;
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    if (text[i] == '"' && isQuoted && i + 1 < text.size() && text[i + 1] == '"')
    {
      fields.back() += text[++i];
    }
    else if (text[i] == '"')
    {
      isQuoted = !isQuoted;
    }
    else if (text[i] == delimiter && !isQuoted)
    {
      fields.emplace_back();
    }
    else
    {
      fields.back() += text[i];
    }
  }
  if (isQuoted)
  {
    throw TableError(line.Number, "a quotation mark is not closed");
  }
  std::transform(fields.begin(), fields.end(), fields.begin(), Trimmed);
  return fields;
}

/** The delimiter that comes first in a line, or 0. */
char FirstDelimiter(const std::string& line)
{
  const std::size_t at = line.find_first_of(",;\t");
  return at == std::string::npos ? '\0' : line[at];
}

/** Which field holds what. */
struct Columns
{
  std::size_t Label = 0;
  std::size_t Name = 1;
  std::array<std::size_t, 3> Color{ 2, 3, 4 };
  bool HasHeader = false;

  std::size_t Needed() const { return std::max(this->Label, this->Name) + 1; }
};

/** The column of the first name that the header has. */
std::size_t FindColumn(const Fields& header, std::initializer_list<const char*> names)
{
  for (const char* name : names)
  {
    const auto column = std::find(header.begin(), header.end(), name);
    if (column != header.end())
    {
      return static_cast<std::size_t>(column - header.begin());
    }
  }
  return Missing;
}

Columns ReadHeader(const TableLine& line, char delimiter)
{
  Fields header = SplitFields(line, delimiter);
  std::transform(header.begin(), header.end(), header.begin(), LowerCase);
  Columns columns;
  columns.HasHeader = true;
  columns.Label =
    FindColumn(header, { "value", "labelvalue", "label_value", "index", "id", "number", "label" });
  columns.Name =
    FindColumn(header, { "name", "labelname", "label_name", "region", "structure", "label" });
  if (columns.Label == Missing || columns.Name == Missing || columns.Label == columns.Name)
  {
    throw TableError(line.Number,
      "it begins with no label and is not a header with columns 'value' and 'name', either");
  }
  columns.Color = { FindColumn(header, { "r", "red", "color_r" }),
    FindColumn(header, { "g", "green", "color_g" }),
    FindColumn(header, { "b", "blue", "color_b" }) };
  return columns;
}

std::optional<std::array<double, 3>> ColorOf(
  const TableLine& line, const Fields& fields, const Columns& columns)
{
  std::array<std::string, 3> texts;
  for (std::size_t i = 0; i < 3; ++i)
  {
    texts[i] = columns.Color[i] < fields.size() ? fields[columns.Color[i]] : "";
  }
  const auto isEmpty = [](const std::string& text) { return text.empty(); };
  return std::all_of(texts.begin(), texts.end(), isEmpty)
    ? std::nullopt
    : std::optional(MakeColor(line.Number, texts));
}

TableRow ParseFields(const TableLine& line, const Fields& fields, const Columns& columns)
{
  if (fields.size() < columns.Needed())
  {
    throw TableError(line.Number, "it has no name");
  }
  if (!columns.HasHeader && fields.size() != 2 && fields.size() != 5 && fields.size() != 6)
  {
    throw TableError(line.Number,
      "it has " + std::to_string(fields.size()) +
        " fields, and must be 'value,name' or 'value,name,red,green,blue'; put quotation marks "
        "around a name with commas");
  }
  TableRow row = MakeRow(line.Number, fields[columns.Label], fields[columns.Name]);
  row.Color = ColorOf(line, fields, columns);
  return row;
}

} // namespace

bool IsDelimited(const std::vector<TableLine>& lines)
{
  if (lines.empty())
  {
    return false;
  }
  const std::string& line = lines.front().Text;
  const char delimiter = FirstDelimiter(line);
  const std::string first = Trimmed(line.substr(0, line.find(delimiter)));
  const bool isHeader = !IsNumber(Words(line).All.front());
  return delimiter != '\0' && (isHeader || (delimiter != '\t' && IsWholeNumber(first)));
}

std::vector<TableRow> ParseDelimited(const std::vector<TableLine>& lines)
{
  const char delimiter = FirstDelimiter(lines.front().Text);
  const Fields first = SplitFields(lines.front(), delimiter);
  const Columns columns =
    IsWholeNumber(first.front()) ? Columns() : ReadHeader(lines.front(), delimiter);
  std::vector<TableRow> rows;
  for (const TableLine& line : lines)
  {
    if (!columns.HasHeader || &line != &lines.front())
    {
      rows.push_back(ParseFields(line, SplitFields(line, delimiter), columns));
    }
  }
  return rows;
}

std::vector<TableRow> ParseWords(const std::vector<TableLine>& lines)
{
  std::vector<TableRow> rows;
  for (const TableLine& line : lines)
  {
    rows.push_back(ParseLineOfWords(line));
  }
  if (const auto names = NamesWithoutCodes(lines))
  {
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      rows[i].Name = (*names)[i];
    }
  }
  return rows;
}

} // namespace voxplex::io
