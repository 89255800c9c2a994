// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Readers.h"

#include "Fields.h"
#include "Placement.h"
#include "StoredVoxels.h"
#include "Units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace voxplex::io
{
namespace
{

constexpr std::size_t SizeOfGIPL = 256;
constexpr std::size_t SizeOfMRC = 1024;
constexpr std::size_t SizeOfMGH = 284;

[[noreturn]] void RefuseType(const char* what, std::int64_t code)
{
  Refuse("its header gives the ", what, ' ', code,
    ", which is not a type of single numbers that is read");
}

ScalarType TypeOfGIPL(std::int64_t code)
{
  using enum ScalarType;
  static const std::map<std::int64_t, ScalarType> types{ { 7, Int8 }, { 8, UInt8 }, { 15, Int16 },
    { 16, UInt16 }, { 31, UInt32 }, { 32, Int32 }, { 64, Float32 }, { 65, Float64 } };
  const auto type = types.find(code);
  if (type == types.end())
  {
    RefuseType("image type", code);
  }
  return type->second;
}

ScalarType TypeOfMGH(std::int64_t code)
{
  using enum ScalarType;
  static const std::map<std::int64_t, ScalarType> types{ { 0, UInt8 }, { 1, Int32 }, { 3, Float32 },
    { 4, Int16 }, { 10, UInt16 } };
  const auto type = types.find(code);
  if (type == types.end())
  {
    RefuseType("type", code);
  }
  return type->second;
}

/** The header has the directions of the axes, and the place of the middle of the image. */
void PlaceMGH(const Fields& fields, ScalarImage& image, Reading& reading)
{
  constexpr std::array<double, 3> signs{ -1.0, -1.0, 1.0 }; // from RAS
  constexpr std::array<double, 9> coronal{ -1, 0, 0, 0, 0, -1, 0, 1, 0 };
  const bool saysWhere = fields.Get<std::int16_t>(28) > 0;
  Vector3 origin{};
  std::array<Vector3, 3> steps{};
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const double spacing = saysWhere ? fields.Get<float>(30 + 4 * axis) : 1.0;
    CheckSpacing(spacing > 0 && std::isfinite(spacing), "the size of its voxels");
    for (std::size_t row = 0; row < 3; ++row)
    {
      const std::size_t at = 3 * axis + row;
      steps[axis][row] =
        signs[row] * spacing * (saysWhere ? fields.Get<float>(42 + 4 * at) : coronal[at]);
    }
  }
  for (std::size_t row = 0; row < 3; ++row)
  {
    origin[row] = saysWhere ? signs[row] * fields.Get<float>(78 + 4 * row) : 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      origin[row] -= steps[axis][row] * image.Dimensions[axis] / 2.0;
    }
  }
  Place(image, steps, origin);
  if (!saysWhere)
  {
    reading.HasPlace = false;
    reading.SpacingGuesses.push_back(
      "its header does not say where the image lies: coronal slices of "
      "voxels of 1 mm were taken, as FreeSurfer does; set their size with "
      "SetSpacing()");
  }
}

bool IsBigEndianMRC(const std::string& bytes)
{
  constexpr char bigEndian = 0x11;
  constexpr char littleEndian = 0x44;
  const char stamp = bytes[212];
  constexpr std::int32_t most = 127; // of the modes
  const std::int32_t mode = Fields(bytes, false).Get<std::int32_t>(12);
  return stamp == bigEndian || (stamp != littleEndian && (mode < 0 || mode > most));
}

bool IsOfIMOD(const Fields& fields)
{
  constexpr std::int32_t stamp = 1146047817;
  return fields.Get<std::int32_t>(152) == stamp;
}

/** Bytes of mode 0 are signed, but those that IMOD wrote before it said so. */
ScalarType TypeOfMRC(const Fields& fields)
{
  switch (const std::int32_t mode = fields.Get<std::int32_t>(12))
  {
    case 0:
      return IsOfIMOD(fields) && (fields.Get<std::int32_t>(156) & 1) == 0 ? ScalarType::UInt8
                                                                          : ScalarType::Int8;
    case 1:
      return ScalarType::Int16;
    case 2:
      return ScalarType::Float32;
    case 6:
      return ScalarType::UInt16;
    default:
      RefuseType("mode", mode);
  }
}

