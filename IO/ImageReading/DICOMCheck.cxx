// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "DICOMCheck.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>

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
constexpr std::uint32_t SequenceEnd = 0xFFFEE0DD;

/** Value representations whose elements have lengths of two bytes, and those with lengths of four. */
constexpr std::array<std::string_view, 21> ShortOnes{ "AE", "AS", "AT", "CS", "DA", "DS", "DT",
  "FD", "FL", "IS", "LO", "LT", "PN", "SH", "SL", "SS", "ST", "TM", "UI", "UL", "US" };
constexpr std::array<std::string_view, 13> LongOnes{ "OB", "OD", "OF", "OL", "OV", "OW", "SQ", "SV",
  "UC", "UN", "UR", "UT", "UV" };

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

/** Reads elements and stops where the file ends or makes no sense. */
class ElementReader
{
public:
  explicit ElementReader(const std::string& path)
    : File(path, std::ios::binary)
  {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    this->Size = error ? 0 : size;
  }

  std::uint64_t GetSize() const { return this->Size; }
  std::uint64_t Position() { return static_cast<std::uint64_t>(this->File.tellg()); }
  std::uint64_t Left() { return this->Size - std::min(this->Size, this->Position()); }
  bool Skip(std::uint64_t length) { return this->GoTo(this->Position() + length); }
  bool GoTo(std::uint64_t position)
  {
    this->File.clear(); // seeking fails once the end was met
    return !!this->File.seekg(static_cast<std::streamoff>(position));
  }

  std::string Text(std::uint32_t length)
  {
    std::string text(length, '\0');
    this->File.read(text.data(), static_cast<std::streamsize>(length));
    return text;
  }

  std::optional<Element> Next(const Syntax& syntax)
  {
    Element element;
    element.Tag = this->Number<std::uint16_t>(syntax) << 16;
    element.Tag |= this->Number<std::uint16_t>(syntax);
    const bool isLong =
      !syntax.IsExplicit || element.IsDelimiter() || this->TakeRepresentation(element);
    element.Length =
      isLong ? this->Number<std::uint32_t>(syntax) : this->Number<std::uint16_t>(syntax);
    return this->File ? std::optional(element) : std::nullopt;
  }

private:
  /**
   * Returns whether a length of four bytes follows. An element without a value representation counts as
   * implicit, as it does for GDCM: there are files with both.
   */
  bool TakeRepresentation(Element& element)
  {
    std::array<char, 2>& name = element.Representation;
    this->File.read(name.data(), name.size());
    if (std::any_of(
          name.begin(), name.end(), [](char letter) { return letter < 'A' || letter > 'Z'; }))
    {
      name = {};
      this->File.seekg(-2, std::ios::cur);
      return true;
    }
    const bool isLong = element.IsAnyOf(LongOnes);
    if (isLong)
    {
      this->File.ignore(2);
    }
    return isLong;
  }

  template <typename T>
  std::uint32_t Number(const Syntax& syntax)
  {
    std::array<unsigned char, sizeof(T)> bytes{};
    this->File.read(reinterpret_cast<char*>(bytes.data()), sizeof(T));
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

  std::ifstream File;
  std::uint64_t Size = 0;
};

Syntax SyntaxNamed(const std::string& uid)
{
  const std::string name = uid.substr(0, uid.find_last_not_of(std::string(" \0", 2)) + 1);
  Syntax syntax;
  syntax.IsExplicit = name != "1.2.840.10008.1.2";
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

std::string DescribeExcess(const Element& element, std::uint64_t left)
{
  return "it is truncated or damaged: its element " + TagOf(element) + " claims " +
    std::to_string(element.Length) + " bytes, and " + std::to_string(left) + " are left";
}

/** Each step returns whether the walk goes on. */
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
    const Syntax syntax = this->ReadFileInformation();
    if (!syntax.IsDeflated)
    {
      this->WalkElements(this->Reader.GetSize(), syntax, 0);
    }
    return this->Fault;
  }

private:
  /** Of group 2, which is written in one way; gives how the others are. */
  Syntax ReadFileInformation()
  {
    constexpr std::uint32_t longestUID = 64;
    Syntax syntax;
    std::uint64_t position = this->Reader.Position();
    for (auto element = this->Reader.Next(Syntax());
         element && element->Tag >> 16 == 2 && element->Length <= this->Reader.Left();
         element = this->Reader.Next(Syntax()))
    {
      if (element->Tag == TransferSyntax && element->Length <= longestUID)
      {
        syntax = SyntaxNamed(this->Reader.Text(element->Length));
      }
      else
      {
        this->Reader.Skip(element->Length);
      }
      position = this->Reader.Position();
    }
    this->Reader.GoTo(position);
    return syntax;
  }

  bool WalkElements(std::uint64_t end, const Syntax& syntax, std::size_t depth)
  {
    while (this->Reader.Position() < end)
    {
      const std::optional<Element> element = this->Reader.Next(syntax);
      if (!element)
      {
        return false;
      }
      if (element->IsDelimiter())
      {
        return true;
      }
      if (!this->Fits(*element) || !this->WalkValue(*element, syntax, depth))
      {
        return false;
      }
    }
    return true;
  }

  bool WalkValue(const Element& element, const Syntax& syntax, std::size_t depth)
  {
    if (element.Length != Undefined && !element.Is("SQ"))
    {
      return this->Reader.Skip(element.Length);
    }
    if (depth == DeepestNesting)
    {
      this->Fault = "it is damaged: its sequences are nested more than " +
        std::to_string(DeepestNesting) + " deep";
      return false;
    }
    // A sequence of which a writer did not know that it is one has implicit elements.
    Syntax inner = syntax;
    inner.IsExplicit = syntax.IsExplicit && !element.Is("UN");
    const bool hasFragments = element.Tag == PixelData || element.Is("OB") || element.Is("OW");
    return this->WalkItems(this->EndOf(element), inner, depth + 1, hasFragments);
  }

  bool WalkItems(std::uint64_t end, const Syntax& syntax, std::size_t depth, bool areFragments)
  {
    while (this->Reader.Position() < end)
    {
      const std::optional<Element> item = this->Reader.Next(syntax);
      if (!item || (item->Tag != Item && item->Tag != SequenceEnd))
      {
        return false;
      }
      if (item->Tag == SequenceEnd)
      {
        return true;
      }
      if (!this->Fits(*item) ||
        !(areFragments ? this->Reader.Skip(item->Length)
                       : this->WalkElements(this->EndOf(*item), syntax, depth)))
      {
        return false;
      }
    }
    return true;
  }

  std::uint64_t EndOf(const Element& element)
  {
    return element.Length == Undefined ? this->Reader.GetSize()
                                       : this->Reader.Position() + element.Length;
  }

  bool Fits(const Element& element)
  {
    const std::uint64_t left = this->Reader.Left();
    if (element.Length != Undefined && element.Length > left)
    {
      this->Fault = DescribeExcess(element, left);
      return false;
    }
    // GDCM takes some of the next bytes for its length, which may be any.
    if (element.Representation[0] != '\0' && !element.IsAnyOf(ShortOnes) &&
      !element.IsAnyOf(LongOnes))
    {
      this->Fault = "it is damaged: its element " + TagOf(element) +
        " has the value representation '" + std::string(element.Representation.data(), 2) +
        "', which DICOM does not have";
      return false;
    }
    return true;
  }

  ElementReader Reader;
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

} // namespace voxplex::io
