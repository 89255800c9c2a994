// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/Series/FrameSeries.h"

#include "Base/Error.h"
#include "Base/NumberText.h"
#include "Image/LabelValue.h"
#include "Image/ScalarTypes.h"
#include "Image/Series/FrameInterpolation.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace voxplex
{

namespace
{

/** Voxels that a thread takes at a time. */
constexpr std::size_t Grain = 1 << 16;

/**
 * A series that is not equally spaced gets at most so many voxels, or twice its own if these are
 * more. Labels take two bytes each then.
 */
constexpr std::int64_t MostVoxels = 400'000'000;
/** How far frames may be from lying on each other, in voxels. */
constexpr double GridTolerance = 1e-3;

std::string Number(double x)
{
  return NumberText(x, 10);
}

/** What it takes to hold a value: the index of FrameSeries' alternative, or that it is no label. */
enum class Width : unsigned
{
  Bits8,
  Bits16,
  Bits64,
  NoLabel
};

/** @param narrow whether only labels that were asked for count: other whole numbers are background */
template <typename T>
Width WidthOf(T value, bool narrow)
{
  const T nearest = NearestLabel(value);
  if (!IsLabel(nearest))
  {
    return narrow && IsWhole(nearest) ? Width::Bits8 : Width::NoLabel;
  }
  const auto label = static_cast<std::int64_t>(nearest);
  return label <= std::numeric_limits<std::uint8_t>::max() ? Width::Bits8
    : label <= std::numeric_limits<std::uint16_t>::max()   ? Width::Bits16
                                                           : Width::Bits64;
}

/** The largest width of the values at 0, stride, 2 stride, ... */
template <typename T>
Width LargestWidth(
  const T* values, std::size_t count, std::size_t stride, bool narrow, unsigned threads)
{
  std::atomic<unsigned> largest{ 0 };
  ParallelFor(0, count, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      unsigned mine = 0;
      for (std::size_t i = first; i < last; ++i)
      {
        mine = std::max(mine, static_cast<unsigned>(WidthOf(values[i * stride], narrow)));
      }
      // Relaxed: the loop's end comes before it is read.
      unsigned seen = largest.load(std::memory_order_relaxed);
      while (mine > seen && !largest.compare_exchange_weak(seen, mine, std::memory_order_relaxed))
      {
      }
    });
  return static_cast<Width>(largest.load());
}

/** A value as FrameSeries keeps it; what is no label is background. */
template <typename Value, typename T>
Value Convert(T value)
{
  if constexpr (std::is_integral_v<Value>)
  {
    const T label = NearestLabel(value);
    return IsLabel(label) ? static_cast<Value>(label) : Value(0);
  }
  else
  {
    return static_cast<Value>(value);
  }
}

/** The kernel's message about a frame with a value that is no label. */
template <typename T>
[[noreturn]] void ThrowBadValue(const T* values, std::size_t stride, const GridGeometry<3>& grid,
  const LabelSelection& selection, const std::string& name)
{
  const auto& n = grid.Dimensions;
  std::vector<T> frame(static_cast<std::size_t>(n[0] * n[1] * n[2]));
  for (std::size_t i = 0; i < frame.size(); ++i)
  {
    frame[i] = values[i * stride];
  }
  try
  {
    LabelImage<3>::FromScalars<T>(frame, grid, selection);
  }
  catch (const InputError& error)
  {
    throw InputError("In " + name + ": " + error.what());
  }
  throw InputError("In " + name + ": a value is not a label.");
}

std::string Format(const std::array<std::int64_t, 3>& n)
{
  return std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " + std::to_string(n[2]);
}

std::string Format(const Point<3>& p)
{
  return "(" + Number(p[0]) + ", " + Number(p[1]) + ", " + Number(p[2]) + ")";
}

Point<3> SpacingOf(const ImageFrame& frame)
{
  return { frame.Grid.Spacing(0), frame.Grid.Spacing(1), frame.Grid.Spacing(2) };
}

/** World position of the voxel at the other end of the image along an axis. */
Point<3> EndOf(const ImageFrame& frame, std::size_t axis)
{
  Point<3> index{};
  index[axis] = static_cast<double>(frame.Grid.Dimensions[axis] - 1);
  return frame.ToWorld(frame.Grid.ToFrame(index));
}

} // namespace

