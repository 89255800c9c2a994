// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Readers.h"

#include "DICOMDataSet.h"
#include "DICOMPixels.h"
#include "DICOMSegments.h"
#include "DICOMSlices.h"
#include "Placement.h"
#include "Text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <type_traits>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

constexpr DICOMTag MediaStorage{ 0x00020002, "Media Storage SOP Class UID" };
constexpr DICOMTag SeriesUID{ 0x0020000E, "Series Instance UID" };
constexpr DICOMTag PixelData{ 0x7FE00010, "Pixel Data" };

/** The class of a DICOMDIR. */
constexpr std::string_view Directory = "1.2.840.10008.1.3.10";

using FileNames = std::vector<std::string>;

/** The slices of one volume, and what their pixels are like. */
struct Volume
{
  FileNames Files;
  std::vector<DICOMSlice> Slices;
  DICOMPixelFormat Format;
  bool IsLossy = false;
  DICOMStack Stack = DICOMStack::Complete;
  std::vector<DICOMSegment> Segments; ///< of a segmentation
  std::uint16_t Background = 0;       ///< of a label map, beside 0
};

std::string NameInFolder(const std::string& path)
{
  return "'" + Excerpt(fs::path(path).filename().string()) + "'";
}

/** What read() returns. @throws FileError that names the file of a folder */
template <typename TRead>
auto Naming(const std::string& path, TRead&& read)
{
  try
  {
    return read();
  }
  catch (const FileError& error)
  {
    Refuse(NameInFolder(path), ": ", error.what());
  }
}

void CheckFormat(const DICOMSlice& first, const DICOMPixelFormat& a, const DICOMSlice& second,
  const DICOMPixelFormat& b)
{
  const auto check = [&](const char* name, unsigned one, unsigned other)
  {
    RefuseIf(one != other, first.Name, " and ", second.Name, " differ in ", name, ", which is ",
      one, " and ", other,
      ": slices of one volume are alike; take the others out of the folder first");
  };
  check("Columns (0028,0011)", a.Columns, b.Columns);
  check("Rows (0028,0010)", a.Rows, b.Rows);
  check("Bits Allocated (0028,0100)", a.BitsAllocated, b.BitsAllocated);
  check("Bits Stored (0028,0101)", a.BitsStored, b.BitsStored);
  check("High Bit (0028,0102)", a.HighBit, b.HighBit);
  check("Pixel Representation (0028,0103)", a.IsSigned, b.IsSigned);
}

bool IsSegmentation(const DICOMDataSet& data)
{
  return IsLabelMap(data) || HasFramesOfSegments(data);
}

/** Adds the slices of a file. */
DICOMPixelFormat AddFile(Volume& volume, const std::string& path)
{
  const DICOMDataSet data(path);
  CheckObject(data);
  const DICOMPixels pixels(data);
  for (DICOMSlice& slice : ReadSlices(data, pixels.Frames()))
  {
    slice.File = volume.Files.size();
    volume.Slices.push_back(slice);
  }
  volume.IsLossy = volume.IsLossy || pixels.IsLossy();
  volume.Files.push_back(path);
  if (IsSegmentation(data))
  {
    volume.Stack = IsLabelMap(data) ? DICOMStack::LabelMap : DICOMStack::OfSegments;
    volume.Segments = ListSegments(data);
    volume.Background = FindBackground(data);
  }
  return pixels.Format();
}

/** Adds a slice of a series. */
void AddSlice(Volume& volume, const std::string& path)
{
  const std::size_t before = volume.Slices.size();
  const DICOMPixelFormat format = Naming(path, [&] { return AddFile(volume, path); });
  const std::size_t frames = volume.Slices.size() - before;
  RefuseIf(frames > 1 || volume.Stack == DICOMStack::OfSegments, NameInFolder(path), " has ",
    frames, (volume.Stack == DICOMStack::OfSegments ? " frames of segments" : " frames"),
    ", and there are other files in its series: each may be an image of its own: give one of the "
    "files");
  volume.Slices.back().Name = NameInFolder(path);
  volume.Format = before == 0 ? format : volume.Format;
  CheckFormat(volume.Slices.front(), volume.Format, volume.Slices.back(), format);
}

