// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelTableFile.h
 * @brief Names and colours of labels from the text files that atlases and programs come with.
 *
 * The format is detected by content. Empty lines and those that begin with # are left out; so is
 * the background 0. Text is UTF-8; lines may end as on Windows.
 *
 * | format | line |
 * | --- | --- |
 * | plain | `37 Left hippocampus`: label and name |
 * | mricron | `37 Hippocampus_L 4101`: and a code, which is not used |
 * | FreeSurfer, 3D Slicer (.ctbl) | `17 Left-Hippocampus 220 216 20 0`: red, green, blue, and what is not used |
 * | ITK-SNAP | `3 0 0 255 1 1 0 "Left hippocampus"`: red, green, blue first, then what is not used |
 * | CSV | `3,"Hippocampus, left",220,216,20`: with commas or semicolons; colours may be left out |
 * | CSV or TSV with a header | any order of columns, which the header names |
 *
 * Colours are of 0 to 255, in CSV also of 0 to 1 if no number in the file is larger. A third column
 * of whole numbers is taken to be mricron's code if all lines have it, there are several lines, and the names
 * differ without it; otherwise it belongs to the name ("Area 4").
 */
#ifndef voxplex_io_LabelTableFile_h
#define voxplex_io_LabelTableFile_h

#include "LabelTable.h"

#include <optional>
#include <string>

namespace voxplex::io
{

/**
 * Reads a table.
 *
 * @throws FileError with file and line: no such file, no text, no UTF-8, a line that does not begin with a
 *   label, a label without a name or with two, colours out of range, no labels at all
 */
LabelTable ReadLabelTableFile(const std::string& path);

/**
 * The file in which mricron keeps the table of an image: x.nii.txt beside x.nii.gz, and in general the
 * image's name without .gz and with .txt added. Nothing if there is no such file.
 */
std::optional<std::string> FindLabelTableFile(const std::string& imagePath);

} // namespace voxplex::io

#endif
