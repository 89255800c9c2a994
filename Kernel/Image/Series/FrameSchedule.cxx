// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/Series/FrameSchedule.h"

#include "Base/Error.h"
#include "Base/NumberText.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

namespace voxplex
{

namespace
{

/** The smallest distance of two frames is divided into at most so many steps. */
constexpr int MostParts = 8;

/** Quotients of times may be off by this factor. */
constexpr double Rounding = 1e-9;

std::string Number(double x)
{
  return NumberText(x, 10);
}

void CheckTimes(std::span<const double> times)
{
  if (times.size() < 2)
  {
    throw InputError(
      "A series has two frames or more; this one has " + std::to_string(times.size()) + ".");
  }
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    if (!std::isfinite(times[i]))
    {
      throw InputError("The time of frame " + std::to_string(i) + " is " + Number(times[i]) +
        "; it must be finite.");
    }
    if (i > 0 && !(times[i] > times[i - 1]))
    {
      throw InputError("The times of frames must increase, but frame " + std::to_string(i - 1) +
        " has time " + Number(times[i - 1]) + " and frame " + std::to_string(i) + " has time " +
        Number(times[i]) + ".");
    }
  }
  if (!std::isfinite(times.back() - times.front()))
  {
    throw InputError("The times of frames are too far apart.");
  }
}

/** The frame after which the next one follows soonest. */
std::size_t FindNearestPair(std::span<const double> times)
{
  std::size_t nearest = 0;
  for (std::size_t i = 1; i + 1 < times.size(); ++i)
  {
    nearest = times[i + 1] - times[i] < times[nearest + 1] - times[nearest] ? i : nearest;
  }
  return nearest;
}

bool AreEquallySpaced(std::span<const double> times)
{
  const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (std::size_t i = 1; i < times.size(); ++i)
  {
    if (!(std::abs(times[i] - times[i - 1] - step) <= FrameTimeTolerance * step))
    {
      return false;
    }
  }
  return true;
}

/** The frames at multiples of a step, and those between them; nothing if a frame is not there. */
std::optional<FrameSchedule> WithStep(std::span<const double> times, std::int64_t steps)
{
  const double step = (times.back() - times.front()) / static_cast<double>(steps);
  FrameSchedule schedule;
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    const double place = (times[i] - times.front()) / step;
    const double nearest = std::round(place);
    const auto number = static_cast<std::int64_t>(nearest);
    if (std::abs(place - nearest) > FrameTimeTolerance ||
      (i > 0 && number < schedule.NumberOfFrames()))
    {
      return std::nullopt;
    }
    const std::int64_t first = schedule.NumberOfFrames() - 1; // of the frame before
    for (std::int64_t k = first + 1; i > 0 && k < number; ++k)
    {
      schedule.Places.push_back({ static_cast<std::int64_t>(i) - 1,
        static_cast<double>(k - first) / static_cast<double>(number - first) });
    }
    schedule.Places.push_back({ static_cast<std::int64_t>(i), 0.0 });
  }
  return schedule;
}

/** Frames at equal distances, wherever the given frames are. */
FrameSchedule Between(std::span<const double> times, std::int64_t steps)
{
  const double step = (times.back() - times.front()) / static_cast<double>(steps);
  FrameSchedule schedule;
  std::size_t before = 0;
  for (std::int64_t k = 0; k < steps; ++k)
  {
    const double time = times.front() + static_cast<double>(k) * step;
    while (before + 2 < times.size() && times[before + 1] <= time + FrameTimeTolerance * step)
    {
      ++before;
    }
    const double sooner = time - times[before];
    schedule.Places.push_back({ static_cast<std::int64_t>(before),
      sooner <= FrameTimeTolerance * step ? 0.0 : sooner / (times[before + 1] - times[before]) });
  }
  schedule.Places.push_back({ static_cast<std::int64_t>(times.size()) - 1, 0.0 });
  return schedule;
}

} // namespace

//------------------------------------------------------------------------------------------------
FrameSchedule ScheduleFrames(std::span<const double> times, std::int64_t most)
{
  CheckTimes(times);
  if (AreEquallySpaced(times))
  {
    FrameSchedule schedule;
    for (std::size_t i = 0; i < times.size(); ++i)
    {
      schedule.Places.push_back({ static_cast<std::int64_t>(i), 0.0 });
    }
    return schedule;
  }
  const std::size_t nearest = FindNearestPair(times);
  const double smallest = times[nearest + 1] - times[nearest];
  const double distances = (times.back() - times.front()) / smallest;
  const double steps = std::ceil(distances * (1.0 - Rounding));
  if (!(steps < static_cast<double>(most)))
  {
    throw InputError("The times of frames " + std::to_string(nearest) + " and " +
      std::to_string(nearest + 1) + ", " + Number(times[nearest]) + " and " +
      Number(times[nearest + 1]) +
      ", are too near each other: frames at such distances from time " + Number(times.front()) +
      " to time " + Number(times.back()) + " are more than " + std::to_string(most) +
      ", the largest number for such images. Leave one of the two frames out, or divide the "
      "series.");
  }
  for (int parts = 1; parts <= MostParts; ++parts)
  {
    const double finer = std::round(distances * parts);
    if (!(finer < static_cast<double>(most)))
    {
      break;
    }
    if (auto schedule = WithStep(times, static_cast<std::int64_t>(finer)))
    {
      return *std::move(schedule);
    }
  }
  return Between(times, static_cast<std::int64_t>(steps));
}

} // namespace voxplex
