// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelTableFile.h"

#include "FileError.h"
#include "LabelTableLines.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

constexpr std::uintmax_t MaximumSize = 16 << 20;

[[noreturn]] void Refuse(const std::string& path, const std::string& reason)
{
  throw FileError("cannot read the label table '" + path + "': " + reason);
}

std::string ReadText(const std::string& path)
{
  std::error_code ignored;
  if (!fs::exists(path, ignored))
  {
    Refuse(path, "there is no such file");
  }
  if (!fs::is_regular_file(path, ignored))
  {
    Refuse(path, "it is not a regular file");
  }
  if (fs::file_size(path, ignored) > MaximumSize)
  {
    Refuse(path, "it is larger than 16 MiB and thus no table of labels");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file)
  {
    Refuse(path, std::strerror(errno));
  }
  return { std::istreambuf_iterator<char>(file), {} };
}

/** Without empty lines and comments. */
std::vector<TableLine> SplitLines(const std::string& text)
{
  constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";
  std::istringstream stream(text.substr(text.rfind(byteOrderMark, 0) == 0 ? 3 : 0));
  std::vector<TableLine> lines;
  int number = 0;
  for (std::string line; std::getline(stream, line);)
  {
    ++number;
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first != std::string::npos && line[first] != '#')
    {
      const std::size_t last = line.find_last_not_of(" \t\r");
      lines.push_back({ number, line.substr(first, last - first + 1) });
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
    if (!isNew && table.Entries[row.Label].Name != entry.Name)
    {
      throw TableError(row.Line,
        "label " + std::to_string(row.Label) + " has another name on line " +
          std::to_string(line->second));
    }
    table.Entries[row.Label] = entry;
  }
  table.Entries.erase(0);
  return table;
}

} // namespace

LabelTable ReadLabelTableFile(const std::string& path)
{
  const std::string text = ReadText(path);
  if (text.find('\0') != std::string::npos)
  {
    Refuse(path, "it is no text file");
  }
  const std::vector<TableLine> lines = SplitLines(text);
  try
  {
    const bool isDelimited = IsDelimited(lines);
    const LabelTable table =
      ToTable(isDelimited ? ParseDelimited(lines) : ParseWords(lines), isDelimited);
    if (table.Entries.empty())
    {
      Refuse(path, "it lists no labels");
    }
    return table;
  }
  catch (const TableError& error)
  {
    Refuse(path, "line " + std::to_string(error.Line) + ": " + error.what());
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
