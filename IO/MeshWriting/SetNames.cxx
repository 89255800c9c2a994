// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SetNames.h"

#include "LabelTable.h"
#include "MeshView.h"
#include "TextFile.h"

#include <algorithm>
#include <array>
#include <cctype>

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

struct Character
{
  char32_t Code;
  std::size_t Length; ///< in bytes
};

constexpr char32_t Invalid = 0; // no format allows it

/** The first character of UTF-8 text that is not empty; Invalid if it is not one of Unicode. */
Character FirstOf(std::string_view text)
{
  constexpr std::array<char32_t, 5> smallest{ 0, 0, 0x80, 0x800, 0x10000 };
  const auto first = static_cast<unsigned char>(text.front());
  if (first < 0x80)
  {
    return { first, 1 };
  }
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc0 || first > 0xf7 || text.size() < length)
  {
    return { Invalid, 1 };
  }
  char32_t code = first & (0x7fU >> length);
  for (std::size_t i = 1; i < length; ++i)
  {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte & 0xc0U) != 0x80)
    {
      return { Invalid, 1 };
    }
    code = (code << 6U) | (byte & 0x3fU);
  }
  const bool isSurrogate = code >= 0xd800 && code < 0xe000;
  const bool isNoCharacter = (code & 0xfffeU) == 0xfffe || code > 0x10ffff;
  const bool isOverlong = code < smallest[length];
  return { isSurrogate || isNoCharacter || isOverlong ? Invalid : code, length };
}

/** Without blanks at the ends; may be empty. */
std::string MakeLegal(std::string_view name, const NameRules& rules)
{
  std::string legal;
  bool isReplacing = false;
  while (!name.empty())
  {
    const auto [code, length] = FirstOf(name);
    if (!rules.Allows(code))
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

/** The first bytes of a text, at most `size`, without part of a character at the end. */
std::string_view Cut(std::string_view text, std::size_t size)
{
  const auto isInside = [&](std::size_t at)
  { return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0U) == 0x80; };
  while (size > 0 && isInside(size))
  {
    --size;
  }
  return text.substr(0, size);
}

std::string LowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

} // namespace

const NameRules AbaqusNames{ AbaqusAllows, true, false, 80 };
const NameRules QuotedNames{ QuotedAllows, false, true, 127 };
const NameRules FEBioNames{ FEBioAllows, false, true, 127 };

SetNames::SetNames(const MeshView& view, const NameRules& rules)
  : Rules(rules)
{
  std::set<std::int64_t> labels;
  std::set<LabelPair> pairs;
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    labels.insert(label);
  }
  for (const auto& [pair, cells] : view.TrianglesOfPair)
  {
    labels.insert({ pair.first, pair.second });
    pairs.insert(pair);
  }
  labels.erase(0);
  this->NameSets(labels, pairs, view.Table);
}

SetNames::SetNames(const std::set<std::int64_t>& labels, const std::set<LabelPair>& pairs,
  const LabelTable& table, const NameRules& rules)
  : Rules(rules)
{
  this->NameSets(labels, pairs, table);
}

void SetNames::NameSets(
  const std::set<std::int64_t>& labels, const std::set<LabelPair>& pairs, const LabelTable& table)
{
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
