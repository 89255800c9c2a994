// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "FileChecks.h"

#include "Excerpt.h"
#include "TextHeader.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <memory>
#include <span>
#include <sstream>
#include <vector>

namespace voxplex::io
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
  {
    // As ITK tells the byte order: by the number of dimensions, not by the size that the header gives itself.
    if (!this->HasDimensions())
    {
      this->Swapped = true;
      this->Swapped = this->HasDimensions();
    }
  }

  bool HasDimensions() const { return this->Dimension(0) >= 1 && this->Dimension(0) <= 7; }
  bool HoldsVoxels() const { return std::memcmp(&this->Bytes[344], "n+1", 4) == 0; }
  int Dimension(int i) const
  {
    return this->Get<std::int16_t>(40 + 2 * static_cast<std::size_t>(i));
  }
  int BitsPerVoxel() const { return this->Get<std::int16_t>(72); }
  bool HasFrames() const { return this->Dimension(0) > 3 && this->Dimension(4) > 1; }
  float Step(int i) const { return this->Get<float>(76 + 4 * static_cast<std::size_t>(i)); }
  float FirstTime() const { return this->Get<float>(136); }
  float VoxelOffset() const { return this->Get<float>(108); }
  /**
   * Whether the numbers that place the image in space, of the methods that the header uses, are such as ITK can take: with
   * what is not finite it ends the program, and with squares that are not it never ends.
   */
  bool IsPlaced() const
  {
    const bool isNIfTI = std::memcmp(&this->Bytes[344], "n", 1) == 0; // else Analyze, without them
    constexpr float Largest = 1e12f;
    const auto areFinite = [this](std::size_t first, std::size_t count)
    {
      bool finite = true;
      for (std::size_t i = 0; i < count; ++i)
      {
        finite = finite && std::abs(this->Get<float>(first + 4 * i)) <= Largest; // not NaN
      }
      return finite;
    };
    return !isNIfTI ||
      ((this->Get<std::int16_t>(252) <= 0 || areFinite(256, 6)) &&  // qform
        (this->Get<std::int16_t>(254) <= 0 || areFinite(280, 12))); // sform
  }

  /** Bytes of the whole uncompressed file; a product that may be too large for an integer. */
  double FileSize() const
  {
    double voxels = 1.0;
    for (int i = 1; i <= this->Dimension(0); ++i)
    {
      voxels *= std::max(1, this->Dimension(i));
    }
    return std::floor(double{ this->VoxelOffset() } + voxels * this->BitsPerVoxel() / 8.0);
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

/** Reads a file as the NIfTI library does: what is called .gz is unpacked, and nothing else, however it begins. */
class NIfTIFile
{
public:
  explicit NIfTIFile(const std::string& path)
  {
    const std::string extension = std::filesystem::path(path).extension().string();
    if (extension == ".gz" || extension == ".GZ")
    {
      this->Compressed.reset(gzopen(path.c_str(), "rb"));
    }
    else
    {
      this->Plain.open(path, std::ios::binary);
    }
  }

  /** @return how many bytes there were; 0 at the end of the file and where the compressed stream is damaged */
  std::size_t Read(std::span<char> bytes)
  {
    if (this->Compressed)
    {
      return static_cast<std::size_t>(std::max(
        0, gzread(this->Compressed.get(), bytes.data(), static_cast<unsigned>(bytes.size()))));
    }
    this->Plain.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return static_cast<std::size_t>(this->Plain.gcount());
  }

  /** Bytes up to the end of the file, or to enough. */
  std::uint64_t CountBytes(double enough)
  {
    std::vector<char> buffer(1 << 18);
    std::uint64_t count = 0;
    while (static_cast<double>(count) < enough)
    {
      const std::size_t got = this->Read(buffer);
      if (got == 0)
      {
        break;
      }
      count += got;
    }
    return count;
  }

private:
  struct GzCloser
  {
    void operator()(gzFile_s* file) const { gzclose(file); }
  };

  std::unique_ptr<gzFile_s, GzCloser> Compressed;
  std::ifstream Plain;
};

/** Images in two files have it in the one with this extension; ITK takes either name. */
std::string HeaderPathOfNIfTI(const std::string& path)
{
  std::filesystem::path header(path);
  const bool isCompressed = header.extension() == ".gz";
  if (isCompressed)
  {
    header.replace_extension();
  }
  if (header.extension() != ".img")
  {
    return path;
  }
  header.replace_extension(".hdr");
  std::error_code ignored;
  if (!std::filesystem::exists(header, ignored))
  {
    header += ".gz";
  }
  return header.string();
}

std::string SpacingFault(const std::string& value)
{
  return "the voxel spacing in its header is '" + Excerpt(value) +
    "'; it must be a positive length along each axis: correct the header";
}

std::string TimeStepFault(const std::string& value)
{
  return "the time from frame to frame in its header is '" + Excerpt(value) +
    "'; it must be a positive number: correct the header";
}

bool IsPositive(double number)
{
  return number > 0 && std::isfinite(number);
}

constexpr std::size_t TimeAxis = 3;

std::string FindFaultOfSpacings(const std::string& spacing)
{
  const std::vector<double> numbers = ParseNumbers(spacing);
  const auto fault = std::find_if_not(numbers.begin(), numbers.end(), IsPositive);
  if (fault == numbers.end())
  {
    return "";
  }
  return fault == numbers.begin() + TimeAxis ? TimeStepFault(spacing) : SpacingFault(spacing);
}

/** NaN means 'unknown', which is fine for an axis that is not one of space. */
std::string FindFaultOfNRRD(const TextHeader& header)
{
  const std::vector<NRRDAxis> axes = ParseNRRDAxes(header);
  const bool hasList =
    std::any_of(axes.begin(), axes.end(), [](const NRRDAxis& axis) { return axis.IsList(); });
  for (std::size_t a = 0; a < axes.size(); ++a)
  {
    const NRRDAxis& axis = axes[a];
    const bool isTime = axis.IsList() || (a == TimeAxis && !hasList);
    if (std::any_of(axis.Direction.begin(), axis.Direction.end(),
          [](double number) { return !std::isfinite(number); }))
    {
      return SpacingFault(*header.Find("space directions"));
    }
    const bool mayBeUnknown = isTime || !axis.Direction.empty();
    if (axis.HasSpacing && !IsPositive(axis.Spacing) && !(std::isnan(axis.Spacing) && mayBeUnknown))
    {
      const std::string& spacings = *header.Find("spacings");
      return isTime ? TimeStepFault(spacings) : SpacingFault(spacings);
    }
  }
  return "";
}

} // namespace

