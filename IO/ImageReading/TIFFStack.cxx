// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "TIFFStack.h"

#include "FileError.h"
#include "OMEMetadata.h"
#include "Text.h"
#include "Units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

namespace voxplex::io
{
namespace
{

// --- Fields of a description

template <typename T>
T ParseNumber(std::string_view name, std::string_view text)
{
  const std::optional<T> value = ToNumber<T>(text);
  RefuseIf(!value, "its description has '", Excerpt(text), "' for ", name,
    ", which is no such number: correct it");
  return *value;
}

std::string FindText(const TextFields& fields, std::string_view name)
{
  return std::string(Trim(TextOf(fields, name)));
}

/** Empty if the field is missing. @throws FileError if it is no number */
template <typename T>
std::optional<T> FindNumber(const TextFields& fields, std::string_view name)
{
  const std::string text = FindText(fields, name);
  return text.empty() ? std::nullopt : std::optional(ParseNumber<T>(name, text));
}

std::int64_t CheckCount(std::string_view name, std::int64_t count)
{
  RefuseIf(count < 1 || count > std::numeric_limits<std::int32_t>::max(), "its description has ",
    count, " for ", name, ": correct it");
  return count;
}

/** 1 if the field is missing. */
std::int64_t FindCount(const TextFields& fields, std::string_view name)
{
  return CheckCount(name, FindNumber<std::int64_t>(fields, name).value_or(1));
}

/** Lines such as "slices=12". */
TextFields ParseLines(const std::string& description)
{
  TextFields fields;
  for (const std::string& line : Split(description, '\n'))
  {
    const std::size_t equals = line.find('=');
    if (equals != std::string::npos)
    {
      fields.emplace(Trim(line.substr(0, equals)), line.substr(equals + 1));
    }
  }
  return fields;
}

// --- The size of voxels

/** What a description says of the lengths along each axis; empty where it says nothing. */
struct VoxelSize
{
  std::array<std::optional<double>, 3> Length;
  std::array<std::string, 3> Unit;
};

/** All lengths will have the unit of the first axis. */
void SetSpacing(TIFFStack& stack, const VoxelSize& size, Reading& reading)
{
  const auto isKnown = [](const std::optional<double>& length) { return length.has_value(); };
  const auto isOne = [](const std::optional<double>& length)
  { return length.value_or(1.0) == 1.0; };
  const auto first = std::find_if(size.Length.begin(), size.Length.end(), isKnown);
  const bool hasUnit = std::any_of(size.Unit.begin(), size.Unit.end(), IsUnitOfLength);
  if (first == size.Length.end() ||
    (!hasUnit && std::all_of(size.Length.begin(), size.Length.end(), isOne)))
  {
    reading.SpacingGuesses.push_back(
      "it does not say how large its voxels are (the resolution of a TIFF file is that of a "
      "print), and they are taken to be 1 x 1 x 1: give their size with SetSpacing()");
    return;
  }
  std::array<std::string, 3> units = size.Unit;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    if (!size.Length[axis])
    {
      units[axis] = size.Unit[static_cast<std::size_t>(first - size.Length.begin())];
      reading.SpacingGuesses.push_back(
        std::string("it does not say how large its voxels are along ") + "xyz"[axis] +
        ", which is taken to be 1: give their size with SetSpacing()");
    }
  }
  const Vector3 factors = ToUnitOfFirst(units, reading);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    stack.Spacing[axis] = size.Length[axis].value_or(1.0) * factors[axis];
  }
  if (IsUnitOfLength(units[0]))
  {
    WarnOfLengths(units[0], reading);
  }
  else
  {
    reading.Warnings.push_back("its lengths have no unit, and the mesh has the same numbers");
  }
}

void SetTimeStep(
  TIFFStack& stack, std::optional<double> step, const std::string& unit, Reading& reading)
{
  if (stack.Frames == 1)
  {
    return;
  }
  if (!step || *step == 0)
  {
    reading.Warnings.push_back(
      "it does not give the time from frame to frame, which is taken to be 1; use "
      "SetTimeScale() to weigh time against space");
    return;
  }
  constexpr double largest = 1e12;
  RefuseIf(!(*step > 0 && *step < largest), "its description has ", *step,
    " for the time from frame to frame, which must be a positive number: correct it");
  stack.TimeStep = *step;
  WarnOfTimes(unit, reading);
}

// --- The order of pages

/** An axis along which pages follow each other. */
struct PageAxis
{
  std::string
    Name; ///< in the plural, as messages have it; those of a label image are the two below
  std::int64_t Length;
};

