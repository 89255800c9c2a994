// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ByteSource.h"

#include "FileError.h"
#include "InputFile.h"

#include <algorithm>
#include <limits>
#include <new>

namespace voxplex::io
{
namespace
{

constexpr std::size_t BufferSize = 1 << 15; // small, since some files have very many streams
constexpr int ZlibOrGzip = 15 + 32;         // the largest window, and either header

} // namespace

std::optional<char> ByteSource::Get()
{
  if (this->Next == this->Ahead.size())
  {
    this->Next = 0;
    this->Ahead.clear();
    std::vector<std::byte> bytes(BufferSize);
    bytes.resize(this->Read(bytes));
    this->Ahead = std::move(bytes);
  }
  return this->Next < this->Ahead.size()
    ? std::optional(static_cast<char>(this->Ahead[this->Next++]))
    : std::nullopt;
}

void ByteSource::Skip(std::uint64_t count)
{
  while (count > 0)
  {
    std::vector<std::byte> bytes(
      static_cast<std::size_t>(std::min<std::uint64_t>(count, BufferSize)));
    const std::size_t got = this->Read(bytes);
    if (got == 0)
    {
      return;
    }
    count -= got;
  }
}

std::size_t ByteSource::TakeAhead(std::span<std::byte> to)
{
  const std::size_t count = std::min(to.size(), this->Ahead.size() - this->Next);
  std::copy_n(this->Ahead.begin() + static_cast<std::ptrdiff_t>(this->Next), count, to.begin());
  this->Next += count;
  return count;
}

std::size_t FileSource::Read(std::span<std::byte> to)
{
  const std::size_t ahead = this->TakeAhead(to);
  to = to.subspan(ahead);
  const auto length = static_cast<std::size_t>(std::min<std::uint64_t>(to.size(), this->Left));
  const std::size_t got = this->File.ReadAt(this->Position, to.first(length));
  this->Position += got;
  this->Left -= got;
  return ahead + got;
}

InflateSource::InflateSource(ByteSource& packed, bool hasHeader)
  : Packed(packed)
  , HasHeader(hasHeader)
{
}

InflateSource::~InflateSource()
{
  if (this->HasStarted)
  {
    inflateEnd(&this->Stream);
  }
}

/** Returns whether there are packed bytes. */
bool InflateSource::Refill()
{
  if (!this->HasStarted)
  {
    if (inflateInit2(&this->Stream, this->HasHeader ? ZlibOrGzip : -MAX_WBITS) != Z_OK)
    {
      throw std::bad_alloc();
    }
    this->HasStarted = true;
  }
  if (this->Stream.avail_in == 0)
  {
    this->Input.resize(BufferSize);
    this->Input.resize(this->Packed.Read(this->Input));
    this->Stream.next_in = reinterpret_cast<Bytef*>(this->Input.data());
    this->Stream.avail_in = static_cast<uInt>(this->Input.size());
  }
  return this->Stream.avail_in > 0;
}

std::size_t InflateSource::Read(std::span<std::byte> to)
{
  std::size_t done = this->TakeAhead(to);
  while (done < to.size() && this->Refill())
  {
    if (this->HasEnded)
    {
      constexpr unsigned char gzip = 0x1f;
      if (!this->HasHeader || *this->Stream.next_in != gzip)
      {
        break; // bytes after the streams
      }
      inflateReset(&this->Stream);
      this->HasEnded = false;
    }
    const auto room =
      static_cast<uInt>(std::min<std::size_t>(to.size() - done, std::numeric_limits<uInt>::max()));
    this->Stream.next_out = reinterpret_cast<Bytef*>(to.data() + done);
    this->Stream.avail_out = room;
    const int result = inflate(&this->Stream, Z_NO_FLUSH);
    done += room - this->Stream.avail_out;
    this->HasEnded = result == Z_STREAM_END;
    if (result == Z_MEM_ERROR)
    {
      throw std::bad_alloc();
    }
    RefuseIf(result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR,
      "it is damaged: its compressed voxels do not unpack (",
      this->Stream.msg ? this->Stream.msg : "no zlib or gzip stream", ")");
  }
  return done;
}

void InflateSource::Finish()
{
  std::vector<std::byte> rest(BufferSize);
  while (!this->HasEnded)
  {
    RefuseIf(this->Read(rest) == 0 && !this->HasEnded,
      "it is truncated: the end of its compressed voxels is missing");
  }
}

} // namespace voxplex::io