std::optional<NIfTITimes> ReadTimesOfNIfTI(const std::string& path)
{
  NIfTIFile file(HeaderPathOfNIfTI(path));
  std::array<char, NIfTIHeader::Size> bytes{};
  if (file.Read(bytes) != NIfTIHeader::Size)
  {
    return std::nullopt;
  }
  const NIfTIHeader header(bytes);
  if (!header.HasDimensions() || !header.HasFrames())
  {
    return std::nullopt;
  }
  return NIfTITimes{ header.FirstTime(), header.Step(4) };
}

std::string FindFaultOfNIfTI(const std::string& path)
{
  NIfTIFile file(HeaderPathOfNIfTI(path));
  std::array<char, NIfTIHeader::Size> bytes{};
  if (file.Read(bytes) != NIfTIHeader::Size)
  {
    return "";
  }
  const NIfTIHeader header(bytes);
  if (!header.HasDimensions())
  {
    return "it is damaged: its header gives " + std::to_string(header.Dimension(0)) +
      " dimensions, and the format has 1 to 7";
  }
  if (header.HasFrames() && !std::isfinite(header.FirstTime()))
  {
    return "the time of the first frame in its header (toffset) is not a finite number: correct "
           "the header";
  }
  if (header.HasFrames() && !IsPositive(header.Step(4)) && header.Step(4) != 0)
  {
    std::ostringstream value;
    value << header.Step(4);
    return TimeStepFault(value.str());
  }
  for (int i = 1; i <= std::min(3, header.Dimension(0)); ++i)
  {
    if (!IsPositive(header.Step(i)))
    {
      std::ostringstream value;
      value << header.Step(1) << ' ' << header.Step(2) << ' ' << header.Step(3);
      return SpacingFault(value.str());
    }
  }
  if (!header.IsPlaced())
  {
    return "the position or orientation in its header (qform or sform) is not finite, or far too "
           "large: correct the "
           "header";
  }
  if (!header.HoldsVoxels())
  {
    return "";
  }
  if (!(header.VoxelOffset() >= 0) || header.BitsPerVoxel() < 0)
  {
    return "it is damaged: its header gives " + std::to_string(header.BitsPerVoxel()) +
      " bits a voxel from byte " + std::to_string(header.VoxelOffset()) + " on";
  }
  const double expected = header.FileSize();
  const std::uint64_t found =
    NIfTIHeader::Size + file.CountBytes(expected - double{ NIfTIHeader::Size });
  if (static_cast<double>(found) < expected)
  {
    std::ostringstream bytes;
    bytes << found << " of " << std::fixed << std::setprecision(0) << expected;
    return "the file is truncated or damaged (" + bytes.str() + " bytes)";
  }
  return "";
}

std::string FindFaultOfTextHeader(const std::string& path)
{
  const TextHeader header(path);
  const std::string* spacing = header.Find("elementspacing");
  return spacing ? FindFaultOfSpacings(*spacing) : FindFaultOfNRRD(header);
}

} // namespace voxplex::io
