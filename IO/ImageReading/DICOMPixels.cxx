// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "DICOMPixels.h"

#include "ByteSource.h"
#include "FileError.h"
#include "Text.h"

#include <gdcmUIDs.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace voxplex::io
{
namespace
{

constexpr DICOMTag SOPClass{ 0x00080016, "SOP Class UID" };
constexpr DICOMTag SamplesPerPixel{ 0x00280002, "Samples per Pixel" };
constexpr DICOMTag Photometric{ 0x00280004, "Photometric Interpretation" };
constexpr DICOMTag NumberOfFramesTag{ 0x00280008, "Number of Frames" };
constexpr DICOMTag Rows{ 0x00280010, "Rows" };
constexpr DICOMTag Columns{ 0x00280011, "Columns" };
constexpr DICOMTag BitsAllocated{ 0x00280100, "Bits Allocated" };
constexpr DICOMTag BitsStored{ 0x00280101, "Bits Stored" };
constexpr DICOMTag HighBit{ 0x00280102, "High Bit" };
constexpr DICOMTag PixelRepresentation{ 0x00280103, "Pixel Representation" };
constexpr DICOMTag LossyCompression{ 0x00282110, "Lossy Image Compression" };
constexpr DICOMTag PixelData{ 0x7FE00010, "Pixel Data" };

unsigned Required(const DICOMDataSet& data, const DICOMTag& tag)
{
  const std::optional<unsigned> number = data.Short(tag);
  RefuseIf(!number, "it has no ", tag);
  return *number;
}

void CheckColours(const DICOMDataSet& data)
{
  constexpr const char* colours = ": its voxels are colours, and a label image has one value a "
                                  "voxel: export the labels, or convert it to grey values first";
  const unsigned samples = data.Short(SamplesPerPixel).value_or(1);
  RefuseIf(samples != 1, "its ", SamplesPerPixel, " is ", samples, colours);
  const std::string meaning = data.Text(Photometric);
  const bool isLabels = IsLabelMap(data) && meaning == "PALETTE COLOR";
  RefuseIf(meaning != "MONOCHROME2" && meaning != "MONOCHROME1" && !isLabels, "its ", Photometric,
    " is '", Excerpt(meaning), "'", colours);
}

DICOMPixelFormat ReadFormat(const DICOMDataSet& data)
{
  DICOMPixelFormat format;
  format.Rows = Required(data, Rows);
  format.Columns = Required(data, Columns);
  format.BitsAllocated = Required(data, BitsAllocated);
  format.BitsStored = Required(data, BitsStored);
  format.HighBit = data.Short(HighBit).value_or(format.BitsStored - 1);
  const unsigned representation = Required(data, PixelRepresentation);
  format.IsSigned = representation == 1;
  RefuseIf(format.Rows == 0 || format.Columns == 0, "it has ", format.Rows, " rows and ",
    format.Columns, " columns");
  const bool isOfSegments = HasFramesOfSegments(data);
  RefuseIf(format.BitsAllocated != 8 &&
      (isOfSegments ? format.BitsAllocated != 1
                    : format.BitsAllocated != 16 && format.BitsAllocated != 32),
    "its ", BitsAllocated, " is ", format.BitsAllocated, ": voxels of ",
    (isOfSegments ? "1 and 8" : "8, 16 and 32"), " bits are read: convert it first");
  RefuseIf(format.BitsStored == 0 || format.HighBit >= format.BitsAllocated ||
      format.HighBit + 1 < format.BitsStored,
    "its voxels have ", format.BitsStored, " bits stored up to bit ", format.HighBit, " of ",
    format.BitsAllocated, ", which cannot be: correct its header");
  RefuseIf(
    representation > 1, "its ", PixelRepresentation, " is ", representation, ": it must be 0 or 1");
  return format;
}

int ReadNumberOfFrames(const DICOMDataSet& data)
{
  const std::vector<double> number = data.Numbers(NumberOfFramesTag, 1);
  if (number.empty())
  {
    return 1;
  }
  RefuseIf(number[0] < 1 || number[0] > std::numeric_limits<int>::max() ||
      number[0] != std::trunc(number[0]),
    "its ", NumberOfFramesTag, " is '", Excerpt(data.Text(NumberOfFramesTag)),
    "': it must be a positive whole number");
  return static_cast<int>(number[0]);
}

std::string NameOfSyntax(const std::string& uid)
{
  gdcm::UIDs names;
  const bool isKnown = names.SetFromUID(uid.c_str());
  return "'" + (isKnown ? std::string(names.GetName()) : Excerpt(uid)) + "'";
}

std::string Truncation(std::uint64_t found, std::uint64_t needed)
{
  return "its pixels are truncated: " + std::to_string(found) + " of " + std::to_string(needed) +
    " bytes";
}

/** One byte of each pixel: literals, and bytes that are repeated (PS3.5, G.3). */
void DecodeSegment(
  std::span<const std::byte> packed, std::byte* to, std::size_t count, std::size_t stride)
{
  std::size_t at = 0;
  std::size_t done = 0;
  while (done < count && at < packed.size())
  {
    const int head = static_cast<signed char>(packed[at++]);
    const bool isRun = head < 0;
    const auto length = static_cast<std::size_t>(head == -128 ? 0 : isRun ? 1 - head : 1 + head);
    const std::size_t taken = std::min<std::size_t>(length, isRun ? 1 : length);
    if (packed.size() - at < taken || count - done < length)
    {
      break;
    }
    for (std::size_t i = 0; i < length; ++i)
    {
      to[(done + i) * stride] = packed[at + (isRun ? 0 : i)];
    }
    at += taken;
    done += length;
  }
  const std::span<const std::byte> padding = packed.subspan(at);
  const bool isPadded = std::all_of(
    padding.begin(), padding.end(), [](std::byte byte) { return byte == std::byte(0); });
  RefuseIf(done < count || !isPadded,
    "its pixels are truncated or damaged: a run-length segment has ",
    (done < count ? std::to_string(done) + " of " : std::string("more than ")), count, " bytes");
}

/** A byte for each of so many bits from one on. The lowest of a byte comes first. */
std::vector<std::byte> UnpackBits(
  const std::vector<std::byte>& packed, std::size_t first, std::size_t count)
{
  std::vector<std::byte> bytes(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    bytes[i] = packed[(first + i) / 8] >> (first + i) % 8 & std::byte{ 1 };
  }
  return bytes;
}

/** What a part of memory holds. */
class MemorySource : public ByteSource
{
public:
  explicit MemorySource(std::span<const std::byte> bytes)
    : Left(bytes)
  {
  }
  std::size_t Read(std::span<std::byte> to) override
  {
    const std::size_t length = std::min(to.size(), this->Left.size());
    std::copy_n(this->Left.begin(), length, to.begin());
    this->Left = this->Left.subspan(length);
    return length;
  }

private:
  std::span<const std::byte> Left;
};

/** Each frame is a stream of its own. */
DICOMFrame DecodeDeflate(const std::vector<std::byte>& packed, const DICOMPixelFormat& format)
{
  DICOMFrame frame{ std::vector<std::byte>(static_cast<std::size_t>(format.StoredBytesOfFrame())),
    static_cast<std::size_t>(format.BytesOfSample()), false };
  MemorySource source(packed);
  InflateSource stream(source, false);
  const std::size_t found = stream.Read(frame.Samples);
  RefuseIf(found != frame.Samples.size(),
    "its pixels are truncated or damaged: a frame unpacks to ", found, " of ", frame.Samples.size(),
    " bytes");
  stream.Finish();
  return frame;
}

/** Segments hold a byte of each pixel, the most significant first. */
DICOMFrame DecodeRLE(const std::vector<std::byte>& packed, const DICOMPixelFormat& format)
{
  constexpr std::size_t headerSize = 64;
  const auto expected = static_cast<std::size_t>(format.BytesOfSample());
  const auto number = [&packed](std::size_t index)
  { return ReadNumber(std::span(packed).subspan(4 * index, 4), false); };
  RefuseIf(packed.size() < headerSize || number(0) != expected,
    "its pixels are damaged: a frame has ",
    (packed.size() < headerSize ? "no" : std::to_string(number(0))), " run-length segments, and ",
    expected, " are needed");
  DICOMFrame frame{ std::vector<std::byte>(static_cast<std::size_t>(format.BytesOfFrame())),
    expected, false };
  for (std::size_t segment = 0; segment < expected; ++segment)
  {
    const std::size_t begin = number(1 + segment);
    const std::size_t end = segment + 1 < expected ? number(2 + segment) : packed.size();
    RefuseIf(begin < headerSize || begin > end || end > packed.size(),
      "its pixels are damaged: a run-length segment begins at byte ", begin, " and ends at byte ",
      end, " of ", packed.size());
    DecodeSegment(std::span(packed).subspan(begin, end - begin),
      frame.Samples.data() + expected - 1 - segment, static_cast<std::size_t>(format.Pixels()),
      expected);
  }
  return frame;
}

/** Whether a fragment ends with the marker EOI or EOC, which a zero may follow. */
bool EndsImage(const DICOMDataSet& data, const DICOMElement& fragment)
{
  std::array<std::byte, 3> end{};
  const std::size_t length = std::min<std::size_t>(end.size(), fragment.Length);
  data.ReadBytes(fragment.Position + fragment.Length - length, std::span(end).last(length));
  return ReadNumber(std::span(end).last(2), true) == 0xFFD9 || ReadNumber(end, true) == 0xFFD900;
}

} // namespace

bool IsLabelMap(const DICOMDataSet& data)
{
  return data.Text(SOPClass) == "1.2.840.10008.5.1.4.1.1.66.7";
}

bool HasFramesOfSegments(const DICOMDataSet& data)
{
  return data.Text(SOPClass) == "1.2.840.10008.5.1.4.1.1.66.4";
}

DICOMPixels::DICOMPixels(const DICOMDataSet& data)
  : Data(data)
{
  CheckColours(data);
  this->Layout = ReadFormat(data);
  this->NumberOfFrames = ReadNumberOfFrames(data);
  this->ChooseCompression(data.Syntax().UID, data.Text(LossyCompression));
  const DICOMElement* pixels = data.Find(PixelData);
  RefuseIf(!pixels, "it has no ", PixelData);
  if (this->Method == Compression::None)
  {
    this->CheckRawLength(*pixels);
    this->Begin = pixels->Position;
    this->AreBytesSwapped =
      data.Syntax().IsBigEndian && (this->Layout.BitsAllocated > 8 || pixels->VR() == "OW");
    return;
  }
  RefuseIf(pixels->Length != DICOMElement::Undefined,
    "its pixels are damaged: they are not compressed, as its transfer syntax ",
    NameOfSyntax(data.Syntax().UID), " says");
  RefuseIf(this->Layout.BitsAllocated == 1 &&
      (this->Method == Compression::JPEG || this->Method == Compression::JPEGLS),
    "its voxels of 1 bit are compressed by ", NameOfSyntax(data.Syntax().UID),
    ", which is not supported: decompress it first (gdcmconv --raw)");
  this->FindFrames(*pixels);
  this->CheckRatio();
}

void DICOMPixels::ChooseCompression(const std::string& syntax, const std::string& lossy)
{
  struct Known
  {
    std::string_view UID; ///< after the root
    Compression Method;
    bool IsLossy = false;
  };
  constexpr std::string_view root = "1.2.840.10008.1.2";
  constexpr std::array<Known, 16> known{ { { "", Compression::None }, { ".1", Compression::None },
    { ".2", Compression::None }, { ".1.99", Compression::None }, { ".5", Compression::RLE },
    { ".8.1", Compression::Deflate }, { ".4.50", Compression::JPEG, true },
    { ".4.51", Compression::JPEG, true }, { ".4.53", Compression::JPEG, true },
    { ".4.55", Compression::JPEG, true }, { ".4.57", Compression::JPEG },
    { ".4.70", Compression::JPEG }, { ".4.80", Compression::JPEGLS },
    { ".4.81", Compression::JPEGLS, true }, { ".4.90", Compression::JPEG2000 },
    { ".4.91", Compression::JPEG2000 } } };
  const auto found = std::find_if(known.begin(), known.end(),
    [&](const Known& one)
    { return syntax.empty() ? one.UID.empty() : syntax == std::string(root).append(one.UID); });
  if (found == known.end())
  {
    Refuse("its transfer syntax ", NameOfSyntax(syntax),
      " is not supported: decompress it first (gdcmconv --raw, dcmdjpeg)");
  }
  this->Method = found->Method;
  // JPEG-LS and JPEG 2000 may be without loss, also in the transfer syntaxes that allow it.
  this->WasLossy =
    lossy == "01" || (found->IsLossy && (lossy != "00" || found->Method == Compression::JPEG));
}

void DICOMPixels::CheckRawLength(const DICOMElement& pixels) const
{
  const std::uint64_t frame = this->Layout.Pixels() * this->Layout.BitsAllocated;
  const auto frames = static_cast<std::uint64_t>(this->NumberOfFrames);
  const bool isEndless = frame > (std::numeric_limits<std::uint64_t>::max() - 7) / frames;
  const std::uint64_t needed = (frame * frames + 7) / 8;
  RefuseIf(pixels.Length == DICOMElement::Undefined,
    "its pixels are damaged: they have no length, and are not compressed");
  RefuseIf(isEndless || pixels.Length < needed,
    isEndless ? "its header claims more pixels than memory has"
              : Truncation(pixels.Length, needed));
  if (const std::uint64_t padded = needed + needed % 2; pixels.Length > padded)
  {
    Refuse("its pixels have ", pixels.Length, " bytes, and ", this->NumberOfFrames, " frames of ",
      this->Layout.Columns, " x ", this->Layout.Rows, " have ", needed, ": correct its header");
  }
  if (const std::uint64_t found = this->Data.Available(pixels.Position, needed); found < needed)
  {
    Refuse(Truncation(found, needed));
  }
}

/** A frame has one fragment, or those that the table of offsets gives it, or those up to an end of an image. */
void DICOMPixels::FindFrames(const DICOMElement& pixels)
{
  std::vector<DICOMElement> fragments = this->Data.Fragments(pixels);
  RefuseIf(fragments.empty(), "its pixels are truncated: there are none");
  std::vector<std::byte> table(fragments.front().Length);
  this->Data.ReadBytes(fragments.front().Position, table);
  fragments.erase(fragments.begin());

  const auto frames = static_cast<std::size_t>(this->NumberOfFrames);
  if (frames == 1 && !fragments.empty())
  {
    this->FragmentsOfFrames = { fragments };
    return;
  }
  if (frames == fragments.size())
  {
    for (const DICOMElement& fragment : fragments)
    {
      this->FragmentsOfFrames.push_back({ fragment });
    }
    return;
  }
  const bool isByEnds =
    table.empty() && this->Method != Compression::RLE && this->Method != Compression::Deflate;
  bool hasEnded = true;
  for (const DICOMElement& fragment : fragments)
  {
    const std::size_t at = 4 * this->FragmentsOfFrames.size(); // of the next frame in the table
    const std::uint64_t offset = fragment.Position - fragments.front().Position;
    if (isByEnds
        ? hasEnded
        : at + 4 <= table.size() && offset == ReadNumber(std::span(table).subspan(at, 4), false))
    {
      this->FragmentsOfFrames.emplace_back();
    }
    if (this->FragmentsOfFrames.empty())
    {
      break;
    }
    this->FragmentsOfFrames.back().push_back(fragment);
    hasEnded = isByEnds && EndsImage(this->Data, fragment);
  }
  RefuseIf(this->FragmentsOfFrames.size() != frames || (!isByEnds && table.size() != 4 * frames),
    "its pixels are truncated or damaged: it has ", fragments.size(), " compressed fragments for ",
    frames, " frames");
}

/** Memory is not taken for what a file cannot hold. */
void DICOMPixels::CheckRatio() const
{
  // A block of 64 pixels takes a bit of JPEG at least.
  const std::uint64_t most = this->Method == Compression::RLE ? 64
    : this->Method == Compression::Deflate                    ? 1032
    : this->Method == Compression::JPEG                       ? 1024
                                                              : 65536;
  for (const std::vector<DICOMElement>& fragments : this->FragmentsOfFrames)
  {
    std::uint64_t packed = 0;
    for (const DICOMElement& fragment : fragments)
    {
      packed += fragment.Length;
    }
    RefuseIf(packed * most < this->Layout.StoredBytesOfFrame(),
      "its pixels are truncated or damaged: frames of ", this->Layout.StoredBytesOfFrame(),
      " bytes are not compressed to ", packed);
  }
}

DICOMFrame DICOMPixels::Read(int frame) const
{
  switch (this->Method)
  {
    case Compression::None:
      return this->ReadRaw(frame);
    case Compression::RLE:
    case Compression::Deflate:
      return this->ReadBytesOfFrame(frame);
    case Compression::JPEG:
      return DecodeJPEG(this->ReadFragments(frame), this->Layout);
    case Compression::JPEGLS:
      return DecodeJPEGLS(this->ReadFragments(frame), this->Layout);
    case Compression::JPEG2000:
      return DecodeJPEG2000(this->ReadFragments(frame), this->Layout);
  }
  return {};
}

/** Bytes of pixels that are not compressed, as they follow each other. */
std::vector<std::byte> DICOMPixels::ReadStored(std::uint64_t offset, std::size_t size) const
{
  const std::size_t bytesOfSample = static_cast<std::size_t>(this->Layout.BytesOfSample());
  std::vector<std::byte> bytes(size);
  if (!this->AreBytesSwapped || bytesOfSample > 1)
  {
    this->Data.ReadBytes(this->Begin + offset, bytes);
    for (std::size_t i = 0; this->AreBytesSwapped && i < size; i += bytesOfSample)
    {
      std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i),
        bytes.begin() + static_cast<std::ptrdiff_t>(i + bytesOfSample));
    }
    return bytes;
  }
  // Two bytes are in a word, which may belong to two frames.
  std::vector<std::byte> words(size + 2);
  const std::uint64_t start = offset - offset % 2;
  const std::uint64_t end = offset + size + (offset + size) % 2;
  this->Data.ReadBytes(
    this->Begin + start, std::span(words).first(static_cast<std::size_t>(end - start)));
  for (std::size_t i = 0; i < size; ++i)
  {
    bytes[i] = words[((offset + i) ^ 1) - start];
  }
  return bytes;
}

