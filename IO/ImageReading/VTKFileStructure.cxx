// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "VTKFileStructure.h"

#include "Fields.h"
#include "Readers.h"
#include "Text.h"
#include "XMLParser.h"

#include <vtkBase64Utilities.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace voxplex::io
{
namespace
{

constexpr const char* Damaged = "it is truncated or damaged: ";

/** Of a number. */
struct Limits
{
  double Least = -std::numeric_limits<double>::max();
  double Most = std::numeric_limits<double>::max();
};

/** Of the numbers of an array; nothing for a type that VTK does not have. */
std::optional<Limits> LimitsOfType(std::string_view type)
{
  constexpr TypeNames names{ "|Int8|", "|UInt8|", "|Int16|", "|UInt16|", "|Int32|", "|UInt32|",
    "|Int64|", "|UInt64|", "|Float32|", "|Float64|" };
  if (type == "Bit")
  {
    return Limits{ 0, 1 };
  }
  const std::optional<ScalarType> found = FindType(type, names);
  const auto limits = [](auto zero)
  {
    using T = decltype(zero);
    return std::is_integral_v<T> ? Limits{ static_cast<double>(std::numeric_limits<T>::lowest()),
      static_cast<double>(std::numeric_limits<T>::max()) }
                                 : Limits();
  };
  return found ? std::optional(Dispatch(*found, limits)) : std::nullopt;
}

bool IsBlank(char letter)
{
  return letter == ' ' || letter == '\n' || letter == '\r' || letter == '\t';
}

constexpr std::size_t LettersOfCounts = 32; // are enough for three of either size

/** What an array begins with: its bytes; if it is compressed its blocks, the size of each and that of the last. */
using Counts = std::array<std::uint64_t, 3>;

/** Any compressor's. */
constexpr double MostOfAByte = 65536.0;

/** Those of arrays in base64, among blanks. */
struct Letters
{
  std::string Beginning;
  std::uint64_t Length = 0;
  bool HasEnded = false; ///< for VTK: after a letter came what is none
  bool IsInterrupted =
    false; ///< by blanks or other letters, for which VTK takes numbers that it has

  void Add(std::string_view text)
  {
    for (const char letter : text)
    {
      const bool isBase64 = (letter >= 'A' && letter <= 'Z') || (letter >= 'a' && letter <= 'z') ||
        (letter >= '0' && letter <= '9') || letter == '+' || letter == '/' || letter == '=';
      if (IsBlank(letter))
      {
        this->HasEnded = this->Length > 0;
        continue;
      }
      this->IsInterrupted = this->IsInterrupted || this->HasEnded || !isBase64;
      this->Beginning.append(this->Length++ < LettersOfCounts ? 1 : 0, letter);
    }
  }
};

/** What comes before the appended data. */
struct Structure
{
  std::string Wrong; ///< an attribute that is none, and that VTK would leave out
  std::string Kind;  ///< of what the file holds
  bool IsCompressed = false;
  bool IsBigEndian = false;
  std::size_t BytesOfCount = 4; ///< before the bytes of an array
  std::string WholeExtent;
  std::vector<std::string> Extents;   ///< of each piece
  double MostClaimed = 0;             ///< of points, or of cells of a kind
  std::vector<std::uint64_t> Offsets; ///< of arrays in the appended data
  bool IsAppended = false;
  bool IsBase64 = false;
  std::uint64_t AppendedTag = 0;   ///< where its element begins
  int Depth = 0;                   ///< open elements
  bool IsInFields = false;         ///< and not in data of points or cells
  std::optional<Letters> OfBase64; ///< inside an array in base64
  bool IsInterrupted = false;      ///< what is in base64 has blanks or other letters within
  std::optional<Limits> OfText;    ///< inside an array of text: of its numbers
  int Nested = 0;                  ///< open elements inside of that array: keys of information
  std::string Word;                ///< the last of them
  std::vector<std::pair<Counts, std::uint64_t>> Inline; ///< of each: what it claims, its bytes
};

/** What an array claims, of which these are the first bytes. */
Counts DecodeCounts(const std::string& text, bool isBase64, const Structure& structure)
{
  std::string bytes = text;
  bytes.resize(LettersOfCounts, isBase64 ? 'A' : '\0');
  if (isBase64)
  {
    auto* data = reinterpret_cast<unsigned char*>(bytes.data());
    vtkBase64Utilities::DecodeSafely(data, LettersOfCounts, data, LettersOfCounts / 4 * 3);
  }
  const Fields fields(bytes, structure.IsBigEndian);
  const auto count = [&](std::size_t i) -> std::uint64_t
  {
    const std::size_t at = i * structure.BytesOfCount;
    return structure.BytesOfCount == 8 ? fields.Get<std::uint64_t>(at)
                                       : fields.Get<std::uint32_t>(at);
  };
  return { count(0), count(1), count(2) };
}

/** VTK looks for the last block by its size, and notices itself if blocks are short. */
void CheckCounts(const Counts& counts, std::uint64_t bytes, const Structure& structure)
{
  const auto& [count, size, last] = counts;
  const std::uint64_t most = bytes - std::min<std::uint64_t>(bytes, structure.BytesOfCount);
  RefuseIf(count > (structure.IsCompressed ? most / structure.BytesOfCount : most), Damaged,
    "an array claims ", count, (structure.IsCompressed ? " blocks" : " bytes"), ", and has ", bytes,
    " bytes");
  const double total =
    (static_cast<double>(count) - 1) * static_cast<double>(size) + static_cast<double>(last);
  const bool fits = count == 0
    ? last == 0
    : size > 0 && last <= size && total <= MostOfAByte * static_cast<double>(bytes);
  RefuseIf(structure.IsCompressed && !fits, Damaged, "an array claims ", count, " blocks of ", size,
    " bytes, the last of ", last, ", and has ", bytes, " bytes");
}

/** The same numbers with one blank between them. */
std::string Normalize(const std::string& numbers)
{
  std::string all;
  for (const std::string_view number : Words(numbers))
  {
    all.append(all.empty() ? "" : " ").append(number);
  }
  return all;
}

/** An attribute of so many numbers, if it is there. */
void CheckNumbers(Structure& structure, const TextFields& attributes, const char* name,
  std::size_t count, Limits limits = {})
{
  const std::string text = TextOf(attributes, name);
  const std::vector<std::string_view> words = Words(text);
  const bool areNumbers = words.size() == count &&
    std::all_of(words.begin(), words.end(),
      [&limits](std::string_view word)
      {
        const std::optional<double> number = ToNumber<double>(word);
        return number && *number >= limits.Least && *number <= limits.Most;
      });
  if (!areNumbers && !text.empty())
  {
    structure.Wrong = std::string(name) + "=\"" + Excerpt(text) + "\"";
  }
}

void StartArray(Structure& structure, const TextFields& attributes)
{
  constexpr double mostComponents = 10'000;
  constexpr double mostTuples =
    10'000'000; // of field data; other arrays have one for each point or cell
  CheckNumbers(structure, attributes, "NumberOfComponents", 1, { 1, mostComponents });
  CheckNumbers(structure, attributes, "NumberOfTuples", 1,
    structure.IsInFields ? Limits{ 0, mostTuples } : Limits{});
  CheckNumbers(structure, attributes, "offset", 1, { 0 });
  const std::string type = TextOf(attributes, "type");
  const std::optional<Limits> limits = LimitsOfType(type);
  if (!limits && !(type == "String" && structure.IsInFields)) // VTK's reader crashes
  {
    structure.Wrong = "type=\"" + Excerpt(type) + "\" of an array";
  }
  const std::string format = TextOf(attributes, "format");
  if (format == "ascii" && type != "Float32" && type != "Float64")
  {
    structure.OfText = limits;
  }
  if (format == "appended")
  {
    const std::string offset = TextOf(attributes, "offset");
    const std::optional<std::uint64_t> value = ToNumber<std::uint64_t>(offset);
    if (!value)
    {
      structure.Wrong = "offset=\"" + Excerpt(offset) + "\"";
    }
    structure.Offsets.push_back(value.value_or(0));
  }
  else if (format == "binary")
  {
    structure.OfBase64.emplace();
  }
}

/** A piece that may be one of a mesh. */
void StartMesh(Structure& structure, const TextFields& attributes)
{
  for (const char* const name : { "NumberOfPoints", "NumberOfCells", "NumberOfVerts",
         "NumberOfLines", "NumberOfStrips", "NumberOfPolys" })
  {
    CheckNumbers(structure, attributes, name, 1, { 0 });
    const auto number = ToNumber<double>(TextOf(attributes, name));
    structure.MostClaimed = std::max(structure.MostClaimed, number.value_or(0));
  }
}

/** VTK takes text in base64 from the file itself, and stops at what is no letter there. */
void Interrupt(Structure& structure)
{
  if (structure.OfBase64 && structure.OfBase64->Length > 0)
  {
    structure.OfBase64->HasEnded = true;
  }
}

void StartElement(
  Structure& structure, XMLParser& parser, std::string_view name, const TextFields& attributes)
{
  constexpr int deepest = 100; // VTK calls itself for each
  if (++structure.Depth > deepest)
  {
    structure.Wrong = "elements in more than " + std::to_string(deepest) + " others";
  }
  if (structure.OfBase64 || structure.OfText)
  {
    ++structure.Nested;
    Interrupt(structure);
  }
  if (name == "VTKFile")
  {
    structure.Kind = TextOf(attributes, "type");
    structure.IsCompressed = !TextOf(attributes, "compressor").empty();
    structure.IsBigEndian = TextOf(attributes, "byte_order") == "BigEndian";
    structure.BytesOfCount = TextOf(attributes, "header_type") == "UInt64" ? 8 : 4;
  }
  else if (name == "ImageData")
  {
    structure.WholeExtent = Normalize(TextOf(attributes, "WholeExtent"));
    CheckNumbers(structure, attributes, "Spacing", 3);
    CheckNumbers(structure, attributes, "Origin", 3);
    CheckNumbers(structure, attributes, "Direction", 9);
  }
  else if (name == "Piece")
  {
    structure.Extents.push_back(Normalize(TextOf(attributes, "Extent")));
    StartMesh(structure, attributes);
  }
  else if (name == "FieldData" || name == "PointData" || name == "CellData")
  {
    structure.IsInFields = name == "FieldData";
  }
  else if ((name == "DataArray" || name == "Array") && structure.Nested == 0)
  {
    StartArray(structure, attributes);
  }
  else if (name == "AppendedData")
  {
    structure.IsAppended = true;
    structure.IsBase64 = TextOf(attributes, "encoding") == "base64";
    structure.AppendedTag = parser.Offset();
    parser.Stop(); // what follows may be no XML
  }
}

/** VTK would make another number of one that does not fit. What is no number it finds itself. */
void CheckWord(Structure& structure)
{
  const std::optional<double> number = ToNumber<double>(structure.Word);
  if (number && !(*number >= structure.OfText->Least && *number <= structure.OfText->Most))
  {
    structure.Wrong = "the number " + Excerpt(structure.Word) + " in an array of a smaller type";
  }
  structure.Word.clear();
}

void AddText(Structure& structure, XMLParser& parser, std::string_view text)
{
  if (structure.Nested > 0)
  {
    return;
  }
  if (structure.OfBase64)
  {
    structure.OfBase64->Add(text);
    structure.OfBase64->IsInterrupted = structure.OfBase64->IsInterrupted ||
      (parser.Length() != text.size() && !IsBlank(text[0])); // written as a reference, &#65;
  }
  for (const char letter : structure.OfText ? text : std::string_view())
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

void EndElement(Structure& structure)
{
  --structure.Depth;
  if (structure.Nested > 0)
  {
    --structure.Nested;
    return;
  }
  if (const std::optional<Letters>& letters = structure.OfBase64)
  {
    structure.Inline.push_back(
      { DecodeCounts(letters->Beginning, true, structure), letters->Length / 4 * 3 });
    structure.IsInterrupted = structure.IsInterrupted || letters->IsInterrupted;
    structure.OfBase64.reset();
  }
  if (structure.OfText)
  {
    CheckWord(structure);
    structure.OfText.reset();
  }
}

Structure Parse(const InputFile& file)
{
  Structure structure;
  XMLParser parser({ [&](std::string_view name, const TextFields& attributes)
    { StartElement(structure, parser, name, attributes); },
    [&] { EndElement(structure); },
    [&](std::string_view text) { AddText(structure, parser, text); },
    [&] { Interrupt(structure); } });
  std::vector<std::byte> buffer(1 << 20);
  std::uint64_t position = 0;
  bool isLast = false;
  while (!isLast && !structure.IsAppended)
  {
    const std::size_t got = file.ReadAt(position, buffer);
    position += got;
    isLast = got < buffer.size();
    const std::string_view part(reinterpret_cast<const char*>(buffer.data()), got);
    if (!parser.Parse(part, isLast) && !structure.IsAppended)
    {
      RefuseIf(parser.HasDocumentType(),
        "it has a document type, which VTK's files have not: take that line out");
      Refuse(Damaged, parser.Error());
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
  RefuseIf(mark == start.npos || last == end.npos || end.find("</VTKFile>", last) == end.npos,
    Damaged, "its appended data do not end");
  return { structure.AppendedTag + mark + 1, tail + last };
}

void CheckLetters(const InputFile& file, const Range& data, Structure& structure)
{
  constexpr std::uint64_t most = 1 << 20;
  Letters letters;
  for (std::uint64_t at = data.Begin; at < data.End && structure.IsBase64; at += most)
  {
    letters.Add(ReadText(file, at, static_cast<std::size_t>(std::min(most, data.End - at))));
  }
  structure.IsInterrupted = structure.IsInterrupted || letters.IsInterrupted;
}

void CheckAppendedData(const InputFile& file, Structure& structure)
{
  const Range data = FindAppendedData(file, structure);
  CheckLetters(file, data, structure);
  const std::uint64_t length = data.End > data.Begin ? data.End - data.Begin : 0;
  for (const std::uint64_t offset : structure.Offsets)
  {
    RefuseIf(offset >= length, Damaged, "an array begins beyond the end");
    const std::string first = ReadText(file, data.Begin + offset, LettersOfCounts);
    CheckCounts(DecodeCounts(first, structure.IsBase64, structure),
      structure.IsBase64 ? (length - offset) / 4 * 3 : length - offset, structure);
  }
}

void CheckPieces(const Structure& structure)
{
  RefuseIf(!structure.Wrong.empty(), "it has ", structure.Wrong, ", which cannot be: correct it");
  RefuseIf(structure.Extents.size() != 1, "it is stored in ", structure.Extents.size(),
    " pieces: save it in one");
}

void CheckArrays(const InputFile& file, Structure& structure)
{
  for (const auto& [counts, bytes] : structure.Inline)
  {
    CheckCounts(counts, bytes, structure);
  }
  if (structure.IsAppended)
  {
    CheckAppendedData(file, structure);
  }
  RefuseIf(structure.IsInterrupted,
    "its data in base64 have line breaks or foreign letters within, which VTK does not read: save "
    "it in the encoding raw");
}

} // namespace

std::string BeginningOfVTK(const InputFile& file)
{
  constexpr std::size_t enough = 4096;
  return file.Beginning(enough);
}

bool IsLegacyVTK(const std::string& beginning)
{
  return beginning.starts_with("# vtk DataFile");
}

bool IsVTK(const InputFile& file)
{
  const std::string beginning = BeginningOfVTK(file);
  const std::size_t first = beginning.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return IsLegacyVTK(beginning) ||
    (first != beginning.npos && beginning[first] == '<' &&
      beginning.find("<VTKFile") != beginning.npos);
}

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
  CheckPieces(structure);
  RefuseIf(structure.Extents.front() != structure.WholeExtent, Damaged, "it has the extent ",
    Excerpt(structure.WholeExtent), ", and its piece ", Excerpt(structure.Extents.front()));
  CheckArrays(file, structure);
}

void CheckStructureOfMesh(const InputFile& file, std::string_view kind)
{
  Structure structure = Parse(file);
  RefuseIf(structure.Kind != kind, "it holds ", Excerpt(structure.Kind), ", and not ", kind);
  CheckPieces(structure);
  RefuseIf(structure.MostClaimed > MostOfAByte * static_cast<double>(file.Size()), Damaged,
    "it claims ", structure.MostClaimed, " points or cells, and has ", file.Size(), " bytes");
  CheckArrays(file, structure);
}

} // namespace voxplex::io
