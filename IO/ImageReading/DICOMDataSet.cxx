// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "DICOMDataSet.h"

#include "ByteSource.h"
#include "FileError.h"
#include "Text.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <ostream>

namespace voxplex::io
{

/** The rest of a deflated file is unpacked as far as it is asked for. */
class DICOMSource
{
public:
  explicit DICOMSource(const std::string& path)
    : File(path)
  {
  }

  void InflateFrom(std::uint64_t position)
  {
    this->Packed.emplace(this->File, position);
    this->Stream.emplace(*this->Packed, false);
    this->Start = position;
  }

  std::uint64_t Available(std::uint64_t position, std::uint64_t length)
  {
    if (this->Stream && position >= this->Start)
    {
      this->Inflate(position - this->Start + length);
      const std::uint64_t end = this->Start + this->Unpacked.size();
      return std::min(length, end - std::min(end, position));
    }
    return std::min(length, this->File.Size() - std::min(this->File.Size(), position));
  }

  std::size_t ReadAt(std::uint64_t position, std::span<std::byte> to)
  {
    const auto length = static_cast<std::size_t>(this->Available(position, to.size()));
    if (!this->Stream || position < this->Start)
    {
      return this->ReadFile(position, to.first(length));
    }
    std::copy_n(this->Unpacked.begin() + static_cast<std::ptrdiff_t>(position - this->Start),
      length, to.begin());
    return length;
  }

private:
  /** Elements are small, and follow each other. */
  std::size_t ReadFile(std::uint64_t position, std::span<std::byte> to)
  {
    constexpr std::size_t size = 4096;
    if (to.size() > size / 8)
    {
      return this->File.ReadAt(position, to);
    }
    if (position < this->WindowStart ||
      position + to.size() > this->WindowStart + this->Window.size())
    {
      this->Window.resize(size);
      this->Window.resize(this->File.ReadAt(position, this->Window));
      this->WindowStart = position;
    }
    const auto begin =
      this->Window.begin() + static_cast<std::ptrdiff_t>(position - this->WindowStart);
    const std::size_t length =
      std::min(to.size(), static_cast<std::size_t>(this->Window.end() - begin));
    std::copy_n(begin, length, to.begin());
    return length;
  }

  void Inflate(std::uint64_t wanted)
  {
    std::vector<std::byte> part(1 << 20);
    while (!this->IsAtEnd && this->Unpacked.size() < wanted)
    {
      std::size_t got = 0;
      try
      {
        got = this->Stream->Read(part);
        this->IsAtEnd = got < part.size();
        if (this->IsAtEnd)
        {
          this->Stream->Finish();
        }
      }
      catch (const FileError&)
      {
        Refuse("it is truncated or damaged: what is compressed in it does not unpack");
      }
      this->Unpacked.insert(
        this->Unpacked.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(got));
    }
  }

  InputFile File;
  std::vector<std::byte> Window;
  std::uint64_t WindowStart = 0;

  std::optional<FileSource> Packed;
  std::optional<InflateSource> Stream; ///< empty if nothing is deflated
  std::uint64_t Start = 0;             ///< of what is deflated
  std::deque<std::byte> Unpacked;      ///< which grows without a copy
  bool IsAtEnd = false;
};

namespace
{

constexpr std::size_t DeepestNesting = 64;
constexpr std::uint64_t PreambleSize = 128;
constexpr std::string_view Magic = "DICM";
constexpr std::uint64_t NoEnd = std::numeric_limits<std::uint64_t>::max();

constexpr std::uint32_t TransferSyntax = 0x00020010;
constexpr std::array<std::uint32_t, 3> Pixels{ 0x7FE00008, 0x7FE00009, 0x7FE00010 };
constexpr std::uint32_t Item = 0xFFFEE000;
constexpr std::uint32_t ItemEnd = 0xFFFEE00D;
constexpr std::uint32_t SequenceEnd = 0xFFFEE0DD;

/** Value representations whose elements have lengths of two bytes, and those with lengths of four. */
constexpr std::array<std::string_view, 21> ShortOnes{ "AE", "AS", "AT", "CS", "DA", "DS", "DT",
  "FD", "FL", "IS", "LO", "LT", "PN", "SH", "SL", "SS", "ST", "TM", "UI", "UL", "US" };
constexpr std::array<std::string_view, 13> LongOnes{ "OB", "OD", "OF", "OL", "OV", "OW", "SQ", "SV",
  "UC", "UN", "UR", "UT", "UV" };

template <typename TList>
bool Contains(const TList& list, std::string_view name)
{
  return std::find(list.begin(), list.end(), name) != list.end();
}

bool IsPixels(std::uint32_t tag)
{
  return std::find(Pixels.begin(), Pixels.end(), tag) != Pixels.end();
}

/** Goes through elements by their grammar. */
class Walk
{
public:
  Walk(DICOMSource& source, std::uint64_t position)
    : Source(source)
    , Position(position)
  {
  }

