// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "StoredVoxels.h"

#include "ByteSource.h"
#include "Readers.h"
#include "Text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

constexpr double LargestDeflateRatio = 1032.0;
constexpr std::size_t Slab = 1 << 24; // bytes that are read without looking up

// --- Sizes -------------------------------------------------------------------------------------------

/** "6 x 5 x 4 voxels of 2 bytes" */
std::string DescribeClaim(const ScalarImage& image)
{
  std::ostringstream claim;
  claim << image.Dimensions[0] << " x " << image.Dimensions[1] << " x " << image.Dimensions[2];
  if (image.Frames > 1)
  {
    claim << " x " << image.Frames;
  }
  const std::size_t bytes = SizeOf(image.Type);
  claim << " voxels of " << bytes << (bytes == 1 ? " byte" : " bytes");
  return claim.str();
}

/** How many bytes of voxels so many bytes of a file hold at most. */
double Capacity(Encoding encoding, double bytes, ScalarType type)
{
  switch (encoding)
  {
    case Encoding::Raw:
      return bytes;
    case Encoding::Deflate:
      return bytes * LargestDeflateRatio;
    case Encoding::Hex:
      return bytes / 2.0;
    case Encoding::Text:
      break;
  }
  return (bytes + 1.0) / 2.0 *
    static_cast<double>(SizeOf(type)); // a digit and a blank for each number
}

/** Before memory is taken. Files hold whole slices, volumes or frames. */
void CheckClaim(const StoredVoxels& stored, const ScalarImage& image)
{
  const auto count = static_cast<double>(stored.Files.size());
  const std::array<double, 4> parts{ 1.0, double{ static_cast<double>(image.Frames) },
    static_cast<double>(image.Frames) * image.Dimensions[2],
    static_cast<double>(image.Frames) * image.Dimensions[2] * image.Dimensions[1] };
  RefuseIf(
    std::find(parts.begin(), parts.end(), count) == parts.end() && count != image.Dimensions[2],
    "its header names ", stored.Files.size(), " data files, which cannot hold ",
    DescribeClaim(image), " in equal parts");
  const double claimed = static_cast<double>(image.NumberOfVoxels()) * image.Frames *
    static_cast<double>(SizeOf(image.Type));
  for (const std::string& path : stored.Files)
  {
    const std::uint64_t size = InputFile(path).Size();
    RefuseIf(claimed / count > Capacity(stored.Coding, static_cast<double>(size), image.Type),
      "it is truncated or damaged: its header claims ", DescribeClaim(image),
      (count > 1 ? " in " + std::to_string(stored.Files.size()) + " files" : ""), ", and '",
      Excerpt(fs::path(path).filename().string()), "' has ", size, " bytes");
  }
}

/** Whether a number is whole, and small enough to be so exactly. */
bool IsWhole(double number)
{
  constexpr double exact = 9007199254740992.0; // 2^53
  return std::trunc(number) == number && std::abs(number) <= exact;
}

// --- Texts -------------------------------------------------------------------------------------------

/** What blanks, line ends and commas separate; empty at the end. */
std::string NextWord(ByteSource& source)
{
  constexpr std::size_t longest = 64; // of a number
  std::string word;
  for (std::optional<char> c; word.size() <= longest && (c = source.Get());)
  {
    const bool separates = *c == ' ' || *c == ',' || (*c >= '\t' && *c <= '\r');
    if (separates && !word.empty())
    {
      break;
    }
    word.append(separates ? 0 : 1, *c);
  }
  return word;
}

/** "7", and "7.0" for an integer, too; nothing for other words and numbers that the type does not hold. */
template <typename T>
std::optional<T> ParseVoxel(const std::string& word)
{
  std::optional<T> number = ToNumber<T>(word);
  if constexpr (std::is_integral_v<T>)
  {
    const double real = number ? 0.5 : ToNumber<double>(word).value_or(0.5);
    if (IsWhole(real) && std::in_range<T>(static_cast<std::int64_t>(real)))
    {
      number = static_cast<T>(real);
    }
  }
  return number;
}

template <typename T>
std::size_t ReadText(ByteSource& source, std::span<std::byte> to)
{
  std::size_t done = 0;
  for (std::string word; done < to.size() && !(word = NextWord(source)).empty(); done += sizeof(T))
  {
    const std::optional<T> number = ParseVoxel<T>(word);
    if (!number)
    {
      Refuse("'", Excerpt(word), "' among its voxels is not a number of their type");
    }
    std::memcpy(to.data() + done, &*number, sizeof(T));
  }
  return done;
}