constexpr const char* Slices = "slices";
constexpr const char* Frames = "frames";

/** From a name such as programs write. */
PageAxis NameAxis(const std::string& name, std::int64_t length)
{
  if (name == "Z")
  {
    return { Slices, length };
  }
  if (name == "T" || name == "Time")
  {
    return { Frames, length };
  }
  const bool isChannel = name == "C" || name == "Channel";
  return { isChannel ? "channels" : "pages along its axis '" + Excerpt(name) + "'", length };
}

std::string Describe(const std::vector<PageAxis>& axes)
{
  std::string text;
  for (const PageAxis& axis : axes)
  {
    if (axis.Length > 1)
    {
      text += (text.empty() ? "" : " x ") + std::to_string(axis.Length) + " " + axis.Name;
    }
  }
  return text.empty() ? "1 page" : text;
}

/** How many pages these axes have, or another number above `most`. */
std::int64_t CountPages(const std::vector<PageAxis>& axes, std::int64_t most)
{
  std::int64_t product = 1;
  for (const PageAxis& axis : axes)
  {
    product = product > most ? product : product * axis.Length; // fits: both have 31 bits
  }
  return product;
}

/** @param axes the fastest first. @throws FileError if they are not those of a label image with so many pages */
void NumberPages(TIFFStack& stack, const std::vector<PageAxis>& axes, std::int64_t pages)
{
  for (const PageAxis& axis : axes)
  {
    RefuseIf(axis.Name != Slices && axis.Name != Frames && axis.Length > 1, "it has ", axis.Length,
      " ", axis.Name,
      "; a label image has one number a voxel: save what holds the labels by itself");
  }
  RefuseIf(CountPages(axes, pages) != pages, "its description says ", Describe(axes),
    ", and the file has ", pages, " pages: save it again with the program that wrote it");
  std::int64_t sliceStep = 0;
  std::int64_t frameStep = 0;
  std::int64_t step = 1;
  for (const PageAxis& axis : axes)
  {
    if (axis.Length > 1)
    {
      (axis.Name == Slices ? stack.Slices : stack.Frames) = axis.Length;
      (axis.Name == Slices ? sliceStep : frameStep) = step;
      step *= axis.Length;
    }
  }
  for (std::int64_t frame = 0; frame < stack.Frames; ++frame)
  {
    for (std::int64_t slice = 0; slice < stack.Slices; ++slice)
    {
      stack.Pages.push_back(static_cast<std::size_t>(slice * sliceStep + frame * frameStep));
    }
  }
}

/** How many pages there are. One directory is enough if all follow each other. @throws FileError if they end before */
std::int64_t FindPages(TIFFStack& stack, const TIFFPages& pages, std::int64_t claimed)
{
  if (pages.Count() > 1 || claimed <= 1)
  {
    return pages.Count();
  }
  RefuseIf(claimed > pages.Contiguous, "it is truncated or damaged: its description says ", claimed,
    " pages, and it holds ", pages.Contiguous);
  stack.IsContiguous = true;
  return claimed;
}

// --- ImageJ

/** Numbers of grey that are not those that are stored. */
void ReadGreyCalibration(
  TIFFStack& stack, const TIFFPages& pages, const TextFields& fields, Reading& reading)
{
  const std::string function = FindText(fields, "cf");
  if (function.empty() || function == "20" || function == "21") // none
  {
    return;
  }
  const auto offset = FindNumber<double>(fields, "c0");
  const auto slope = FindNumber<double>(fields, "c1");
  const bool isStraight = function == "0" && slope == 1.0;
  stack.IsSignedWithOffset = isStraight && offset == -32768.0 && pages.IsUInt16;
  if (!stack.IsSignedWithOffset && !(isStraight && offset == 0.0))
  {
    reading.Warnings.push_back(
      "its calibration of grey values is not applied: labels are the numbers that are stored");
  }
}

/** Resolutions are voxels for the unit that the description names. That of the TIFF file means nothing then. */
VoxelSize FindVoxelSizeOfImageJ(const TIFFPages& pages, const TextFields& fields)
{
  VoxelSize size;
  const std::string unit = FindText(fields, "unit");
  const std::string ofY = FindText(fields, "yunit");
  const std::string ofZ = FindText(fields, "zunit");
  size.Unit = { unit, ofY.empty() ? unit : ofY, ofZ.empty() ? unit : ofZ };
  const bool isPrint = pages.HasUnit && !IsUnitOfLength(unit);
  if (!isPrint && pages.XResolution > 0)
  {
    size.Length[0] = 1.0 / pages.XResolution;
    size.Length[1] = 1.0 / (pages.YResolution > 0 ? pages.YResolution : pages.XResolution);
  }
  const double distance = FindNumber<double>(fields, "spacing").value_or(0.0);
  if (distance != 0)
  {
    size.Length[2] = std::abs(distance); // as ImageJ takes it
  }
  return size;
}

