// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "TextHeader.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace voxplex::io
{
namespace
{

constexpr std::size_t MaximumLength = 1 << 20;

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

/** "none (1,0,0) (0, 1, 0)": the vectors, empty where there is none. */
std::vector<std::vector<double>> ParseVectors(const std::string& text)
{
  std::vector<std::vector<double>> vectors;
  for (std::size_t at = 0; (at = text.find_first_not_of(" \t", at)) != std::string::npos;)
  {
    const bool isVector = text[at] == '(';
    const std::size_t end = std::min(text.find_first_of(isVector ? ")" : " \t", at), text.size());
    vectors.push_back(isVector ? ParseNumbers(text.substr(at, end - at)) : std::vector<double>());
    at = std::min(end + 1, text.size());
  }
  return vectors;
}

std::string ReadBeginning(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  std::string text(std::min<std::uintmax_t>(size, MaximumLength), '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

} // namespace

TextHeader::TextHeader(const std::string& path)
{
  const std::string text = ReadBeginning(path);
  this->IsNRRD = text.starts_with("NRRD");
  bool hasEnded = false;
  for (std::size_t at = 0; at < text.size() && !hasEnded;)
  {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    hasEnded = this->TakeLine(text.substr(at, end - at));
    at = end + 1;
  }
  this->Endless = !hasEnded && text.size() == MaximumLength;
}

bool TextHeader::TakeLine(std::string line)
{
  line.erase(line.find_last_not_of(" \t\r") + 1);
  line.erase(0, line.find_first_not_of(" \t"));
  if (line.empty())
  {
    return this->IsNRRD; // whose header it ends
  }
  if (this->IsInList)
  {
    this->List.push_back(std::move(line));
    return false;
  }
  const std::size_t separator = line.find_first_of("=:");
  if (separator == std::string::npos)
  {
    return false;
  }
  std::string key = LowerCase(line.substr(0, separator));
  key.erase(key.find_last_not_of(" \t") + 1);
  std::string value = line.substr(separator + 1);
  value.erase(0, value.find_first_not_of(" \t=")); // NRRD has "key:=value", too
  const bool isDataOfMetaImage = key == "elementdatafile";
  this->IsInList =
    (isDataOfMetaImage || key == "data file" || key == "datafile") && value.rfind("LIST", 0) == 0;
  this->Fields.emplace(key, std::move(value));
  return isDataOfMetaImage && !this->IsInList; // which ends the header of MetaImage
}

const std::string* TextHeader::Find(const std::string& key) const
{
  const auto field = this->Fields.find(key);
  return field == this->Fields.end() ? nullptr : &field->second;
}

std::vector<double> ParseNumbers(std::string text)
{
  std::replace_if(
    text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::vector<double> numbers;
  for (const std::string& word : Words(text))
  {
    double number = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error == std::errc() && end == word.data() + word.size())
    {
      numbers.push_back(number);
    }
  }
  return numbers;
}

bool NRRDAxis::IsList() const
{
  return !this->Kind.empty() && this->Kind != "domain" && this->Kind != "space" &&
    this->Kind != "time" && this->Kind != "???";
}

std::vector<NRRDAxis> ParseNRRDAxes(const TextHeader& header)
{
  const std::string* sizes = header.Find("sizes");
  if (!sizes)
  {
    return {};
  }
  std::vector<NRRDAxis> axes(Words(*sizes).size());
  if (const std::string* kinds = header.Find("kinds"))
  {
    const std::vector<std::string> words = Words(LowerCase(*kinds));
    for (std::size_t a = 0; a < std::min(axes.size(), words.size()); ++a)
    {
      axes[a].Kind = words[a];
    }
  }
  if (const std::string* directions = header.Find("space directions"))
  {
    const auto vectors = ParseVectors(*directions);
    for (std::size_t a = 0; a < std::min(axes.size(), vectors.size()); ++a)
    {
      // A vector of NaN says 'none', too.
      const bool isNone = std::all_of(
        vectors[a].begin(), vectors[a].end(), [](double number) { return std::isnan(number); });
      axes[a].Direction = isNone ? std::vector<double>() : vectors[a];
    }
  }
  if (const std::string* spacings = header.Find("spacings"))
  {
    const std::vector<double> numbers = ParseNumbers(*spacings);
    for (std::size_t a = 0; a < std::min(axes.size(), numbers.size()); ++a)
    {
      axes[a].HasSpacing = true;
      axes[a].Spacing = numbers[a];
    }
  }
  return axes;
}

} // namespace voxplex::io
