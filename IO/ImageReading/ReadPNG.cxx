// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Readers.h"

#include "Placement.h"
#include "Text.h"

#include <vtk_png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstdint>
#include <span>

namespace voxplex::io
{
namespace
{

/** What libpng, which is C and leaves by longjmp(), reads from, and what it says. */
struct Source
{
  const InputFile& File;
  std::uint64_t Position = 0;
  std::array<char, 100> Error{};
};

void ReadBytes(png_structp png, png_bytep to, std::size_t count)
{
  Source& source = *static_cast<Source*>(png_get_io_ptr(png));
  std::size_t got = 0;
  try
  {
    got = source.File.ReadAt(source.Position, { reinterpret_cast<std::byte*>(to), count });
  }
  catch (const FileError&) // of which nothing may go through libpng
  {
  }
  if (got < count)
  {
    png_error(png, "the file ends before it does");
  }
  source.Position += count;
}

void NoteError(png_structp png, png_const_charp text)
{
  Source& source = *static_cast<Source*>(png_get_error_ptr(png));
  const std::string_view message(text);
  std::copy_n(
    message.begin(), std::min(message.size(), source.Error.size() - 1), source.Error.begin());
  png_longjmp(png, 1);
}

void Ignore(png_structp, png_const_charp) {}

class PNGReader
{
public:
  explicit PNGReader(const InputFile& file)
    : Reads{ file }
    , PNG(png_create_read_struct(PNG_LIBPNG_VER_STRING, &Reads, NoteError, Ignore))
    , Info(png_create_info_struct(PNG))
  {
    png_set_read_fn(this->PNG, &this->Reads, ReadBytes);
    png_set_crc_action(this->PNG, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  }
  ~PNGReader() { png_destroy_read_struct(&this->PNG, &this->Info, nullptr); }
  PNGReader(const PNGReader&) = delete;
  PNGReader& operator=(const PNGReader&) = delete;

  /** @throws FileError with what libpng says. @param call makes nothing that has a destructor */
  template <typename TCall>
  void Call(TCall&& call)
  {
    if (setjmp(png_jmpbuf(this->PNG)) == 0)
    {
      call(this->PNG, this->Info);
      return;
    }
    Refuse("it is truncated or damaged (", Excerpt(this->Reads.Error.data()), ")");
  }

  png_structp Handle() const { return this->PNG; }
  png_infop Header() const { return this->Info; }

private:
  Source Reads;
  png_structp PNG;
  png_infop Info;
};

} // namespace

bool IsPNG(const InputFile& file)
{
  return file.Beginning(8) == "\x89PNG\r\n\x1a\n";
}

ScalarImage ReadPNGSlice(const std::string& path, Reading& reading)
{
  const InputFile file(path);
  PNGReader reader(file);
  RefuseIf(!reader.Header(), "libpng is another one than voxplex was built with");
  reader.Call([](png_structp png, png_infop info) { png_read_info(png, info); });
  const png_uint_32 width = png_get_image_width(reader.Handle(), reader.Header());
  const png_uint_32 height = png_get_image_height(reader.Handle(), reader.Header());
  const int bits = png_get_bit_depth(reader.Handle(), reader.Header());
  const int kind = png_get_color_type(reader.Handle(), reader.Header());
  RefuseIf(kind == PNG_COLOR_TYPE_PALETTE,
    "its numbers stand for colours of a palette, and need not be labels: save it as grey values");
  RefuseIf(kind != PNG_COLOR_TYPE_GRAY,
    "its numbers are colours, or have an alpha channel, and a label image has one label a voxel: "
    "save it as grey values");
  constexpr double mostOfAByte = 1032.0; // of its compression
  RefuseIf(static_cast<double>(width) * height * bits >
      8.0 * mostOfAByte * static_cast<double>(file.Size()),
    "it is truncated or damaged: it claims ", width, " x ", height, " voxels, and the file has ",
    file.Size(), " bytes");
  ScalarImage image;
  image.Type = bits == 16 ? ScalarType::UInt16 : ScalarType::UInt8;
  SetSizes(image, { width, height, 1 });
  const std::size_t bytes = width * SizeOf(image.Type);
  image.Scalars = reading.Allocate(bytes * height);
  std::vector<png_bytep> rows(height);
  for (std::size_t row = 0; row < height; ++row)
  {
    rows[row] = static_cast<png_bytep>(image.Scalars.get()) + row * bytes;
  }
  png_bytep* const all = rows.data();
  reader.Call(
    [all](png_structp png, png_infop)
    {
      png_set_packing(png); // numbers of less than a byte stay as they are
      if (std::endian::native == std::endian::little)
      {
        png_set_swap(png);
      }
      png_set_interlace_handling(png);
      png_read_image(png, all);
      png_read_end(png, nullptr);
    });
  return image;
}

} // namespace voxplex::io
