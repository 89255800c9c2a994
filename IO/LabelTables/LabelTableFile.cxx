// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelTables/LabelTableFile.h"

#include "FileError.h"
#include "Text.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

/** A line that is neither empty nor a comment, without blanks around it. */
struct TableLine
{
  int Number; ///< from 1 on
  std::string Text;
};

/** What a line says. */
struct TableRow
{
  int Line;
  std::int64_t Label;                         ///< 0 or more
  std::string Name;                           ///< not empty
  std::optional<std::array<double, 3>> Color; ///< as it is written, 0 to 255
};

template <typename... TParts>
void RefuseLineIf(bool isWrong, int line, const TParts&... parts)
{
  RefuseIf(isWrong, "line ", line, ": ", parts...);
}

bool IsNumber(std::string_view text)
{
  return ToNumber<double>(text).has_value();
}

std::string_view WithoutQuotes(std::string_view text)
{
  const bool isQuoted =
    text.size() > 1 && text.front() == text.back() && (text.front() == '"' || text.front() == '\'');
  return isQuoted ? Trim(text.substr(1, text.size() - 2)) : text;
}

/** Label and name, checked. */
TableRow MakeRow(int line, std::string_view label, std::string_view name)
{
  const std::int64_t value = ToNumber<std::int64_t>(label).value_or(-1);
  RefuseLineIf(
    value < 0, line, "'", Excerpt(label), "' is not a label; labels are whole numbers from 1 on");
  RefuseLineIf(name.empty(), line, "label ", value, " has no name");
  RefuseLineIf(
    !IsUTF8(name), line, "the name is not in UTF-8; convert the file, with iconv for example");
  return { line, value, std::string(name), std::nullopt };
}

template <typename TText>
std::array<double, 3> MakeColor(int line, const TText* texts)
{
  std::array<double, 3> color;
  for (std::size_t i = 0; i < 3; ++i)
  {
    color[i] = ToNumber<double>(texts[i]).value_or(-1.0);
    RefuseLineIf(!(color[i] >= 0 && color[i] <= 255), line, "'", Excerpt(texts[i]),
      "' is not a part of a colour; red, green and blue are numbers of 0 to 255");
  }
  return color;
}

// --- Words separated by blanks ---------------------------------------------------------------------

TableRow ParseLineOfWords(const TableLine& line)
{
  const std::vector<std::string_view> words = Words(line.Text);
  const std::size_t count = words.size();
  const auto text = [&words](std::size_t first, std::size_t end)
  {
    return first < end ? WithoutQuotes({ words[first].begin(), words[end - 1].end() })
                       : std::string_view();
  };
  // ITK-SNAP: seven numbers and a name in quotes.
  if (count > 7 && words[7].front() == '"' && line.Text.back() == '"' &&
    std::all_of(words.begin(), words.begin() + 7, IsNumber))
  {
    TableRow row = MakeRow(line.Number, words[0], text(7, count));
    row.Color = MakeColor(line.Number, &words[1]);
    return row;
  }
  // A name with red, green, blue, and perhaps an opacity.
  const auto last = std::find_if_not(words.rbegin(), words.rend(), IsNumber);
  const auto numbers = static_cast<std::size_t>(std::min<std::ptrdiff_t>(last - words.rbegin(), 4));
  const bool hasColor = numbers >= 3 && count >= numbers + 2;
  TableRow row = MakeRow(line.Number, words[0], text(1, hasColor ? count - numbers : count));
  if (hasColor)
  {
    row.Color = MakeColor(line.Number, &words[count - numbers]);
  }
  return row;
}

/** The names without the code that mricron has in a third column; nothing if there is no such column. */
std::optional<std::vector<std::string>> NamesWithoutCodes(const std::vector<TableLine>& lines)
{
  std::vector<std::string> names;
  for (const TableLine& line : lines)
  {
    const std::vector<std::string_view> words = Words(line.Text);
    if (words.size() != 3 || !ToNumber<std::int64_t>(words[2]))
    {
      return std::nullopt;
    }
    names.emplace_back(words[1]);
  }
  const std::set<std::string> distinct(names.begin(), names.end());
  return names.size() > 1 && distinct.size() == names.size() ? std::optional(names) : std::nullopt;
}

std::vector<TableRow> ParseWords(const std::vector<TableLine>& lines)
{
  std::vector<TableRow> rows;
  std::transform(lines.begin(), lines.end(), std::back_inserter(rows), ParseLineOfWords);
  if (const auto names = NamesWithoutCodes(lines))
  {
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      rows[i].Name = (*names)[i];
    }
  }
  return rows;
}

// --- Delimited fields ------------------------------------------------------------------------------

using Fields = std::vector<std::string>;
constexpr std::size_t Missing = static_cast<std::size_t>(-1);

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
  RefuseLineIf(isQuoted, line.Number, "a quotation mark is not closed");
  std::transform(fields.begin(), fields.end(), fields.begin(),
    [](const std::string& field) { return std::string(Trim(field)); });
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
  RefuseLineIf(columns.Label == Missing || columns.Name == Missing || columns.Label == columns.Name,
    line.Number,
    "it begins with no label and is not a header with columns 'value' and 'name', either");
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
    : std::optional(MakeColor(line.Number, texts.data()));
}