DICOMFrame DICOMPixels::ReadRaw(int frame) const
{
  const auto size = static_cast<std::size_t>(this->Layout.BytesOfFrame());
  const std::uint64_t first = static_cast<std::uint64_t>(frame) * size;
  const auto bytesOfSample = static_cast<std::size_t>(this->Layout.BytesOfSample());
  if (this->Layout.BitsAllocated > 1)
  {
    return { this->ReadStored(first, size), bytesOfSample, false };
  }
  // Frames of bits need not begin with a byte.
  return { UnpackBits(this->ReadStored(
                        first / 8, static_cast<std::size_t>((first + size + 7) / 8 - first / 8)),
             static_cast<std::size_t>(first % 8), size),
    bytesOfSample, false };
}

/** Compressed as bytes, in which there may be bits. */
DICOMFrame DICOMPixels::ReadBytesOfFrame(int frame) const
{
  const bool isOfBits = this->Layout.BitsAllocated == 1;
  DICOMPixelFormat bytes = this->Layout;
  if (isOfBits)
  {
    bytes.Rows = 1;
    bytes.Columns = static_cast<unsigned>(this->Layout.StoredBytesOfFrame());
    bytes.BitsAllocated = 8;
  }
  const std::vector<std::byte> packed = this->ReadFragments(frame);
  DICOMFrame result =
    this->Method == Compression::RLE ? DecodeRLE(packed, bytes) : DecodeDeflate(packed, bytes);
  if (isOfBits)
  {
    result.Samples = UnpackBits(result.Samples, 0, static_cast<std::size_t>(this->Layout.Pixels()));
  }
  return result;
}

std::vector<std::byte> DICOMPixels::ReadFragments(int frame) const
{
  std::vector<std::byte> packed;
  for (const DICOMElement& fragment : this->FragmentsOfFrames[static_cast<std::size_t>(frame)])
  {
    const std::size_t before = packed.size();
    packed.resize(before + fragment.Length);
    this->Data.ReadBytes(fragment.Position, std::span(packed).subspan(before));
  }
  return packed;
}

} // namespace voxplex::io
