// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadFrames.h"

#include "FileChecks.h"
#include "FileError.h"
#include "TextHeader.h"

#include <itkImageIOBase.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <sstream>

namespace voxplex::io
{
namespace
{

constexpr unsigned TimeAxis = 3;
/** Header fields have few digits; a direction is taken for what it is meant to be up to this. */
constexpr double DirectionTolerance = 1e-5;
/** How far a frame may lie from its place, in steps from frame to frame. */
constexpr double TimeTolerance = 1e-3;

[[noreturn]] void Refuse(const std::string& path, const std::string& reason)
{
  throw FileError("cannot read '" + path + "': " + reason);
}

ScalarType ScalarTypeOf(const std::string& path, const itk::ImageIOBase& io)
{
  using Component = itk::IOComponentEnum;
  const Component type = io.GetComponentType();
  if (type == Component::FLOAT || type == Component::DOUBLE)
  {
    return type == Component::FLOAT ? ScalarType::Float32 : ScalarType::Float64;
  }
  const bool isSigned = type == Component::CHAR || type == Component::SHORT ||
    type == Component::INT || type == Component::LONG || type == Component::LONGLONG;
  const bool isUnsigned = type == Component::UCHAR || type == Component::USHORT ||
    type == Component::UINT || type == Component::ULONG || type == Component::ULONGLONG;
  if (isSigned || isUnsigned)
  {
    if (const auto integer = IntegerType(io.GetComponentSize(), isSigned))
    {
      return *integer;
    }
  }
  Refuse(path, "its scalar type is not supported");
}

double Determinant(const std::array<double, 9>& m)
{
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
    m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/** The three axes of space. */
void AdoptSpace(const std::string& path, const itk::ImageIOBase& io, ScalarImage& image)
{
  for (unsigned axis = 0; axis < 3; ++axis)
  {
    image.Dimensions[axis] = static_cast<int>(io.GetDimensions(axis));
    image.Origin[axis] = io.GetOrigin(axis);
    image.Spacing[axis] = io.GetSpacing(axis);
    const std::vector<double> direction = io.GetDirection(axis);
    for (unsigned row = 0; row < 3; ++row)
    {
      image.Direction[3 * row + axis] = direction[row];
    }
  }
  if (std::abs(Determinant(image.Direction)) < DirectionTolerance)
  {
    Refuse(
      path, "its axes are not independent, the direction matrix is singular: correct the header");
  }
}

/** A fourth axis must be one of time alone, and the others of space alone. */
void CheckThatTimeIsApart(const std::string& path, const itk::ImageIOBase& io)
{
  const std::vector<double> time = io.GetDirection(TimeAxis);
  bool isApart = true;
  for (unsigned axis = 0; axis < 3; ++axis)
  {
    isApart = isApart && std::abs(io.GetDirection(axis)[TimeAxis]) < DirectionTolerance &&
      std::abs(time[axis]) < DirectionTolerance;
  }
  if (!isApart)
  {
    Refuse(path,
      "its direction matrix mixes time with space; only images whose frames each show one time can "
      "be meshed: correct the header, or resample the image");
  }
  if (time[TimeAxis] < 0)
  {
    Refuse(path, "its time runs backwards: reverse the frames, or correct the header");
  }
}

/** The times of a list of frames: an origin and a step if they are equally spaced. */
void AdoptTimes(const std::string& path, const std::vector<double>& times, ScalarImage& image)
{
  const auto steps = static_cast<double>(times.size() - 1);
  image.TimeOrigin = times.front();
  image.TimeSpacing = (times.back() - times.front()) / steps;
  for (std::size_t n = 1; n < times.size(); ++n)
  {
    if (!(times[n] > times[n - 1]))
    {
      std::ostringstream reason;
      reason << "the times of its frames do not increase: " << times[n] << " follows "
             << times[n - 1] << "; sort the frames, or correct the header";
      Refuse(path, reason.str());
    }
    const double expected = image.TimeOrigin + static_cast<double>(n) * image.TimeSpacing;
    if (std::abs(times[n] - expected) > TimeTolerance * image.TimeSpacing)
    {
      image.Times = times;
    }
  }
}

/** The axis of frames in an NRRD file, or the number of axes. */
std::size_t FindList(const std::vector<NRRDAxis>& axes)
{
  return static_cast<std::size_t>(
    std::find_if(axes.begin(), axes.end(), [](const NRRDAxis& axis) { return axis.IsList(); }) -
    axes.begin());
}

/** What 3D Slicer's sequences have: "axis 0 index values:=0 0.04 0.08". */
bool AdoptIndexValues(const std::string& path, const TextHeader& header, std::size_t axis,
  ScalarImage& image, std::vector<std::string>& warnings)
{
  const std::string key = "axis " + std::to_string(axis) + " index ";
  const std::string* values = header.Find(key + "values");
  if (!values)
  {
    return false;
  }
  const std::string* type = header.Find(key + "type");
  const std::vector<double> times = ParseNumbers(*values);
  const bool isFinite =
    std::all_of(times.begin(), times.end(), [](double time) { return std::isfinite(time); });
  if (times.size() != static_cast<std::size_t>(image.Frames) || !isFinite ||
    (type && *type == "text"))
  {
    warnings.push_back(
      path + ": its '" + key + "values' are not one number for each frame, and are not used");
    return false;
  }
  AdoptTimes(path, times, image);
  return true;
}

void AdoptTimesOfNIfTI(
  const std::string& path, ScalarImage& image, std::vector<std::string>& warnings)
{
  if (const std::optional<NIfTITimes> times = ReadTimesOfNIfTI(path))
  {
    image.TimeOrigin = times->First;
    if (times->Step == 0)
    {
      warnings.push_back(path +
        ": its header has 0 for the time from frame to frame, which is taken to be 1; use "
        "SetTimeScale() to weigh time against space");
    }
  }
}

void AdoptTimesOfNRRD(
  const std::string& path, ScalarImage& image, std::vector<std::string>& warnings)
{
  const TextHeader header(path);
  const std::vector<NRRDAxis> axes = ParseNRRDAxes(header);
  const std::size_t list = FindList(axes);
  const std::size_t axis = list < axes.size() ? list : std::size_t{ TimeAxis };
  if (!AdoptIndexValues(path, header, axis, image, warnings) && list < axes.size() &&
    axes[list].HasSpacing && axes[list].Spacing > 0)
  {
    image.TimeSpacing = axes[list].Spacing;
  }
}

template <typename T>
void Separate(const std::byte* together, std::byte* apart, std::size_t voxels, std::size_t frames)
{
  const T* from = reinterpret_cast<const T*>(together);
  T* to = reinterpret_cast<T*>(apart);
  for (std::size_t voxel = 0; voxel < voxels; ++voxel)
  {
    for (std::size_t frame = 0; frame < frames; ++frame)
    {
      to[frame * voxels + voxel] = *from++;
    }
  }
}

using Buffer = std::shared_ptr<std::byte[]>;

/** From all frames of a voxel, then those of the next, to one whole frame after the other. */
Buffer SeparateFrames(const Buffer& together, const itk::ImageIOBase& io)
{
  const auto voxels = static_cast<std::size_t>(io.GetImageSizeInPixels());
  const std::size_t frames = io.GetNumberOfComponents();
  const Buffer apart(new std::byte[static_cast<std::size_t>(io.GetImageSizeInBytes())]);
  switch (io.GetComponentSize())
  {
    case 1:
      Separate<std::uint8_t>(together.get(), apart.get(), voxels, frames);
      break;
    case 2:
      Separate<std::uint16_t>(together.get(), apart.get(), voxels, frames);
      break;
    case 4:
      Separate<std::uint32_t>(together.get(), apart.get(), voxels, frames);
      break;
    default:
      Separate<std::uint64_t>(together.get(), apart.get(), voxels, frames);
  }
  return apart;
}

/** The whole image, time slowest. */
std::shared_ptr<void> ReadScalars(itk::ImageIOBase& io)
{
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis)
  {
    region.SetIndex(axis, 0);
    region.SetSize(axis, io.GetDimensions(axis));
  }
  io.SetIORegion(region);
  Buffer buffer(new std::byte[static_cast<std::size_t>(io.GetImageSizeInBytes())]);
  io.Read(buffer.get());
  if (io.GetNumberOfComponents() > 1)
  {
    buffer = SeparateFrames(buffer, io);
  }
  return { buffer, buffer.get() };
}

} // namespace

unsigned CountAxes(const itk::ImageIOBase& io)
{
  unsigned axes = io.GetNumberOfDimensions();
  while (axes > 3 && io.GetDimensions(axes - 1) == 1)
  {
    --axes;
  }
  return std::max(axes, 3u);
}

bool ComponentsAreFrames(const std::string& path, const itk::ImageIOBase& io)
{
  if (std::string(io.GetNameOfClass()) != "NrrdImageIO" || io.GetNumberOfDimensions() != 3)
  {
    return false;
  }
  const TextHeader header(path);
  const std::vector<NRRDAxis> axes = ParseNRRDAxes(header);
  const std::size_t list = FindList(axes);
  return list < axes.size() && axes[list].Kind == "list" && !header.Find("segment0_id");
}

ScalarImage ReadFrames(
  const std::string& path, itk::ImageIOBase& io, std::vector<std::string>& warnings)
{
  ScalarImage image;
  image.Type = ScalarTypeOf(path, io);
  AdoptSpace(path, io, image);
  const std::string format = io.GetNameOfClass();
  if (io.GetNumberOfComponents() > 1)
  {
    image.Frames = static_cast<int>(io.GetNumberOfComponents());
  }
  else
  {
    CheckThatTimeIsApart(path, io);
    image.Frames = static_cast<int>(io.GetDimensions(TimeAxis));
    image.TimeOrigin = io.GetOrigin(TimeAxis);
    image.TimeSpacing = io.GetSpacing(TimeAxis);
  }
  if (format == "NiftiImageIO")
  {
    AdoptTimesOfNIfTI(path, image, warnings);
  }
  if (format == "NrrdImageIO")
  {
    AdoptTimesOfNRRD(path, image, warnings);
  }

  image.Scalars = ReadScalars(io);
  return image;
}

} // namespace voxplex::io
