// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Placement.h"

#include "Geometry/Determinants.h"
#include "Refuse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace voxplex
{
namespace
{

constexpr double Largest = 1e12;
/** Of the determinant of three unit vectors. Header fields have few digits. */
constexpr double SmallestDeterminant = 1e-5;
/** How far a frame may lie from its place, in steps from frame to frame. */
constexpr double TimeTolerance = 1e-3;

bool IsUsable(const Vector3& numbers)
{
  return std::all_of(numbers.begin(), numbers.end(),
    [](double number) { return std::abs(number) <= Largest; }); // not NaN
}

} // namespace

void Place(ScalarImage& image, const std::array<Vector3, 3>& steps, const Vector3& origin)
{
  RefuseIf(!IsUsable(origin) || !std::all_of(steps.begin(), steps.end(), IsUsable),
    "its position or orientation in space is not finite, or far too large: correct the header");
  image.Origin = origin;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const Vector3& step = steps[axis];
    const double length = std::hypot(step[0], step[1], step[2]);
    RefuseIf(!(length > 0), "the voxel spacing along axis ", axis,
      " is 0 in its header; it must be a positive length: correct the header");
    image.Spacing[axis] = length;
    for (std::size_t row = 0; row < 3; ++row)
    {
      image.Direction[3 * row + axis] = step[row] / length;
    }
  }
  RefuseIf(VolumeOfDirections(image) < SmallestDeterminant,
    "its axes are not independent, the direction matrix is singular: correct the header");
}

std::array<Vector3, 3> StepsOf(const ScalarImage& image)
{
  std::array<Vector3, 3> steps;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    for (std::size_t row = 0; row < 3; ++row)
    {
      steps[axis][row] = image.Direction[3 * row + axis] * image.Spacing[axis];
    }
  }
  return steps;
}

double VolumeOfDirections(const ScalarImage& image)
{
  const auto& d = image.Direction;
  return std::abs(Determinant(std::array<Vector3, 3>{
    { { d[0], d[1], d[2] }, { d[3], d[4], d[5] }, { d[6], d[7], d[8] } } }));
}

void PlaceAlongAxes(ScalarImage& image, const Vector3& spacing, const Vector3& origin)
{
  std::array<Vector3, 3> steps{};
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    RefuseIf(!(spacing[axis] > 0) || !std::isfinite(spacing[axis]), "the voxel spacing along axis ",
      axis, " is ", spacing[axis],
      " in its header; it must be a positive length: correct the header");
    steps[axis][axis] = spacing[axis];
  }
  Place(image, steps, origin);
}

void SetSizes(ScalarImage& image, std::vector<std::int64_t> sizes)
{
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  constexpr double mostVoxels = 1e15;
  while (sizes.size() > 3 && sizes.back() == 1)
  {
    sizes.pop_back();
  }
  std::string text;
  double voxels = 1.0;
  bool areUsable = true;
  for (const std::int64_t size : sizes)
  {
    text += (text.empty() ? "" : " x ") + std::to_string(size);
    areUsable = areUsable && size >= 1 && size <= most;
    voxels *= static_cast<double>(size);
  }
  RefuseIf(sizes.size() < 3, "it has ", sizes.size(),
    " dimensions, and a volume has three: give a volume");
  RefuseIf(sizes.size() > 4, "it has ", sizes.size(), " dimensions (", text,
    "); voxplex meshes images of three, and of four with time as the last: extract one of those "
    "first");
  RefuseIf(!areUsable || voxels > mostVoxels, "its header claims ", text,
    " voxels, which no image has: correct the header");
  std::copy_n(sizes.begin(), 3, image.Dimensions.begin());
  image.Frames = sizes.size() == 4 ? static_cast<int>(sizes[3]) : 1;
}

void CheckSpacing(bool isRight, std::string_view shown)
{
  RefuseIf(!isRight, "the voxel spacing in its header is '", shown,
    "'; it must be a positive length along each axis: correct the header");
}

void CheckTimeIsApart(bool isApart)
{
  RefuseIf(!isApart,
    "its direction matrix mixes time with space; only images whose frames each show one time can "
    "be meshed: correct the header, or resample the image");
}

void SetTimeStep(ScalarImage& image, double first, double step, std::string_view shown)
{
  RefuseIf(!(step > 0) || !std::isfinite(step) || !std::isfinite(first),
    "the time from frame to frame in its header is '", shown,
    "'; it must be a positive number: correct the header");
  image.TimeOrigin = first;
  image.TimeSpacing = step;
}

void SetFrameTimes(ScalarImage& image, const std::vector<double>& times)
{
  image.Times.clear();
  image.TimeOrigin = times.front();
  image.TimeSpacing =
    times.size() > 1 ? (times.back() - times.front()) / static_cast<double>(times.size() - 1) : 1.0;
  for (std::size_t n = 0; n < times.size(); ++n)
  {
    if (!std::isfinite(times[n]) || (n > 0 && !(times[n] > times[n - 1])))
    {
      Refuse("the times of its frames do not increase: ", times[n], " follows ",
        n > 0 ? times[n - 1] : 0.0, "; sort the frames, or correct the header");
    }
    const double expected = image.TimeOrigin + static_cast<double>(n) * image.TimeSpacing;
    if (std::abs(times[n] - expected) > TimeTolerance * image.TimeSpacing)
    {
      image.Times = times;
    }
  }
}

} // namespace voxplex
