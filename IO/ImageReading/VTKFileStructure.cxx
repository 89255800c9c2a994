// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "VTKFileStructure.h"

#include "FileError.h"
#include "Text.h"

#include <vtk_expat.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace voxplex::io
{
namespace
{

[[noreturn]] void RefuseDamage(const std::string& reason)
{
  Refuse("it is truncated or damaged: ", reason);
}

/** Of a number. */
struct Limits
{
  double Least = -std::numeric_limits<double>::max();
  double Most = std::numeric_limits<double>::max();
};

template <typename T>
Limits LimitsOf()
{
  return { static_cast<double>(std::numeric_limits<T>::lowest()),
    static_cast<double>(std::numeric_limits<T>::max()) };
}

/** Of the numbers of an array; nothing for a type that VTK does not have. */
std::optional<Limits> LimitsOfType(std::string_view type)
{
  struct Known
  {
    std::string_view Name;
    Limits Numbers;
  };
  const std::array<Known, 11> known{ { { "Int8", LimitsOf<std::int8_t>() },
    { "UInt8", LimitsOf<std::uint8_t>() }, { "Int16", LimitsOf<std::int16_t>() },
    { "UInt16", LimitsOf<std::uint16_t>() }, { "Int32", LimitsOf<std::int32_t>() },
    { "UInt32", LimitsOf<std::uint32_t>() }, { "Int64", LimitsOf<std::int64_t>() },
    { "UInt64", LimitsOf<std::uint64_t>() }, { "Float32", LimitsOf<double>() },
    { "Float64", LimitsOf<double>() }, { "Bit", { 0, 1 } } } };
  const auto found =
    std::find_if(known.begin(), known.end(), [type](const Known& one) { return one.Name == type; });
  return found == known.end() ? std::nullopt : std::optional(found->Numbers);
}

/** What comes before the appended data. */
struct Structure
{
  XML_Parser Parser = nullptr;
  bool HasDocumentType = false;
  std::string Wrong; ///< an attribute that is none, and that VTK would leave out
  std::string Kind;  ///< of what the file holds
  bool IsCompressed = false;
  bool IsBigEndian = false;
  std::size_t BytesOfCount = 4; ///< before the bytes of an array
  std::string WholeExtent;
  std::vector<std::string> Extents;   ///< of each piece
  std::vector<std::uint64_t> Offsets; ///< of arrays in the appended data
  bool IsAppended = false;
  bool IsBase64 = false;
  std::uint64_t AppendedTag = 0; ///< where its element begins
  bool IsInFields = false;       ///< and not in data of points or cells
  bool IsInline = false;         ///< inside an array in base64
  std::string InlineBeginning;
  std::uint64_t InlineLength = 0; ///< of the array in base64
  bool IsInterrupted = false;     ///< what is in base64 has blanks or other letters within
  bool HasBlank = false;          ///< after letters of the array
  std::optional<Limits> OfText;   ///< inside an array of text: of its numbers
  std::string Word;               ///< the last of them
  std::vector<std::array<std::uint64_t, 2>> Inline; ///< of each: the bytes that it claims, and has
};

std::uint64_t DecodeBase64(char letter)
{
  constexpr std::string_view letters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t value = letters.find(letter);
  return value == letters.npos ? 0 : value;
}

/** The bytes of the first four letters, of the next four, ... */
std::string DecodeWords(const std::string& letters)
{
  std::string decoded;
  for (std::size_t i = 0; i + 4 <= letters.size(); i += 4)
  {
    std::uint64_t bits = 0;
    for (std::size_t j = 0; j < 4; ++j)
    {
      bits = bits << 6 | DecodeBase64(letters[i + j]);
    }
    decoded +=
      { static_cast<char>(bits >> 16), static_cast<char>(bits >> 8), static_cast<char>(bits) };
  }
  return decoded;
}

constexpr std::size_t LettersOfCount = 12; // are enough for either size

bool IsBase64(char letter)
{
  return (letter >= 'A' && letter <= 'Z') || (letter >= 'a' && letter <= 'z') ||
    (letter >= '0' && letter <= '9') || letter == '+' || letter == '/' || letter == '=';
}

bool IsBlank(char letter)
{
  return letter == ' ' || letter == '\n' || letter == '\r' || letter == '\t';
}

/** The number of bytes that an array claims, of which these are the first. */
std::uint64_t DecodeCount(const std::string& text, bool isBase64, const Structure& structure)
{
  std::string bytes = isBase64 ? DecodeWords(text) : text;
  bytes.resize(structure.BytesOfCount);
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
  {
    const char byte = bytes[structure.IsBigEndian ? i : bytes.size() - 1 - i];
    count = count << 8 | static_cast<unsigned char>(byte);
  }
  return count;
}

/** What is compressed begins with the number of blocks, and has a size for each; VTK notices itself if blocks are
 * short. */
void CheckCount(std::uint64_t count, std::uint64_t bytes, const Structure& structure)
{
  const std::uint64_t most = bytes - std::min<std::uint64_t>(bytes, structure.BytesOfCount);
  if (count > (structure.IsCompressed ? most / structure.BytesOfCount : most))
  {
    RefuseDamage("an array claims " + std::to_string(count) +
      (structure.IsCompressed ? " blocks" : " bytes") + ", and has " + std::to_string(bytes) +
      " bytes");
  }
}

Structure& At(void* data)
{
  return *static_cast<Structure*>(data);
}

std::string Attribute(const char** attributes, std::string_view name)
{
  for (; *attributes; attributes += 2)
  {
    if (name == attributes[0])
    {
      return attributes[1];
    }
  }
  return {};
}

/** The same numbers with one blank between them. */
std::string Normalize(const std::string& numbers)
{
  std::istringstream stream(numbers);
  std::string all;
  for (std::string number; stream >> number;)
  {
    all += (all.empty() ? "" : " ") + number;
  }
  return all;
}

/** An attribute of so many numbers, if it is there. */
void CheckNumbers(Structure& structure, const char** attributes, const char* name,
  std::size_t count, Limits limits = {})
{
  const std::string text = Attribute(attributes, name);
  std::istringstream words(text);
  std::size_t found = 0;
  for (std::string word; words >> word; ++found)
  {
    double number = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    const bool isNumber = error == std::errc() && end == word.data() + word.size() &&
      number >= limits.Least && number <= limits.Most;
    found += isNumber ? 0 : count;
  }
  if (found != count && !text.empty())
  {
    structure.Wrong = std::string(name) + "=\"" + Excerpt(text) + "\"";
  }
}

void StartArray(Structure& structure, const char** attributes)
{
  constexpr double mostComponents = 10'000;
  constexpr double mostTuples =
    10'000'000; // of field data; other arrays have one for each point or cell
  CheckNumbers(structure, attributes, "NumberOfComponents", 1, { 1, mostComponents });
  CheckNumbers(structure, attributes, "NumberOfTuples", 1,
    structure.IsInFields ? Limits{ 0, mostTuples } : Limits{});
  CheckNumbers(structure, attributes, "offset", 1, { 0 });
  const std::string type = Attribute(attributes, "type");
  const std::optional<Limits> limits = LimitsOfType(type);
  if (!limits && !(type == "String" && structure.IsInFields)) // VTK's reader crashes
  {
    structure.Wrong = "type=\"" + Excerpt(type) + "\" of an array";
  }
  const std::string format = Attribute(attributes, "format");
  if (format == "ascii" && type != "Float32" && type != "Float64")
  {
    structure.OfText = limits;
  }
  if (format == "appended")
  {
    const std::string offset = Attribute(attributes, "offset");
    std::uint64_t value = 0;
    if (std::from_chars(offset.data(), offset.data() + offset.size(), value).ec != std::errc())
    {
      structure.Wrong = "offset=\"" + Excerpt(offset) + "\"";
    }
    structure.Offsets.push_back(value);
  }
  else if (format == "binary")
  {
    structure.IsInline = true;
    structure.InlineBeginning.clear();
    structure.InlineLength = 0;
    structure.HasBlank = false;
  }
}

void StartElement(void* data, const char* elementName, const char** attributes)
{
  Structure& structure = At(data);
  const std::string_view name(elementName);
  if (name == "VTKFile")
  {
    structure.Kind = Attribute(attributes, "type");
    structure.IsCompressed = !Attribute(attributes, "compressor").empty();
    structure.IsBigEndian = Attribute(attributes, "byte_order") == "BigEndian";
    structure.BytesOfCount = Attribute(attributes, "header_type") == "UInt64" ? 8 : 4;
  }
  else if (name == "ImageData")
  {
    structure.WholeExtent = Normalize(Attribute(attributes, "WholeExtent"));
    CheckNumbers(structure, attributes, "Spacing", 3);
    CheckNumbers(structure, attributes, "Origin", 3);
    CheckNumbers(structure, attributes, "Direction", 9);
  }
  else if (name == "Piece")
  {
    structure.Extents.push_back(Normalize(Attribute(attributes, "Extent")));
  }
  else if (name == "FieldData" || name == "PointData" || name == "CellData")
  {
    structure.IsInFields = name == "FieldData";
  }
  else if (name == "DataArray" || name == "Array")
  {
    StartArray(structure, attributes);
  }
  else if (name == "AppendedData")
  {
    structure.IsAppended = true;
    structure.IsBase64 = Attribute(attributes, "encoding") == "base64";
    structure.AppendedTag = static_cast<std::uint64_t>(XML_GetCurrentByteIndex(structure.Parser));
    XML_StopParser(structure.Parser, XML_FALSE); // what follows may be no XML
  }
}

/** VTK would make another number of one that does not fit. What is no number it finds itself. */
void CheckWord(Structure& structure)
{
  double number = 0.0;
  const char* const begin = structure.Word.data();
  if (std::from_chars(begin, begin + structure.Word.size(), number).ec == std::errc() &&
    !(number >= structure.OfText->Least && number <= structure.OfText->Most))
  {
    structure.Wrong = "the number " + Excerpt(structure.Word) + " in an array of a smaller type";
  }
  structure.Word.clear();
}

void AddText(void* data, const char* text, int length)
{
  Structure& structure = At(data);
  const std::string_view letters(text, structure.IsInline ? static_cast<std::size_t>(length) : 0);
  for (const char letter : letters)
  {
    if (IsBlank(letter))
    {
      structure.HasBlank = structure.InlineLength > 0;
      continue;
    }
    structure.IsInterrupted = structure.IsInterrupted || structure.HasBlank || !IsBase64(letter);
    ++structure.InlineLength;
    if (structure.InlineBeginning.size() < LettersOfCount)
    {
      structure.InlineBeginning += letter;
    }
  }
  for (const char letter :
    std::string_view(text, structure.OfText ? static_cast<std::size_t>(length) : 0))
  {
    if (IsBlank(letter))
    {
      CheckWord(structure);
    }
    else
    {
      structure.Word += letter;
    }
  }
}

void EndElement(void* data, const char* /*name*/)
{
  Structure& structure = At(data);
  if (structure.IsInline)
  {
    structure.Inline.push_back(
      { DecodeCount(structure.InlineBeginning, true, structure), structure.InlineLength / 4 * 3 });
  }
  structure.IsInline = false;
  if (structure.OfText)
  {
    CheckWord(structure);
    structure.OfText.reset();
  }
}

/** VTK's files have none. */
void RefuseDocumentType(void* data, const char* /*name*/, const char* /*system*/,
  const char* /*identifier*/, int /*hasInternalSubset*/)
{
  At(data).HasDocumentType = true;
  XML_StopParser(At(data).Parser, XML_FALSE);
}

Structure Parse(const InputFile& file)
{
  const std::unique_ptr<std::remove_pointer_t<XML_Parser>, void (*)(XML_Parser)> parser(
    XML_ParserCreate(nullptr), XML_ParserFree);
  Structure structure;
  structure.Parser = parser.get();
  XML_SetUserData(parser.get(), &structure);
  XML_SetElementHandler(parser.get(), StartElement, EndElement);
  XML_SetCharacterDataHandler(parser.get(), AddText);
  XML_SetStartDoctypeDeclHandler(parser.get(), RefuseDocumentType);
  std::vector<std::byte> buffer(1 << 20);
  std::uint64_t position = 0;
  bool isLast = false;
  while (!isLast && !structure.IsAppended)
  {
    const std::size_t got = file.ReadAt(position, buffer);
    position += got;
    isLast = got < buffer.size();
    if (XML_Parse(parser.get(), reinterpret_cast<const char*>(buffer.data()), static_cast<int>(got),
          isLast) != XML_STATUS_OK &&
      !structure.IsAppended)
    {
      RefuseIf(structure.HasDocumentType,
        "it has a document type, which VTK's files have not: take that line out");
      RefuseDamage(std::string(XML_ErrorString(XML_GetErrorCode(parser.get()))) + " in line " +
        std::to_string(XML_GetCurrentLineNumber(parser.get())));
    }
  }
  return structure;
}

std::string ReadText(const InputFile& file, std::uint64_t position, std::size_t length)
{
  std::string text(length, '\0');
  text.resize(file.ReadAt(position, std::as_writable_bytes(std::span(text))));
  return text;
}

/** Where the appended data begin and end. */
struct Range
{
  std::uint64_t Begin;
  std::uint64_t End;
};

Range FindAppendedData(const InputFile& file, const Structure& structure)
{
  constexpr std::size_t enough = 1000;
  const std::string start = ReadText(file, structure.AppendedTag, enough);
  const std::size_t mark = start.find('_', start.find('>'));
  const std::uint64_t tail = file.Size() - std::min<std::uint64_t>(file.Size(), enough);
  const std::string end = ReadText(file, tail, enough);
  const std::size_t last = end.rfind("</AppendedData>");
  if (mark == start.npos || last == end.npos || end.find("</VTKFile>", last) == end.npos)
  {
    RefuseDamage("its appended data do not end");
  }
  return { structure.AppendedTag + mark + 1, tail + last };
}

/** VTK takes what it has for numbers where a letter is none of base64. */
void CheckLetters(const InputFile& file, const Range& data, Structure& structure)
{
  constexpr std::uint64_t most = 1 << 20;
  bool hasBegun = false;
  bool hasBlank = false;
  for (std::uint64_t at = data.Begin; at < data.End && structure.IsBase64; at += most)
  {
    const std::uint64_t length = std::min(most, data.End - at);
    for (const char letter : ReadText(file, at, static_cast<std::size_t>(length)))
    {
      const bool isBlank = IsBlank(letter);
      structure.IsInterrupted =
        structure.IsInterrupted || (!isBlank && (hasBlank || !IsBase64(letter)));
      hasBlank = isBlank && hasBegun;
      hasBegun = hasBegun || !isBlank;
    }
  }
}

void CheckAppendedData(const InputFile& file, Structure& structure)
{
  const Range data = FindAppendedData(file, structure);
  CheckLetters(file, data, structure);
  const std::uint64_t length = data.End > data.Begin ? data.End - data.Begin : 0;
  for (const std::uint64_t offset : structure.Offsets)
  {
    if (offset >= length)
    {
      RefuseDamage("an array begins beyond the end");
    }
    const std::string first = ReadText(
      file, data.Begin + offset, structure.IsBase64 ? LettersOfCount : structure.BytesOfCount);
    CheckCount(DecodeCount(first, structure.IsBase64, structure),
      structure.IsBase64 ? (length - offset) / 4 * 3 : length - offset, structure);
  }
}

} // namespace

void CheckKindOfVTK(const std::string& kind, std::string_view wanted)
{
  RefuseIf(kind.empty(), "it is truncated or damaged: it does not say what it holds");
  RefuseIf(kind != wanted, "it holds ", Excerpt(kind), "; a label image of VTK is ", wanted,
    ": sample it on a regular grid (vtkImageData) first");
}

void CheckStructureOfVTI(const InputFile& file)
{
  Structure structure = Parse(file);
  CheckKindOfVTK(structure.Kind, "ImageData");
  RefuseIf(!structure.Wrong.empty(), "it has ", structure.Wrong, ", which cannot be: correct it");
  RefuseIf(structure.Extents.size() != 1, "it is stored in ", structure.Extents.size(),
    " pieces: save it in one");
  if (structure.Extents.front() != structure.WholeExtent)
  {
    RefuseDamage("it has the extent " + Excerpt(structure.WholeExtent) + ", and its piece " +
      Excerpt(structure.Extents.front()));
  }
  for (const auto& [count, bytes] : structure.Inline)
  {
    CheckCount(count, bytes, structure);
  }
  if (structure.IsAppended)
  {
    CheckAppendedData(file, structure);
  }
  RefuseIf(structure.IsInterrupted,
    "its data in base64 have line breaks or foreign letters within, which VTK does not read: save "
    "it in the encoding raw");
}

} // namespace voxplex::io
