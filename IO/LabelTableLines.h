// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelTableLines.h
 * @brief From the lines of a label table to labels, names and colours; see LabelTableFile.h.
 */
#ifndef voxplex_io_LabelTableLines_h
#define voxplex_io_LabelTableLines_h

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace voxplex::io
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

/** A line makes no sense. */
class TableError : public std::runtime_error
{
public:
  TableError(int line, const std::string& what)
    : std::runtime_error(what)
    , Line(line)
  {
  }

  int Line;
};

/** Whether fields are separated by commas or semicolons, or by tabs below a header. */
bool IsDelimited(const std::vector<TableLine>& lines);

///@{
/** The rows of all lines. @throws TableError */
std::vector<TableRow> ParseDelimited(const std::vector<TableLine>& lines);
std::vector<TableRow> ParseWords(const std::vector<TableLine>& lines);
///@}

} // namespace voxplex::io

#endif
