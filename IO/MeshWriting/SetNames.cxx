// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SetNames.h"

#include "LabelTable.h"
#include "MeshView.h"
#include "Text.h"
#include "TextFile.h"

#include <string>

namespace voxplex::io
{
namespace
{

bool IsLetter(char32_t c)
{
  return (c >= U'a' && c <= U'z') || (c >= U'A' && c <= U'Z');
}

bool AbaqusAllows(char32_t c)
{
  return IsLetter(c) || (c >= U'0' && c <= U'9') || c == U'_' || c == U'-';
}

bool IsControl(char32_t c)
{
  return c < 0x20 || (c >= 0x7f && c < 0xa0);
}

bool QuotedAllows(char32_t c)
{
  return !IsControl(c) && c != U'"' && c != U'\\';
}

bool FEBioAllows(char32_t c)
{
  return QuotedAllows(c) && std::u32string_view(U"&<>',:.@/").find(c) == std::u32string_view::npos;
}

/** Code points that Unicode gives to no character. */
bool IsNoCharacter(char32_t c)
{
  return (c & 0xfffeU) == 0xfffe;
}

/** Without blanks at the ends; may be empty. */
std::string MakeLegal(std::string_view name, const NameRules& rules)
{
  std::string legal;
  bool isReplacing = false;
  while (!name.empty())
  {
    const auto [code, length] = FirstCharacter(name);
    if (IsNoCharacter(code) || !rules.Allows(code))
    {
      isReplacing = true;
    }
    else if (code != U' ' || !legal.empty())
    {
      legal.append(isReplacing && !legal.empty() ? "_" : "").append(name.substr(0, length));
      isReplacing = false;
    }
    name.remove_prefix(length);
  }
  legal.erase(legal.find_last_not_of(' ') + 1);
  const bool lacksLetter =
    rules.BeginsWithLetter && !legal.empty() && !IsLetter(static_cast<unsigned char>(legal[0]));
  return lacksLetter ? "set_" + legal : legal;
}

} // namespace

const NameRules AbaqusNames{ AbaqusAllows, true, false, 80 };
const NameRules QuotedNames{ QuotedAllows, false, true, 127 };
const NameRules FEBioNames{ FEBioAllows, false, true, 127 };

SetNames::SetNames(const MeshView& view, const NameRules& rules)
  : SetNames(KeysOf(view.TetrahedraOfLabel), KeysOf(view.TrianglesOfPair), view.Table, rules)
{
}

SetNames::SetNames(std::set<std::int64_t> labels, const std::set<LabelPair>& pairs,
  const LabelTable& table, const NameRules& rules)
  : Rules(rules)
{
  for (const auto& [first, second] : pairs)
  {
    labels.insert({ first, second });
  }
  labels.erase(0);
  for (const std::int64_t label : labels)
  {
    const std::string suffix = "_" + std::to_string(label);
    std::string name = MakeLegal(table.NameOf(label), this->Rules);
    if (name.empty())
    {
      name = "label" + suffix;
    }
    this->Labels[label] = this->MakeUnique(name, suffix);
  }
  const auto side = [this](std::int64_t label)
  { return label == 0 ? "background" : this->OfLabel(label); };
  for (const LabelPair& pair : pairs)
  {
    this->Pairs[pair] = this->MakeUnique(side(pair.first) + "__" + side(pair.second),
      "_" + std::to_string(pair.first) + "_" + std::to_string(pair.second));
  }
}

std::string SetNames::MakeUnique(const std::string& name, const std::string& suffix)
{
  const auto withSuffix = [&](const std::string& ending)
  { return std::string(Cut(name, this->Rules.MaximalLength - ending.size())) + ending; };
  const auto take = [this](const std::string& candidate)
  { return this->Taken.insert(this->Rules.CaseMatters ? candidate : LowerCase(candidate)).second; };

  std::string unique = name.size() > this->Rules.MaximalLength ? withSuffix(suffix) : name;
  for (int n = 1; !take(unique); ++n)
  {
    unique = withSuffix(n == 1 ? suffix : suffix + "_" + std::to_string(n));
  }
  return unique;
}

void WriteLabelNames(
  TextFile& file, const MeshView& view, const SetNames& names, std::string_view start)
{
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    const std::string& name = names.OfLabel(label);
    const std::string full = MakeLegal(view.Table.NameOf(label), QuotedNames);
    file << start << "   " << label << ": " << name;
    if (!full.empty() && full != name)
    {
      file << " (" << Cut(full, QuotedNames.MaximalLength) << ')';
    }
    file << '\n';
  }
}

void WritePairNames(
  TextFile& file, const MeshView& view, const SetNames& names, std::string_view start)
{
  for (const auto& [pair, number] : view.PairNumber)
  {
    file << start << "   " << number << ": " << pair.first << ' ' << pair.second << ' '
         << names.OfPair(pair) << '\n';
  }
}

} // namespace voxplex::io