std::size_t ReadHex(ByteSource& source, std::span<std::byte> to)
{
  const auto digit = [](char c) -> int
  {
    return c >= '0' && c <= '9' ? c - '0'
      : c >= 'a' && c <= 'f'    ? c - 'a' + 10
      : c >= 'A' && c <= 'F'    ? c - 'A' + 10
                                : -1;
  };
  std::size_t digits = 0;
  int value = 0;
  for (std::optional<char> c; digits < 2 * to.size() && (c = source.Get());)
  {
    if (*c == ' ' || (*c >= '\t' && *c <= '\r'))
    {
      continue;
    }
    if (digit(*c) < 0)
    {
      Refuse("'", Excerpt({ &*c, 1 }), "' among its voxels is not a hexadecimal digit");
    }
    value = 16 * value + digit(*c);
    if (++digits % 2 == 0)
    {
      to[digits / 2 - 1] = static_cast<std::byte>(value);
      value = 0;
    }
  }
  return digits / 2;
}

// --- Files -------------------------------------------------------------------------------------------

/** @param tell of so many bytes */
template <typename TTell>
void ReadPart(const StoredVoxels& stored, const std::string& path, ScalarType type,
  std::span<std::byte> to, TTell&& tell)
{
  const InputFile file(path);
  const bool areLast = stored.BytesToSkip == StoredVoxels::FromTheEnd;
  const auto begin = static_cast<std::uint64_t>(stored.Offset);
  // What is too short is found below.
  FileSource raw(file,
    areLast ? std::max(begin, file.Size() - std::min<std::uint64_t>(file.Size(), to.size()))
            : begin);
  for (std::int64_t lines = stored.LinesToSkip; lines > 0;)
  {
    const std::optional<char> c = raw.Get();
    lines = c ? lines - (*c == '\n') : 0;
  }
  InflateSource unpacked(raw);
  ByteSource& source =
    stored.Coding == Encoding::Deflate ? static_cast<ByteSource&>(unpacked) : raw;
  source.Skip(areLast ? 0 : static_cast<std::uint64_t>(stored.BytesToSkip));

  const bool isText = stored.Coding == Encoding::Text;
  const std::size_t unit = isText ? SizeOf(type) : 1;
  std::size_t found = 0;
  for (std::size_t end = 0; end < to.size() && found == end; tell(found))
  {
    const auto slab = to.subspan(end, std::min(Slab, to.size() - end));
    end += slab.size();
    found += isText
      ? Dispatch(type, [&](auto zero) { return ReadText<decltype(zero)>(source, slab); })
      : stored.Coding == Encoding::Hex ? ReadHex(source, slab)
                                       : source.Read(slab);
  }
  RefuseIf(found < to.size(), "it is truncated: '", Excerpt(fs::path(path).filename().string()),
    "' holds ", found / unit, " of ", to.size() / unit, isText ? " numbers" : " bytes of voxels");
  if (!isText)
  {
    source.Finish();
  }
}

// --- Conversions -------------------------------------------------------------------------------------

using Wide = __int128; // of products of 64-bit integers

/** The type of integers that holds the numbers from low to high; nothing if there is none. */
std::optional<ScalarType> IntegerTypeFor(Wide low, Wide high)
{
  std::optional<ScalarType> found;
  for (const ScalarType type : { ScalarType::UInt8, ScalarType::Int16, ScalarType::UInt16,
         ScalarType::Int32, ScalarType::UInt32, ScalarType::Int64, ScalarType::UInt64 })
  {
    Dispatch(type,
      [&](auto zero)
      {
        using T = decltype(zero);
        if constexpr (std::is_integral_v<T>)
        {
          const bool holds = low >= Wide{ std::numeric_limits<T>::min() } &&
            high <= Wide{ std::numeric_limits<T>::max() };
          found = holds && !found ? std::optional(type) : found;
        }
      });
  }
  return found;
}

/** The type of the results, if all of them are integers. */
template <typename T>
std::optional<ScalarType> FindTypeOfResults(
  std::span<const T> values, double slope, double intercept)
{
  if constexpr (std::is_integral_v<T>)
  {
    if (IsWhole(slope) && IsWhole(intercept))
    {
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      const Wide a =
        Wide{ static_cast<std::int64_t>(slope) } * *low + static_cast<std::int64_t>(intercept);
      const Wide b =
        Wide{ static_cast<std::int64_t>(slope) } * *high + static_cast<std::int64_t>(intercept);
      return IntegerTypeFor(std::min(a, b), std::max(a, b));
    }
  }
  return std::nullopt;
}

template <typename TFrom, typename TTo>
void Convert(std::span<const TFrom> from, TTo* to, double slope, double intercept)
{
  for (std::size_t i = 0; i < from.size(); ++i)
  {
    if constexpr (std::is_integral_v<TFrom> && std::is_integral_v<TTo>)
    {
      to[i] = static_cast<TTo>(
        Wide{ static_cast<std::int64_t>(slope) } * from[i] + static_cast<std::int64_t>(intercept));
    }
    else
    {
      to[i] = static_cast<TTo>(slope * static_cast<double>(from[i]) + intercept);
    }
  }
}

} // namespace

