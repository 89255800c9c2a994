// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MarkdownTable.h
 * @brief A Markdown table that is also readable on a terminal.
 */
#ifndef voxplex_MarkdownTable_h
#define voxplex_MarkdownTable_h

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace voxplex::benchmarks
{

/** A number in printf() format. If the format is empty, 1234567 becomes "1,234,567". */
inline std::string Format(double number, const char* format = "")
{
  char text[64];
  std::snprintf(text, sizeof(text), *format ? format : "%.0f", number);
  std::string result = text;
  for (std::size_t i = result.size(); !*format && i > 3 && result[i - 4] != '-'; i -= 3)
  {
    result.insert(i - 3, ",");
  }
  return result;
}

class MarkdownTable
{
public:
  explicit MarkdownTable(std::vector<std::string> header) { this->Rows = { std::move(header) }; }

  /** Adds a row. If it is shorter than the header, empty cells are added. */
  void Add(std::vector<std::string> row)
  {
    row.resize(this->Rows.front().size());
    this->Rows.push_back(std::move(row));
  }

  /** Prints the table and a blank line on standard output. */
  void Print() const
  {
    std::vector<std::size_t> widths(this->Rows.front().size(), 3);
    for (const auto& row : this->Rows)
    {
      for (std::size_t c = 0; c < row.size(); ++c)
      {
        widths[c] = std::max(widths[c], row[c].size());
      }
    }
    for (std::size_t r = 0; r < this->Rows.size(); ++r)
    {
      PrintRow(this->Rows[r], widths);
      if (r == 0)
      {
        std::vector<std::string> line;
        for (const std::size_t width : widths)
        {
          line.push_back(
            line.empty() ? std::string(width, '-') : std::string(width - 1, '-') + ":");
        }
        PrintRow(line, widths);
      }
    }
    std::printf("\n");
  }

private:
  /** The first column is left-aligned, the others are right-aligned. */
  static void PrintRow(const std::vector<std::string>& row, const std::vector<std::size_t>& widths)
  {
    for (std::size_t c = 0; c < row.size(); ++c)
    {
      std::printf(c == 0 ? "| %-*s |" : " %*s |", static_cast<int>(widths[c]), row[c].c_str());
    }
    std::printf("\n");
  }

  std::vector<std::vector<std::string>> Rows;
};

} // namespace voxplex::benchmarks

#endif
