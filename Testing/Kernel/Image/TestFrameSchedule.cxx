// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Equally spaced frames for any times: which frames are kept, steps, ends, limits; images with such frames.
#include "Base/Error.h"
#include "Image/Series/FrameInterpolation.h"
#include "Image/Series/FrameSchedule.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

using Times = std::vector<double>;

/** The times of the places, from those of the frames. */
Times TimesOf(const FrameSchedule& schedule, const Times& times)
{
  Times result;
  for (const FramePlace& place : schedule.Places)
  {
    const auto before = static_cast<std::size_t>(place.Before);
    result.push_back(place.Weight == 0.0
        ? times[before]
        : (1.0 - place.Weight) * times[before] + place.Weight * times[before + 1]);
  }
  return result;
}

double SmallestDistance(const Times& times)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < times.size(); ++i)
  {
    smallest = std::min(smallest, times[i] - times[i - 1]);
  }
  return smallest;
}

/** What holds for all times. */
void ExpectEqualSteps(const FrameSchedule& schedule, const Times& times)
{
  const Times made = TimesOf(schedule, times);
  ASSERT_GE(made.size(), 2u);
  EXPECT_EQ(made.front(), times.front());
  EXPECT_EQ(made.back(), times.back());
  const double step = (times.back() - times.front()) / static_cast<double>(made.size() - 1);
  EXPECT_LE(step, SmallestDistance(times) * (1.0 + 2.0 * FrameTimeTolerance));
  for (std::size_t k = 0; k < made.size(); ++k)
  {
    EXPECT_NEAR(
      made[k], times.front() + static_cast<double>(k) * step, 1.01 * FrameTimeTolerance * step);
  }
}

std::size_t KeptFrames(const FrameSchedule& schedule)
{
  std::size_t kept = 0;
  for (const FramePlace& place : schedule.Places)
  {
    kept += place.Weight == 0.0;
  }
  return kept;
}

std::string ErrorOf(const Times& times, std::int64_t most = MostScheduledFrames)
{
  return MessageOf([&] { ScheduleFrames(times, most); });
}

} // namespace

TEST(FrameSchedule, EqualStepsChangeNothing)
{
  for (const Times& times :
    { Times{ 0, 1 }, Times{ 3, 5, 7, 9 }, Times{ 0, 0.333333, 0.666667, 1 } })
  {
    const FrameSchedule schedule = ScheduleFrames(times);
    EXPECT_TRUE(schedule.ChangesNothing());
    EXPECT_EQ(TimesOf(schedule, times), times);
  }
  // More frames than a schedule may make.
  Times many;
  for (int i = 0; i < 1500; ++i)
  {
    many.push_back(i);
  }
  EXPECT_TRUE(ScheduleFrames(many).ChangesNothing());
  EXPECT_TRUE(ScheduleFrames(many, 2).ChangesNothing());
}

TEST(FrameSchedule, MultiplesOfAStepAreKept)
{
  struct Case
  {
    Times Given;
    std::size_t Frames;
  };
  for (const Case& c : { Case{ { 0, 1, 2, 4 }, 5 }, Case{ { 0, 40, 160, 200 }, 6 },
         Case{ { 1, 3, 6, 8 }, 8 },          // half of the smallest distance
         Case{ { -1, -0.2, 0.1, 0.3 }, 14 }, // half of 0.2
         Case{ { 0, 8, 17, 25 }, 26 },       // an eighth
         Case{ { 0, 1, 3.0005, 4 }, 5 } })   // to a thousandth
  {
    const FrameSchedule schedule = ScheduleFrames(c.Given);
    EXPECT_EQ(schedule.Places.size(), c.Frames);
    EXPECT_EQ(KeptFrames(schedule), c.Given.size());
    EXPECT_FALSE(schedule.ChangesNothing());
    ExpectEqualSteps(schedule, c.Given);
  }
}

TEST(FrameSchedule, OtherTimesAreInterpolated)
{
  const Times times = { 0, 1, 2.33, 3.1, 5.777 };
  const FrameSchedule schedule = ScheduleFrames(times);
  EXPECT_EQ(schedule.Places.size(), 9u); // 8 steps of 0.722
  EXPECT_EQ(KeptFrames(schedule), 2u);
  ExpectEqualSteps(schedule, times);

  std::mt19937 random(3);
  std::uniform_real_distribution<double> distance(0.3, 2.0);
  for (int i = 0; i < 200; ++i)
  {
    Times some = { distance(random) };
    for (int k = 1; k < 2 + i % 20; ++k)
    {
      some.push_back(some.back() + distance(random));
    }
    ExpectEqualSteps(ScheduleFrames(some), some);
  }
}

TEST(FrameSchedule, Limits)
{
  // An eighth of a step would be too many: frames are interpolated.
  const Times eighth = { 0, 8, 17, 25 };
  const FrameSchedule schedule = ScheduleFrames(eighth, 25);
  EXPECT_EQ(schedule.Places.size(), 5u);
  ExpectEqualSteps(schedule, eighth);
  EXPECT_EQ(ScheduleFrames(Times{ 0, 1, 2, 999 }).Places.size(), 1000u);

  const std::string error = ErrorOf({ 0, 1, 1.001, 2, 3 });
  EXPECT_NE(error.find("frames 1 and 2, 1 and 1.001, are too near each other"), std::string::npos)
    << error;
  EXPECT_NE(error.find("from time 0 to time 3 are more than 1000"), std::string::npos) << error;
  EXPECT_NE(ErrorOf({ 0, 1, 2, 1000 }), "");
  EXPECT_NE(ErrorOf(eighth, 4), "");
}

