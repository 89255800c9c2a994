// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Readers.h"

#include "ByteSource.h"
#include "Fields.h"
#include "Placement.h"
#include "StoredVoxels.h"
#include "TIFFStack.h"
#include "Text.h"

#include <vtk_tiff.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace voxplex::io
{
namespace
{

// --- libtiff, which says what it finds to us alone

struct Source
{
  explicit Source(const InputFile& file)
    : File(file)
    , Descriptor(fcntl(file.Descriptor(), F_DUPFD_CLOEXEC, 0))
  {
  }

  const InputFile& File;
  int Descriptor;      ///< for libtiff, which closes it
  std::string Error;   ///< the first since it was cleared
  std::string Warning; ///< the last since it was cleared
  std::string
    Ignored; ///< the warning of a tag that matters and is not used; empty if there is none
};

std::string Format(const char* format, va_list values)
{
  std::array<char, 400> text{};
  std::vsnprintf(text.data(), text.size(), format, values);
  return text.data();
}

void NoteError(Source& source, const char* format, va_list values)
{
  if (source.Error.empty())
  {
    source.Error = Format(format, values);
  }
}

void NoteWarning(Source& source, const char* format, va_list values)
{
  source.Warning = Format(format, values);
  constexpr std::array<std::string_view, 9> tagsThatMatter{ "\"SubfileType\"",
    "\"PhotometricInterpretation\"", "\"ImageDescription\"", "\"Orientation\"", "\"FillOrder\"",
    "\"Predictor\"", "\"XResolution\"", "\"YResolution\"", "\"ResolutionUnit\"" };
  const auto isNamed = [&](std::string_view tag)
  { return source.Warning.find(tag) != std::string::npos; };
  if (source.Ignored.empty() && source.Warning.find("ignored") != std::string::npos &&
    std::any_of(tagsThatMatter.begin(), tagsThatMatter.end(), isNamed))
  {
    source.Ignored = source.Warning;
  }
}

struct TIFFCloser
{
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

using TIFFHandle = std::unique_ptr<TIFF, TIFFCloser>;

// Memory is not mapped, so that a file that shrinks is no crash; strips are not divided.
constexpr const char* Mode = "rmc";

/** libtiff's handlers, which all versions have, are those of the whole process: it reads one file at a time. */
Source* current = nullptr;

template <void (*Note)(Source&, const char*, va_list)>
void Handle(thandle_t file, const char*, const char* format, va_list values)
{
  if (current && reinterpret_cast<std::intptr_t>(file) == current->Descriptor)
  {
    Note(*current, format, values);
  }
}

TIFF* OpenWithHandlers(Source& source)
{
  current = &source;
  TIFFSetErrorHandler(nullptr);
  TIFFSetErrorHandlerExt(Handle<NoteError>);
  TIFFSetWarningHandler(nullptr);
  TIFFSetWarningHandlerExt(Handle<NoteWarning>);
  return TIFFFdOpen(source.Descriptor, "", Mode);
}

TIFFHandle Open(Source& source)
{
  TIFFHandle handle(OpenWithHandlers(source));
  if (!handle)
  {
    close(source.Descriptor);
  }
  return handle;
}

constexpr const char* DamagedPage = "it is truncated or damaged: page ";

/** By what libtiff says. */
void RefuseDamageIf(bool isDamaged, std::int64_t page, const std::string& reason)
{
  RefuseIf(isDamaged, DamagedPage, page, reason.empty() ? "" : " (" + Excerpt(reason, 200) + ")");
}

/** The value of a tag, or what TIFF says where there is none. */
template <typename T>
T Get(TIFF* tiff, std::uint32_t tag, T otherwise)
{
  T value{};
  return TIFFGetFieldDefaulted(tiff, tag, &value) ? value : otherwise;
}

// --- One page

/** What all pages have alike. */
struct PageType
{
  std::uint32_t Width = 0;
  std::uint32_t Length = 0;
  std::uint16_t Bits = 1;
  std::uint16_t Format = SAMPLEFORMAT_UINT;
  std::uint16_t Samples = 1;

  bool operator==(const PageType&) const = default;
  std::uint64_t BytesOf(std::uint64_t columns) const { return (columns * this->Bits + 7) / 8; }
};

PageType GetType(TIFF* tiff)
{
  PageType type;
  type.Width = Get(tiff, TIFFTAG_IMAGEWIDTH, type.Width);
  type.Length = Get(tiff, TIFFTAG_IMAGELENGTH, type.Length);
  type.Bits = Get(tiff, TIFFTAG_BITSPERSAMPLE, type.Bits);
  type.Format = Get(tiff, TIFFTAG_SAMPLEFORMAT, type.Format);
  type.Samples = Get(tiff, TIFFTAG_SAMPLESPERPIXEL, type.Samples);
  if (type.Format == SAMPLEFORMAT_VOID)
  {
    type.Format = SAMPLEFORMAT_UINT;
  }
  return type;
}

/** "20 x 12, unsigned integers of 16 bits" */
std::string Describe(const PageType& type)
{
  constexpr std::array<const char*, 7> formats{ "numbers", "unsigned integers", "signed integers",
    "floating-point numbers", "numbers", "complex integers", "complex numbers" };
  return std::to_string(type.Width) + " x " + std::to_string(type.Length) + ", " +
    (type.Samples > 1 ? std::to_string(type.Samples) + " " : "") +
    formats[type.Format < formats.size() ? type.Format : 0] + " of " + std::to_string(type.Bits) +
    " bits";
}

/** Empty for what a voxel cannot be. */
std::optional<ScalarType> FindScalarType(const PageType& type)
{
  if (type.Format == SAMPLEFORMAT_IEEEFP)
  {
    return type.Bits == 32 ? std::optional(ScalarType::Float32)
      : type.Bits == 64    ? std::optional(ScalarType::Float64)
                           : std::nullopt;
  }
  const bool isSigned = type.Format == SAMPLEFORMAT_INT;
  if (type.Bits == 1 && type.Format == SAMPLEFORMAT_UINT)
  {
    return ScalarType::UInt8;
  }
  return type.Bits % 8 == 0 && (isSigned || type.Format == SAMPLEFORMAT_UINT)
    ? IntegerType(type.Bits / 8, isSigned)
    : std::nullopt;
}

void CheckType(const PageType& type)
{
  RefuseIf(type.Samples != 1, "it has ", type.Samples,
    " components a voxel (colours or vectors); a label image has one: export it as a label map "
    "first");
  RefuseIf(!FindScalarType(type), "its pages are ", Describe(type),
    "; voxplex reads integers of 1, 8, 16, 32 and 64 bits and floating-point numbers of 32 and 64: "
    "save it with one of these types");
}

/** ImageJ gives colours to numbers that have a meaning without them; for others, numbers only choose colours. */
void CheckColours(TIFF* tiff, bool isImageJ)
{
  const auto colours = Get<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  RefuseIf(colours == PHOTOMETRIC_PALETTE && !isImageJ,
    "its numbers stand for colours of a palette, and need not be labels: save it as grey values");
  RefuseIf(colours != PHOTOMETRIC_MINISBLACK && colours != PHOTOMETRIC_MINISWHITE &&
      colours != PHOTOMETRIC_PALETTE,
    "its numbers are colours (PhotometricInterpretation ", colours,
    "), not labels: export it as a label map first");
}

/** Rows may run upwards. */
bool IsUpsideDown(TIFF* tiff)
{
  const auto orientation =
    Get<std::uint16_t>(tiff, TIFFTAG_ORIENTATION, std::uint16_t{ ORIENTATION_TOPLEFT });
  RefuseIf(orientation != ORIENTATION_TOPLEFT && orientation != ORIENTATION_BOTLEFT,
    "its pages are stored mirrored or turned (Orientation ", orientation, "): save it upright");
  return orientation == ORIENTATION_BOTLEFT;
}

/** @return warning, or an empty string */
std::string CheckCompression(std::uint16_t compression)
{
  const TIFFCodec* codec = TIFFFindCODEC(compression);
  const std::string name =
    codec ? codec->name : "a method that is unknown, " + std::to_string(compression);
  RefuseIf(!TIFFIsCODECConfigured(compression), "it is compressed with ", name,
    ", which this libtiff cannot read: save it uncompressed, or with LZW or Deflate");
  const bool mayChange = compression == COMPRESSION_LERC; // this is a choice of the writer
  const bool isLossy = mayChange || compression == COMPRESSION_JPEG ||
    compression == COMPRESSION_OJPEG || compression == COMPRESSION_PIXARLOG;
  return isLossy
    ? "it is compressed with " + name + ", which " + (mayChange ? "may change" : "changes") +
      " numbers: labels may be wrong, most of all where tissues meet"
    : "";
}

/** Strips or tiles: they cover a page in rows of equal parts. */
struct Parts
{
  bool AreTiles = false;
  std::uint32_t Width = 0;
  std::uint32_t Length = 0;
  std::uint64_t Across = 1;
  std::uint64_t Down = 0;

  /** Rows that are stored of each part: a strip ends with the page. */
  std::uint64_t RowsFrom(std::uint64_t row, const PageType& page) const
  {
    return this->AreTiles ? this->Length : std::min<std::uint64_t>(this->Length, page.Length - row);
  }
};

Parts GetParts(TIFF* tiff, const PageType& page)
{
  Parts parts;
  parts.AreTiles = TIFFIsTiled(tiff) != 0;
  parts.Width = parts.AreTiles ? Get<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH, 0) : page.Width;
  parts.Length = parts.AreTiles
    ? Get<std::uint32_t>(tiff, TIFFTAG_TILELENGTH, 0)
    : std::min(page.Length, Get<std::uint32_t>(tiff, TIFFTAG_ROWSPERSTRIP, page.Length));
  if (parts.Width > 0 && parts.Length > 0)
  {
    parts.Across = (std::uint64_t{ page.Width } + parts.Width - 1) / parts.Width;
    parts.Down = (std::uint64_t{ page.Length } + parts.Length - 1) / parts.Length;
  }
  return parts;
}

// --- All pages

class PageReader
{
public:
  explicit PageReader(const InputFile& file)
    : Reads(file)
    , Handle(Open(this->Reads))
  {
    RefuseDamageIf(!this->Handle, 1, this->Reads.Error);
  }

  /** Looks at each directory, and checks that what it needs is in the file. */
  TIFFPages List(std::vector<std::string>& warnings);
  ScalarType Type() const { return FindScalarType(this->First).value(); }
  /** In memory, where a bit takes a byte. */
  std::size_t BytesOfPage() const { return this->RowBytes() * this->First.Length; }
  /** @throws FileError if the file is too small for so many pages, however they are compressed */
  void CheckClaim(std::uint64_t rowBytes, std::uint64_t rows) const;

  /** @param places one for each page */
  void ReadInto(const std::vector<std::byte*>& places, const TIFFPages& pages);
  /** Where voxels are if the first page has a directory, and the others follow it without one. */
  StoredVoxels Contiguous() const;

private:
  bool HasLink();
  bool MoveToNext(std::int64_t page);
  bool IsFullPage() const
  {
    return (Get<std::uint32_t>(this->Handle.get(), TIFFTAG_SUBFILETYPE, 0) &
             (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) == 0;
  }
  void DescribeFirst(TIFFPages& pages);
  void CheckPage(std::int64_t page, bool isImageJ, std::vector<std::string>& warnings);
  void CheckParts(std::int64_t page, const Parts& parts);
  std::int64_t CountContiguous();
  std::size_t RowBytes() const
  {
    return std::size_t{ this->First.Width } * ((std::size_t{ this->First.Bits } + 7) / 8);
  }
  void ReadPage(std::int64_t page, std::byte* to);
  void ReadPart(std::int64_t page, std::uint32_t part, std::span<std::byte> to);
  void CheckSum(std::int64_t page, std::uint32_t part);
  void Paste(std::byte* to, const Parts& parts, std::uint64_t column, std::uint64_t row) const;

  Source Reads;
  TIFFHandle Handle;
  PageType First;
  std::uint64_t Begin = 0;             ///< of the first page
  std::uint64_t BytesUncompressed = 0; ///< that pages need
  std::vector<std::byte> Scratch;      ///< a part
};

/** libtiff takes a file that ends before the link from a directory to the next for the last page. */
bool PageReader::HasLink()
{
  TIFF* const tiff = this->Handle.get();
  const bool isBig = this->Reads.File.Beginning(4).find('+') != std::string::npos;
  const std::uint64_t start = TIFFCurrentDirOffset(tiff);
  std::string bytes(8, '\0');
  this->Reads.File.ReadAt(start, std::as_writable_bytes(std::span(bytes)));
  const Fields fields(bytes, TIFFIsBigEndian(tiff) != 0);
  const std::uint64_t entries = isBig ? fields.Get<std::uint64_t>(0) : fields.Get<std::uint16_t>(0);
  return start + (isBig ? 8 + 20 * entries + 8 : 2 + 12 * entries + 4) <= this->Reads.File.Size();
}

bool PageReader::MoveToNext(std::int64_t page)
{
  if (TIFFLastDirectory(this->Handle.get()))
  {
    RefuseIf(!this->HasLink(), DamagedPage, page, " (the file ends before it)");
    return false;
  }
  this->Reads.Error.clear();
  this->Reads.Warning.clear();
  const bool isRead = TIFFReadDirectory(this->Handle.get()) != 0;
  RefuseDamageIf(
    !isRead, page, this->Reads.Error.empty() ? this->Reads.Warning : this->Reads.Error);
  return true;
}

TIFFPages PageReader::List(std::vector<std::string>& warnings)
{
  constexpr std::size_t most = 100'000; // libtiff compares each with all before it
  TIFFPages pages;
  std::size_t directory = 0;
  do
  {
    if (this->IsFullPage())
    {
      if (pages.Directories.empty())
      {
        this->DescribeFirst(pages);
      }
      pages.Directories.push_back(directory);
      this->CheckPage(pages.Count(), pages.Description.rfind("ImageJ=", 0) == 0, warnings);
      pages.Contiguous = pages.Count() == 1 ? this->CountContiguous() : pages.Contiguous;
    }
    RefuseIf(++directory > most, "it has more than ", most, " pages");
    RefuseDamageIf(!this->Reads.Ignored.empty(), pages.Count(), this->Reads.Ignored);
  } while (this->MoveToNext(pages.Count() + 1));
  RefuseIf(pages.Directories.empty(), "it has no page that is not a reduced image or a mask");
  return pages;
}

void PageReader::DescribeFirst(TIFFPages& pages)
{
  TIFF* const tiff = this->Handle.get();
  this->First = GetType(tiff);
  CheckType(this->First);
  pages.Width = this->First.Width;
  pages.Length = this->First.Length;
  pages.IsUInt16 = this->Type() == ScalarType::UInt16;
  pages.Description = Get<const char*>(tiff, TIFFTAG_IMAGEDESCRIPTION, "");
  pages.HasUnit = Get<std::uint16_t>(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH) != RESUNIT_NONE;
  pages.XResolution = double{ Get(tiff, TIFFTAG_XRESOLUTION, 0.0F) };
  pages.YResolution = double{ Get(tiff, TIFFTAG_YRESOLUTION, 0.0F) };
}

void PageReader::CheckPage(std::int64_t page, bool isImageJ, std::vector<std::string>& warnings)
{
  TIFF* const tiff = this->Handle.get();
  const PageType type = GetType(tiff);
  RefuseIf(type != this->First, "its pages differ: page ", page, " is ", Describe(type),
    ", and the first is ", Describe(this->First));
  RefuseIf(Get<std::uint32_t>(tiff, TIFFTAG_IMAGEDEPTH, 1) != 1,
    "its pages have several slices each (ImageDepth), which voxplex does not read: save it with a "
    "page for each slice");
  CheckColours(tiff, isImageJ);
  IsUpsideDown(tiff);
  const std::string warning =
    CheckCompression(Get<std::uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE));
  if (page == 1 && !warning.empty())
  {
    warnings.push_back(warning);
  }
  this->CheckParts(page, GetParts(tiff, type));
}

/** The most that a compression makes of a byte; see Documentation/FileFormats.md. */
constexpr double MostOfAByte = 65536.0;

void PageReader::CheckClaim(std::uint64_t rowBytes, std::uint64_t rows) const
{
  const double claim = static_cast<double>(rowBytes) * static_cast<double>(rows);
  RefuseIf(claim > MostOfAByte * static_cast<double>(this->Reads.File.Size()),
    "it is truncated or damaged: it claims ", Describe(this->First), " a page, and the file has ",
    this->Reads.File.Size(), " bytes");
}

void PageReader::CheckParts(std::int64_t page, const Parts& parts)
{
  TIFF* const tiff = this->Handle.get();
  const std::uint64_t size = this->Reads.File.Size();
  const std::uint64_t count = parts.AreTiles ? TIFFNumberOfTiles(tiff) : TIFFNumberOfStrips(tiff);
  RefuseIf(parts.Across * parts.Down != count || count == 0 || count > size, DamagedPage, page,
    " (it claims ", count, " strips or tiles of ", parts.Width, " x ", parts.Length, ")");
  const std::uint64_t rowBytes = this->First.BytesOf(parts.Width);
  this->CheckClaim(this->First.BytesOf(this->First.Width), this->First.Length);
  this->CheckClaim(rowBytes, parts.Length);
  const bool isPlain =
    Get<std::uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_NONE;
  for (std::uint64_t part = 0; part < count; ++part)
  {
    const std::uint64_t row = part / parts.Across * parts.Length;
    const std::uint64_t offset = TIFFGetStrileOffset(tiff, static_cast<std::uint32_t>(part));
    const std::uint64_t bytes = TIFFGetStrileByteCount(tiff, static_cast<std::uint32_t>(part));
    RefuseIf(offset == 0 && bytes == 0, "it is a sparse file, which leaves out strip or tile ",
      part + 1, " of page ", page, ": save it with all strips and tiles");
    const std::uint64_t needed = isPlain ? rowBytes * parts.RowsFrom(row, this->First) : 1;
    RefuseIf(bytes < needed || offset == 0 || offset > size || bytes > size - offset, DamagedPage,
      page, " (its strip or tile ", part + 1, " has ", bytes, " bytes from byte ", offset, " on; ",
      needed, " are needed, and the file has ", size, ")");
    this->BytesUncompressed += isPlain ? needed : 0;
    RefuseIf(this->BytesUncompressed > size, DamagedPage, page,
      " (it shares its voxels with other pages)");
  }
}

std::int64_t PageReader::CountContiguous()
{
  TIFF* const tiff = this->Handle.get();
  const Parts parts = GetParts(tiff, this->First);
  const std::uint64_t rowBytes = this->First.BytesOf(this->First.Width);
  this->Begin = TIFFGetStrileOffset(tiff, 0);
  bool isOnePiece = !parts.AreTiles && this->First.Bits >= 8 && !IsUpsideDown(tiff) &&
    Get<std::uint16_t>(tiff, TIFFTAG_FILLORDER, FILLORDER_MSB2LSB) == FILLORDER_MSB2LSB &&
    Get<std::uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_NONE;
  for (std::uint64_t part = 0; isOnePiece && part < parts.Down; ++part)
  {
    isOnePiece = TIFFGetStrileOffset(tiff, static_cast<std::uint32_t>(part)) ==
      this->Begin + part * parts.Length * rowBytes;
  }
  return isOnePiece ? static_cast<std::int64_t>(
                        (this->Reads.File.Size() - this->Begin) / (rowBytes * this->First.Length))
                    : 1;
}

StoredVoxels PageReader::Contiguous() const
{
  StoredVoxels stored;
  stored.IsBigEndian = TIFFIsBigEndian(this->Handle.get()) != 0;
  stored.Files = { this->Reads.File.Path() };
  stored.Offset = static_cast<std::int64_t>(this->Begin);
  return stored;
}

void PageReader::ReadInto(const std::vector<std::byte*>& places, const TIFFPages& pages)
{
  TIFFSetDirectory(this->Handle.get(), 0);
  std::size_t directory = 0;
  for (std::size_t page = 0; page < places.size(); ++page, ++directory)
  {
    const auto number = static_cast<std::int64_t>(page + 1);
    for (; directory < pages.Directories[page]; ++directory)
    {
      this->MoveToNext(number);
    }
    this->ReadPage(number, places[page]);
    if (page + 1 < places.size())
    {
      this->MoveToNext(number + 1);
    }
  }
}

void PageReader::ReadPage(std::int64_t page, std::byte* to)
{
  const Parts parts = GetParts(this->Handle.get(), this->First);
  const std::uint64_t rowBytes = this->First.BytesOf(parts.Width);
  const bool isDirect = !parts.AreTiles && this->First.Bits >= 8;
  std::uint32_t part = 0;
  for (std::uint64_t row = 0; row < this->First.Length; row += parts.Length)
  {
    const auto bytes = static_cast<std::size_t>(rowBytes * parts.RowsFrom(row, this->First));
    for (std::uint64_t column = 0; column < this->First.Width; column += parts.Width, ++part)
    {
      if (isDirect)
      {
        this->ReadPart(page, part, std::span(to + row * rowBytes, bytes));
        continue;
      }
      this->Scratch.resize(bytes);
      this->ReadPart(page, part, this->Scratch);
      this->Paste(to, parts, column, row);
    }
  }
  if (IsUpsideDown(this->Handle.get()))
  {
    const std::size_t bytes = this->RowBytes();
    for (std::size_t top = 0, bottom = this->First.Length - 1; top < bottom; ++top, --bottom)
    {
      std::swap_ranges(to + top * bytes, to + (top + 1) * bytes, to + bottom * bytes);
    }
  }
}

/** Decoders of pictures go on with a warning where something is missing. */
bool WarnsOfDamage(std::uint16_t compression)
{
  constexpr std::array<std::uint16_t, 7> decoders{ COMPRESSION_JPEG, COMPRESSION_OJPEG,
    COMPRESSION_JBIG, COMPRESSION_CCITTRLE, COMPRESSION_CCITTRLEW, COMPRESSION_CCITTFAX3,
    COMPRESSION_CCITTFAX4 };
  return std::find(decoders.begin(), decoders.end(), compression) != decoders.end();
}

void PageReader::ReadPart(std::int64_t page, std::uint32_t part, std::span<std::byte> to)
{
  TIFF* const tiff = this->Handle.get();
  this->Reads.Error.clear();
  this->Reads.Warning.clear();
  const auto size = static_cast<tmsize_t>(to.size());
  const tmsize_t got = TIFFIsTiled(tiff) ? TIFFReadEncodedTile(tiff, part, to.data(), size)
                                         : TIFFReadEncodedStrip(tiff, part, to.data(), size);
  RefuseDamageIf(got != size || !this->Reads.Error.empty(), page, this->Reads.Error);
  const auto compression = Get<std::uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  RefuseDamageIf(
    !this->Reads.Warning.empty() && WarnsOfDamage(compression), page, this->Reads.Warning);
  const bool isDeflated =
    compression == COMPRESSION_ADOBE_DEFLATE || compression == COMPRESSION_DEFLATE;
  const auto order = Get<std::uint16_t>(tiff, TIFFTAG_FILLORDER, FILLORDER_MSB2LSB);
  if (isDeflated && order == FILLORDER_MSB2LSB)
  {
    this->CheckSum(page, part);
  }
}

/** libtiff stops when a part is full, and the checksum comes after that. */
void PageReader::CheckSum(std::int64_t page, std::uint32_t part)
{
  TIFF* const tiff = this->Handle.get();
  FileSource packed(
    this->Reads.File, TIFFGetStrileOffset(tiff, part), TIFFGetStrileByteCount(tiff, part));
  try
  {
    InflateSource(packed).Finish();
  }
  catch (const FileError& error)
  {
    RefuseDamageIf(true, page, error.what());
  }
}

/** Puts what a part has of the page in its place; a bit becomes a byte. */
void PageReader::Paste(
  std::byte* to, const Parts& parts, std::uint64_t column, std::uint64_t row) const
{
  const auto columns = std::min<std::uint64_t>(parts.Width, this->First.Width - column);
  const auto rows = std::min<std::uint64_t>(parts.Length, this->First.Length - row);
  const std::uint64_t partBytes = this->First.BytesOf(parts.Width);
  for (std::uint64_t r = 0; r < rows; ++r)
  {
    const std::byte* from = this->Scratch.data() + r * partBytes;
    std::byte* const line = to + (row + r) * this->RowBytes();
    if (this->First.Bits >= 8)
    {
      std::memcpy(line + this->First.BytesOf(column), from, this->First.BytesOf(columns));
      continue;
    }
    for (std::uint64_t c = 0; c < columns; ++c)
    {
      line[column + c] = (from[c / 8] >> (7 - c % 8)) & std::byte{ 1 };
    }
  }
}

/** 32768 is to be 0. */
void SubtractOffset(ScalarImage& image)
{
  const std::span numbers(static_cast<std::uint16_t*>(image.Scalars.get()),
    image.NumberOfVoxels() * static_cast<std::size_t>(image.Frames));
  for (std::uint16_t& number : numbers)
  {
    number ^= 0x8000; // the same bits as the difference
  }
  image.Type = ScalarType::Int16;
}

} // namespace

ScalarImage ReadTIFFSlice(const std::string& path, Reading& reading)
{
  const InputFile file(path);
  RefuseIf(!IsTIFF(file), "it is no TIFF or PNG file, as its name says");
  PageReader reader(file);
  const TIFFPages pages = reader.List(reading.Warnings);
  RefuseIf(pages.Count() > 1, "it has ", pages.Count(),
    " pages, and files of a folder of slices have one each: if each is a mask, give the files one "
    "by one");
  ScalarImage image;
  image.Type = reader.Type();
  SetSizes(image, { pages.Width, pages.Length, 1 });
  image.Scalars = reading.Allocate(reader.BytesOfPage());
  reader.ReadInto({ static_cast<std::byte*>(image.Scalars.get()) }, pages);
  return image;
}

ScalarImage ReadTIFF(const std::string& path, Reading& reading)
{
  const InputFile file(path);
  PageReader reader(file);
  const TIFFPages pages = reader.List(reading.Warnings);
  const TIFFStack stack = DescribeStack(pages, reading);

  ScalarImage image;
  image.Type = reader.Type();
  SetSizes(image, { pages.Width, pages.Length, stack.Slices, stack.Frames });
  PlaceAlongAxes(image, stack.Spacing, stack.Origin.value_or(Vector3{}));
  reading.HasPlace = stack.Origin.has_value();
  image.TimeSpacing = stack.TimeStep;
  const std::size_t bytes = reader.BytesOfPage();
  reader.CheckClaim(bytes, stack.Pages.size());
  if (stack.IsContiguous)
  {
    ReadVoxels(reader.Contiguous(), image, reading);
    MoveFramesToTheEnd(
      image, std::is_sorted(stack.Pages.begin(), stack.Pages.end()) ? 3 : 2, reading);
  }
  else
  {
    image.Scalars = reading.Allocate(bytes * stack.Pages.size());
    std::vector<std::byte*> places(stack.Pages.size());
    for (std::size_t slice = 0; slice < places.size(); ++slice)
    {
      places[stack.Pages[slice]] = static_cast<std::byte*>(image.Scalars.get()) + slice * bytes;
    }
    reader.ReadInto(places, pages);
  }
  if (stack.IsSignedWithOffset)
  {
    SubtractOffset(image);
  }
  return image;
}

} // namespace voxplex::io