/** A range of whole numbers: the values of a type or of an image. */
struct Range
{
  double Least = 0.0;
  double Most = 0.0;
};

template <typename T>
bool Holds(const Range& range)
{
  // 2^63 is the double above the most that 64 bits hold.
  return range.Least >= static_cast<double>(std::numeric_limits<T>::min()) &&
    range.Most < -static_cast<double>(std::numeric_limits<T>::min());
}

/** Of voxels when they are rescaled: whole numbers stay whole. */
ScalarType ChooseType(const Volume& volume)
{
  const DICOMPixelFormat& format = volume.Format;
  const double half = std::ldexp(1.0, static_cast<int>(format.BitsStored) - 1);
  const Range stored =
    format.IsSigned ? Range{ -half, half - 1.0 } : Range{ 0.0, 2.0 * half - 1.0 };
  Range range;
  bool isIdentity = true;
  for (const DICOMSlice& slice : volume.Slices)
  {
    if (slice.Slope != std::trunc(slice.Slope) || slice.Intercept != std::trunc(slice.Intercept))
    {
      return ScalarType::Float64;
    }
    const double a = stored.Least * slice.Slope + slice.Intercept;
    const double b = stored.Most * slice.Slope + slice.Intercept;
    // The products count, too, from which the sums are made.
    range = { std::min({ range.Least, a, b, a - slice.Intercept, b - slice.Intercept }),
      std::max({ range.Most, a, b, a - slice.Intercept, b - slice.Intercept }) };
    isIdentity = isIdentity && slice.Slope == 1.0 && slice.Intercept == 0.0;
  }
  if (isIdentity)
  {
    return IntegerType(format.BitsAllocated / 8, format.IsSigned).value();
  }
  return Holds<std::int16_t>(range) ? ScalarType::Int16
    : Holds<std::int32_t>(range)    ? ScalarType::Int32
    : Holds<std::int64_t>(range)    ? ScalarType::Int64
                                    : ScalarType::Float64;
}

/** Takes the bits that belong to a sample, gives them their sign and rescales. */
template <typename TVoxel>
void Convert(
  const DICOMFrame& frame, const DICOMPixelFormat& format, const DICOMSlice& slice, TVoxel* to)
{
  using Number = std::conditional_t<std::is_floating_point_v<TVoxel>, double, std::int64_t>;
  const unsigned shift = format.HighBit + 1 - format.BitsStored;
  const std::uint32_t mask =
    static_cast<std::uint32_t>((std::uint64_t(1) << format.BitsStored) - 1);
  const std::uint32_t sign = format.IsSigned ? std::uint32_t(1) << (format.BitsStored - 1) : 0;
  const auto slope = static_cast<Number>(slice.Slope);
  const auto intercept = static_cast<Number>(slice.Intercept);
  const auto count = static_cast<std::size_t>(format.Pixels());
  const std::span<const std::byte> samples(frame.Samples);
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::uint32_t bits =
      ReadNumber(samples.subspan(frame.BytesOfSample * i, frame.BytesOfSample), false) >> shift &
      mask;
    const std::int64_t value = std::int64_t(bits) - (bits & sign ? std::int64_t(sign) * 2 : 0);
    to[i] = static_cast<TVoxel>(static_cast<Number>(value) * slope + intercept);
  }
}

void WarnOfLoss(const Volume& volume, Reading& reading)
{
  if (volume.IsLossy)
  {
    reading.Warnings.push_back("its voxels were compressed with loss, which makes wrong labels at "
                               "their borders: take the images from before, if there are any");
  }
}

void TakeLabels(const Volume& volume, Reading& reading)
{
  for (const DICOMSegment& segment : volume.Segments)
  {
    if (!segment.Entry.Name.empty())
    {
      reading.Labels.Entries[segment.Number] = segment.Entry;
    }
  }
  LeaveOutOtherTexts(reading.Labels, reading.Warnings);
}

