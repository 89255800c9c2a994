// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelTable.h
 * @brief Names and colours of labels, and the field data in which they travel.
 *
 * Three arrays with one value, or tuple, a label:
 * - `LabelValues`: vtkIntArray, or vtkLongLongArray if a value does not fit an int; increasing, each once,
 *   without the background 0;
 * - `LabelNames`: vtkStringArray, UTF-8, none empty: a label without a name is not listed; see TextsOf();
 * - `LabelColors`: vtkDoubleArray, red, green and blue in [0, 1]; NaN where a label has no colour.
 *   Missing if none has.
 */
#ifndef voxplex_LabelTable_h
#define voxplex_LabelTable_h

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

class vtkFieldData;

namespace voxplex
{

/** Labels are positive and have names. */
struct LabelTable
{
  struct Entry
  {
    std::string Name; ///< UTF-8, not empty
    std::optional<std::array<double, 3>> Color;
  };
  std::map<std::int64_t, Entry> Entries;

  /** Empty if the label is not listed. */
  const std::string& NameOf(std::int64_t label) const;
  std::map<std::int64_t, std::string> Names() const;
};

/**
 * The texts of an array in field data: those of a vtkStringArray, or of the bytes that our .vtu and .vtk files have in
 * its place, a vtkUnsignedCharArray that has a 0 at the end of each text. Empty if there is no such array.
 */
std::vector<std::string> TextsOf(vtkFieldData* fields, const char* name);

/**
 * The table in a data object's field data; empty if there is none, or if its arrays do not agree. Labels
 * that are not positive and names that are empty are left out.
 */
LabelTable GetLabelTable(vtkFieldData* fields);

/** Replaces the table in a data object's field data. An empty one leaves no arrays. */
void SetLabelTable(vtkFieldData* fields, const LabelTable& table);

/** Removes names that are not UTF-8, with a warning for each. */
void LeaveOutOtherTexts(LabelTable& table, std::vector<std::string>& warnings);

} // namespace voxplex

#endif