  std::uint64_t GetPosition() const { return this->Position; }
  bool IsAtEnd() { return this->Source.Available(this->Position, 1) == 0; }

  std::uint32_t PeekGroup()
  {
    std::array<std::byte, 2> group{};
    this->Source.ReadAt(this->Position, group);
    return ReadNumber(group, false);
  }

  /** From the next element, for files that do not say. */
  bool IsExplicit()
  {
    std::array<std::byte, 6> head{};
    this->Source.ReadAt(this->Position, head);
    const std::array<char, 2> name{ static_cast<char>(head[4]), static_cast<char>(head[5]) };
    return Contains(ShortOnes, { name.data(), 2 }) || Contains(LongOnes, { name.data(), 2 });
  }

  /** The next element, if it is whole and ends before `end`. The walk goes on in its value. */
  DICOMElement Next(const DICOMSyntax& syntax, std::uint64_t end)
  {
    DICOMElement element;
    element.Tag = this->Number(2, syntax.IsBigEndian) << 16;
    element.Tag |= this->Number(2, syntax.IsBigEndian);
    const bool isLong = !syntax.IsExplicit || element.Tag >> 16 == 0xFFFE || this->TakeVR(element);
    element.Length = this->Number(isLong ? 4 : 2, syntax.IsBigEndian);
    element.Position = this->Position;
    this->CheckLength(element, end);
    return element;
  }

  /** To the end of the value. */
  void Skip(
    const DICOMElement& element, const DICOMSyntax& syntax, std::uint64_t end, std::size_t depth)
  {
    if (element.Length != DICOMElement::Undefined)
    {
      this->Position += element.Length;
      return;
    }
    RefuseIf(depth == DeepestNesting, "it is damaged: its sequences are nested more than ",
      DeepestNesting, " deep");
    const DICOMSyntax inner = SyntaxInside(element, syntax);
    for (DICOMElement item = this->NextItem(inner, end); item.Tag != SequenceEnd;
         item = this->NextItem(inner, end))
    {
      this->SkipItem(item, inner, end, depth + 1);
    }
  }

  /** Also of fragments. */
  DICOMElement NextItem(const DICOMSyntax& syntax, std::uint64_t end)
  {
    const DICOMElement item = this->Next(syntax, end);
    RefuseIf(item.Tag != Item && item.Tag != SequenceEnd, "it is damaged: its element ",
      DICOMTag{ item.Tag }, " is where an item must be");
    return item;
  }

  void SkipItem(
    const DICOMElement& item, const DICOMSyntax& syntax, std::uint64_t end, std::size_t depth)
  {
    if (item.Length != DICOMElement::Undefined)
    {
      this->Position += item.Length;
      return;
    }
    std::map<std::uint32_t, DICOMElement> ignored;
    this->TakeElements(ignored, syntax, end, true, depth);
  }

  /** Those of an item, or of the file up to its pixels. */
  void TakeElements(std::map<std::uint32_t, DICOMElement>& elements, const DICOMSyntax& syntax,
    std::uint64_t end, bool isDelimited, std::size_t depth)
  {
    while (this->Position < end && (end != NoEnd || depth > 0 || !this->IsAtEnd()))
    {
      const DICOMElement element = this->Next(syntax, end);
      if (isDelimited && element.Tag == ItemEnd)
      {
        return;
      }
      RefuseIf(element.Tag >> 16 == 0xFFFE || element.Tag >> 16 == 0 || element.Tag >> 16 == 2,
        "it is damaged: its element ", DICOMTag{ element.Tag }, " is out of place");
      RefuseIf(!elements.emplace(element.Tag, element).second, "it is damaged: it has its element ",
        DICOMTag{ element.Tag }, " twice");
      if (depth == 0 && IsPixels(element.Tag))
      {
        return;
      }
      this->Skip(element, syntax, end, depth);
    }
  }

