// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TextHeader.h
 * @brief The fields in the text header of an NRRD or MetaImage file, as they are written there.
 *
 * ITK gives what it makes of a header. This is for what it leaves out: spacings that it replaces,
 * and the axis of an NRRD file that it turns into components.
 */
#ifndef voxplex_io_TextHeader_h
#define voxplex_io_TextHeader_h

#include <map>
#include <string>
#include <vector>

namespace voxplex::io
{

/** Keys are in lower case; "key: value", "key = value" and NRRD's "key:=value" are all fields. */
class TextHeader
{
public:
  /** Reads up to the end of the header, at most 1 MiB. A file without one has no fields. */
  explicit TextHeader(const std::string& path);

  /** Whether the file goes on after 1 MiB of header. */
  bool IsEndless() const { return this->Endless; }

  /** The value without surrounding blanks, or null. */
  const std::string* Find(const std::string& key) const;

  /** The lines that follow a field of data files whose value begins with LIST. */
  const std::vector<std::string>& ListedFiles() const { return this->List; }

private:
  /** Returns whether the header ends with this line. */
  bool TakeLine(std::string line);

  std::map<std::string, std::string> Fields;
  std::vector<std::string> List;
  bool IsNRRD = false;
  bool IsInList = false;
  bool Endless = false;
};

/** The numbers of a list; brackets and commas separate, words that are no numbers are left out. */
std::vector<double> ParseNumbers(std::string text);

/** One axis of an NRRD file; see the definition of the format on teem.sourceforge.net. */
struct NRRDAxis
{
  std::string Kind;              ///< lower case; empty if not given
  std::vector<double> Direction; ///< its space direction; empty if "none" or not given
  bool HasSpacing = false;       ///< whether the field "spacings" names one, which may be NaN
  double Spacing = 0.0;

  /** Frames, components, channels: not along space or time. */
  bool IsList() const;
};

/** The axes in the order of the file, the fastest first; empty if it is no NRRD file. */
std::vector<NRRDAxis> ParseNRRDAxes(const TextHeader& header);

} // namespace voxplex::io

#endif