bool IsZero(std::span<const std::byte> bytes)
{
  return std::all_of(
    bytes.begin(), bytes.end(), [](std::byte byte) { return byte == std::byte(0); });
}

/**
 * Takes away the slices that were put at the ends. A frame without a voxel at an end shows that its writer left out
 * nothing there. One farther in does not: dcmqi writes all slices between the first and the last of a segment.
 */
void TakeEndsAway(ScalarImage& image, const std::vector<DICOMSlice>& slices)
{
  const std::size_t size = image.NumberOfVoxels() / slices.size() * SizeOf(image.Type);
  auto* voxels = static_cast<std::byte*>(image.Scalars.get());
  std::copy_n(voxels + size, size * (slices.size() - 2), voxels);
  image.Dimensions[2] -= 2;
  image.Origin = slices[1].Position;
}

ScalarImage ReadVolume(Volume& volume, Reading& reading)
{
  ScalarImage image;
  const Vector3 step = ArrangeSlices(volume.Slices, volume.Stack, reading.Warnings);
  const DICOMSlice& first = volume.Slices.front();
  Place(image, { first.Row, first.Column, step }, first.Position);
  SetSizes(image,
    { std::int64_t(volume.Format.Columns), std::int64_t(volume.Format.Rows),
      static_cast<std::int64_t>(volume.Slices.size()) });
  image.Type = ChooseType(volume);
  const std::size_t bytesOfSlice =
    static_cast<std::size_t>(volume.Format.Pixels()) * SizeOf(image.Type);
  image.Scalars = reading.Allocate(bytesOfSlice * volume.Slices.size());
  reading.Files = volume.Files;
  auto* voxels = static_cast<std::byte*>(image.Scalars.get());

  const bool isFolder = volume.Files.size() > 1;
  std::unique_ptr<DICOMDataSet> data;
  std::unique_ptr<DICOMPixels> pixels;
  std::size_t open = volume.Files.size();
  for (std::size_t k = 0; k < volume.Slices.size(); ++k)
  {
    const DICOMSlice& slice = volume.Slices[k];
    const auto read = [&]
    {
      if (slice.File != open)
      {
        pixels.reset();
        data = std::make_unique<DICOMDataSet>(volume.Files[slice.File]);
        pixels = std::make_unique<DICOMPixels>(*data);
        open = slice.File;
        RefuseIf(pixels->Format() != volume.Format || slice.Frame >= pixels->Frames(),
          "it has changed while it was read");
      }
      const DICOMFrame frame = pixels->Read(slice.Frame);
      volume.IsLossy = volume.IsLossy || frame.IsLossy;
      Dispatch(image.Type,
        [&](auto zero)
        {
          Convert(frame, volume.Format, slice,
            reinterpret_cast<decltype(zero)*>(voxels + k * bytesOfSlice));
        });
    };
    if (slice.Frame == DICOMSlice::NoFrame)
    {
      std::fill_n(voxels + k * bytesOfSlice, bytesOfSlice, std::byte(0));
      continue;
    }
    isFolder ? Naming(volume.Files[slice.File], read) : read();
  }
  if (volume.Background != 0)
  {
    Dispatch(image.Type,
      [&](auto zero)
      {
        auto* scalars = static_cast<decltype(zero)*>(image.Scalars.get());
        std::replace(scalars, scalars + image.NumberOfVoxels(),
          static_cast<decltype(zero)>(volume.Background), zero);
      });
  }
  if (volume.Stack == DICOMStack::LabelMap &&
    (IsZero({ voxels + bytesOfSlice, bytesOfSlice }) ||
      IsZero({ voxels + (volume.Slices.size() - 2) * bytesOfSlice, bytesOfSlice })))
  {
    TakeEndsAway(image, volume.Slices);
  }
  WarnOfLoss(volume, reading);
  TakeLabels(volume, reading);
  return image;
}