TIFFStack DescribeImageJ(const TIFFPages& pages, Reading& reading)
{
  TIFFStack stack;
  const TextFields fields = ParseLines(pages.Description);
  const std::int64_t images = FindPages(stack, pages, FindCount(fields, "images"));
  std::vector<PageAxis> axes{ { "channels", FindCount(fields, "channels") },
    { Slices, FindCount(fields, "slices") }, { Frames, FindCount(fields, "frames") } };
  if (CountPages(axes, 1) == 1)
  {
    axes[1].Length = images;
  }
  NumberPages(stack, axes, images);
  RefuseIf(FindText(fields, "inverty") == "true",
    "its y axis runs upwards (inverty=true), so that the mesh would be a mirror image: in ImageJ, "
    "clear 'Invert Y coordinates' and save it again");
  SetSpacing(stack, FindVoxelSizeOfImageJ(pages, fields), reading);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    if (const auto origin = FindNumber<double>(fields, std::string(1, "xyz"[axis]) + "origin"))
    {
      stack.Origin = stack.Origin.value_or(Vector3{});
      (*stack.Origin)[axis] = -*origin * stack.Spacing[axis]; // it is counted in voxels
    }
  }
  SetTimeStep(stack, FindNumber<double>(fields, "finterval"), FindText(fields, "tunit"), reading);
  ReadGreyCalibration(stack, pages, fields, reading);
  return stack;
}

// --- SCIFIO

/** A number of a list, or nothing if the list is shorter. */
std::optional<double> NumberAt(const std::vector<std::string>& list, std::size_t at)
{
  return at < list.size() && !list[at].empty()
    ? std::optional(ParseNumber<double>("scales", list[at]))
    : std::nullopt;
}

/** Lists such as axes=X,Y,Z,Time and scales=0.5,0.5,2,1. */
TIFFStack DescribeSCIFIO(const TIFFPages& pages, Reading& reading)
{
  const TextFields fields = ParseLines(pages.Description);
  const std::vector<std::string> names = Split(FindText(fields, "axes"), ',');
  const std::vector<std::string> lengths = Split(FindText(fields, "lengths"), ',');
  const std::vector<std::string> scales = Split(FindText(fields, "scales"), ',');
  const std::vector<std::string> units = Split(FindText(fields, "units"), ',');
  RefuseIf(names.size() < 2 || names[0] != "X" || names[1] != "Y" || lengths.size() != names.size(),
    "its SCIFIO description has the axes '", Excerpt(FindText(fields, "axes")),
    "' of the lengths '", Excerpt(FindText(fields, "lengths")), "', which are no stack of pages");
  std::vector<PageAxis> axes;
  VoxelSize size;
  std::optional<double> timeStep;
  std::string timeUnit;
  for (std::size_t a = 0; a < names.size(); ++a)
  {
    const std::string unit = a < units.size() ? units[a] : std::string();
    if (a < 2 || names[a] == "Z")
    {
      size.Length[std::min<std::size_t>(a, 2)] = NumberAt(scales, a);
      size.Unit[std::min<std::size_t>(a, 2)] = unit;
    }
    if (names[a] == "Time")
    {
      timeStep = NumberAt(scales, a);
      timeUnit = unit;
    }
    if (a >= 2)
    {
      axes.push_back(NameAxis(
        names[a], CheckCount("lengths", ParseNumber<std::int64_t>("lengths", lengths[a]))));
    }
  }
  TIFFStack stack;
  NumberPages(stack, axes, pages.Count());
  SetSpacing(stack, size, reading);
  SetTimeStep(stack, timeStep, timeUnit, reading);
  return stack;
}

// --- tifffile

/** The text between the first two of these letters after a key of JSON; or an empty string. */
std::string FindJSON(const std::string& text, const std::string& key, char first, char last)
{
  const std::size_t at = text.find('"' + key + "\":");
  const std::size_t begin = at == text.npos ? at : text.find(first, at + key.size() + 3);
  const std::size_t end = begin == text.npos ? begin : text.find(last, begin + 1);
  return end == text.npos ? std::string() : text.substr(begin + 1, end - begin - 1);
}