  /** If a writer did not know that an element is a sequence, its elements are implicit. */
  static DICOMSyntax SyntaxInside(const DICOMElement& element, const DICOMSyntax& syntax)
  {
    DICOMSyntax inner = syntax;
    inner.IsExplicit = syntax.IsExplicit && element.VR() != "UN";
    return inner;
  }

private:
  std::uint32_t Number(std::size_t size, bool isBigEndian)
  {
    std::array<std::byte, 4> bytes;
    const std::span<std::byte> part = std::span(bytes).first(size);
    RefuseIf(this->Source.ReadAt(this->Position, part) != size,
      "it is truncated or damaged: it ends within an element");
    this->Position += size;
    return ReadNumber(part, isBigEndian);
  }

  /** Returns whether the length has four bytes. */
  bool TakeVR(DICOMElement& element)
  {
    const std::uint32_t name = this->Number(2, true);
    element.Representation = { static_cast<char>(name >> 8), static_cast<char>(name & 0xFF) };
    const bool isLong = Contains(LongOnes, element.VR());
    if (!isLong && !Contains(ShortOnes, element.VR()))
    {
      const bool isNamed = std::all_of(element.Representation.begin(), element.Representation.end(),
        [](char letter) { return letter >= 'A' && letter <= 'Z'; });
      Refuse("it is damaged: its element ", DICOMTag{ element.Tag },
        (isNamed ? " has the value representation '" + std::string(element.VR()) +
              "', which DICOM does not have"
                 : " has no value representation"));
    }
    this->Position += isLong ? 2 : 0;
    return isLong;
  }

  void CheckLength(const DICOMElement& element, std::uint64_t end)
  {
    if (element.Length == DICOMElement::Undefined)
    {
      const bool mayBe = element.Tag >> 16 == 0xFFFE || !element.HasVR() || element.VR() == "SQ" ||
        element.VR() == "UN" || IsPixels(element.Tag);
      RefuseIf(!mayBe, "it is damaged: its element ", DICOMTag{ element.Tag }, " has no length");
      return;
    }
    if (IsPixels(element.Tag) && end == NoEnd) // is compared with the sizes of the image first
    {
      return;
    }
    const std::uint64_t left = std::min(
      this->Source.Available(this->Position, element.Length), end - std::min(end, this->Position));
    RefuseIf(left < element.Length || this->Position > end,
      "it is truncated or damaged: its element ", DICOMTag{ element.Tag }, " claims ",
      element.Length, " bytes, and ", left, " are left");
  }