TableRow ParseFields(const TableLine& line, const Fields& fields, const Columns& columns)
{
  RefuseLineIf(fields.size() < columns.Needed(), line.Number, "it has no name");
  RefuseLineIf(!columns.HasHeader && fields.size() != 2 && fields.size() != 5 && fields.size() != 6,
    line.Number, "it has ", fields.size(),
    " fields, and must be 'value,name' or 'value,name,red,green,blue'; put quotation marks "
    "around a name with commas");
  TableRow row = MakeRow(line.Number, fields[columns.Label], fields[columns.Name]);
  row.Color = ColorOf(line, fields, columns);
  return row;
}

/** Whether fields are separated by commas or semicolons, or by tabs below a header. */
bool IsDelimited(const std::vector<TableLine>& lines)
{
  if (lines.empty())
  {
    return false;
  }
  const std::string& line = lines.front().Text;
  const char delimiter = FirstDelimiter(line);
  const std::string_view first = Trim(std::string_view(line).substr(0, line.find(delimiter)));
  const bool isHeader = !IsNumber(Words(line).front());
  return delimiter != '\0' && (isHeader || (delimiter != '\t' && ToNumber<std::int64_t>(first)));
}

std::vector<TableRow> ParseDelimited(const std::vector<TableLine>& lines)
{
  const char delimiter = FirstDelimiter(lines.front().Text);
  const Fields first = SplitFields(lines.front(), delimiter);
  const Columns columns =
    ToNumber<std::int64_t>(first.front()) ? Columns() : ReadHeader(lines.front(), delimiter);
  std::vector<TableRow> rows;
  for (std::size_t i = columns.HasHeader ? 1 : 0; i < lines.size(); ++i)
  {
    rows.push_back(ParseFields(lines[i], SplitFields(lines[i], delimiter), columns));
  }
  return rows;
}

// --- The file --------------------------------------------------------------------------------------

std::string ReadText(const std::string& path)
{
  std::error_code ignored;
  RefuseIf(!fs::exists(path, ignored), "there is no such file");
  RefuseIf(!fs::is_regular_file(path, ignored), "it is not a regular file");
  constexpr std::uintmax_t most = 16 << 20;
  RefuseIf(
    fs::file_size(path, ignored) > most, "it is larger than 16 MiB and thus no table of labels");
  std::ifstream file(path, std::ios::binary);
  if (!file)
  {
    Refuse(std::strerror(errno));
  }
  std::string text(std::istreambuf_iterator<char>(file), {});
  RefuseIf(text.find('\0') != text.npos, "it is no text file");
  return text;
}

/** Without empty lines and comments. */
std::vector<TableLine> SplitLines(const std::string& text)
{
  constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";
  std::istringstream stream(text.substr(text.starts_with(byteOrderMark) ? 3 : 0));
  std::vector<TableLine> lines;
  int number = 0;
  for (std::string line; std::getline(stream, line);)
  {
    ++number;
    const std::string_view content = Trim(line);
    if (!content.empty() && content.front() != '#')
    {
      lines.push_back({ number, std::string(content) });
    }
  }
  return lines;
}

/** Colours are fractions if none is larger than 1 and the format allows both. */
double ColorScale(const std::vector<TableRow>& rows, bool mayBeFractions)
{
  double largest = 0.0;
  for (const TableRow& row : rows)
  {
    if (row.Color)
    {
      largest = std::max(largest, *std::max_element(row.Color->begin(), row.Color->end()));
    }
  }
  return mayBeFractions && largest <= 1.0 ? 1.0 : 255.0;
}

LabelTable ToTable(const std::vector<TableRow>& rows, bool mayBeFractions)
{
  const double scale = ColorScale(rows, mayBeFractions);
  std::map<std::int64_t, int> lineOf;
  LabelTable table;
  for (const TableRow& row : rows)
  {
    LabelTable::Entry entry{ row.Name, std::nullopt };
    if (row.Color)
    {
      entry.Color = { (*row.Color)[0] / scale, (*row.Color)[1] / scale, (*row.Color)[2] / scale };
    }
    const auto [line, isNew] = lineOf.emplace(row.Label, row.Line);
    RefuseLineIf(!isNew && table.Entries[row.Label].Name != entry.Name, row.Line, "label ",
      row.Label, " has another name on line ", line->second);
    table.Entries[row.Label] = entry;
  }
  table.Entries.erase(0);
  RefuseIf(table.Entries.empty(), "it lists no labels");
  return table;
}

} // namespace

LabelTable ReadLabelTableFile(const std::string& path)
{
  try
  {
    const std::vector<TableLine> lines = SplitLines(ReadText(path));
    const bool isDelimited = IsDelimited(lines);
    return ToTable(isDelimited ? ParseDelimited(lines) : ParseWords(lines), isDelimited);
  }
  catch (const FileError& error)
  {
    Refuse("cannot read the label table '", path, "': ", error.what());
  }
}

std::optional<std::string> FindLabelTableFile(const std::string& imagePath)
{
  fs::path path(imagePath);
  if (path.extension() == ".gz")
  {
    path.replace_extension();
  }
  path += ".txt";
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && path != imagePath
    ? std::optional<std::string>(path.string())
    : std::nullopt;
}

} // namespace voxplex::io
