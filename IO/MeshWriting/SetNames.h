// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SetNames.h
 * @brief Names for the sets of elements and the surfaces of a mesh, as a format allows them.
 *
 * A set of elements is called like its label, or `label_3` if the label has no name. A surface is
 * called `A__B` after the two sets on its sides, that of the larger label first, with `background`
 * for 0. Characters that a format does not allow become `_`, several in a row one `_`. A name that
 * is too long is cut and ends in its labels: `_3`, `_7_3`; so does one that another set has
 * already, among labels the larger one. Sets and surfaces never share a name.
 */
#ifndef voxplex_io_SetNames_h
#define voxplex_io_SetNames_h

#include "LabelPairs.h"

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

namespace voxplex
{
struct LabelTable;
}

namespace voxplex::io
{

class MeshView;
class TextFile;

/** What a format allows in a name. */
struct NameRules
{
  bool (*Allows)(char32_t character);
  bool BeginsWithLetter;     ///< an ASCII one; other names get `set_` in front
  bool CaseMatters;          ///< or whether `Liver` and `LIVER` are one name; of ASCII letters
  std::size_t MaximalLength; ///< in bytes
};

/** Letters, digits, `_` and `-`, all ASCII; 80 characters; case does not matter. */
extern const NameRules AbaqusNames;
/** All but control characters, `"` and `\`; 127 bytes. For names between quotation marks. */
extern const NameRules QuotedNames;
/** As QuotedNames, and without what XML or FEBio's references to sets give a meaning to. */
extern const NameRules FEBioNames;

/** Thread-safe after construction. Complexity: O(n log n) in the number of labels and pairs. */
class SetNames
{
public:
  SetNames(const MeshView& view, const NameRules& rules);
  /** Of these pairs, and of these labels and those of the pairs but the background. */
  SetNames(std::set<std::int64_t> labels, const std::set<LabelPair>& pairs, const LabelTable& table,
    const NameRules& rules);

  /** Of a label that tetrahedra or triangles have. */
  const std::string& OfLabel(std::int64_t label) const { return this->Labels.at(label); }

  /** Of a pair of labels that triangles have. */
  const std::string& OfPair(const LabelPair& pair) const { return this->Pairs.at(pair); }

  /** A further name, which no set gets again; with the suffix if another set has it already. */
  std::string MakeUnique(const std::string& name, const std::string& suffix);

private:
  NameRules Rules;
  std::set<std::string> Taken; ///< in lower case if case does not matter
  std::map<std::int64_t, std::string> Labels;
  std::map<LabelPair, std::string> Pairs;
};

///@{
/**
 * Comments that list names, one a line, as `#   3: Liver` and `#   8: 7 3 Spleen__Liver`: the
 * label, or the number of the pair and the pair. Where the set's name is not the label's, that
 * follows: `#   3: Left_lung (Left lung)`.
 *
 * @param start of each line
 */
void WriteLabelNames(
  TextFile& file, const MeshView& view, const SetNames& names, std::string_view start);
void WritePairNames(
  TextFile& file, const MeshView& view, const SetNames& names, std::string_view start);
///@}

} // namespace voxplex::io

#endif
