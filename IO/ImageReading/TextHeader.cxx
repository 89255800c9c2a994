// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "TextHeader.h"

#include "Excerpt.h"
#include "FileError.h"
#include "InputFile.h"
#include "StoredVoxels.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>

namespace voxplex::io
{
namespace
{

constexpr std::size_t MaximumLength = 1 << 20; // of a header

std::string Trim(std::string text)
{
  text.erase(text.find_last_not_of(" \t\r") + 1);
  text.erase(0, text.find_first_not_of(" \t\r"));
  return text;
}

/** Numbers need no locale here: a decimal comma of the host's does not change them. */
std::optional<double> ParseNumber(const std::string& word)
{
  const char* const begin = word.data() + (word.starts_with('+') ? 1 : 0);
  double number = 0.0;
  const auto [end, error] = std::from_chars(begin, word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(number)
                                                                  : std::nullopt;
}

/** Whether a name of files has "%d" or "%03d". Any other % is a part of a name. */
bool IsPattern(const std::string& name)
{
  std::size_t at = name.find('%');
  while (at != std::string::npos)
  {
    at = name.find_first_not_of("0123456789", at + 1);
    if (at != std::string::npos && (name[at] == 'd' || name[at] == 'i' || name[at] == 'u'))
    {
      return true;
    }
    at = name.find('%', at);
  }
  return false;
}

std::string WithoutBrackets(std::string text)
{
  std::replace_if(
    text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  return text;
}

} // namespace

std::string LowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::vector<std::string> Words(const std::string& text)
{
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;)
  {
    words.push_back(word);
  }
  return words;
}

std::vector<double> ParseNumbers(std::string text)
{
  std::vector<double> numbers;
  for (const std::string& word : Words(WithoutBrackets(std::move(text))))
  {
    if (const std::optional<double> number = ParseNumber(word))
    {
      numbers.push_back(*number);
    }
  }
  return numbers;
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
    hasEnded = this->TakeLine(Trim(text.substr(at, end - at)));
    at = end + 1;
  }
  this->Length = at;
  if (!hasEnded && text.size() == MaximumLength)
  {
    throw FileError("its header does not end within 1 MiB");
  }
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
  const std::string name = Trim(line.substr(0, separator));
  const bool isAssigned = separator != std::string::npos && line.compare(separator, 2, ":=") == 0;
  const bool isPair = this->IsNRRD && isAssigned;
  if (separator == std::string::npos || (name.empty() && !isPair))
  {
    throw FileError("the line '" + Excerpt(line) + "' of its header is no field");
  }
  const std::string key = LowerCase(name);
  std::string value = Trim(line.substr(separator + (isAssigned ? 2 : 1)));
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
  if (!isNew && key != "comment")
  {
    throw FileError("its header gives '" + Excerpt(name) + "' more than once");
  }
  return isDataOfMetaImage && !this->IsInList; // which ends the header of MetaImage
}

const std::string* TextHeader::Find(const std::string& key) const
{
  const auto field = this->Fields.find(key);
  return field == this->Fields.end() ? nullptr : &field->second;
}

const std::string* TextHeader::FindPair(const std::string& key) const
{
  const auto pair = this->Pairs.find(key);
  return pair == this->Pairs.end() ? nullptr : &pair->second;
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

const std::string& TextHeader::SpellingOf(std::initializer_list<const char*> keys) const
{
  return this->Spellings.at(
    *std::find_if(keys.begin(), keys.end(), [this](const char* key) { return this->Find(key); }));
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
  std::vector<double> numbers;
  const std::vector<std::string> words = Words(WithoutBrackets(*value));
  for (const std::string& word : words)
  {
    if (const std::optional<double> number = ParseNumber(word))
    {
      numbers.push_back(*number);
    }
  }
  if (numbers.size() != count || words.size() != count)
  {
    throw FileError("its header gives '" + Excerpt(*value) + "' for '" +
      Excerpt(this->SpellingOf(keys)) + "', where " + std::to_string(count) +
      (count == 1 ? " number" : " numbers") + " must be: correct the header");
  }
  return numbers;
}

std::vector<std::int64_t> TextHeader::Wholes(
  std::initializer_list<const char*> keys, std::size_t count) const
{
  std::vector<std::int64_t> wholes;
  for (const double number : this->Numbers(keys, count))
  {
    constexpr double limit = 9e15;
    if (!(std::abs(number) <= limit) || std::trunc(number) != number)
    {
      throw FileError("its header gives '" + Excerpt(*this->FindAny(keys)) + "' for '" +
        Excerpt(this->SpellingOf(keys)) + "', where whole numbers must be: correct the header");
    }
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