/**
 * The shape of an array, slowest axis first, perhaps with names of its axes:
 * {"axes": "TZYX", "shape": [2, 12, 30, 20]}. If there are none, one axis besides those of a page is that of slices. A
 * last axis may be that of samples, of which a page has one.
 */
TIFFStack DescribeTifffile(const TIFFPages& pages, Reading& reading)
{
  std::vector<std::string> shape = Split(FindJSON(pages.Description, "shape", '[', ']'), ',');
  std::string names = FindJSON(pages.Description, "axes", '"', '"');
  const std::array<std::string, 3> page{ std::to_string(pages.Length), std::to_string(pages.Width),
    "1" };
  if (shape.size() >= page.size() && std::equal(page.rbegin(), page.rend(), shape.rbegin()))
  {
    names.resize(names.size() == shape.size() ? names.size() - 1 : names.size());
    shape.pop_back();
  }
  std::vector<PageAxis> axes;
  for (std::size_t a = 0; a + 2 < shape.size(); ++a)
  {
    const std::int64_t length = CheckCount("shape", ParseNumber<std::int64_t>("shape", shape[a]));
    if (length > 1)
    {
      axes.insert(axes.begin(),
        NameAxis(names.size() == shape.size() ? names.substr(a, 1) : std::string(), length));
    }
  }
  if (axes.size() == 1 && names.empty())
  {
    axes[0].Name = Slices;
  }
  RefuseIf(axes.size() > 1 && names.empty(), "it is an array of ", shape.size(),
    " axes without names (", Excerpt(FindJSON(pages.Description, "shape", '[', ']')),
    "), which could be slices, frames or channels: write it with tifffile's metadata={'axes': "
    "'TZYX'}");
  TIFFStack stack;
  const std::int64_t count = FindPages(stack, pages, CountPages(axes, INT32_MAX));
  if (axes.empty()) // of each page by itself
  {
    axes.push_back({ Slices, count });
  }
  NumberPages(stack, axes, count);
  SetSpacing(stack, {}, reading);
  SetTimeStep(stack, {}, "", reading);
  return stack;
}

// --- OME

/** The name of another file that holds a part of the image; empty if there is none. */
std::string FindOtherFile(const OMEMetadata& metadata)
{
  if (!metadata.CompanionFile.empty())
  {
    return metadata.CompanionFile;
  }
  // A file may have been renamed: what counts is its UUID.
  const std::string own = metadata.File.empty() && !metadata.TiffData.empty()
    ? metadata.TiffData.front().File
    : metadata.File;
  for (const OMEMetadata::Planes& planes : metadata.TiffData)
  {
    if (Trim(planes.File) != Trim(own) && !planes.File.empty())
    {
      return planes.FileName.empty() ? planes.File : planes.FileName;
    }
  }
  return {};
}

/** The page of each plane, in the order of the planes. @throws FileError if it is not one for each */
std::vector<std::size_t> FindPagesOfPlanes(
  const OMEMetadata& metadata, const TIFFPages& pages, const TIFFStack& stack)
{
  const std::size_t none = pages.Directories.size();
  std::vector<std::size_t> found(pages.Directories.size(), none);
  bool isRight = true;
  for (const OMEMetadata::Planes& planes : metadata.TiffData)
  {
    const auto directory = FindNumber<std::uint32_t>(planes.Fields, "IFD");
    const auto slice = FindNumber<std::uint32_t>(planes.Fields, "FirstZ").value_or(0);
    const auto frame = FindNumber<std::uint32_t>(planes.Fields, "FirstT").value_or(0);
    isRight = isRight && slice < stack.Slices && frame < stack.Frames;
    const std::size_t first =
      isRight ? stack.Pages[static_cast<std::size_t>(frame * stack.Slices + slice)] : none;
    const std::size_t count = FindNumber<std::uint32_t>(planes.Fields, "PlaneCount")
                                .value_or(directory ? 1 : static_cast<std::uint32_t>(none - first));
    isRight = isRight && count <= none - first;
    for (std::size_t i = 0; isRight && i < count; ++i)
    {
      const auto page = std::lower_bound(
        pages.Directories.begin(), pages.Directories.end(), directory.value_or(0) + i);
      isRight = page != pages.Directories.end() && *page == directory.value_or(0) + i &&
        found[first + i] == none;
      found[first + i] = static_cast<std::size_t>(page - pages.Directories.begin());
    }
  }
  RefuseIf(!isRight || std::find(found.begin(), found.end(), none) != found.end(),
    "its OME metadata do not give one page to each slice and frame (TiffData): save it again with "
    "the program that wrote it");
  return found;
}

