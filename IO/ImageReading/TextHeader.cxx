// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "TextHeader.h"

#include "FileError.h"
#include "InputFile.h"
#include "StoredVoxels.h"
#include "Text.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace voxplex::io
{
namespace
{

constexpr std::size_t MaximumLength = 1 << 20; // of a header

bool IsOneOf(char letter, std::string_view letters)
{
  return letters.find(letter) != letters.npos;
}

/** Whether a name of files has "%d" or "%03d". Any other % is a part of a name. */
bool IsPattern(const std::string& name)
{
  std::size_t at = name.find('%');
  while (at != std::string::npos)
  {
    at = name.find_first_not_of("0123456789", at + 1);
    if (at != std::string::npos && IsOneOf(name[at], "diu"))
    {
      return true;
    }
    at = name.find('%', at);
  }
  return false;
}

/**
 * The data files that NRRD and MetaImage headers name by a pattern and numbers: "slice_%03d.raw 1 40 1". One number
 * may be printed; the step may be left out.
 *
 * @throws FileError for what is no such pattern, and for more than 100,000 files
 */
std::vector<std::string> ExpandPattern(const std::string& value)
{
  constexpr std::int64_t mostFiles = 100000;
  const std::vector<std::string_view> words = Words(value);
  const auto number = [&words](std::size_t word) { return ToNumber<std::int32_t>(words[word]); };
  const std::string_view pattern = words.empty() ? std::string_view() : words.front();
  const std::size_t percent = std::min(pattern.find('%'), pattern.size());
  const std::size_t letter =
    std::min(pattern.find_first_not_of("0123456789", percent + 1), pattern.size());
  const bool isPattern = letter < pattern.size() && letter - percent <= 3 &&
    IsOneOf(pattern[letter], "diu") && pattern.find('%', letter) == pattern.npos &&
    words.size() >= 3 && number(1) && number(2) && (words.size() == 3 || number(3));
  const std::int64_t first = isPattern ? *number(1) : 0;
  const std::int64_t span = isPattern ? *number(2) - first : 0;
  // NRRD may have one more number, of dimensions in each file, which the sizes tell, too.
  const std::int64_t step = isPattern && words.size() > 3 ? *number(3) : 1;
  RefuseIf(!isPattern || step == 0 || (span != 0 && (span > 0) != (step > 0)), "'", Excerpt(value),
    "' in its header is no pattern of names such as 'a_%03d.raw 1 40 1'");
  const std::int64_t count = span / step + 1;
  RefuseIf(count > mostFiles, "its header names ", count, " data files");
  const int width = ToNumber<int>(pattern.substr(percent + 1, letter - percent - 1)).value_or(0);
  std::vector<std::string> names;
  for (std::int64_t i = 0; i < count; ++i)
  {
    std::ostringstream name;
    name << pattern.substr(0, percent) << std::internal
         << std::setfill(pattern[percent + 1] == '0' ? '0' : ' ') << std::setw(width)
         << first + i * step << pattern.substr(letter + 1);
    names.push_back(name.str());
  }
  return names;
}

/** Null if there is none. */
const std::string* FindIn(const std::map<std::string, std::string>& texts, const std::string& key)
{
  const auto found = texts.find(key);
  return found == texts.end() ? nullptr : &found->second;
}

constexpr std::string_view BetweenNumbers = " \t\r\n\v\f(),";

} // namespace

std::vector<double> ParseNumbers(const std::string& text)
{
  std::vector<double> numbers;
  for (const std::string_view word : Words(text, BetweenNumbers))
  {
    if (const std::optional<double> number = ToNumber<double>(word))
    {
      numbers.push_back(*number);
    }
  }
  return numbers;
}

ScalarType TypeNamed(const std::string& name, const char* field, const TypeNames& names)
{
  const std::optional<ScalarType> type = FindType(name, names);
  RefuseIf(!type, "its header gives the ", field, " '", Excerpt(name),
    "', which is not a type of single numbers");
  return *type;
}

TextHeader::TextHeader(const InputFile& file)
  : Path(file.Path())
{
  const std::string text = file.Beginning(MaximumLength);
  this->IsNRRD = text.starts_with("NRRD");
  bool hasEnded = false;
  std::size_t at = this->IsNRRD ? std::min(text.find('\n'), text.size() - 1) + 1 : 0;
  while (at < text.size() && !hasEnded)
  {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    hasEnded = this->TakeLine(std::string(Trim(std::string_view(text).substr(at, end - at))));
    at = end + 1;
  }
  this->Length = at;
  RefuseIf(!hasEnded && text.size() == MaximumLength, "its header does not end within 1 MiB");
}

bool TextHeader::TakeLine(std::string line)
{
  if (line.empty())
  {
    return this->IsNRRD; // whose header it ends
  }
  if (this->IsInList)
  {
    this->List.push_back(std::move(line));
    return false;
  }
  if (line.front() == '#')
  {
    return false; // a comment
  }
  // In NRRD a key may have a colon, which no blank or equals sign follows.
  const std::size_t ofNRRD = std::min(line.find(": "), line.find(":="));
  const std::size_t separator = this->IsNRRD && ofNRRD != std::string::npos
    ? ofNRRD
    : line.find_first_of(this->IsNRRD ? ":" : "=:");
  const std::string name(Trim(line.substr(0, separator)));
  const bool isAssigned = separator != std::string::npos && line.compare(separator, 2, ":=") == 0;
  const bool isPair = this->IsNRRD && isAssigned;
  RefuseIf(separator == std::string::npos || (name.empty() && !isPair), "the line '", Excerpt(line),
    "' of its header is no field");
  const std::string key = LowerCase(name);
  std::string value(Trim(line.substr(separator + (isAssigned ? 2 : 1))));
  if (isPair)
  {
    this->Pairs.insert_or_assign(key, std::move(value));
    return false;
  }
  const bool isDataOfMetaImage = !this->IsNRRD && key == "elementdatafile";
  const bool isDataFile = isDataOfMetaImage || key == "data file" || key == "datafile";
  this->IsInList = isDataFile && !Words(value).empty() && Words(value).front() == "LIST";
  this->Spellings.emplace(key, name);
  const bool isNew = this->Fields.emplace(key, std::move(value)).second;
  RefuseIf(!isNew && key != "comment", "its header gives '", Excerpt(name), "' more than once");
  return isDataOfMetaImage && !this->IsInList; // which ends the header of MetaImage
}

const std::string* TextHeader::Find(const std::string& key) const
{
  return FindIn(this->Fields, key);
}

const std::string* TextHeader::FindPair(const std::string& key) const
{
  return FindIn(this->Pairs, key);
}

const std::string* TextHeader::FindAny(std::initializer_list<const char*> keys) const
{
  for (const char* key : keys)
  {
    if (const std::string* value = this->Find(key))
    {
      return value;
    }
  }
  return nullptr;
}

std::string TextHeader::SpellingOf(std::initializer_list<const char*> keys) const
{
  return Excerpt(this->Spellings.at(
    *std::find_if(keys.begin(), keys.end(), [this](const char* key) { return this->Find(key); })));
}

std::string TextHeader::Shown(std::initializer_list<const char*> keys) const
{
  const std::string* value = this->FindAny(keys);
  return value ? Excerpt(*value) : "";
}

std::string TextHeader::Word(
  std::initializer_list<const char*> keys, const std::string& missing) const
{
  const std::string* value = this->FindAny(keys);
  return value ? LowerCase(*value) : missing;
}

std::vector<double> TextHeader::Numbers(
  std::initializer_list<const char*> keys, std::size_t count) const
{
  const std::string* value = this->FindAny(keys);
  if (!value)
  {
    return {};
  }
  std::vector<double> numbers = ParseNumbers(*value);
  const std::size_t words = Words(*value, BetweenNumbers).size();
  RefuseIf(numbers.size() != count || words != count, "its header gives '", this->Shown(keys),
    "' for '", this->SpellingOf(keys), "', where ", count, (count == 1 ? " number" : " numbers"),
    " must be: correct the header");
  return numbers;
}

std::vector<std::int64_t> TextHeader::Wholes(
  std::initializer_list<const char*> keys, std::size_t count) const
{
  std::vector<std::int64_t> wholes;
  for (const double number : this->Numbers(keys, count))
  {
    constexpr double limit = 9e15;
    RefuseIf(!(std::abs(number) <= limit) || std::trunc(number) != number, "its header gives '",
      this->Shown(keys), "' for '", this->SpellingOf(keys),
      "', where whole numbers must be: correct the header");
    wholes.push_back(static_cast<std::int64_t>(number));
  }
  return wholes;
}

std::int64_t TextHeader::Whole(std::initializer_list<const char*> keys, std::int64_t missing) const
{
  const std::vector<std::int64_t> wholes = this->Wholes(keys, 1);
  return wholes.empty() ? missing : wholes.front();
}

void TextHeader::SetFiles(const std::string* value, bool anywhere, StoredVoxels& stored) const
{
  if (!value || LowerCase(*value) == "local")
  {
    stored.Files = { this->Path };
    stored.Offset = static_cast<std::int64_t>(this->Length);
    return;
  }
  const std::vector<std::string> names = this->IsInList ? this->List
    : IsPattern(*value)                                 ? ExpandPattern(*value)
                                                        : std::vector{ *value };
  for (const std::string& name : names)
  {
    stored.Files.push_back(FindDataFile(this->Path, name, anywhere));
  }
}

} // namespace voxplex::io
