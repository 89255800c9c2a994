// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "TIFFCheck.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>

namespace voxplex::io
{
namespace
{

enum Tag : std::uint16_t
{
  ImageWidth = 256,
  ImageLength = 257,
  SamplesPerPixel = 277,
  RowsPerStrip = 278,
  StripByteCounts = 279,
  PlanarConfiguration = 284,
  TileWidth = 322,
  TileLength = 323,
  TileByteCounts = 325
};

/** Bytes of a value, by its type; 0 for types that TIFF does not have, whose tags libtiff skips. */
constexpr std::array<std::uint64_t, 19> SizesOfTypes{ 0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0,
  0, 8, 8, 8 };

struct Entry
{
  bool IsText = false;
  std::uint64_t SizeOfValue = 0;
  std::uint64_t Count = 0;
  std::uint64_t Position = 0; ///< of the first value
};

/** Each step returns what is wrong, or an empty string. */
class DirectoryWalk
{
public:
  explicit DirectoryWalk(const std::string& path)
    : File(path, std::ios::binary)
  {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    this->Size = error ? 0 : size;
  }

  std::string FindFault()
  {
    std::string fault;
    std::set<std::uint64_t> seen;
    for (std::uint64_t directory = this->ReadHeader(); directory != 0 && fault.empty();
         directory = this->Next)
    {
      fault = seen.insert(directory).second ? this->FindFaultOfDirectory(directory)
                                            : "it is damaged: its directories form a circle";
    }
    return fault;
  }

private:
  /** Gives where the first directory is; 0 if this is no TIFF. */
  std::uint64_t ReadHeader()
  {
    constexpr std::uint64_t classic = 42;
    constexpr std::uint64_t big = 43;
    std::array<char, 2> order{};
    this->File.read(order.data(), order.size());
    this->IsBigEndian = order[0] == 'M';
    const std::uint64_t version = this->Number(2, 2);
    this->IsBig = version == big;
    const bool isTIFF = order[0] == order[1] && (order[0] == 'I' || order[0] == 'M') &&
      (version == classic || version == big);
    return isTIFF ? this->Offset(this->IsBig ? 8 : 4) : 0;
  }

  std::string FindFaultOfDirectory(std::uint64_t directory)
  {
    const std::uint64_t sizeOfCount = this->IsBig ? 8 : 2;
    const std::uint64_t sizeOfEntry = this->IsBig ? 20 : 12;
    const std::uint64_t count =
      this->Holds(directory, sizeOfCount) ? this->Number(directory, sizeOfCount) : 0;
    const std::uint64_t first = directory + sizeOfCount;
    if (count == 0 || count > this->Size / sizeOfEntry || !this->Holds(first, count * sizeOfEntry))
    {
      return "it is truncated or damaged: it has no whole directory at byte " +
        std::to_string(directory);
    }
    this->BytesOfDirectories += count * sizeOfEntry;
    if (this->BytesOfDirectories > this->Size)
    {
      return "it is damaged: its directories overlap";
    }
    std::map<std::uint64_t, Entry> entries;
    std::uint64_t bytes = 0;
    for (std::uint64_t i = 0; i < count; ++i)
    {
      const std::uint64_t position = first + i * sizeOfEntry;
      const std::uint64_t tag = this->Number(position, 2);
      const Entry entry = this->ReadEntry(position);
      if (entry.SizeOfValue != 0 &&
        (entry.Count > this->Size / entry.SizeOfValue ||
          !this->Holds(entry.Position, entry.Count * entry.SizeOfValue) ||
          (bytes += entry.Count * entry.SizeOfValue) > this->Size))
      {
        return "it is truncated or damaged: its tag " + std::to_string(tag) + " claims " +
          std::to_string(entry.Count) + " values, and the file has " + std::to_string(this->Size) +
          " bytes";
      }
      // ITK reads a text of one byte up to the next 0.
      if (entry.IsText && entry.Count == 1 && this->Number(entry.Position, 1) != 0)
      {
        return "it is damaged: its tag " + std::to_string(tag) + " has a text that does not end";
      }
      entries.emplace(tag, entry);
    }
    const std::uint64_t end = first + count * sizeOfEntry;
    this->Next = this->Holds(end, this->IsBig ? 8 : 4) ? this->Offset(end) : 0;
    return this->FindFaultOfStrips(entries);
  }