/** Whether voxels of a frame are in its segment. */
std::vector<std::uint8_t> AboveThreshold(
  const DICOMFrame& frame, const DICOMPixelFormat& format, double threshold)
{
  std::array<std::uint8_t, 256> isAbove{};
  const unsigned shift = format.HighBit + 1 - format.BitsStored;
  const unsigned mask = (1U << format.BitsStored) - 1;
  for (unsigned byte = 0; byte < isAbove.size(); ++byte)
  {
    isAbove[byte] = (byte >> shift & mask) > threshold;
  }
  std::vector<std::uint8_t> result(frame.Samples.size());
  std::transform(frame.Samples.begin(), frame.Samples.end(), result.begin(),
    [&isAbove](std::byte sample) { return isAbove[std::to_integer<std::size_t>(sample)]; });
  return result;
}

/** Of segments with frames of their own, which may overlap. */
ScalarImage ReadSegments(Volume& volume, Reading& reading)
{
  ScalarImage image;
  std::vector<DICOMSlice> slices = volume.Slices;
  const Vector3 step = ArrangeSlices(slices, volume.Stack, reading.Warnings);
  Place(image, { slices.front().Row, slices.front().Column, step }, slices.front().Position);
  SetSizes(image,
    { std::int64_t(volume.Format.Columns), std::int64_t(volume.Format.Rows),
      static_cast<std::int64_t>(slices.size()) });

  MaskUnion segments(image, reading.Allocate, "segments");
  std::map<unsigned, std::uint32_t> numbers;
  for (const DICOMSegment& segment : volume.Segments)
  {
    const std::string& name = segment.Entry.Name;
    numbers[segment.Number] = segments.AddName(
      name.empty() ? "segment " + std::to_string(segment.Number) : name, segment.Number);
  }
  const DICOMDataSet data(volume.Files.front());
  const DICOMPixels pixels(data);
  const double threshold =
    FindThreshold(data, volume.Format.BitsStored, reading.Request.MaskThreshold);
  std::set<std::pair<unsigned, std::size_t>> known;
  bool areEndsInFile = false;
  std::stable_sort(volume.Slices.begin(), volume.Slices.end(),
    [](const DICOMSlice& a, const DICOMSlice& b) { return a.Segment < b.Segment; });
  for (const DICOMSlice& frame : volume.Slices)
  {
    const auto segment = numbers.find(frame.Segment);
    RefuseIf(segment == numbers.end(), frame.Name, " is of segment ", frame.Segment,
      ", which is not listed: correct its header");
    const std::size_t slice = FindSlice(slices, step, frame);
    RefuseIf(!known.insert({ frame.Segment, slice }).second, frame.Name,
      " is the second one of segment ", frame.Segment,
      " at its place: there are several images (times, copies), and one can be read: give the "
      "frames of one");
    const DICOMFrame read = pixels.Read(frame.Frame);
    volume.IsLossy = volume.IsLossy || read.IsLossy;
    const bool isAtEnd = slice == 1 || slice + 2 == slices.size();
    areEndsInFile = areEndsInFile || (isAtEnd && IsZero(read.Samples));
    segments.AddSlice(AboveThreshold(read, volume.Format, threshold), slice, segment->second);
  }
  WarnOfLoss(volume, reading);
  TakeLabels(volume, reading);
  image = segments.Finish(reading.Request.Rule, reading.Warnings);
  if (areEndsInFile)
  {
    TakeEndsAway(image, slices);
  }
  return image;
}

/** Files of a folder with one Series Instance UID. */
struct Series
{
  FileNames Files;
  bool HasImages = false;
  bool IsOfSegments = false; ///< a segmentation
};

using SeriesByUID = std::map<std::string, Series>;

void AddToSeries(SeriesByUID& series, const std::string& path)
{
  if (!IsDICOM(InputFile(path)))
  {
    RefuseIf(
      fs::path(path).extension() == ".dcm", "it is no DICOM file, or its beginning is damaged");
    return;
  }
  const DICOMDataSet data(path);
  const std::string uid = data.Text(SeriesUID);
  const bool hasPixels = data.Find(PixelData);
  if (uid.empty() && !hasPixels)
  {
    if (data.Text(MediaStorage) != Directory)
    {
      CheckObject(data);
    }
    return;
  }
  series[uid].Files.push_back(path);
  series[uid].HasImages = series[uid].HasImages || hasPixels;
  series[uid].IsOfSegments = series[uid].IsOfSegments || IsSegmentation(data);
}

