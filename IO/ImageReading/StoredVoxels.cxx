// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "StoredVoxels.h"

#include "ByteSource.h"
#include "Excerpt.h"
#include "FileError.h"
#include "InputFile.h"
#include "Reading.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iomanip>
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

/** Calls function with a value of the type. */
template <typename TFunction>
void Dispatch(ScalarType type, TFunction&& function)
{
  switch (type)
  {
    case ScalarType::Int8:
      return function(std::int8_t());
    case ScalarType::UInt8:
      return function(std::uint8_t());
    case ScalarType::Int16:
      return function(std::int16_t());
    case ScalarType::UInt16:
      return function(std::uint16_t());
    case ScalarType::Int32:
      return function(std::int32_t());
    case ScalarType::UInt32:
      return function(std::uint32_t());
    case ScalarType::Int64:
      return function(std::int64_t());
    case ScalarType::UInt64:
      return function(std::uint64_t());
    case ScalarType::Float32:
      return function(float());
    case ScalarType::Float64:
      return function(double());
  }
}

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
  if (std::find(parts.begin(), parts.end(), count) == parts.end() && count != image.Dimensions[2])
  {
    throw FileError("its header names " + std::to_string(stored.Files.size()) +
      " data files, which cannot hold " + DescribeClaim(image) + " in equal parts");
  }
  const double claimed = static_cast<double>(image.NumberOfVoxels()) * image.Frames *
    static_cast<double>(SizeOf(image.Type));
  for (const std::string& path : stored.Files)
  {
    const std::uint64_t size = InputFile(path).Size();
    if (claimed / count > Capacity(stored.Coding, static_cast<double>(size), image.Type))
    {
      throw FileError("it is truncated or damaged: its header claims " + DescribeClaim(image) +
        (count > 1 ? " in " + std::to_string(stored.Files.size()) + " files" : "") + ", and '" +
        Excerpt(fs::path(path).filename().string()) + "' has " + std::to_string(size) + " bytes");
    }
  }
}

// --- Texts -------------------------------------------------------------------------------------------

/** The words of a source, which blanks, line ends and commas separate. */
class WordReader
{
public:
  explicit WordReader(ByteSource& source)
    : Source(source)
  {
  }

  /** Empty at the end. */
  std::string Next()
  {
    constexpr std::size_t longest = 64; // of a number
    std::string word;
    for (std::optional<char> c = this->Source.Get(); c && word.size() <= longest;
         c = this->Source.Get())
    {
      const bool separates = *c == ' ' || *c == ',' || (*c >= '\t' && *c <= '\r');
      if (!separates)
      {
        word += *c;
      }
      else if (!word.empty())
      {
        break;
      }
    }
    return word;
  }

private:
  ByteSource& Source;
};

/** "7", and "7.0" for an integer, too; nothing for other words and numbers that the type does not hold. */
template <typename T>
std::optional<T> ParseNumber(const std::string& word)
{
  const char* const begin = word.data() + (word[0] == '+' ? 1 : 0);
  const char* const end = word.data() + word.size();
  T number{};
  if (const auto [at, error] = std::from_chars(begin, end, number);
      error == std::errc() && at == end)
  {
    return number;
  }
  if constexpr (std::is_integral_v<T>)
  {
    double real = 0.0;
    const auto [at, error] = std::from_chars(begin, end, real);
    constexpr double limit = 9007199254740992.0; // 2^53
    if (error == std::errc() && at == end && std::abs(real) <= limit && std::trunc(real) == real &&
      std::in_range<T>(static_cast<std::int64_t>(real)))
    {
      return static_cast<T>(real);
    }
  }
  return std::nullopt;
}