  Entry ReadEntry(std::uint64_t position)
  {
    const std::uint64_t sizeOfOffset = this->IsBig ? 8 : 4;
    const std::uint64_t type = this->Number(position + 2, 2);
    constexpr std::uint64_t text = 2;
    Entry entry;
    entry.IsText = type == text;
    entry.SizeOfValue = type < SizesOfTypes.size() ? SizesOfTypes[type] : 0;
    entry.Count = this->Offset(position + 4);
    entry.Position = position + 4 + sizeOfOffset;
    if (entry.SizeOfValue != 0 && entry.Count > sizeOfOffset / entry.SizeOfValue)
    {
      entry.Position = this->Offset(entry.Position);
    }
    return entry;
  }

  std::string FindFaultOfStrips(const std::map<std::uint64_t, Entry>& entries)
  {
    const bool isTiled = entries.count(TileWidth) != 0 || entries.count(TileLength) != 0;
    const double rows = this->Value(entries, RowsPerStrip, INT32_MAX);
    const double width = this->Value(entries, TileWidth, 0);
    const double length = this->Value(entries, TileLength, 0);
    if (isTiled ? width <= 0 || length <= 0 : rows <= 0)
    {
      return "it is damaged: its strips or tiles have no size";
    }
    const double columns = this->Value(entries, ImageWidth, 0);
    const double lines = this->Value(entries, ImageLength, 0);
    const double planes = this->Value(entries, PlanarConfiguration, 1) == 2
      ? this->Value(entries, SamplesPerPixel, 1)
      : 1.0;
    const double strips =
      planes * (isTiled ? (columns / width + 1) * (lines / length + 1) : lines / rows);
    if (strips > static_cast<double>(this->Size))
    {
      return "it is truncated or damaged: its size claims more strips or tiles than the file has "
             "bytes";
    }
    for (const Tag tag : { StripByteCounts, TileByteCounts })
    {
      const auto found = entries.find(tag);
      const Entry entry = found == entries.end() ? Entry() : found->second;
      for (std::uint64_t i = 0; entry.SizeOfValue != 0 && i < entry.Count; ++i)
      {
        if (this->Number(entry.Position + i * entry.SizeOfValue, entry.SizeOfValue) > this->Size)
        {
          return "it is truncated or damaged: one of its strips or tiles claims more bytes than "
                 "the file has";
        }
      }
    }
    return "";
  }

  double Value(const std::map<std::uint64_t, Entry>& entries, Tag tag, double otherwise)
  {
    const auto entry = entries.find(tag);
    return entry == entries.end() || entry->second.Count == 0
      ? otherwise
      : static_cast<double>(this->Number(entry->second.Position, entry->second.SizeOfValue));
  }

  bool Holds(std::uint64_t position, std::uint64_t bytes) const
  {
    return position <= this->Size && bytes <= this->Size - position;
  }

  std::uint64_t Offset(std::uint64_t position)
  {
    return this->Number(position, this->IsBig ? 8 : 4);
  }

  /** 0 beyond the end. */
  std::uint64_t Number(std::uint64_t position, std::uint64_t size)
  {
    std::array<unsigned char, 8> bytes{};
    this->File.clear();
    this->File.seekg(static_cast<std::streamoff>(position));
    this->File.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    std::uint64_t number = 0;
    for (std::uint64_t i = 0; i < size; ++i)
    {
      number = number << 8 | bytes[this->IsBigEndian ? i : size - 1 - i];
    }
    return number;
  }

  std::ifstream File;
  std::uint64_t Size = 0;
  bool IsBigEndian = false;
  bool IsBig = false;
  std::uint64_t Next = 0; ///< where the next directory is; 0 if there is none
  std::uint64_t BytesOfDirectories = 0;
};

} // namespace

std::string FindFaultOfTIFF(const std::string& path)
{
  return DirectoryWalk(path).FindFault();
}

} // namespace voxplex::io