/** Those of a folder that have images. */
SeriesByUID FindSeries(const std::string& path)
{
  FileNames files;
  std::error_code error;
  for (fs::directory_iterator entry(path, error), end; !error && entry != end;
       entry.increment(error))
  {
    std::error_code ignored;
    const fs::file_status status = entry->status(ignored);
    const bool isOther = fs::exists(status) && !fs::is_regular_file(status);
    if (!isOther &&
      !entry->path().filename().string().starts_with('.')) // those of macOS, and locks
    {
      files.push_back(entry->path().string());
    }
  }
  RefuseIf(static_cast<bool>(error), error.message());
  std::sort(files.begin(), files.end());
  SeriesByUID series;
  for (const std::string& name : files)
  {
    Naming(name, [&] { AddToSeries(series, name); });
  }
  const bool hasImages =
    std::any_of(series.begin(), series.end(), [](const auto& one) { return one.second.HasImages; });
  if (!series.empty() && !hasImages)
  {
    const std::string& other = series.begin()->second.Files.front();
    Naming(other, [&] { CheckObject(DICOMDataSet(other)); });
  }
  std::erase_if(series, [](const auto& one) { return !one.second.HasImages; });
  return series;
}

std::string ListSeries(const SeriesByUID& series)
{
  std::ostringstream list;
  for (const auto& [uid, one] : series)
  {
    list << "\n  SetSeriesUID(\"" << Excerpt(uid) << "\")  (" << one.Files.size() << " files)";
  }
  return list.str();
}

/** The one series of a folder, its one segmentation, or the one that the user asks for. */
FileNames ChooseSeries(
  const SeriesByUID& available, const std::string& wanted, std::vector<std::string>& warnings)
{
  RefuseIf(available.empty(),
    "the folder holds no DICOM images, no slices (.tif, .png), and no files that are named as "
    "masks are (.nii.gz, .nrrd)");
  if (const auto exact = available.find(wanted); exact != available.end() && !wanted.empty())
  {
    return exact->second.Files;
  }
  SeriesByUID matching;
  std::copy_if(available.begin(), available.end(), std::inserter(matching, matching.end()),
    [&wanted](const auto& one) { return one.first.starts_with(wanted); });
  RefuseIf(
    matching.empty(), "there is no DICOM series '", wanted, "'; there are", ListSeries(available));
  const auto isOfSegments = [](const auto& one) { return one.second.IsOfSegments; };
  if (wanted.empty() && matching.size() > 1 &&
    std::count_if(matching.begin(), matching.end(), isOfSegments) == 1)
  {
    const auto one = std::find_if(matching.begin(), matching.end(), isOfSegments);
    warnings.push_back("the folder holds " + std::to_string(matching.size()) +
      " DICOM series, and the one that is a segmentation was read ('" + Excerpt(one->first) +
      "'); SetSeriesUID() chooses another");
    return one->second.Files;
  }
  RefuseIf(matching.size() > 1, "the folder holds ", matching.size(),
    " DICOM series; choose one with", ListSeries(matching));
  return matching.begin()->second.Files;
}

} // namespace

ScalarImage ReadDICOMFile(const std::string& path, Reading& reading)
{
  Volume volume;
  volume.Format = AddFile(volume, path);
  return volume.Stack == DICOMStack::OfSegments ? ReadSegments(volume, reading)
                                                : ReadVolume(volume, reading);
}

ScalarImage ReadDICOMFolder(const std::string& path, Reading& reading)
{
  const FileNames files = ChooseSeries(FindSeries(path), reading.Request.Series, reading.Warnings);
  if (files.size() == 1)
  {
    return Naming(files[0], [&] { return ReadDICOMFile(files[0], reading); });
  }
  Volume volume;
  for (const std::string& name : files)
  {
    AddSlice(volume, name);
  }
  return ReadVolume(volume, reading);
}

} // namespace voxplex::io