VoxelSize FindVoxelSizeOfOME(const TextFields& fields)
{
  VoxelSize size;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const std::string name = std::string("PhysicalSize") + "XYZ"[axis];
    const std::string unit = FindText(fields, name + "Unit");
    size.Length[axis] = FindNumber<double>(fields, name);
    size.Unit[axis] = unit.empty() && size.Length[axis] ? "um" : unit;
  }
  return size;
}

/** The axes of planes in their order, such as XYZCT. */
std::vector<PageAxis> FindAxesOfOME(const TextFields& fields)
{
  const std::string order = FindText(fields, "DimensionOrder");
  std::string sorted = order;
  std::sort(sorted.begin(), sorted.end());
  RefuseIf(sorted != "CTXYZ" || order.rfind("XY", 0) != 0,
    "its OME metadata have the DimensionOrder '", Excerpt(order),
    "', which must be XY and then Z, C and T in any order");
  std::vector<PageAxis> axes;
  for (const char axis : order.substr(2))
  {
    axes.push_back(NameAxis(std::string(1, axis), FindCount(fields, std::string("Size") + axis)));
  }
  return axes;
}

TIFFStack DescribeOME(const TIFFPages& pages, Reading& reading)
{
  const OMEMetadata metadata = ParseOMEMetadata(pages.Description);
  if (const std::string other = FindOtherFile(metadata); !other.empty())
  {
    Refuse("its OME metadata say that a part of the image is in another file, '", Excerpt(other),
      "': save the image as one file");
  }
  RefuseIf(metadata.Images != 1, "it holds ", metadata.Images,
    " images, by its OME metadata; a label image is one: save it by itself");
  const std::int64_t width = FindCount(metadata.Pixels, "SizeX");
  const std::int64_t length = FindCount(metadata.Pixels, "SizeY");
  RefuseIf(width != pages.Width || length != pages.Length, "its OME metadata say ", width, " x ",
    length, " voxels a page, and its pages have ", pages.Width, " x ", pages.Length,
    ": save it again with the program that wrote it");
  TIFFStack stack;
  NumberPages(stack, FindAxesOfOME(metadata.Pixels), pages.Count());
  if (!metadata.TiffData.empty())
  {
    const std::vector<std::size_t> found = FindPagesOfPlanes(metadata, pages, stack);
    for (std::size_t& page : stack.Pages)
    {
      page = found[page];
    }
  }
  SetSpacing(stack, FindVoxelSizeOfOME(metadata.Pixels), reading);
  SetTimeStep(stack, FindNumber<double>(metadata.Pixels, "TimeIncrement"),
    FindText(metadata.Pixels, "TimeIncrementUnit"), reading);
  return stack;
}

// --- All of them

TIFFStack DescribeAny(const TIFFPages& pages, Reading& reading)
{
  const std::string& description = pages.Description;
  if (description.rfind("ImageJ=", 0) == 0)
  {
    return DescribeImageJ(pages, reading);
  }
  if (description.rfind("SCIFIO=", 0) == 0)
  {
    return DescribeSCIFIO(pages, reading);
  }
  if (description.rfind("{", 0) == 0 && !FindJSON(description, "shape", '[', ']').empty())
  {
    return DescribeTifffile(pages, reading);
  }
  if (IsOMEMetadata(description))
  {
    return DescribeOME(pages, reading);
  }
  TIFFStack stack;
  NumberPages(stack, { { Slices, pages.Count() } }, pages.Count());
  SetSpacing(stack, {}, reading);
  return stack;
}

} // namespace

TIFFStack DescribeStack(const TIFFPages& pages, Reading& reading)
{
  TIFFStack stack = DescribeAny(pages, reading);
  RefuseIf(stack.Slices == 1 && stack.Frames == 1,
    "it is a picture of one slice, and a label image has several: give a volume (TIFF with a page "
    "for each slice, NRRD, NIfTI, MetaImage, DICOM, ...)");
  RefuseIf(stack.Slices == 1, "its description says that its ", stack.Frames,
    " pages are frames in time, of one slice each, and a label image has several slices: if they "
    "are slices, say so where it was written (in ImageJ: Image > Properties)");
  return stack;
}

} // namespace voxplex::io