//------------------------------------------------------------------------------------------------
void FrameSeries::Start(std::vector<double> times, bool isOfLabels, const LabelSelection& selection)
{
  this->Clear();
  ScheduleFrames(times); // before the first frame is read
  this->Times = std::move(times);
  this->HasLabels = isOfLabels;
  this->Selection = selection;
}

void FrameSeries::Clear()
{
  *this = FrameSeries();
}

std::string FrameSeries::NameOf(std::size_t frame) const
{
  return "frame " + std::to_string(frame) + " (time " + Number(this->Times[frame]) + ")";
}

void FrameSeries::CheckSameGrid(const ImageFrame& frame, const std::string& arrayName) const
{
  const std::string both = this->NameOf(0) + " and " + this->NameOf(this->Added);
  const ImageFrame& a = this->FirstFrame;
  const ImageFrame& b = frame;
  if (a.Grid.Dimensions != b.Grid.Dimensions)
  {
    throw InputError("All frames must have the same dimensions, but those of " + both + " are " +
      Format(a.Grid.Dimensions) + " and " + Format(b.Grid.Dimensions) + ".");
  }
  const Point<3> spacing = SpacingOf(a);
  const Point<3> other = SpacingOf(b);
  const double tolerance = GridTolerance * std::min({ spacing[0], spacing[1], spacing[2] });
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const double last = static_cast<double>(a.Grid.Dimensions[axis] - 1);
    if (std::abs(spacing[axis] - other[axis]) * last > tolerance)
    {
      throw InputError("All frames must have the same spacing, but that of " + both + " is " +
        Format(spacing) + " and " + Format(other) + ".");
    }
  }
  if (Distance(a.Origin, b.Origin) > tolerance)
  {
    throw InputError("All frames must have the same origin, but the first voxels of " + both +
      " lie at " + Format(a.Origin) + " and " + Format(b.Origin) + ".");
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    if (Distance(EndOf(a, axis), EndOf(b, axis)) > 4.0 * tolerance)
    {
      throw InputError("All frames must have the same direction matrix, but those of " + both +
        " differ in axis " + std::to_string(axis) + ".");
    }
  }
  if (this->ArrayName != arrayName)
  {
    throw InputError("All frames must have the labels in an array of the same name, but those of " +
      both + " are '" + this->ArrayName + "' and '" + arrayName + "'.");
  }
}

//------------------------------------------------------------------------------------------------
std::size_t FrameSeries::VoxelsOfFrame() const
{
  const auto& n = this->FirstFrame.Grid.Dimensions;
  return static_cast<std::size_t>(n[0] * n[1] * n[2]);
}

template <typename U>
void FrameSeries::WidenTo(unsigned threads)
{
  const std::size_t voxels = this->VoxelsOfFrame();
  UninitialisedVector<U> wide(voxels * this->Times.size());
  std::visit(
    [&](const auto& narrow)
    {
      ParallelFor(0, voxels * this->Added, Grain, threads,
        [&](std::size_t first, std::size_t last)
        {
          std::transform(narrow.data() + first, narrow.data() + last, wide.data() + first,
            [](auto value) { return static_cast<U>(value); });
        });
    },
    this->Values);
  this->Values = std::move(wide);
}

template <typename T>
void FrameSeries::Copy(const T* values, std::size_t stride, unsigned threads)
{
  std::visit(
    [&](auto& all)
    {
      using Value = typename std::remove_reference_t<decltype(all)>::value_type;
      Value* const out = all.data() + this->VoxelsOfFrame() * this->Added;
      ParallelFor(0, this->VoxelsOfFrame(), Grain, threads,
        [&](std::size_t first, std::size_t last)
        {
          for (std::size_t i = first; i < last; ++i)
          {
            out[i] = Convert<Value>(values[i * stride]);
          }
        });
    },
    this->Values);
}

