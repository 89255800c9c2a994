// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ByteSource.h
 * @brief Bytes one after the other: those of a file, or what they unpack to.
 */
#ifndef voxplex_io_ByteSource_h
#define voxplex_io_ByteSource_h

#include <vtk_zlib.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace voxplex::io
{

class InputFile;

class ByteSource
{
public:
  virtual ~ByteSource() = default;

  /** Fills `to`, or what the source has of it. @return how many bytes that are */
  virtual std::size_t Read(std::span<std::byte> to) = 0;

  /** Called when no more bytes are wanted. @throws FileError if what was read is not what was packed */
  virtual void Finish() {}

  /** The next byte, or nothing at the end. */
  std::optional<char> Get();

  /** Leaves out so many bytes, or all that there are. */
  void Skip(std::uint64_t count);

private:
  std::vector<std::byte> Ahead;
  std::size_t Next = 0;

protected:
  /** Gives out what Get() read ahead, which Read() begins with. */
  std::size_t TakeAhead(std::span<std::byte> to);
};

/** A file from a position on, or a part of it. */
class FileSource : public ByteSource
{
public:
  FileSource(const InputFile& file, std::uint64_t position,
    std::uint64_t length = std::numeric_limits<std::uint64_t>::max())
    : File(file)
    , Position(position)
    , Left(length)
  {
  }
  std::size_t Read(std::span<std::byte> to) override;

private:
  const InputFile& File;
  std::uint64_t Position;
  std::uint64_t Left; ///< bytes of the part
};

/**
 * What a zlib or gzip stream unpacks to; gzip streams may follow each other, as parallel programs write them. Or what a
 * stream without a header does.
 */
class InflateSource : public ByteSource
{
public:
  explicit InflateSource(ByteSource& packed, bool hasHeader = true);
  ~InflateSource() override;
  InflateSource(const InflateSource&) = delete;
  InflateSource& operator=(const InflateSource&) = delete;

  /** @throws FileError for a damaged stream */
  std::size_t Read(std::span<std::byte> to) override;

  /** Unpacks to the end of the stream, where its checksum is. */
  void Finish() override;

private:
  bool Refill();

  ByteSource& Packed;
  std::vector<std::byte> Input;
  z_stream Stream{};
  bool HasHeader;
  bool HasStarted = false;
  bool HasEnded = false;
};

} // namespace voxplex::io

#endif