TEST(FrameSchedule, BadTimes)
{
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double most = std::numeric_limits<double>::max();
  EXPECT_NE(ErrorOf({ 1.0 }).find("two frames or more"), std::string::npos);
  EXPECT_NE(ErrorOf({ 0, 2, 1 }).find("must increase"), std::string::npos);
  EXPECT_NE(ErrorOf({ 0, 1, 1 }).find("must increase"), std::string::npos);
  EXPECT_NE(ErrorOf({ 0, nan, 1 }).find("must be finite"), std::string::npos);
  EXPECT_NE(ErrorOf({ -most, 0, most }).find("too far apart"), std::string::npos);
}

// A ball that moves at constant speed, with frames left out: what is made is near the whole series.
TEST(FrameSchedule, MissingFramesAreInterpolated)
{
  const LabelImage<4> whole = ImageOf(phantoms::FastBall(5));
  const Times times = { 0, 1, 2, 4 };
  const GridGeometry<4>& grid = whole.Grid();
  const auto voxels =
    static_cast<std::size_t>(grid.Dimensions[0] * grid.Dimensions[1] * grid.Dimensions[2]);
  std::vector<std::uint8_t> scalars = phantoms::FastBall(5).Scalars();
  scalars.erase(scalars.begin() + static_cast<std::ptrdiff_t>(3 * voxels),
    scalars.begin() + static_cast<std::ptrdiff_t>(4 * voxels));
  GridGeometry<4> given = grid;
  given.Dimensions[3] = 4;
  const LabelImage<4> image = LabelImage<4>::FromScalars<std::uint8_t>(scalars, given);

  const LabelImage<4> made =
    ScheduledFrames(image, ScheduleFrames(times), grid.IndexToFrame[3][3], 2);
  ASSERT_EQ(made.Grid().Dimensions, grid.Dimensions);
  EXPECT_EQ(made.Grid().IndexToFrame[3][3], grid.IndexToFrame[3][3]);
  EXPECT_TRUE(made.ReachesBorderInTime(0) && made.ReachesBorderInTime(1));
  ASSERT_EQ(made.CropOrigin(), whole.CropOrigin());
  ASSERT_EQ(made.CropDimensions(), whole.CropDimensions());
  const std::size_t frame = made.Ids().size() / 5;
  std::vector<std::size_t> wrong(5, 0);
  std::size_t jump = 0; // from the frame before the missing one to the missing one
  for (std::size_t i = 0; i < made.Ids().size(); ++i)
  {
    wrong[i / frame] += made.Ids()[i] != whole.Ids()[i];
    jump += i / frame == 3 && whole.Ids()[i] != whole.Ids()[i - frame];
  }
  for (const std::size_t kept : { 0u, 1u, 2u, 4u })
  {
    EXPECT_EQ(wrong[kept], 0u) << kept;
  }
  EXPECT_LT(2 * wrong[3], jump);
  EXPECT_GT(wrong[3], 0u); // it is interpolated, not known
}

// The frames of a ball that grows linearly: interpolated ones have volumes in between.
TEST(FrameSchedule, VolumesAreLinearInTime)
{
  const LabelImage<4> image = ImageOf(phantoms::FourBall(6.0));
  Times times;
  for (std::int64_t k = 0; k < image.Grid().Dimensions[3]; ++k)
  {
    times.push_back(static_cast<double>(k) + 0.13 * static_cast<double>((k * k) % 5));
  }
  const FrameSchedule schedule = ScheduleFrames(times);
  const LabelImage<4> made = ScheduledFrames(image, schedule, 0.5);
  const auto countsIn = [](const LabelImage<4>& in, std::int64_t frame)
  {
    frame -= in.CropOrigin()[3];
    double count = 0.0;
    const auto size = static_cast<std::size_t>(
      in.CropDimensions()[0] * in.CropDimensions()[1] * in.CropDimensions()[2]);
    for (std::size_t i = 0; frame >= 0 && frame < in.CropDimensions()[3] && i < size; ++i)
    {
      count += in.Ids()[static_cast<std::size_t>(frame) * size + i] != 0;
    }
    return count;
  };
  double largest = 0.0;
  for (std::int64_t k = 0; k < schedule.NumberOfFrames(); ++k)
  {
    const auto [before, weight] = schedule.Places[static_cast<std::size_t>(k)];
    const double expected = (1.0 - weight) * countsIn(image, before) +
      (weight > 0.0 ? weight * countsIn(image, before + 1) : 0.0);
    EXPECT_NEAR(countsIn(made, k), expected, weight > 0.0 ? 1.0 : 0.0) << k;
    largest = std::max(largest, expected);
  }
  EXPECT_GT(largest, 500.0);
}