  DICOMSource& Source;
  std::uint64_t Position = 0;
};

std::string_view TrimValue(std::string_view text)
{
  return Trim(text, { " \0\t\r\n", 5 });
}

DICOMSyntax SyntaxNamed(const std::string& uid)
{
  return { uid, uid != "1.2.840.10008.1.2", uid == "1.2.840.10008.1.2.2" };
}

} // namespace

std::ostream& operator<<(std::ostream& stream, const DICOMTag& tag)
{
  constexpr std::string_view digits = "0123456789abcdef";
  std::string number = "(0000,0000)";
  for (std::size_t i = 0; i < 8; ++i)
  {
    number[i + 1 + i / 4] = digits[tag.Number >> (28 - 4 * i) & 0xF];
  }
  return stream << tag.Name << (*tag.Name ? " " : "") << number;
}

std::uint32_t ReadNumber(std::span<const std::byte> bytes, bool isBigEndian)
{
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
  {
    number =
      number << 8 | std::to_integer<std::uint32_t>(bytes[isBigEndian ? i : bytes.size() - 1 - i]);
  }
  return number;
}

DICOMDataSet::DICOMDataSet(const std::string& path)
  : Source(std::make_shared<DICOMSource>(path))
{
  std::array<std::byte, Magic.size()> word{};
  this->Source->ReadAt(PreambleSize, word);
  const bool hasPreamble =
    std::equal(word.begin(), word.end(), reinterpret_cast<const std::byte*>(Magic.data()));
  Walk walk(*this->Source, hasPreamble ? PreambleSize + Magic.size() : 0);
  DICOMSyntax meta;
  meta.IsExplicit = walk.IsExplicit();
  while (!walk.IsAtEnd() && walk.PeekGroup() == 2)
  {
    const DICOMElement element = walk.Next(meta, NoEnd);
    RefuseIf(element.Length == DICOMElement::Undefined ||
        !this->Elements.emplace(element.Tag, element).second,
      "it is damaged: its element ", DICOMTag{ element.Tag }, " is out of place");
    walk.Skip(element, meta, NoEnd, 0);
  }
  RefuseIf(walk.IsAtEnd(), "it is truncated: it ends before its first data element");
  if (const std::string uid = this->Text({ TransferSyntax, "Transfer Syntax UID" }); !uid.empty())
  {
    RefuseIf(!uid.starts_with("1.2.840.10008.1.2"), "its transfer syntax '", Excerpt(uid),
      "' is not supported: decompress it first (gdcmconv --raw, dcmdjpeg)");
    this->Encoding = SyntaxNamed(uid);
  }
  else
  {
    this->Encoding.IsExplicit = walk.IsExplicit();
  }
  if (this->Encoding.UID == "1.2.840.10008.1.2.1.99")
  {
    this->Source->InflateFrom(walk.GetPosition());
  }
  walk.TakeElements(this->Elements, this->Encoding, NoEnd, false, 0);
}

const DICOMElement* DICOMDataSet::Find(const DICOMTag& tag) const
{
  const auto found = this->Elements.find(tag.Number);
  return found == this->Elements.end() ? nullptr : &found->second;
}

std::string DICOMDataSet::Value(
  const DICOMTag& tag, std::span<const std::string_view> representations) const
{
  const DICOMElement* element = this->Find(tag);
  if (!element)
  {
    return "";
  }
  const bool isWrong =
    element->HasVR() && element->VR() != "UN" && !Contains(representations, element->VR());
  RefuseIf(isWrong || element->Length == DICOMElement::Undefined, "it is damaged: its element ",
    DICOMTag{ tag.Number }, " has the value representation '", element->VR(),
    "', and must not have it");
  std::string value(element->Length, '\0');
  this->ReadBytes(element->Position, std::as_writable_bytes(std::span(value)));
  return value;
}

std::string DICOMDataSet::Text(const DICOMTag& tag) const
{
  constexpr std::array<std::string_view, 8> texts{ "CS", "DS", "IS", "LO", "SH", "UI", "ST", "LT" };
  return std::string(TrimValue(this->Value(tag, texts)));
}

std::vector<double> DICOMDataSet::AnyNumbers(const DICOMTag& tag) const
{
  const std::string text = this->Text(tag);
  std::vector<double> numbers;
  for (std::size_t at = 0; !text.empty() && at <= text.size();)
  {
    const std::size_t end = std::min(text.find('\\', at), text.size());
    const std::optional<double> number =
      ToNumber<double>(TrimValue(std::string_view(text).substr(at, end - at)));
    RefuseIf(!number || !std::isfinite(*number), "its ", tag, " is '", Excerpt(text),
      "', and must be numbers");
    numbers.push_back(*number);
    at = end + 1;
  }
  return numbers;
}

std::vector<double> DICOMDataSet::Numbers(const DICOMTag& tag, std::size_t count) const
{
  std::vector<double> numbers = this->AnyNumbers(tag);
  if (!numbers.empty() && numbers.size() != count)
  {
    Refuse("its ", tag, " is '", Excerpt(this->Text(tag)), "', and must be ",
      count == 1 ? "one number" : std::to_string(count) + " numbers");
  }
  return numbers;
}

std::optional<unsigned> DICOMDataSet::Short(const DICOMTag& tag) const
{
  constexpr std::array<std::string_view, 1> numbers{ "US" };
  const std::string value = this->Value(tag, numbers);
  if (value.empty())
  {
    return std::nullopt;
  }
  RefuseIf(value.size() != 2, "it is damaged: its ", tag, " has ", value.size(),
    " bytes, and must have 2");
  return ReadNumber(std::as_bytes(std::span(value)), this->Encoding.IsBigEndian);
}

std::vector<unsigned> DICOMDataSet::Shorts(const DICOMTag& tag) const
{
  constexpr std::array<std::string_view, 3> numbers{ "US", "SS", "OW" };
  const std::string value = this->Value(tag, numbers);
  const std::span<const std::byte> bytes = std::as_bytes(std::span(value));
  std::vector<unsigned> result;
  for (std::size_t at = 0; bytes.size() % 2 == 0 && at < bytes.size(); at += 2)
  {
    result.push_back(ReadNumber(bytes.subspan(at, 2), this->Encoding.IsBigEndian));
  }
  return result;
}

std::vector<DICOMDataSet> DICOMDataSet::Items(const DICOMTag& tag) const
{
  std::vector<DICOMDataSet> items;
  const DICOMElement* element = this->Find(tag);
  if (!element)
  {
    return items;
  }
  const DICOMSyntax syntax = Walk::SyntaxInside(*element, this->Encoding);
  const bool isDelimited = element->Length == DICOMElement::Undefined;
  const std::uint64_t end = isDelimited ? NoEnd : element->Position + element->Length;
  Walk walk(*this->Source, element->Position);
  while (walk.GetPosition() < end)
  {
    const DICOMElement item = walk.NextItem(syntax, end);
    if (item.Tag == SequenceEnd)
    {
      break;
    }
    DICOMDataSet data;
    data.Source = this->Source;
    data.Encoding = syntax;
    const bool isItemDelimited = item.Length == DICOMElement::Undefined;
    walk.TakeElements(data.Elements, syntax, isItemDelimited ? end : item.Position + item.Length,
      isItemDelimited, 1);
    items.push_back(std::move(data));
  }
  return items;
}

std::vector<DICOMElement> DICOMDataSet::Fragments(const DICOMElement& pixels) const
{
  std::vector<DICOMElement> fragments;
  Walk walk(*this->Source, pixels.Position);
  for (DICOMElement item = walk.NextItem(this->Encoding, NoEnd); item.Tag != SequenceEnd;
       item = walk.NextItem(this->Encoding, NoEnd))
  {
    RefuseIf(item.Length == DICOMElement::Undefined,
      "it is damaged: its compressed pixels have a fragment without a length");
    fragments.push_back(item);
    walk.SkipItem(item, this->Encoding, NoEnd, 0);
  }
  return fragments;
}

std::uint64_t DICOMDataSet::Available(std::uint64_t position, std::uint64_t length) const
{
  return this->Source->Available(position, length);
}

void DICOMDataSet::ReadBytes(std::uint64_t position, std::span<std::byte> to) const
{
  RefuseIf(this->Source->ReadAt(position, to) != to.size(),
    "it is truncated or damaged: it ends within an element");
}

bool DICOMDataSet::Recognize(const InputFile& file)
{
  constexpr int enough = 3; // elements
  const std::string start = file.Beginning(PreambleSize + Magic.size());
  if (start.size() == PreambleSize + Magic.size() && start.ends_with(Magic))
  {
    return true;
  }
  if (start.size() < 8 || (start[0] != 2 && start[0] != 8) || start[1] != 0)
  {
    return false;
  }
  try
  {
    DICOMSource source(file.Path());
    Walk walk(source, 0);
    DICOMSyntax syntax;
    syntax.IsExplicit = walk.IsExplicit();
    std::uint32_t last = 0;
    for (int i = 0; i < enough; ++i)
    {
      const DICOMElement element = walk.Next(syntax, NoEnd);
      if (element.Tag <= last && i > 0)
      {
        return false;
      }
      last = element.Tag;
      walk.Skip(element, syntax, NoEnd, 0);
    }
  }
  catch (const FileError&)
  {
    return false;
  }
  return true;
}

} // namespace voxplex::io