template <typename T>
std::size_t ReadText(ByteSource& source, std::span<std::byte> to)
{
  WordReader words(source);
  std::size_t done = 0;
  for (; done < to.size(); done += sizeof(T))
  {
    const std::string word = words.Next();
    if (word.empty())
    {
      break;
    }
    const std::optional<T> number = ParseNumber<T>(word);
    if (!number)
    {
      throw FileError("'" + Excerpt(word) + "' among its voxels is not a number of their type");
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
      throw FileError(
        "'" + Excerpt(std::string(1, *c)) + "' among its voxels is not a hexadecimal digit");
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

[[noreturn]] void RefuseAsTruncated(
  const std::string& path, double found, double expected, const char* what)
{
  std::ostringstream reason;
  reason << std::fixed << std::setprecision(0) << "it is truncated: '"
         << Excerpt(fs::path(path).filename().string()) << "' holds " << found << " of " << expected
         << ' ' << what;
  throw FileError(reason.str());
}

void ReadPart(
  const StoredVoxels& stored, const std::string& path, ScalarType type, std::span<std::byte> to)
{
  const InputFile file(path);
  std::uint64_t start = static_cast<std::uint64_t>(stored.Offset);
  if (stored.BytesToSkip == StoredVoxels::FromTheEnd)
  {
    start = file.Size() - std::min<std::uint64_t>(file.Size(), to.size());
  }
  FileSource raw(file, start);
  for (std::int64_t lines = stored.LinesToSkip; lines > 0;)
  {
    const std::optional<char> c = raw.Get();
    lines = c ? lines - (*c == '\n') : 0;
  }
  InflateSource unpacked(raw);
  ByteSource& source =
    stored.Coding == Encoding::Deflate ? static_cast<ByteSource&>(unpacked) : raw;
  source.Skip(stored.BytesToSkip == StoredVoxels::FromTheEnd
      ? 0
      : static_cast<std::uint64_t>(stored.BytesToSkip));

  if (stored.Coding == Encoding::Text)
  {
    std::size_t found = 0;
    Dispatch(type, [&](auto zero) { found = ReadText<decltype(zero)>(source, to); });
    if (found < to.size())
    {
      const auto size = static_cast<double>(SizeOf(type));
      RefuseAsTruncated(
        path, static_cast<double>(found) / size, static_cast<double>(to.size()) / size, "numbers");
    }
    return;
  }
  const std::size_t found = stored.Coding == Encoding::Hex ? ReadHex(source, to) : source.Read(to);
  if (found < to.size())
  {
    RefuseAsTruncated(
      path, static_cast<double>(found), static_cast<double>(to.size()), "bytes of voxels");
  }
  source.Finish();
}

template <typename T>
void SwapBytes(std::byte* voxels, std::size_t count)
{
  for (std::size_t i = 0; i < count; ++i, voxels += sizeof(T))
  {
    std::reverse(voxels, voxels + sizeof(T));
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

/** Whether a number is whole, and small enough to be so exactly. */
bool IsWhole(double number)
{
  constexpr double exact = 9007199254740992.0; // 2^53
  return std::trunc(number) == number && std::abs(number) <= exact;
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

template <typename T>
void Transpose(
  const std::byte* from, std::byte* to, std::size_t inner, std::size_t frames, std::size_t outer)
{
  for (std::size_t f = 0; f < frames; ++f)
  {
    for (std::size_t o = 0; o < outer; ++o)
    {
      for (std::size_t i = 0; i < inner; ++i)
      {
        std::memcpy(to, from + ((o * frames + f) * inner + i) * sizeof(T), sizeof(T));
        to += sizeof(T);
      }
    }
  }
}

} // namespace

void ReadVoxels(const StoredVoxels& stored, ScalarImage& image, Reading& reading)
{
  if (stored.Files.empty())
  {
    throw FileError("its header names no data file");
  }
  CheckClaim(stored, image);
  const std::size_t voxels = image.NumberOfVoxels() * static_cast<std::size_t>(image.Frames);
  const std::size_t bytes = voxels * SizeOf(image.Type);
  const std::size_t part = bytes / stored.Files.size();
  image.Scalars = reading.Allocate(bytes);
  auto* to = static_cast<std::byte*>(image.Scalars.get());
  for (const std::string& path : stored.Files)
  {
    ReadPart(stored, path, image.Type, { to, part });
    to += part;
  }
  const bool isSwapped = stored.IsBigEndian != (std::endian::native == std::endian::big);
  if (isSwapped && stored.Coding != Encoding::Text)
  {
    Dispatch(image.Type,
      [&](auto zero)
      { SwapBytes<decltype(zero)>(static_cast<std::byte*>(image.Scalars.get()), voxels); });
  }
}

void MoveFramesToTheEnd(ScalarImage& image, std::size_t before, Reading& reading)
{
  if (image.Frames == 1 || before >= 3)
  {
    return;
  }
  std::size_t inner = 1;
  for (std::size_t axis = 0; axis < before; ++axis)
  {
    inner *= static_cast<std::size_t>(image.Dimensions[axis]);
  }
  const std::size_t outer = image.NumberOfVoxels() / inner;
  const auto frames = static_cast<std::size_t>(image.Frames);
  const std::shared_ptr<void> together = image.Scalars;
  image.Scalars = reading.Allocate(image.NumberOfVoxels() * frames * SizeOf(image.Type));
  Dispatch(image.Type,
    [&](auto zero)
    {
      Transpose<decltype(zero)>(static_cast<const std::byte*>(together.get()),
        static_cast<std::byte*>(image.Scalars.get()), inner, frames, outer);
    });
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
    if (!isBelow)
    {
      throw FileError("its header names the data file '" + Excerpt(name) +
        "', which is not in the folder of the header or below; move it there, or use "
        "SetDataFilesAnywhere() if you trust the "
        "header");
    }
  }
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  if (!fs::is_regular_file(status))
  {
    throw FileError("its data file '" + Excerpt(name) +
      (fs::exists(status) ? "' is not a regular file" : "' does not exist"));
  }
  return path.string();
}

std::vector<std::string> ExpandPattern(const std::string& value)
{
  constexpr std::size_t mostFiles = 100000;
  const auto refuse = [&value]
  {
    throw FileError(
      "'" + Excerpt(value) + "' in its header is no pattern of names such as 'a_%03d.raw 1 40 1'");
  };
  std::istringstream words(value);
  std::string pattern;
  std::int32_t first = 0;
  std::int32_t last = 0;
  std::int32_t step = 1;
  words >> pattern >> first >> last;
  const bool hasNumbers = !words.fail();
  std::string rest;
  if (!(words >> step).fail())
  {
    words >> rest; // NRRD's number of dimensions in each file, which the sizes tell, too
  }
  else if (!words.eof())
  {
    refuse();
  }
  const std::size_t percent = pattern.find('%');
  const std::size_t letter = pattern.find_first_not_of("0123456789", percent + 1);
  const bool isPattern = percent != std::string::npos && letter != std::string::npos &&
    (pattern[letter] == 'd' || pattern[letter] == 'i' || pattern[letter] == 'u') &&
    letter - percent <= 3 && pattern.find('%', letter) == std::string::npos;
  const std::int64_t span = std::int64_t{ last } - first;
  if (!isPattern || !hasNumbers || step == 0 || (span != 0 && (span > 0) != (step > 0)))
  {
    refuse();
  }
  const std::int64_t count = span / step + 1;
  if (count > static_cast<std::int64_t>(mostFiles))
  {
    throw FileError("its header names " + std::to_string(count) + " data files");
  }
  int width = 0;
  std::from_chars(pattern.data() + percent + 1, pattern.data() + letter, width);
  std::vector<std::string> names;
  for (std::int64_t i = 0; i < count; ++i)
  {
    std::ostringstream name;
    name << pattern.substr(0, percent) << std::internal
         << std::setfill(pattern[percent + 1] == '0' ? '0' : ' ') << std::setw(width)
         << first + i * step << pattern.substr(letter + 1);
    names.push_back(name.str());
  }
  return names;
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
