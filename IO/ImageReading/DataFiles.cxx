// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "DataFiles.h"

#include "Excerpt.h"
#include "TextHeader.h"

#include <itkImageIOBase.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string_view>
#include <utility>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

using FileNames = std::vector<std::string>;

enum class Encoding
{
  Raw,
  Text,    ///< at least a digit and a blank for each number
  Hex,     ///< two digits a byte
  Deflate, ///< zlib, gzip
  Other    ///< compressed in another way, or not known
};

constexpr double LargestDeflateRatio = 1032.0;
constexpr double LargestOtherRatio = 65536.0;

/** How many bytes of voxels a file of this size holds at most. */
double Capacity(double fileSize, Encoding encoding, double componentSize)
{
  switch (encoding)
  {
    case Encoding::Raw:
      return fileSize;
    case Encoding::Text:
      return (fileSize + 1.0) / 2.0 * componentSize;
    case Encoding::Hex:
      return fileSize / 2.0;
    case Encoding::Deflate:
      return fileSize * LargestDeflateRatio;
    case Encoding::Other:
      break;
  }
  return fileSize * LargestOtherRatio;
}

double SizeOf(const std::string& path)
{
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  return error ? 0.0 : static_cast<double>(size);
}

bool BeginsWith(const std::string& path, std::string_view magic)
{
  std::string begin(magic.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return file && begin == magic;
}

Encoding RawUnlessGzipped(const std::string& path)
{
  return BeginsWith(path, "\x1f\x8b") ? Encoding::Deflate : Encoding::Raw;
}

// --- Files that a text header names ----------------------------------------------------------------

/** More than any image has slices. */
constexpr std::size_t MostFiles = 100000;

struct NamedFiles
{
  FileNames Paths;
  std::string Fault; ///< why there are no paths
};

/** "slice_%03d.raw", numbered; nothing if it is no such pattern. */
class NumberedName
{
public:
  explicit NumberedName(const std::string& pattern)
  {
    const std::size_t percent = pattern.find('%');
    const std::size_t letter = pattern.find_first_not_of("0123456789", percent + 1);
    this->IsPattern = percent != std::string::npos && letter != std::string::npos &&
      pattern[letter] == 'd' && letter - percent <= 3 &&
      pattern.find('%', letter) == std::string::npos;
    if (this->IsPattern)
    {
      const std::string width = pattern.substr(percent + 1, letter - percent - 1);
      std::from_chars(width.data(), width.data() + width.size(), this->Width);
      this->Fill = !width.empty() && width.front() == '0' ? '0' : ' ';
      this->Before = pattern.substr(0, percent);
      this->After = pattern.substr(letter + 1);
    }
  }

  explicit operator bool() const { return this->IsPattern; }

  std::string Number(std::int64_t number) const
  {
    std::ostringstream name;
    name << this->Before << std::internal << std::setfill(this->Fill) << std::setw(this->Width)
         << number << this->After;
    return name.str();
  }

private:
  bool IsPattern = false;
  int Width = 0;
  char Fill = ' ';
  std::string Before;
  std::string After;
};

/** "slice_%03d.raw 1 40 1" */
NamedFiles ExpandPattern(const std::string& value)
{
  std::istringstream words(value);
  std::string pattern;
  std::int64_t first = 0;
  std::int64_t last = 0;
  std::int64_t step = 1;
  words >> pattern >> first >> last;
  const bool hasNumbers = !words.fail();
  words >> step; // which MetaImage may leave out
  const NumberedName name(pattern);
  constexpr std::int64_t most = INT32_MAX - 1; // ITK counts with int
  if (!name || !hasNumbers || step == 0 || std::max(std::abs(first), std::abs(last)) > most ||
    (last - first) / step < 0)
  {
    return { {},
      "'" + Excerpt(value) + "' in its header is no pattern of names such as 'a_%03d.raw 1 40 1'" };
  }
  const auto count = static_cast<std::uint64_t>((last - first) / step) + 1;
  if (count > MostFiles)
  {
    return { {}, "its header names " + std::to_string(count) + " data files" };
  }
  NamedFiles files;
  for (std::uint64_t i = 0; i < count; ++i)
  {
    files.Paths.push_back(name.Number(first + static_cast<std::int64_t>(i) * step));
  }
  return files;
}

/** The field that says where the voxels are. */
const std::string* FindDataField(const TextHeader& header)
{
  for (const char* key : { "elementdatafile", "data file", "datafile" })
  {
    if (const std::string* value = header.Find(key))
    {
      return value;
    }
  }
  return nullptr;
}

bool IsLocal(const std::string* dataField)
{
  return !dataField || *dataField == "LOCAL" || *dataField == "Local" || *dataField == "local";
}

NamedFiles ListNamedFiles(const TextHeader& header, const std::string& dataField)
{
  if (dataField.rfind("LIST", 0) == 0)
  {
    return { header.ListedFiles(), "" };
  }
  return dataField.find('%') != std::string::npos ? ExpandPattern(dataField)
                                                  : NamedFiles{ { dataField }, "" };
}

/** Names are relative to the header. */
NamedFiles FindNamedFiles(const std::string& path, const TextHeader& header)
{
  const std::string* field = FindDataField(header);
  if (IsLocal(field))
  {
    return { { path }, "" };
  }
  NamedFiles files = ListNamedFiles(header, *field);
  const fs::path folder = fs::path(path).parent_path();
  for (std::string& file : files.Paths)
  {
    const std::string name = std::exchange(file, (folder / file).string());
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    if (!fs::is_regular_file(status))
    {
      return { {},
        "its data file '" + Excerpt(name) +
          (fs::exists(status) ? "' is not a regular file" : "' does not exist") };
    }
  }
  return files;
}

// --- What files of each format can hold ------------------------------------------------------------

struct Holding
{
  FileNames Files;
  double Bytes = 0.0;
};

Holding Hold(const FileNames& files, Encoding encoding, double componentSize)
{
  Holding holding{ files, 0.0 };
  for (const std::string& file : files)
  {
    holding.Bytes += Capacity(SizeOf(file), encoding, componentSize);
  }
  return holding;
}

Encoding EncodingOfNRRD(const TextHeader& header)
{
  const std::string* field = header.Find("encoding");
  const std::string name = field ? *field : "";
  if (name == "raw")
  {
    return Encoding::Raw;
  }
  if (name == "txt" || name == "text" || name == "ascii")
  {
    return Encoding::Text;
  }
  if (name == "hex")
  {
    return Encoding::Hex;
  }
  return name == "gz" || name == "gzip" ? Encoding::Deflate : Encoding::Other;
}

/** MetaImage's words for yes. */
bool IsTrue(const std::string& text)
{
  return text.find_first_of("Tt1") == 0;
}

Encoding EncodingOfMetaImage(const TextHeader& header)
{
  const std::string* compressed = header.Find("compresseddata");
  if (compressed && IsTrue(*compressed))
  {
    return Encoding::Deflate;
  }
  const std::string* binary = header.Find("binarydata");
  return binary && !IsTrue(*binary) ? Encoding::Text : Encoding::Raw;
}

/** The third line says it: ASCII or BINARY. */
Encoding EncodingOfVTK(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  constexpr std::streamsize longest = 1024;
  for (int i = 0; i < 2; ++i)
  {
    file.ignore(longest, '\n');
  }
  const int letter = file.get();
  return letter == 'A' || letter == 'a' ? Encoding::Text : Encoding::Raw;
}

/** Of headers that have their voxels in a file with another extension: what there is of both. */
Holding HoldWithCompanions(const std::string& path, std::initializer_list<const char*> extensions)
{
  fs::path stem(path);
  if (stem.extension() == ".gz")
  {
    stem.replace_extension();
  }
  Holding holding = Hold({ path }, RawUnlessGzipped(path), 1.0);
  for (const char* extension : extensions)
  {
    const std::string companion = stem.replace_extension(extension).string();
    std::error_code ignored;
    if (companion != path && fs::is_regular_file(companion, ignored))
    {
      holding.Files.push_back(companion);
      holding.Bytes += Capacity(SizeOf(companion), RawUnlessGzipped(companion), 1.0);
    }
    stem.replace_extension(); // of ".img.gz"
  }
  return holding;
}

Holding HoldingOf(const FileNames& files, const itk::ImageIOBase& io)
{
  const std::string format = io.GetNameOfClass();
  const std::string& path = files.front();
  const double componentSize = io.GetComponentSize();
  if (format == "NrrdImageIO" || format == "MetaImageIO")
  {
    const TextHeader header(path);
    return Hold(FindNamedFiles(path, header).Paths,
      format == "NrrdImageIO" ? EncodingOfNRRD(header) : EncodingOfMetaImage(header),
      componentSize);
  }
  if (format == "NiftiImageIO")
  {
    return HoldWithCompanions(path, { ".img", ".img.gz" });
  }
  if (format == "StimulateImageIO")
  {
    return HoldWithCompanions(path, { ".sdt" });
  }
  if (format == "PhilipsRECImageIO")
  {
    return HoldWithCompanions(path, { ".rec", ".REC", ".rec.gz", ".REC.gz" });
  }
  if (format == "VTKImageIO")
  {
    return Hold(files, EncodingOfVTK(path), componentSize);
  }
  if (format == "GiplImageIO" || format == "MGHImageIO" || format == "MRCImageIO" ||
    format == "BioRadImageIO")
  {
    return Hold(files, RawUnlessGzipped(path), componentSize);
  }
  return Hold(files, Encoding::Other, componentSize);
}

/** "6 x 5 x 4 voxels of 2 bytes" */
std::string DescribeClaim(const itk::ImageIOBase& io, std::size_t files)
{
  std::ostringstream claim;
  for (unsigned i = 0; i < io.GetNumberOfDimensions(); ++i)
  {
    claim << (i ? " x " : "") << io.GetDimensions(i);
  }
  if (files > 1)
  {
    claim << " x " << files;
  }
  const std::size_t bytes = std::size_t{ io.GetComponentSize() } * io.GetNumberOfComponents();
  claim << " voxels of " << bytes << (bytes == 1 ? " byte" : " bytes");
  return claim.str();
}

/** "the file has 1000 bytes" */
std::string DescribeFiles(const FileNames& files, const std::string& path)
{
  double size = 0.0;
  for (const std::string& file : files)
  {
    size += SizeOf(file);
  }
  std::ostringstream text;
  text << std::fixed << std::setprecision(0);
  if (files.size() == 1)
  {
    text << (files.front() == path
                ? "the file"
                : "'" + Excerpt(fs::path(files.front()).filename().string()) + "'")
         << " has ";
  }
  else
  {
    text << "its " << files.size() << " files have ";
  }
  text << size << " bytes";
  return text.str();
}

/** MetaIO takes as much memory as the header claims of compressed voxels, from each file. */
std::string FindFaultOfCompressedSize(const TextHeader& header, const FileNames& files)
{
  const std::string* field = header.Find("compresseddatasize");
  if (!field || EncodingOfMetaImage(header) != Encoding::Deflate)
  {
    return "";
  }
  const std::vector<double> size = ParseNumbers(*field);
  const bool fits = !size.empty() && size.front() >= 0 &&
    std::all_of(files.begin(), files.end(),
      [&size](const std::string& file) { return size.front() <= SizeOf(file); });
  return fits ? ""
              : "it is truncated or damaged: its header claims '" + Excerpt(*field) +
      "' bytes of compressed voxels";
}

} // namespace

std::string FindFaultOfNamedFiles(const std::string& path)
{
  const TextHeader header(path);
  if (header.IsEndless())
  {
    return "it is damaged: its header does not end within 1 MiB";
  }
  const NamedFiles files = FindNamedFiles(path, header);
  return files.Fault.empty() ? FindFaultOfCompressedSize(header, files.Paths) : files.Fault;
}

std::string FindFaultOfSize(const FileNames& files, const itk::ImageIOBase& io)
{
  // In floating point: products of hostile numbers overflow integers.
  double claimed = static_cast<double>(io.GetComponentSize()) *
    static_cast<double>(io.GetNumberOfComponents()) * static_cast<double>(files.size());
  for (unsigned i = 0; i < io.GetNumberOfDimensions(); ++i)
  {
    claimed *= static_cast<double>(io.GetDimensions(i));
  }
  if (claimed == 0.0)
  {
    return "its header claims no voxels: " + DescribeClaim(io, files.size());
  }
  const Holding holding = HoldingOf(files, io);
  if (claimed <= holding.Bytes)
  {
    return "";
  }
  return "it is truncated or damaged: its header claims " + DescribeClaim(io, files.size()) +
    ", and " + DescribeFiles(holding.Files, files.front());
}

} // namespace voxplex::io