void ReadVoxels(const StoredVoxels& stored, ScalarImage& image, Reading& reading)
{
  RefuseIf(stored.Files.empty(), "its header names no data file");
  CheckClaim(stored, image);
  const std::size_t voxels = image.NumberOfVoxels() * static_cast<std::size_t>(image.Frames);
  const std::size_t bytes = voxels * SizeOf(image.Type);
  const std::size_t part = bytes / stored.Files.size();
  image.Scalars = reading.Allocate(bytes);
  reading.Files = stored.Files;
  auto* to = static_cast<std::byte*>(image.Scalars.get());
  for (const std::string& path : stored.Files)
  {
    ReadPart(stored, path, image.Type, { to, part },
      [&](std::size_t found)
      {
        const auto done =
          static_cast<std::size_t>(to - static_cast<const std::byte*>(image.Scalars.get()));
        reading.Tell(static_cast<double>(done + found) / static_cast<double>(bytes));
      });
    to += part;
  }
  const bool isSwapped = stored.IsBigEndian != (std::endian::native == std::endian::big);
  if (isSwapped && stored.Coding != Encoding::Text)
  {
    Dispatch(image.Type,
      [&](auto zero)
      {
        auto* voxel = static_cast<std::byte*>(image.Scalars.get());
        for (std::size_t i = 0; i < voxels; ++i, voxel += sizeof zero)
        {
          std::reverse(voxel, voxel + sizeof zero);
        }
      });
  }
}

void MoveFramesToTheEnd(ScalarImage& image, std::size_t before, Reading& reading)
{
  if (image.Frames == 1 || before >= 3)
  {
    return;
  }
  std::size_t inner = SizeOf(image.Type); // bytes that stay together
  for (std::size_t axis = 0; axis < before; ++axis)
  {
    inner *= static_cast<std::size_t>(image.Dimensions[axis]);
  }
  const std::size_t bytes = image.NumberOfVoxels() * SizeOf(image.Type);
  const auto frames = static_cast<std::size_t>(image.Frames);
  const std::shared_ptr<void> together = image.Scalars;
  image.Scalars = reading.Allocate(bytes * frames);
  auto* to = static_cast<std::byte*>(image.Scalars.get());
  for (std::size_t f = 0; f < frames; ++f)
  {
    const std::byte* from = static_cast<const std::byte*>(together.get()) + f * inner;
    for (std::size_t at = 0; at < bytes; at += inner, from += frames * inner, to += inner)
    {
      std::memcpy(to, from, inner);
    }
  }
}

void Rescale(ScalarImage& image, double slope, double intercept, Reading& reading)
{
  if (slope == 1.0 && intercept == 0.0)
  {
    return;
  }
  const std::size_t count = image.NumberOfVoxels() * static_cast<std::size_t>(image.Frames);
  const std::shared_ptr<void> stored = image.Scalars;
  Dispatch(image.Type,
    [&](auto zero)
    {
      using T = decltype(zero);
      const std::span<const T> values(static_cast<const T*>(stored.get()), count);
      image.Type = FindTypeOfResults(values, slope, intercept).value_or(ScalarType::Float64);
      image.Scalars = reading.Allocate(count * SizeOf(image.Type));
      Dispatch(image.Type,
        [&](auto result) {
          Convert(values, static_cast<decltype(result)*>(image.Scalars.get()), slope, intercept);
        });
    });
}

std::string FindDataFile(const std::string& header, const std::string& name, bool anywhere)
{
  const fs::path given(name);
  const fs::path folder =
    fs::path(header).has_parent_path() ? fs::path(header).parent_path() : fs::path(".");
  const fs::path path = folder / given;
  if (!anywhere)
  {
    std::error_code failed;
    const fs::path root = fs::canonical(folder, failed);
    const fs::path real = fs::weakly_canonical(path, failed);
    const bool isBelow = !given.is_absolute() &&
      std::find(given.begin(), given.end(), "..") == given.end() &&
      std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first == root.end();
    RefuseIf(!isBelow, "its header names the data file '", Excerpt(name),
      "', which is not in the folder of the header or below; move it there, or use "
      "SetDataFilesAnywhere() if you trust the header");
  }
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  RefuseIf(!fs::is_regular_file(status), "its data file '", Excerpt(name),
    (fs::exists(status) ? "' is not a regular file" : "' does not exist"));
  RefuseIf(fs::equivalent(path, header, failed),
    "its header names itself as its data file: give the name of the file with the voxels");
  return path.string();
}

std::string UnpackBeginning(const InputFile& file, std::size_t length)
{
  FileSource raw(file, 0);
  InflateSource unpacked(raw);
  const bool isPacked = file.Beginning(2) == "\x1f\x8b";
  ByteSource& source = isPacked ? static_cast<ByteSource&>(unpacked) : raw;
  std::string text(
    isPacked ? length : static_cast<std::size_t>(std::min<std::uint64_t>(length, file.Size())),
    '\0');
  text.resize(source.Read(std::as_writable_bytes(std::span(text))));
  return text;
}

} // namespace voxplex::io