/** ITK and others before 2014 mean numbers up to 255 by mode 0, and do not say so; IMOD means them less 128. */
void WarnOfNegativeBytes(const Fields& fields, const ScalarImage& image, Reading& reading)
{
  constexpr std::int32_t firstThatSaysSo = 20140;
  const auto* const bytes = static_cast<const std::int8_t*>(image.Scalars.get());
  if (image.Type != ScalarType::Int8 ||
    std::none_of(
      bytes, bytes + image.NumberOfVoxels(), [](std::int8_t voxel) { return voxel < 0; }))
  {
    return;
  }
  if (IsOfIMOD(fields))
  {
    reading.Warnings.push_back(
      "it has negative voxels (mode 0), in which IMOD stores numbers from 0 to 255 less 128: "
      "if labels are negative, save it with mode 6 (newstack -mode 6)");
  }
  else if (fields.Get<std::int32_t>(108) < firstThatSaysSo)
  {
    reading.Warnings.push_back("it has negative voxels (mode 0), by which the program that wrote "
                               "it may have meant numbers from 128 to 255");
  }
}

void PlaceMRC(const Fields& fields, ScalarImage& image, Reading& reading)
{
  Vector3 origin{};
  Vector3 spacing{};
  std::array<std::size_t, 3> axes{};
  std::array<std::int32_t, 3> sizes{};
  std::array<std::int32_t, 3> intervals{};
  bool hasOrigin = false;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const std::int32_t axis =
      fields.Get<std::int32_t>(64 + 4 * i); // of columns, rows, sections: 1 to 3
    axes[i] = axis == 0 ? i : static_cast<std::size_t>(axis - 1);
    origin[i] = fields.Get<float>(196 + 4 * i);
    hasOrigin = hasOrigin || origin[i] != 0;
    sizes[i] = fields.Get<std::int32_t>(4 * i);
    intervals[i] = fields.Get<std::int32_t>(28 + 4 * i);
    RefuseIf(intervals[i] <= 0, "its header gives ", intervals[i],
      " for the sampling of its cell: correct the header");
    spacing[i] = fields.Get<float>(40 + 4 * i) / static_cast<double>(intervals[i]);
    const float angle = fields.Get<float>(52 + 4 * i);
    RefuseIf(angle != 90.0F && angle != 0.0F, "its cell is not rectangular (angles of ", angle,
      "): resample it");
  }
  RefuseIf(axes[0] + axes[1] + axes[2] != 3 || std::max({ axes[0], axes[1], axes[2] }) > 2 ||
      axes[0] == axes[1],
    "its header does not say which axes columns, rows and sections run along");
  const std::array alongFile{ intervals[axes[0]], intervals[axes[1]], intervals[axes[2]] };
  RefuseIf(intervals == sizes && alongFile != sizes,
    "its header contradicts itself: the sampling of its cell (MX, MY, MZ) is that of columns, rows "
    "and sections, which run along other axes (MAPC, MAPR, MAPS): correct one of them");
  if (spacing == Vector3{}) // what mrcfile writes, if it is not told
  {
    spacing = { 1.0, 1.0, 1.0 };
    WarnOfSpacing(reading);
  }
  std::array<Vector3, 3> steps{};
  for (std::size_t i = 0; i < 3; ++i)
  {
    RefuseIf(!(spacing[axes[i]] > 0),
      "the size of its cell is not positive in its header: correct the header");
    steps[i][axes[i]] = spacing[axes[i]];
    if (!hasOrigin)
    {
      origin[axes[i]] = fields.Get<std::int32_t>(16 + 4 * i) * spacing[axes[i]];
    }
  }
  Place(image, steps, origin);
}

} // namespace

bool IsGIPL(const InputFile& file)
{
  const std::string bytes = UnpackBeginning(file, SizeOfGIPL);
  const std::uint32_t magic =
    bytes.size() < SizeOfGIPL ? 0 : Fields(bytes, true).Get<std::uint32_t>(252);
  return magic == 0xEFFFE9B0U || magic == 0x2AE389B8U;
}

