// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadMetaImage.h"

#include "Excerpt.h"
#include "FileError.h"
#include "InputFile.h"
#include "Placement.h"
#include "Reading.h"
#include "StoredVoxels.h"
#include "TextHeader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace voxplex::io
{
namespace
{

constexpr std::size_t TimeAxis = 3;
/** Header fields have few digits; a direction is taken for what it is meant to be up to this. */
constexpr double DirectionTolerance = 1e-5;

ScalarType TypeNamed(const std::string& name)
{
  static const std::map<std::string, ScalarType> types{
    { "MET_CHAR", ScalarType::Int8 },
    { "MET_UCHAR", ScalarType::UInt8 },
    { "MET_SHORT", ScalarType::Int16 },
    { "MET_USHORT", ScalarType::UInt16 },
    { "MET_INT", ScalarType::Int32 },
    { "MET_UINT", ScalarType::UInt32 },
    { "MET_LONG", ScalarType::Int32 }, // of four bytes on every machine
    { "MET_ULONG", ScalarType::UInt32 },
    { "MET_LONG_LONG", ScalarType::Int64 },
    { "MET_ULONG_LONG", ScalarType::UInt64 },
    { "MET_FLOAT", ScalarType::Float32 },
    { "MET_DOUBLE", ScalarType::Float64 },
  };
  const auto type = types.find(name);
  if (type == types.end())
  {
    throw FileError("its header gives the ElementType '" + Excerpt(name) +
      "', which is not a type of single numbers");
  }
  return type->second;
}

/** MetaImage's words for yes. */
bool IsTrue(const TextHeader& header, std::initializer_list<const char*> keys, bool missing)
{
  const std::string* text = header.FindAny(keys);
  return text ? text->find_first_of("Tt1") == 0 : missing;
}

/** How many axes count: those behind the third that are longer than 1. */
std::vector<std::int64_t> ReadSizes(const TextHeader& header, std::size_t axes)
{
  std::vector<std::int64_t> sizes = header.Wholes({ "dimsize" }, axes);
  if (sizes.empty())
  {
    throw FileError("its header does not give DimSize");
  }
  while (sizes.size() > 3 && sizes.back() == 1)
  {
    sizes.pop_back();
  }
  if (sizes.size() > TimeAxis + 1)
  {
    throw FileError("it has " + std::to_string(sizes.size()) +
      " dimensions; voxplex meshes images of three, and of four "
      "with time as the last: extract one of those first");
  }
  return sizes;
}

/** Numbers by axis, as many as the format says that there are. */
struct Geometry
{
  std::vector<double> Spacing;
  std::vector<double> Origin;
  std::vector<double> Directions; ///< of one axis after the other
};

Geometry ReadGeometry(const TextHeader& header, std::size_t axes, Reading& reading)
{
  Geometry geometry;
  geometry.Spacing = header.Numbers({ "elementspacing", "elementsize" }, axes);
  geometry.Origin = header.Numbers({ "offset", "position", "origin" }, axes);
  geometry.Directions =
    header.Numbers({ "transformmatrix", "rotation", "orientation" }, axes * axes);
  if (geometry.Spacing.empty())
  {
    geometry.Spacing.assign(axes, 1.0);
    reading.Warnings.push_back("its header gives no spacing of the voxels, which is taken to be 1; "
                               "set it with SetSpacing()");
  }
  geometry.Origin.resize(axes, 0.0);
  if (geometry.Directions.empty())
  {
    geometry.Directions.assign(axes * axes, 0.0);
    for (std::size_t axis = 0; axis < axes; ++axis)
    {
      geometry.Directions[axis * axes + axis] = 1.0;
    }
  }
  const bool isPositive = std::all_of(geometry.Spacing.begin(),
    geometry.Spacing.begin() + std::min<std::ptrdiff_t>(3, static_cast<std::ptrdiff_t>(axes)),
    [](double spacing) { return spacing > 0 && std::isfinite(spacing); });
  if (!isPositive)
  {
    throw FileError("the voxel spacing in its header is '" +
      Excerpt(*header.FindAny({ "elementspacing", "elementsize" })) +
      "'; it must be a positive length along each axis: correct the header");
  }
  return geometry;
}

void PlaceImage(const Geometry& geometry, std::size_t axes, ScalarImage& image)
{
  std::array<Vector3, 3> steps{ { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
  Vector3 origin{};
  for (std::size_t axis = 0; axis < std::min<std::size_t>(axes, 3); ++axis)
  {
    origin[axis] = geometry.Origin[axis];
    for (std::size_t row = 0; row < std::min<std::size_t>(axes, 3); ++row)
    {
      steps[axis][row] = geometry.Spacing[axis] * geometry.Directions[axis * axes + row];
    }
  }
  Place(image, steps, origin);
}

void AdoptTimes(
  const TextHeader& header, const Geometry& geometry, std::size_t axes, ScalarImage& image)
{
  bool isApart = true;
  for (std::size_t axis = 0; axis < TimeAxis; ++axis)
  {
    isApart = isApart &&
      std::abs(geometry.Directions[axis * axes + TimeAxis]) < DirectionTolerance &&
      std::abs(geometry.Directions[TimeAxis * axes + axis]) < DirectionTolerance;
  }
  if (!isApart)
  {
    throw FileError("its direction matrix mixes time with space; only images whose frames each "
                    "show one time can be meshed: "
                    "correct the header, or resample the image");
  }
  if (geometry.Directions[TimeAxis * axes + TimeAxis] < 0)
  {
    throw FileError("its time runs backwards: reverse the frames, or correct the header");
  }
  const double step = geometry.Spacing[TimeAxis];
  if (!(step > 0) || !std::isfinite(step) || !std::isfinite(geometry.Origin[TimeAxis]))
  {
    throw FileError("the time from frame to frame in its header is '" +
      Excerpt(header.Word({ "elementspacing", "elementsize" }, "")) +
      "'; it must be a positive number: correct the header");
  }
  image.TimeSpacing = step;
  image.TimeOrigin = geometry.Origin[TimeAxis];
}

StoredVoxels FindVoxels(const TextHeader& header, const Reading& reading)
{
  StoredVoxels stored;
  if (IsTrue(header, { "compresseddata" }, false))
  {
    stored.Coding = Encoding::Deflate;
  }
  else if (!IsTrue(header, { "binarydata" }, true))
  {
    stored.Coding = Encoding::Text;
  }
  stored.IsBigEndian = IsTrue(header, { "elementbyteordermsb", "binarydatabyteordermsb" }, false);
  const std::string* file = header.Find("elementdatafile");
  if (!file)
  {
    throw FileError("its header does not give ElementDataFile");
  }
  header.SetFiles(file, reading.DataFilesAnywhere, stored);
  if (header.Whole({ "compresseddatasize" }, 0) < 0)
  {
    throw FileError("its header gives a CompressedDataSize below 0: correct the header");
  }
  const std::int64_t headerSize = header.Whole({ "headersize" }, 0);
  if (headerSize < StoredVoxels::FromTheEnd ||
    (headerSize == StoredVoxels::FromTheEnd && stored.Coding != Encoding::Raw))
  {
    throw FileError("its header gives the HeaderSize " + std::to_string(headerSize) +
      ", which is none: correct the header");
  }
  if (headerSize > 0)
  {
    stored.Offset = headerSize; // of the file with the voxels
  }
  else if (headerSize == StoredVoxels::FromTheEnd)
  {
    stored.BytesToSkip = StoredVoxels::FromTheEnd;
  }
  return stored;
}

} // namespace

bool IsMetaImage(const InputFile& file)
{
  constexpr std::size_t length = 8192;
  const std::string text = file.Beginning(length);
  for (std::size_t at = 0; at < text.size();)
  {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::size_t separator = text.find_first_of("=:", at);
    if (separator < end &&
      Words(text.substr(at, separator - at)) == std::vector<std::string>{ "NDims" })
    {
      return true;
    }
    at = end + 1;
  }
  return false;
}

ScalarImage ReadMetaImage(const std::string& path, Reading& reading)
{
  const InputFile file(path);
  const TextHeader header(file);
  if (const std::string object = header.Word({ "objecttype" }, "image"); object != "image")
  {
    throw FileError(
      "it is a MetaIO file of the ObjectType '" + Excerpt(object) + "', and no image");
  }
  const std::int64_t axes = header.Whole({ "ndims" }, 0);
  constexpr std::int64_t most = 10; // which MetaImage has
  if (axes < 1 || axes > most)
  {
    throw FileError(
      "its header gives " + std::to_string(axes) + " dimensions, and the format has 1 to 10");
  }
  const std::int64_t channels = header.Whole({ "elementnumberofchannels" }, 1);
  if (channels != 1)
  {
    throw FileError("it has " + std::to_string(channels) +
      " components a voxel (colours or vectors); a label image has one: "
      "export it as a label map first, or, if they are time frames, as an image of four "
      "dimensions");
  }
  const auto count = static_cast<std::size_t>(axes);
  ScalarImage image;
  const std::string* type = header.Find("elementtype");
  image.Type = TypeNamed(type ? *type : "");
  SetSizes(image, ReadSizes(header, count));
  const Geometry geometry = ReadGeometry(header, count, reading);
  PlaceImage(geometry, count, image);
  if (image.Frames > 1)
  {
    AdoptTimes(header, geometry, count, image);
  }
  WarnOfLengths(
    header.Word({ "distanceunits" }, "") == "?" ? "" : header.Word({ "distanceunits" }, ""),
    reading);
  ReadVoxels(FindVoxels(header, reading), image, reading);
  return image;
}

} // namespace voxplex::io