template <typename T>
void FrameSeries::CopyLabels(const T* values, std::size_t stride, unsigned threads)
{
  const Width width =
    LargestWidth(values, this->VoxelsOfFrame(), stride, !this->Selection.Only.empty(), threads);
  if (width == Width::NoLabel)
  {
    ThrowBadValue(
      values, stride, this->FirstFrame.Grid, this->Selection, this->NameOf(this->Added));
  }
  if (this->Added == 0 || static_cast<std::size_t>(width) > this->Values.index())
  {
    switch (width)
    {
      case Width::Bits8:
        this->WidenTo<std::uint8_t>(threads);
        break;
      case Width::Bits16:
        this->WidenTo<std::uint16_t>(threads);
        break;
      default:
        this->WidenTo<std::int64_t>(threads);
    }
  }
  this->Copy(values, stride, threads);
}

template <typename T>
void FrameSeries::CopyGreyValues(const T* values, std::size_t stride, unsigned threads)
{
  constexpr bool isExactAsFloat = std::is_same_v<T, float> ||
    std::numeric_limits<T>::digits <= std::numeric_limits<float>::digits;
  if (!isExactAsFloat && !std::holds_alternative<UninitialisedVector<double>>(this->Values))
  {
    this->WidenTo<double>(threads);
  }
  else if (this->Added == 0)
  {
    this->WidenTo<float>(threads);
  }
  this->Copy(values, stride, threads);
}

template <typename T>
void FrameSeries::Add(const T* values, std::size_t stride, const ImageFrame& frame,
  const std::string& arrayName, unsigned threads)
{
  if (this->Added == 0)
  {
    this->FirstFrame = frame;
    this->ArrayName = arrayName;
  }
  this->CheckSameGrid(frame, arrayName);
  if (this->HasLabels)
  {
    this->CopyLabels(values, stride, threads);
  }
  else
  {
    this->CopyGreyValues(values, stride, threads);
  }
  ++this->Added;
}

#define VOXPLEX_ADD(T)                                                                             \
  template void FrameSeries::Add<T>(                                                               \
    const T*, std::size_t, const ImageFrame&, const std::string&, unsigned)
VOXPLEX_FOR_EACH_SCALAR_TYPE(VOXPLEX_ADD);
#undef VOXPLEX_ADD

//------------------------------------------------------------------------------------------------
FrameSchedule FrameSeries::MakeSchedule() const
{
  const auto& n = this->FirstFrame.Grid.Dimensions;
  const auto most =
    std::max(MostVoxels / (n[0] * n[1] * n[2]), 2 * static_cast<std::int64_t>(this->Times.size()));
  return ScheduleFrames(this->Times, std::min(most, MostScheduledFrames));
}

SpaceTimeFrame FrameSeries::MakeFrame(double timeScale) const
{
  return MakeSpaceTimeFrame(this->FirstFrame, this->MakeSchedule().NumberOfFrames(),
    this->Times.front(), this->Times.back(), timeScale);
}

LabelImage<4> FrameSeries::MakeLabelImage(const GridGeometry<4>& grid, unsigned threads) const
{
  GridGeometry<4> given = grid;
  given.Dimensions[3] = static_cast<std::int64_t>(this->Times.size());
  LabelImage<4> image = std::visit(
    [&](const auto& labels)
    {
      using Label = typename std::remove_cvref_t<decltype(labels)>::value_type;
      return LabelImage<4>::FromScalars<Label>(labels, given, this->Selection, threads);
    },
    this->Values);
  const FrameSchedule schedule = this->MakeSchedule();
  return schedule.ChangesNothing()
    ? std::move(image)
    : ScheduledFrames(image, schedule, grid.IndexToFrame[3][3], threads);
}

IsosurfaceImage<4> FrameSeries::MakeIsosurface(
  const GridGeometry<4>& grid, const Isosurface& surface, unsigned threads)
{
  const FrameSchedule schedule = this->MakeSchedule();
  const auto make = [&]<typename T>(UninitialisedVector<T>& values)
  {
    if (!schedule.ChangesNothing())
    {
      values = ScheduledValues<T>(values, this->VoxelsOfFrame(), schedule, threads);
    }
    return IsosurfaceImage<4>::FromScalars<T>(values, grid, surface, threads);
  };
  auto* const floats = std::get_if<UninitialisedVector<float>>(&this->Values);
  return floats ? make(*floats) : make(std::get<UninitialisedVector<double>>(this->Values));
}

} // namespace voxplex
