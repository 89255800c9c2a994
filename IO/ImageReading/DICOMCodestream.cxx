// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "DICOMPixels.h"

#include "FileError.h"

#include <gdcmDataElement.h>
#include <gdcmFragment.h>
#include <gdcmJPEG2000Codec.h>
#include <gdcmJPEGCodec.h>
#include <gdcmJPEGLSCodec.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>

#include <array>
#include <optional>
#include <set>

namespace voxplex::io
{
namespace
{

using Codestream = std::span<const std::byte>;

/** What a codestream says of itself. */
struct Header
{
  std::uint64_t Columns = 0;
  std::uint64_t Rows = 0;
  unsigned Components = 0;
  unsigned Bits = 0;
  bool IsSigned = false;
  bool IsLossy = false;    ///< as far as it can be told
  std::uint32_t Frame = 0; ///< marker of its kind, in JPEG
  std::size_t Scan = 0;    ///< where its data begin, in JPEG
};

constexpr std::uint32_t EndOfImage = 0xFFD9; // of all three

constexpr const char* Damaged = "its pixels are truncated or damaged: ";

/** At a position; big endian. */
std::uint32_t NumberAt(Codestream stream, std::size_t at, std::size_t size)
{
  RefuseIf(at + size > stream.size(), Damaged, "a compressed frame ends within its header");
  return ReadNumber(stream.subspan(at, size), true);
}

/** Zeros may follow the end, which make the length even. */
Codestream WithoutPadding(const std::vector<std::byte>& packed)
{
  Codestream stream(packed);
  while (!stream.empty() && stream.back() == std::byte(0))
  {
    stream = stream.first(stream.size() - 1);
  }
  RefuseIf(stream.size() < 4 || NumberAt(stream, stream.size() - 2, 2) != EndOfImage, Damaged,
    "a compressed frame of ", packed.size(), " bytes has no end");
  return stream;
}

constexpr std::uint32_t FillBytes = 0xFFFF;
constexpr std::uint32_t StartOfScan = 0xFFDA;
constexpr std::uint32_t LosslessFrame = 0xFFC3;
constexpr std::uint32_t FirstRestart = 0xFFD0;

/**
 * From the marker segment SOF, of JPEG-LS or of JPEG. All segments up to the first scan follow each other, and bytes
 * 0xFF may fill up before each marker.
 */
Header ReadHeaderOfJPEG(Codestream stream, bool isLS)
{
  constexpr std::uint32_t startOfImage = 0xFFD8;
  constexpr std::uint32_t firstFrame =
    0xFFC0; // baseline; extended, progressive and lossless follow
  constexpr std::uint32_t frameOfLS = 0xFFF7;
  std::optional<Header> header;
  std::uint32_t marker = NumberAt(stream, 0, 2);
  bool isSound = marker == startOfImage;
  std::size_t at = 2;
  for (; isSound && marker != StartOfScan; at += 2 + NumberAt(stream, at + 2, 2))
  {
    while ((marker = NumberAt(stream, at, 2)) == FillBytes)
    {
      ++at;
    }
    if (isLS ? marker == frameOfLS : marker >= firstFrame && marker <= LosslessFrame)
    {
      isSound = !header;
      header = Header{ NumberAt(stream, at + 7, 2), NumberAt(stream, at + 5, 2),
        NumberAt(stream, at + 9, 1), NumberAt(stream, at + 4, 1), false, false, marker };
    }
    isSound = isSound && marker >= firstFrame && marker != EndOfImage;
  }
  RefuseIf(!isSound || !header, Damaged,
    isLS ? "a frame is no JPEG-LS" : "a frame is no JPEG of a kind that is supported");
  header->Scan = at;
  header->IsLossy = isLS ? NumberAt(stream, at - 3, 1) != 0 // how far off values may be
                         : header->Frame != LosslessFrame;
  return *header;
}

/**
 * One scan of a lossless JPEG that goes on to the end. Where its data end too soon, or have a code that there is not,
 * GDCM goes on with zeros, and fails at the second warning only. So it gets a byte before the end that is worth the
 * first one.
 */
std::vector<std::byte> WithWarning(Codestream stream, std::size_t scan)
{
  std::vector<std::byte> result(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(scan));
  for (std::size_t at = scan; at + 2 < stream.size(); ++at)
  {
    const std::uint32_t marker = NumberAt(stream, at, 2);
    const bool isRestart = marker >= FirstRestart && marker < FirstRestart + 8;
    RefuseIf(marker > 0xFF00 && marker != FillBytes && !isRestart, Damaged,
      "a compressed frame has a marker within its pixels");
    if (marker != FillBytes)
    {
      result.push_back(stream[at]);
    }
  }
  // A restart takes the library out of the scan; what is after it belongs to nothing.
  for (const unsigned byte : { 0xFFU, 0xD0U, 0U, 0xFFU, 0xD9U })
  {
    result.push_back(std::byte(byte));
  }
  return result;
}

/**
 * All tiles are there, up to the end. The library would leave out those that are missing.
 * @return whether the wavelets are those of whole numbers, with which nothing need be lost
 */
bool CheckTiles(Codestream stream, std::uint64_t count)
{
  constexpr std::uint32_t startOfTile = 0xFF90;
  constexpr std::uint32_t codingStyle = 0xFF52;
  bool isReversible = true;
  std::size_t at = 2;
  for (std::uint32_t marker = 0; (marker = NumberAt(stream, at, 2)) != startOfTile;
       at += 2 + NumberAt(stream, at + 2, 2))
  {
    isReversible = isReversible && (marker != codingStyle || NumberAt(stream, at + 13, 1) == 1);
  }
  std::set<std::uint32_t> tiles;
  while (NumberAt(stream, at, 2) == startOfTile)
  {
    constexpr std::uint32_t shortest = 14; // with the marker of its data
    const std::uint32_t length = NumberAt(stream, at + 6, 4);
    tiles.insert(NumberAt(stream, at + 4, 2));
    if (length == 0) // to the end
    {
      at = stream.size() - 2;
      break;
    }
    RefuseIf(length < shortest, Damaged, "a JPEG 2000 tile has ", length, " bytes");
    at += length;
  }
  RefuseIf(at != stream.size() - 2 || tiles.size() != count, Damaged, "a JPEG 2000 frame has ",
    tiles.size(), " whole tiles of ", count);
  return isReversible;
}

/** From the marker segment SIZ, which comes first. */
Header ReadHeaderOfJPEG2000(Codestream stream)
{
  constexpr std::uint32_t startOfCodestream = 0xFF4FFF51; // with SIZ
  constexpr std::uint32_t startOfFile = 0x0000000C;
  RefuseIf(NumberAt(stream, 0, 4) == startOfFile,
    "its frames are files of JPEG 2000, where codestreams must be: decompress it first (gdcmconv "
    "--raw)");
  RefuseIf(
    NumberAt(stream, 0, 4) != startOfCodestream, Damaged, "a frame is no JPEG 2000 codestream");
  const std::uint64_t right = NumberAt(stream, 8, 4);
  const std::uint64_t bottom = NumberAt(stream, 12, 4);
  const std::uint64_t left = NumberAt(stream, 16, 4);
  const std::uint64_t top = NumberAt(stream, 20, 4);
  const std::uint64_t tileColumns = NumberAt(stream, 24, 4);
  const std::uint64_t tileRows = NumberAt(stream, 28, 4);
  const std::uint64_t tileLeft = NumberAt(stream, 32, 4);
  const std::uint64_t tileTop = NumberAt(stream, 36, 4);
  const std::uint32_t depth = NumberAt(stream, 42, 1);
  const bool isWhole = NumberAt(stream, 43, 2) == 0x0101; // not subsampled
  RefuseIf(!isWhole || left >= right || top >= bottom || tileLeft > left || tileTop > top ||
      tileColumns == 0 || tileRows == 0,
    Damaged, "a frame has sizes that JPEG 2000 does not allow, or is subsampled");
  const bool isReversible = CheckTiles(stream,
    ((right - tileLeft + tileColumns - 1) / tileColumns) *
      ((bottom - tileTop + tileRows - 1) / tileRows));
  return { right - left, bottom - top, NumberAt(stream, 40, 2), (depth & 0x7F) + 1, depth >= 0x80,
    !isReversible, 0, 0 };
}

void CheckHeader(const Header& header, const DICOMPixelFormat& format)
{
  RefuseIf(header.Columns != format.Columns || header.Rows != format.Rows || header.Components != 1,
    "its pixels are damaged: a compressed frame has ", header.Columns, " x ", header.Rows,
    " pixels of ", header.Components, " components, and its header says ", format.Columns, " x ",
    format.Rows, " of 1");
  const bool isShifted =
    format.HighBit + 1 != format.BitsStored && header.Bits != format.BitsAllocated;
  const bool isSignLost = format.IsSigned ? header.Bits < format.BitsStored : header.IsSigned;
  RefuseIf(header.Bits < (format.BitsAllocated == 1 ? 1 : 2), "its pixels are compressed and have ",
    header.Bits, " bit, which is not supported: decompress it first (gdcmconv --raw)");
  RefuseIf(header.Bits > format.BitsAllocated || isShifted || isSignLost, "its pixels have ",
    header.Bits, (header.IsSigned ? " signed" : ""), " bits where they are compressed, and ",
    format.BitsStored, (format.IsSigned ? " signed" : ""),
    " in its header, which do not fit together: decompress it first (gdcmconv --raw, dcmdjpeg)");
}

/** With one codec of GDCM. */
DICOMFrame Decode(gdcm::ImageCodec& codec, const Header& header, Codestream stream,
  const DICOMPixelFormat& format, const gdcm::PixelFormat& pixels)
{
  gdcm::Trace::SetWarning(false);
  gdcm::Trace::SetError(false);
  const std::array<unsigned, 3> sizes{ format.Columns, format.Rows, 1 };
  codec.SetNumberOfDimensions(2);
  codec.SetDimensions(sizes.data());
  codec.SetPlanarConfiguration(0);
  codec.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  codec.SetPixelFormat(pixels);

  gdcm::Fragment fragment;
  fragment.SetByteValue(
    reinterpret_cast<const char*>(stream.data()), static_cast<std::uint32_t>(stream.size()));
  const gdcm::SmartPointer<gdcm::SequenceOfFragments> fragments = new gdcm::SequenceOfFragments;
  fragments->AddFragment(fragment);
  gdcm::DataElement packed(gdcm::Tag(0x7FE0, 0x0010));
  packed.SetVR(gdcm::VR::OB);
  packed.SetValue(*fragments);
  gdcm::DataElement unpacked;
  const bool isDecoded = codec.Decode(packed, unpacked);
  const gdcm::ByteValue* bytes = isDecoded ? unpacked.GetByteValue() : nullptr;
  const std::size_t bytesOfSample = (pixels.GetBitsAllocated() + 7U) / 8U;
  const std::uint64_t expected = format.Pixels() * bytesOfSample;
  const std::uint64_t found = bytes ? static_cast<std::uint32_t>(bytes->GetLength()) : 0;
  RefuseIf(found != expected && found != expected + expected % 2, Damaged,
    "a compressed frame gives ", found, " of ", expected, " bytes");
  const auto* begin = reinterpret_cast<const std::byte*>(bytes->GetPointer());
  return { { begin, begin + expected }, bytesOfSample, header.IsLossy };
}

/** Samples as GDCM gives them, in whole bytes. */
gdcm::PixelFormat FormatOfSamples(unsigned bits, bool isSigned)
{
  const auto allocated = static_cast<unsigned short>(bits <= 8 ? 8 : bits <= 16 ? 16 : 32);
  const auto highBit = static_cast<unsigned short>(allocated - 1);
  return gdcm::PixelFormat(1, allocated, allocated, highBit, static_cast<unsigned short>(isSigned));
}

} // namespace

DICOMFrame DecodeJPEG(const std::vector<std::byte>& packed, const DICOMPixelFormat& format)
{
  const Codestream stream = WithoutPadding(packed);
  const Header header = ReadHeaderOfJPEG(stream, false);
  CheckHeader(header, format);
  const bool isLossless = header.Frame == LosslessFrame;
  const std::vector<std::byte> warned =
    isLossless ? WithWarning(stream, header.Scan) : std::vector<std::byte>();
  const bool isTwelve = header.Bits > 8 && header.Bits <= 12;
  gdcm::JPEGCodec codec;
  // There is a library for each of 8, 12 and 16 bits, and that for 16 bits complains of 12.
  return Decode(codec, header, isLossless ? Codestream(warned) : stream, format,
    isTwelve ? gdcm::PixelFormat(1, 12, 12, 11, 0) : FormatOfSamples(header.Bits, false));
}

DICOMFrame DecodeJPEGLS(const std::vector<std::byte>& packed, const DICOMPixelFormat& format)
{
  const Codestream stream = WithoutPadding(packed);
  const Header header = ReadHeaderOfJPEG(stream, true);
  CheckHeader(header, format);
  gdcm::JPEGLSCodec codec;
  return Decode(codec, header, stream, format, FormatOfSamples(header.Bits, false));
}

DICOMFrame DecodeJPEG2000(const std::vector<std::byte>& packed, const DICOMPixelFormat& format)
{
  const Codestream stream = WithoutPadding(packed);
  const Header header = ReadHeaderOfJPEG2000(stream);
  CheckHeader(header, format);
  gdcm::PixelFormat pixels = FormatOfSamples(header.Bits, header.IsSigned);
  pixels.SetBitsStored(static_cast<unsigned short>(header.Bits));
  pixels.SetHighBit(static_cast<unsigned short>(header.Bits - 1));
  gdcm::JPEG2000Codec codec;
  return Decode(codec, header, stream, format, pixels);
}

} // namespace voxplex::io
