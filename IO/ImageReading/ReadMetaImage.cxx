// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Readers.h"

#include "Placement.h"
#include "StoredVoxels.h"
#include "Text.h"
#include "TextHeader.h"
#include "Units.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace voxplex::io
{
namespace
{

constexpr std::size_t TimeAxis = 3;
/** Header fields have few digits; a direction is taken for what it is meant to be up to this. */
constexpr double DirectionTolerance = 1e-5;

constexpr TypeNames Types{ "|MET_CHAR|", "|MET_UCHAR|", "|MET_SHORT|", "|MET_USHORT|",
  "|MET_INT|MET_LONG|", "|MET_UINT|MET_ULONG|", // of four bytes on every machine
  "|MET_LONG_LONG|", "|MET_ULONG_LONG|", "|MET_FLOAT|", "|MET_DOUBLE|" };

/** MetaImage's words for yes. */
bool IsTrue(const TextHeader& header, std::initializer_list<const char*> keys, bool missing)
{
  const std::string* text = header.FindAny(keys);
  return text ? text->find_first_of("Tt1") == 0 : missing;
}

/** Numbers by axis, as many as the format says that there are. */
struct Geometry
{
  std::vector<double> Spacing;
  std::vector<double> Origin;
  std::vector<double> Directions; ///< of one axis after the other
  std::string Shown;              ///< the spacing as messages show it
};

Geometry ReadGeometry(const TextHeader& header, std::size_t axes, Reading& reading)
{
  Geometry geometry;
  geometry.Spacing = header.Numbers({ "elementspacing", "elementsize" }, axes);
  geometry.Shown = header.Shown({ "elementspacing", "elementsize" });
  geometry.Origin = header.Numbers({ "offset", "position", "origin" }, axes);
  geometry.Directions =
    header.Numbers({ "transformmatrix", "rotation", "orientation" }, axes * axes);
  if (geometry.Spacing.empty())
  {
    geometry.Spacing.assign(axes, 1.0);
    WarnOfSpacing(reading);
  }
  if (geometry.Origin.empty())
  {
    geometry.Origin.assign(axes, 0.0);
    reading.HasPlace = false;
  }
  if (geometry.Directions.empty())
  {
    geometry.Directions.assign(axes * axes, 0.0);
    for (std::size_t axis = 0; axis < axes; ++axis)
    {
      geometry.Directions[axis * axes + axis] = 1.0;
    }
  }
  return geometry;
}

void PlaceImage(const Geometry& geometry, std::size_t axes, ScalarImage& image)
{
  std::array<Vector3, 3> steps{ { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
  Vector3 origin{};
  for (std::size_t axis = 0; axis < std::min<std::size_t>(axes, 3); ++axis)
  {
    const double spacing = geometry.Spacing[axis];
    CheckSpacing(spacing > 0 && std::isfinite(spacing), geometry.Shown);
    origin[axis] = geometry.Origin[axis];
    for (std::size_t row = 0; row < std::min<std::size_t>(axes, 3); ++row)
    {
      steps[axis][row] = spacing * geometry.Directions[axis * axes + row];
    }
  }
  Place(image, steps, origin);
}

void AdoptTimes(const Geometry& geometry, std::size_t axes, ScalarImage& image)
{
  for (std::size_t axis = 0; axis < TimeAxis; ++axis)
  {
    CheckTimeIsApart(std::abs(geometry.Directions[axis * axes + TimeAxis]) < DirectionTolerance &&
      std::abs(geometry.Directions[TimeAxis * axes + axis]) < DirectionTolerance);
  }
  RefuseIf(geometry.Directions[TimeAxis * axes + TimeAxis] < 0,
    "its time runs backwards: reverse the frames, or correct the header");
  SetTimeStep(image, geometry.Origin[TimeAxis], geometry.Spacing[TimeAxis], geometry.Shown);
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
  RefuseIf(!file, "its header does not give ElementDataFile");
  header.SetFiles(file, reading.Request.DataFilesAnywhere, stored);
  RefuseIf(header.Whole({ "compresseddatasize" }, 0) < 0,
    "its header gives a CompressedDataSize below 0: correct the header");
  const std::int64_t headerSize = header.Whole({ "headersize" }, 0);
  RefuseIf(headerSize < StoredVoxels::FromTheEnd ||
      (headerSize == StoredVoxels::FromTheEnd && stored.Coding != Encoding::Raw),
    "its header gives the HeaderSize ", headerSize, ", which is none: correct the header");
  RefuseIf(headerSize > 0 && headerSize < stored.Offset, "its header gives the HeaderSize ",
    headerSize, ", and is ", stored.Offset, " bytes long itself: correct the header");
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
    if (separator < end && Trim(std::string_view(text).substr(at, separator - at)) == "NDims")
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
    Refuse("it is a MetaIO file of the ObjectType '", Excerpt(object), "', and no image");
  }
  const std::int64_t axes = header.Whole({ "ndims" }, 0);
  constexpr std::int64_t most = 10; // which MetaImage has
  RefuseIf(
    axes < 1 || axes > most, "its header gives ", axes, " dimensions, and the format has 1 to 10");
  const std::int64_t channels = header.Whole({ "elementnumberofchannels" }, 1);
  RefuseIf(channels != 1, "it has ", channels,
    " components a voxel (colours or vectors); a label image has one: export it as a label map "
    "first, or, if they are time frames, as an image of four dimensions");
  const auto count = static_cast<std::size_t>(axes);
  ScalarImage image;
  const std::string* type = header.Find("elementtype");
  image.Type = TypeNamed(type ? *type : "", "ElementType", Types);
  const std::vector<std::int64_t> sizes = header.Wholes({ "dimsize" }, count);
  RefuseIf(sizes.empty(), "its header does not give DimSize");
  SetSizes(image, sizes);
  const Geometry geometry = ReadGeometry(header, count, reading);
  PlaceImage(geometry, count, image);
  if (image.Frames > 1)
  {
    AdoptTimes(geometry, count, image);
  }
  const std::string unit = header.Word({ "distanceunits" }, "?");
  WarnOfLengths(unit == "?" ? "" : unit, reading);
  ReadVoxels(FindVoxels(header, reading), image, reading);
  return image;
}

} // namespace voxplex::io
