// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "DICOMCheck.h"

#include "Excerpt.h"

#include <gdcmDicts.h>
#include <gdcmGlobal.h>
#include <gdcmVR.h>

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace voxplex::io
{
namespace
{

constexpr std::size_t DeepestNesting = 64;
constexpr std::uint64_t PreambleSize = 128;
constexpr std::string_view Magic = "DICM";
constexpr std::uint32_t Undefined = 0xFFFFFFFF;

constexpr std::uint32_t TransferSyntax = 0x00020010;
constexpr std::uint32_t PixelData = 0x7FE00010;
constexpr std::uint32_t Item = 0xFFFEE000;
constexpr std::uint32_t ItemEnd = 0xFFFEE00D;
constexpr std::uint32_t SequenceEnd = 0xFFFEE0DD;

/** Tags that GDCM reads in another way than DICOM. */
constexpr std::uint32_t PhilipsItem = 0xFEFF00E0;
constexpr std::uint32_t DigitexPixels = 0x00FF4AA5;

/** Group, and tags, of what DICOM allows in sequences only. */
constexpr std::uint32_t Waveforms = 0x5400;
constexpr std::uint32_t ZeroVelocity = 0x00189810;
constexpr std::uint32_t MappedPixel = 0x00221452;

/** Value representations whose elements have lengths of two bytes, and those with lengths of four. */
constexpr std::array<std::string_view, 21> ShortOnes{ "AE", "AS", "AT", "CS", "DA", "DS", "DT",
  "FD", "FL", "IS", "LO", "LT", "PN", "SH", "SL", "SS", "ST", "TM", "UI", "UL", "US" };
constexpr std::array<std::string_view, 13> LongOnes{ "OB", "OD", "OF", "OL", "OV", "OW", "SQ", "SV",
  "UC", "UN", "UR", "UT", "UV" };

/** What GDCM reads in the value representation of its dictionary, or aborts. The group of overlays counts for all of them. */
constexpr std::uint32_t Pixels = 0x0028;
constexpr std::uint32_t Overlays = 0x6000;
constexpr std::array<std::uint32_t, 14> TagsThatGDCMReads{ 0x00080008, 0x00080016, 0x00080018,
  0x00080060, 0x00180050, 0x00180088, 0x00181063, 0x0018602C, 0x0018602E, 0x00200013, 0x00200032,
  0x00200037, 0x3004000C, 0x3004000E };

/** Elements with numbers. GDCM takes some values and aborts at others. */
constexpr std::uint32_t SamplesPerPixel = 0x00280002;
constexpr std::uint32_t PlanarConfiguration = 0x00280006;
/** Of the predecessors of DICOM. */
constexpr std::uint32_t RecognitionCode = 0x00080010;
constexpr std::array<std::string_view, 3> RecognitionCodes{ "ACR-NEMA", "ACRNEMA", "MIPS 2.0" };

constexpr std::uint32_t PhotometricInterpretation = 0x00280004;
/** The places of a dose's frames, for which GDCM looks up how many they are. */
constexpr std::uint32_t GridFrameOffsets = 0x3004000C;
constexpr std::uint32_t NumberOfFrames = 0x00280008;

struct NumbersInText
{
  std::uint32_t Tag;
  std::size_t Count;
};

/** Texts in which GDCM takes numbers for granted: of frames, thickness, positions and directions, spacings, rescaling. */
constexpr std::array<NumbersInText, 9> TextsOfNumbers{ { { 0x00180050, 1 }, { 0x00180088, 1 },
  { 0x00200013, 1 }, { 0x00200032, 3 }, { 0x00200037, 6 }, { 0x00280008, 1 }, { 0x00280030, 2 },
  { 0x00281052, 1 }, { 0x00281053, 1 } } };

/** How elements are written. */
struct Syntax
{
  bool IsExplicit = true; ///< each element names its value representation
  bool IsBigEndian = false;
  bool IsDeflated = false;
};

struct Element
{
  std::uint32_t Tag = 0;
  std::array<char, 2> Representation{};
  std::uint32_t Length = 0;

  bool IsDelimiter() const { return this->Tag >> 16 == 0xFFFE; }
  bool HasRepresentation() const { return this->Representation[0] != '\0'; }
  bool Is(std::string_view representation) const
  {
    return std::equal(representation.begin(), representation.end(), this->Representation.begin());
  }
  bool IsAnyOf(std::span<const std::string_view> representations) const
  {
    return std::any_of(representations.begin(), representations.end(),
      [this](std::string_view one) { return this->Is(one); });
  }
};

/** What was compressed by deflate, without a header; nothing if it is damaged. */
std::optional<std::string> Unpack(std::vector<char>& packed)
{
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK)
  {
    return std::nullopt;
  }
  stream.next_in = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string unpacked;
  std::array<char, 1 << 16> part;
  int status = Z_OK;
  while (status == Z_OK)
  {
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = static_cast<uInt>(part.size());
    status = inflate(&stream, Z_NO_FLUSH);
    unpacked.append(part.data(), part.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  return status == Z_STREAM_END ? std::optional(std::move(unpacked)) : std::nullopt;
}

/** Reads elements and stops where the file ends or makes no sense. */
class ElementReader
{
public:
  explicit ElementReader(const std::string& path)
    : File(std::make_unique<std::ifstream>(path, std::ios::binary))
  {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    this->Size = error ? 0 : size;
  }

  std::uint64_t GetSize() const { return this->Size; }
  std::uint64_t Position() { return static_cast<std::uint64_t>(this->File->tellg()); }
  bool Skip(std::uint64_t length) { return this->GoTo(this->Position() + length); }
  bool GoTo(std::uint64_t position)
  {
    this->File->clear(); // seeking fails once the end was met
    return !!this->File->seekg(static_cast<std::streamoff>(position));
  }

  /** Goes on in what the rest of the file is when it is unpacked; returns whether it is sound. */
  bool Inflate()
  {
    std::vector<char> packed(static_cast<std::size_t>(this->Size - this->Position()));
    this->File->read(packed.data(), static_cast<std::streamsize>(packed.size()));
    const std::optional<std::string> unpacked = Unpack(packed);
    this->Size = unpacked ? unpacked->size() : 0;
    this->File = std::make_unique<std::istringstream>(unpacked.value_or(""));
    return unpacked.has_value();
  }

  std::string Text(std::uint32_t length)
  {
    std::string text(length, '\0');
    this->File->read(text.data(), static_cast<std::streamsize>(length));
    return text;
  }

  std::uint32_t ShortNumber(const Syntax& syntax) { return this->Number<std::uint16_t>(syntax); }

  std::optional<Element> Next(const Syntax& syntax)
  {
    Element element;
    element.Tag = this->Number<std::uint16_t>(syntax) << 16;
    element.Tag |= this->Number<std::uint16_t>(syntax);
    const bool isLong =
      !syntax.IsExplicit || element.IsDelimiter() || this->TakeRepresentation(element);
    element.Length =
      isLong ? this->Number<std::uint32_t>(syntax) : this->Number<std::uint16_t>(syntax);
    return *this->File ? std::optional(element) : std::nullopt;
  }

private:
  /** Returns whether a length of four bytes follows, as it does where there is no value representation. */
  bool TakeRepresentation(Element& element)
  {
    std::array<char, 2>& name = element.Representation;
    this->File->read(name.data(), name.size());
    if (std::any_of(
          name.begin(), name.end(), [](char letter) { return letter < 'A' || letter > 'Z'; }))
    {
      name = {};
      this->File->seekg(-2, std::ios::cur);
      return true;
    }
    const bool isLong = element.IsAnyOf(LongOnes);
    if (isLong)
    {
      this->File->ignore(2);
    }
    return isLong;
  }

  template <typename T>
  std::uint32_t Number(const Syntax& syntax)
  {
    std::array<unsigned char, sizeof(T)> bytes{};
    this->File->read(reinterpret_cast<char*>(bytes.data()), sizeof(T));
    if (!syntax.IsBigEndian)
    {
      std::reverse(bytes.begin(), bytes.end());
    }
    std::uint32_t number = 0;
    for (const unsigned char byte : bytes)
    {
      number = number << 8 | byte;
    }
    return number;
  }

  std::unique_ptr<std::istream> File;
  std::uint64_t Size = 0;
};

Syntax SyntaxNamed(const std::string& uid)
{
  std::string name = uid.substr(0, uid.find('\0'));
  name.erase(name.find_last_not_of(' ') + 1);
  Syntax syntax;
  syntax.IsExplicit =
    name != "1.2.840.10008.1.2" && name != "1.2.840.113619.5.2" && name != "1.2.840.10008.1.20";
  syntax.IsBigEndian = name == "1.2.840.10008.1.2.2";
  syntax.IsDeflated = name == "1.2.840.10008.1.2.1.99";
  return syntax;
}

std::string TagOf(const Element& element)
{
  std::ostringstream text;
  text << std::hex << std::setfill('0') << '(' << std::setw(4) << (element.Tag >> 16) << ','
       << std::setw(4) << (element.Tag & 0xFFFF) << ')';
  return text.str();
}

/** What the dictionary says of the element's tag; invalid if the tag is private, or not in it. */
gdcm::VR RepresentationInDictionary(const Element& element)
{
  const auto group = static_cast<std::uint16_t>(element.Tag >> 16);
  const auto number = static_cast<std::uint16_t>(element.Tag & 0xFFFF);
  if (group % 2 != 0)
  {
    return gdcm::VR::INVALID;
  }
  if (number == 0)
  {
    return gdcm::VR::UL;
  }
  const bool isOverlay = (group & 0xFF00) == Overlays;
  return gdcm::Global::GetInstance()
    .GetDicts()
    .GetPublicDict()
    .GetDictEntry(gdcm::Tag(isOverlay ? Overlays : group, number))
    .GetVR();
}

bool IsReadByGDCM(const Element& element)
{
  const std::uint32_t group = element.Tag >> 16;
  return group == Pixels || (group & 0xFF00) == Overlays ||
    std::find(TagsThatGDCMReads.begin(), TagsThatGDCMReads.end(), element.Tag) !=
    TagsThatGDCMReads.end();
}

/** Text, numbers, bytes or sequences: GDCM converts texts into each other. */
bool AreOfOneKind(gdcm::VR a, gdcm::VR b)
{
  constexpr std::int64_t bytes =
    gdcm::VR::OB | gdcm::VR::OW | gdcm::VR::OF | gdcm::VR::OD | gdcm::VR::OL | gdcm::VR::OV;
  return ((a & gdcm::VR::VRASCII) && (b & gdcm::VR::VRASCII)) || ((a & bytes) && (b & bytes));
}

/** Bytes of a number; 1 for other values. */
std::uint32_t SizeOfNumber(gdcm::VR representation)
{
  switch (representation)
  {
    case gdcm::VR::US:
    case gdcm::VR::SS:
    case gdcm::VR::US_SS:
      return 2;
    case gdcm::VR::UL:
    case gdcm::VR::SL:
    case gdcm::VR::FL:
    case gdcm::VR::AT:
      return 4;
    case gdcm::VR::FD:
    case gdcm::VR::SV:
    case gdcm::VR::UV:
      return 8;
    default:
      return 1;
  }
}

std::string DescribeValue(const std::string& value)
{
  return " has the value '" + Excerpt(value) + "', which it must not have";
}

/** Whether the text is `count` numbers, separated by backslashes, or blanks only. */
bool HoldsNumbers(const std::string& text, std::size_t count)
{
  const std::string blanks(" \0", 2);
  std::size_t found = 0;
  bool areNumbers = true;
  for (std::size_t at = 0; at <= text.size(); ++found)
  {
    const std::size_t end = std::min(text.find('\\', at), text.size());
    std::string word = text.substr(at, end - at);
    word.erase(word.find_last_not_of(blanks) + 1);
    word.erase(0, word.find_first_not_of(' '));
    std::istringstream stream(word);
    double number = 0.0;
    // GDCM takes a single number from the beginning of a text.
    areNumbers = areNumbers && stream >> number &&
      (count == 1 || stream.peek() == std::istringstream::traits_type::eof());
    at = end + 1;
  }
  return (areNumbers && found == count) || text.find_first_not_of(blanks) == std::string::npos;
}

std::string DescribeExcess(const Element& element, std::uint64_t left)
{
  return "it is truncated or damaged: its element " + TagOf(element) + " claims " +
    std::to_string(element.Length) + " bytes, and " + std::to_string(left) + " are left";
}

/**
 * Reads the file to its end by the grammar of DICOM. Where GDCM meets anything else it begins anew, by the grammar of some
 * faulty writer, and takes other bytes for lengths: such files are refused. Each step returns whether the walk goes on.
 */
class Walk
{
public:
  explicit Walk(const std::string& path)
    : Reader(path)
  {
  }

  std::string FindFault(std::uint64_t start)
  {
    this->Reader.GoTo(start);
    const std::optional<Syntax> syntax = this->ReadFileInformation();
    if (syntax && syntax->IsDeflated && !this->Reader.Inflate())
    {
      this->Fault = "it is truncated or damaged: what is compressed in it does not unpack";
    }
    else if (syntax)
    {
      this->WalkElements({ this->Reader.GetSize() }, *syntax, 0);
      if (this->Fault.empty() && this->HasOffsets && !this->HasFrames)
      {
        this->Fault =
          "it is damaged: its element (3004,000c) needs an element (0028,0008), which is missing";
      }
    }
    return this->Fault;
  }

private:
  /** What holds the elements: the file, a sequence or an item. */
  struct Enclosure
  {
    std::uint64_t End = 0;
    bool IsDelimited = false; ///< it ends with a delimiter, somewhere before End
  };

  /** Of group 2, which is written in one way; gives how the others are. */
  std::optional<Syntax> ReadFileInformation()
  {
    constexpr std::uint32_t group = 2;
    constexpr std::uint32_t longestUID = 64;
    std::optional<Syntax> named;
    const Syntax syntax = this->DetectSyntax();
    std::optional<std::uint32_t> next = this->PeekGroup();
    for (; next == group; next = this->PeekGroup())
    {
      const std::optional<Element> element = this->Read(syntax, { this->Reader.GetSize() });
      if (!element || !this->HasPlainValue(*element))
      {
        return std::nullopt;
      }
      if (element->Tag == TransferSyntax && element->Length <= longestUID && !named)
      {
        named = SyntaxNamed(this->Reader.Text(element->Length));
      }
      else
      {
        this->Reader.Skip(element->Length);
      }
    }
    if (!next)
    {
      this->Fault = "it is truncated: it ends before its first data element";
      return std::nullopt;
    }
    return named ? named : this->DetectSyntax();
  }

  std::optional<std::uint32_t> PeekGroup()
  {
    const std::uint64_t position = this->Reader.Position();
    Syntax implicit;
    implicit.IsExplicit = false;
    const std::optional<Element> element = this->Reader.Next(implicit);
    this->Reader.GoTo(position);
    return element ? std::optional(element->Tag >> 16) : std::nullopt;
  }

  /** From the next element, as GDCM does without a transfer syntax. */
  Syntax DetectSyntax()
  {
    const std::uint64_t position = this->Reader.Position();
    Syntax syntax;
    const std::optional<Element> element = this->Reader.Next(syntax);
    syntax.IsExplicit = element && element->HasRepresentation();
    this->Reader.GoTo(position);
    return syntax;
  }

  bool HasPlainValue(const Element& element)
  {
    if (element.Length == Undefined || element.Is("SQ"))
    {
      this->Fault =
        "it is damaged: its element " + TagOf(element) + " is a sequence, and must not be one";
      return false;
    }
    return true;
  }

  bool WalkElements(const Enclosure& enclosure, const Syntax& syntax, std::size_t depth)
  {
    while (this->Reader.Position() < enclosure.End)
    {
      const std::optional<Element> element = this->Read(syntax, enclosure);
      if (!element)
      {
        return false;
      }
      if (enclosure.IsDelimited && element->Tag == ItemEnd)
      {
        return true;
      }
      this->HasOffsets = this->HasOffsets || (depth == 0 && element->Tag == GridFrameOffsets);
      this->HasFrames = this->HasFrames || (depth == 0 && element->Tag == NumberOfFrames);
      if (!this->IsInPlace(*element, syntax, depth) ||
        !this->WalkValue(*element, enclosure, syntax, depth))
      {
        return false;
      }
    }
    return !enclosure.IsDelimited || this->Truncate();
  }

  bool WalkValue(
    const Element& element, const Enclosure& enclosure, const Syntax& syntax, std::size_t depth)
  {
    const std::uint64_t end = this->Reader.Position() + element.Length;
    if (!this->IsSequence(element))
    {
      return this->Reader.Skip(element.Length);
    }
    if (depth == DeepestNesting)
    {
      this->Fault = "it is damaged: its sequences are nested more than " +
        std::to_string(DeepestNesting) + " deep";
      return false;
    }
    // If a writer did not know that an element is a sequence, its elements are implicit.
    Syntax inner = syntax;
    inner.IsExplicit = syntax.IsExplicit && !element.Is("UN");
    const Enclosure items =
      element.Length == Undefined ? Enclosure{ enclosure.End, true } : Enclosure{ end };
    return this->WalkItems(items, inner, depth + 1, element.Tag == PixelData);
  }

  bool WalkItems(
    const Enclosure& enclosure, const Syntax& syntax, std::size_t depth, bool areFragments)
  {
    while (this->Reader.Position() < enclosure.End)
    {
      const std::optional<Element> item = this->Read(syntax, enclosure);
      if (!item)
      {
        return false;
      }
      if (enclosure.IsDelimited && item->Tag == SequenceEnd && item->Length == 0)
      {
        return true;
      }
      if (item->Tag != Item || (areFragments && item->Length == Undefined))
      {
        this->Fault = "it is damaged: its element " + TagOf(*item) + " is where an item must be";
        return false;
      }
      const Enclosure elements = item->Length == Undefined
        ? Enclosure{ enclosure.End, true }
        : Enclosure{ this->Reader.Position() + item->Length };
      if (!(areFragments ? this->Reader.Skip(item->Length)
                         : this->WalkElements(elements, syntax, depth)))
      {
        return false;
      }
    }
    return !enclosure.IsDelimited || this->Truncate();
  }

  /** The next element, if it is whole and inside what holds it. */
  std::optional<Element> Read(const Syntax& syntax, const Enclosure& enclosure)
  {
    const std::optional<Element> element = this->Reader.Next(syntax);
    if (!element)
    {
      this->Truncate();
      return std::nullopt;
    }
    const std::uint64_t position = this->Reader.Position();
    const std::uint64_t left = enclosure.End - std::min(enclosure.End, position);
    if (position > enclosure.End || (element->Length != Undefined && element->Length > left))
    {
      this->Fault = DescribeExcess(*element, left);
      return std::nullopt;
    }
    if (syntax.IsExplicit && !element->IsDelimiter() && !element->IsAnyOf(ShortOnes) &&
      !element->IsAnyOf(LongOnes))
    {
      this->Fault = "it is damaged: its element " + TagOf(*element) +
        (element->HasRepresentation() ? " has the value representation '" +
              std::string(element->Representation.data(), 2) + "', which DICOM does not have"
                                      : " has no value representation");
      return std::nullopt;
    }
    return element;
  }

  /** Without a value representation the dictionary tells, if the length does not. */
  static bool IsSequence(const Element& element)
  {
    const bool isUntold = !element.HasRepresentation() || element.Is("UN");
    return element.Length == Undefined || element.Is("SQ") ||
      (isUntold && RepresentationInDictionary(element) == gdcm::VR::SQ);
  }

  /** GDCM aborts where an element is of another kind than its dictionary says, or has half a number. */
  std::string FindFaultOfRepresentation(const Element& element)
  {
    const gdcm::VR expected = RepresentationInDictionary(element);
    const bool isTold = element.HasRepresentation() && !element.Is("UN");
    const gdcm::VR given =
      isTold ? gdcm::VR(gdcm::VR::GetVRTypeFromFile(element.Representation.data())) : expected;
    const bool isKnown = expected != gdcm::VR::INVALID && expected != gdcm::VR::UN;
    if (isKnown && expected != gdcm::VR::SQ && element.Tag != PixelData && IsSequence(element))
    {
      return " is a sequence, and must not be one";
    }
    if (isKnown && isTold && !expected.Compatible(given) &&
      (IsReadByGDCM(element) || !AreOfOneKind(expected, given)))
    {
      return " has the value representation '" + std::string(element.Representation.data(), 2) +
        "', and must not have it";
    }
    const std::uint32_t size = SizeOfNumber(given);
    return element.Length != Undefined && element.Length % size != 0
      ? " has " + std::to_string(element.Length) + " bytes, of numbers of " + std::to_string(size)
      : "";
  }

  /** Leaves the reader where the value begins. */
  std::string FindFaultOfValue(const Element& element, const Syntax& syntax, std::size_t depth)
  {
    constexpr std::uint32_t longest = 1024; // of what is looked at
    const auto numbers = std::find_if(TextsOfNumbers.begin(), TextsOfNumbers.end(),
      [&element](const NumbersInText& one) { return one.Tag == element.Tag; });
    const bool isNumber = element.Tag == SamplesPerPixel || element.Tag == PlanarConfiguration;
    const bool isText = element.Tag == RecognitionCode ||
      element.Tag == PhotometricInterpretation || numbers != TextsOfNumbers.end();
    if (element.Length == 0 || element.Length == Undefined || (!isNumber && !isText))
    {
      return "";
    }
    const std::uint64_t position = this->Reader.Position();
    const std::string value = isNumber ? std::to_string(this->Reader.ShortNumber(syntax))
                                       : this->Reader.Text(std::min(element.Length, longest));
    this->Reader.GoTo(position);
    if (element.Tag == PhotometricInterpretation)
    {
      return depth == 0 && value.starts_with("PALETTE")
        ? " says that its voxels are colours of a palette"
        : "";
    }
    const bool isSound = element.Tag == SamplesPerPixel
      ? value == "1" || value == "3" || value == "4"
      : element.Tag == PlanarConfiguration ? value == "0" || value == "1"
      : element.Tag == RecognitionCode
      ? std::any_of(RecognitionCodes.begin(), RecognitionCodes.end(),
          [&value](std::string_view code) { return value.starts_with(code); })
      : HoldsNumbers(value, numbers->Count);
    return isSound ? "" : DescribeValue(value);
  }

  bool IsInPlace(const Element& element, const Syntax& syntax, std::size_t depth)
  {
    const std::string start = "it is damaged: its element " + TagOf(element);
    if (element.IsDelimiter() || element.Tag >> 16 <= 2 || element.Tag == PhilipsItem ||
      element.Tag == DigitexPixels)
    {
      this->Fault = start + " is out of place";
    }
    // GDCM aborts where it looks for what tells their type.
    else if (depth == 0 &&
      (element.Tag >> 16 == Waveforms || element.Tag == ZeroVelocity || element.Tag == MappedPixel))
    {
      this->Fault = start + " belongs in a sequence";
    }
    // GDCM counts an odd length as the even one above it, and reads 10 bytes for an implicit 13.
    else if (element.Length != Undefined && element.Length % 2 != 0 &&
      (depth > 0 || !syntax.IsExplicit))
    {
      this->Fault = start + " has the odd length " + std::to_string(element.Length);
    }
    else if (element.Length == Undefined && syntax.IsExplicit && !element.Is("SQ") &&
      !element.Is("UN") && element.Tag != PixelData)
    {
      this->Fault = start + " has no length";
    }
    else if (element.Tag == PixelData && syntax.IsExplicit && !element.Is("OB") &&
      !element.Is("OW") && !element.Is("UN"))
    {
      this->Fault = start + " has another value representation than pixels";
    }
    else if (const std::string fault = this->FindFaultOfRepresentation(element); !fault.empty())
    {
      this->Fault = start + fault;
    }
    else if (const std::string value = this->FindFaultOfValue(element, syntax, depth);
             !value.empty())
    {
      this->Fault = start + value;
    }
    return this->Fault.empty();
  }

  bool Truncate()
  {
    this->Fault = "it is truncated or damaged: it ends within an element";
    return false;
  }

  ElementReader Reader;
  bool HasOffsets = false;
  bool HasFrames = false;
  std::string Fault;
};

/** Where the elements begin; nothing if the file is none of DICOM. */
std::optional<std::uint64_t> FindStart(const std::string& path)
{
  std::array<char, PreambleSize + Magic.size()> begin{};
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), begin.size());
  if (std::string_view(begin.data() + PreambleSize, Magic.size()) == Magic)
  {
    return begin.size();
  }
  // Old files have no preamble, and begin with an element of group 2 or 8. GIPL begins with its size.
  const bool hasGroup = (begin[0] == 2 || begin[0] == 8) && begin[1] == 0;
  return hasGroup && std::filesystem::path(path).extension() != ".gipl"
    ? std::optional<std::uint64_t>(0)
    : std::nullopt;
}

} // namespace

std::string FindFaultOfDICOM(const std::string& path)
{
  const std::optional<std::uint64_t> start = FindStart(path);
  return start ? Walk(path).FindFault(*start) : "";
}

bool HasPreambleOfDICOM(const std::string& path)
{
  return FindStart(path) == PreambleSize + Magic.size();
}

} // namespace voxplex::io
