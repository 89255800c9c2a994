// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "FileChecks.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>
#include <string_view>
#include <vector>

namespace voxplex::cli
{
namespace
{

// --- NIfTI
// ------------------------------------------------------------------------------------------

/** The fields of the 348-byte header that matter here, in the byte order of this machine. */
class NIfTIHeader
{
public:
  static constexpr std::size_t Size = 348;

  explicit NIfTIHeader(const std::array<char, Size>& bytes)
    : Bytes(bytes)
    , Swapped(this->Get<std::int32_t>(0) != static_cast<std::int32_t>(Size))
  {
  }

  bool IsValid() const { return this->Get<std::int32_t>(0) == static_cast<std::int32_t>(Size); }
  bool HoldsVoxels() const { return std::memcmp(&this->Bytes[344], "n+1", 4) == 0; }
  int Dimension(int i) const
  {
    return this->Get<std::int16_t>(40 + 2 * static_cast<std::size_t>(i));
  }
  int BitsPerVoxel() const { return this->Get<std::int16_t>(72); }
  float Step(int i) const { return this->Get<float>(76 + 4 * static_cast<std::size_t>(i)); }
  float VoxelOffset() const { return this->Get<float>(108); }

  /** Bytes of the whole uncompressed file. */
  std::uint64_t FileSize() const
  {
    std::uint64_t voxels = 1;
    for (int i = 1; i <= this->Dimension(0); ++i)
    {
      voxels *= static_cast<std::uint64_t>(std::max(1, this->Dimension(i)));
    }
    return static_cast<std::uint64_t>(this->VoxelOffset()) +
      voxels * static_cast<std::uint64_t>(this->BitsPerVoxel()) / 8;
  }

private:
  template <typename T>
  T Get(std::size_t offset) const
  {
    std::array<char, sizeof(T)> bytes;
    std::copy_n(this->Bytes.begin() + offset, sizeof(T), bytes.begin());
    if (this->Swapped)
    {
      std::reverse(bytes.begin(), bytes.end());
    }
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }

  const std::array<char, Size>& Bytes;
  bool Swapped = false;
};

struct GzCloser
{
  void operator()(gzFile_s* file) const { gzclose(file); }
};

/** Bytes up to the end of the file, at most enough; less if the compressed stream is damaged. */
std::uint64_t CountBytes(gzFile file, std::uint64_t enough)
{
  std::vector<char> buffer(1 << 18);
  std::uint64_t count = 0;
  while (count < enough)
  {
    const int got = gzread(file, buffer.data(), static_cast<unsigned>(buffer.size()));
    if (got <= 0)
    {
      break;
    }
    count += static_cast<std::uint64_t>(got);
  }
  return count;
}

// --- Text headers
// -----------------------------------------------------------------------------------

std::string LowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/** "ElementSpacing = 1 1 1" and "spacings: 1 1 1": the value if the key is this one. */
bool SplitField(const std::string& line, std::string_view key, std::string& value)
{
  const std::size_t separator = line.find_first_of("=:");
  if (separator == std::string::npos)
  {
    return false;
  }
  std::string name = LowerCase(line.substr(0, separator));
  name.erase(name.find_last_not_of(" \t") + 1);
  value = line.substr(separator + 1);
  value.erase(0, value.find_first_not_of(" \t=")); // NRRD has "key:=value", too
  value.erase(value.find_last_not_of(" \t\r") + 1);
  return name == key;
}

std::vector<double> Numbers(std::string text)
{
  std::replace_if(
    text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;)
  {
    double number = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error == std::errc() && end == word.data() + word.size())
    {
      numbers.push_back(number);
    }
  }
  return numbers;
}

std::string SpacingFault(const std::string& value)
{
  return "the voxel spacing in its header is '" + value +
    "'; it must be a positive length along each axis: correct the header";
}

} // namespace

std::string FindFaultOfNIfTI(const std::string& path)
{
  const std::unique_ptr<gzFile_s, GzCloser> file(gzopen(path.c_str(), "rb"));
  std::array<char, NIfTIHeader::Size> bytes{};
  if (!file || gzread(file.get(), bytes.data(), NIfTIHeader::Size) != int{ NIfTIHeader::Size })
  {
    return "";
  }
  const NIfTIHeader header(bytes);
  if (!header.IsValid())
  {
    return "";
  }
  for (int i = 1; i <= std::min(3, header.Dimension(0)); ++i)
  {
    if (!(header.Step(i) > 0) || !std::isfinite(header.Step(i)))
    {
      std::ostringstream value;
      value << header.Step(1) << ' ' << header.Step(2) << ' ' << header.Step(3);
      return SpacingFault(value.str());
    }
  }
  if (!header.HoldsVoxels())
  {
    return "";
  }
  const std::uint64_t expected = header.FileSize();
  const std::uint64_t found = NIfTIHeader::Size +
    CountBytes(file.get(), expected - std::min(expected, NIfTIHeader::Size + 0ul));
  if (found < expected)
  {
    return "the file is truncated or damaged (" + std::to_string(found) + " of " +
      std::to_string(expected) + " bytes)";
  }
  return "";
}

std::string FindFaultOfTextHeader(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  std::string value;
  std::size_t length = 0;
  // An empty line ends the header of NRRD, the name of the data file that of MetaImage.
  for (std::string line; length < 65536 && std::getline(file, line) && !line.empty();
       length += line.size())
  {
    if (SplitField(line, "elementdatafile", value))
    {
      break;
    }
    const bool isVectors = SplitField(line, "space directions", value);
    if (isVectors || SplitField(line, "spacings", value) ||
      SplitField(line, "elementspacing", value))
    {
      const std::vector<double> numbers = Numbers(value);
      const bool isFault = std::any_of(numbers.begin(), numbers.end(),
        [isVectors](double number)
        { return !std::isfinite(number) || (!isVectors && number <= 0); });
      // Axes that are not of space (components, time) may be NaN, which is 'unknown' in NRRD.
      if (isFault && (isVectors || numbers.size() <= 3))
      {
        return SpacingFault(value);
      }
    }
  }
  return "";
}

} // namespace voxplex::cli