ScalarImage ReadGIPL(const std::string& path, Reading& reading)
{
  const InputFile file(path);
  const std::string bytes = UnpackBeginning(file, SizeOfGIPL);
  const Fields fields(bytes, true);
  ScalarImage image;
  image.Type = TypeOfGIPL(fields.Get<std::uint16_t>(8));
  std::vector<std::int64_t> sizes;
  Vector3 spacing{};
  Vector3 origin{};
  for (std::size_t i = 0; i < 4; ++i)
  {
    sizes.push_back(fields.Get<std::uint16_t>(2 * i));
    if (i < 3)
    {
      spacing[i] = fields.Get<float>(10 + 4 * i);
      origin[i] = fields.Get<double>(204 + 8 * i);
    }
  }
  if (sizes[3] <= 1)
  {
    sizes.pop_back();
  }
  SetSizes(image, sizes);
  PlaceAlongAxes(image, spacing, origin);
  if (image.Frames > 1)
  {
    const double step = fields.Get<float>(22);
    image.TimeSpacing = step > 0 && std::isfinite(step) ? step : 1.0;
    const double first = fields.Get<double>(228);
    image.TimeOrigin = std::isfinite(first) ? first : 0.0;
  }

  StoredVoxels stored;
  stored.IsBigEndian = true;
  stored.Files = { path };
  stored.Coding = file.Beginning(2) == "\x1f\x8b" ? Encoding::Deflate : Encoding::Raw;
  stored.BytesToSkip = SizeOfGIPL;
  ReadVoxels(stored, image, reading);
  return image;
}

bool IsMGH(const InputFile& file)
{
  const std::string bytes = UnpackBeginning(file, SizeOfMGH);
  bool isHeader = bytes.size() == SizeOfMGH && Fields(bytes, true).Get<std::int32_t>(0) == 1;
  for (std::size_t i = 1; isHeader && i <= 4; ++i)
  {
    isHeader = Fields(bytes, true).Get<std::int32_t>(4 * i) > 0;
  }
  constexpr std::uint32_t most = 10; // of the types
  return isHeader && Fields(bytes, true).Get<std::uint32_t>(20) <= most;
}

ScalarImage ReadMGH(const std::string& path, Reading& reading)
{
  const InputFile file(path);
  const std::string bytes = UnpackBeginning(file, SizeOfMGH);
  const Fields fields(bytes, true);
  ScalarImage image;
  image.Type = TypeOfMGH(fields.Get<std::int32_t>(20));
  std::vector<std::int64_t> sizes;
  for (std::size_t i = 1; i <= 4; ++i)
  {
    sizes.push_back(fields.Get<std::int32_t>(4 * i));
  }
  SetSizes(image, sizes);
  PlaceMGH(fields, image, reading);
  if (image.Frames > 1)
  {
    reading.Warnings.push_back(
      "the time between its frames is taken to be 1; use SetTimeScale() to "
      "weigh time against space");
  }
  StoredVoxels stored;
  stored.IsBigEndian = true;
  stored.Files = { path };
  stored.Coding = file.Beginning(2) == "\x1f\x8b" ? Encoding::Deflate : Encoding::Raw;
  stored.BytesToSkip = SizeOfMGH;
  ReadVoxels(stored, image, reading);
  return image;
}

bool IsMRC(const InputFile& file)
{
  const std::string bytes = file.Beginning(SizeOfMRC);
  return bytes.size() == SizeOfMRC && bytes.compare(208, 3, "MAP") == 0;
}

ScalarImage ReadMRC(const std::string& path, Reading& reading)
{
  const std::string bytes = InputFile(path).Beginning(SizeOfMRC);
  StoredVoxels stored;
  stored.IsBigEndian = IsBigEndianMRC(bytes);
  const Fields fields(bytes, stored.IsBigEndian);
  ScalarImage image;
  image.Type = TypeOfMRC(fields);
  SetSizes(image,
    { fields.Get<std::int32_t>(0), fields.Get<std::int32_t>(4), fields.Get<std::int32_t>(8) });
  PlaceMRC(fields, image, reading);
  const std::int32_t extension = fields.Get<std::int32_t>(92);
  RefuseIf(extension < 0, "its header claims an extension of ", extension, " bytes");
  constexpr std::int32_t firstOfStacks = 401;
  RefuseIf(fields.Get<std::int32_t>(88) >= firstOfStacks,
    "it is a stack of volumes: extract one of them first");
  WarnOfLengths("angstrom", reading);
  stored.Files = { path };
  stored.BytesToSkip = static_cast<std::int64_t>(SizeOfMRC) + extension;
  ReadVoxels(stored, image, reading);
  WarnOfNegativeBytes(fields, image, reading);
  return image;
}

} // namespace voxplex::io
