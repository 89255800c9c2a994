// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FrameSchedule.h
 * @brief Equally spaced frames for a series whose frames have any times.
 */
#ifndef voxplex_FrameSchedule_h
#define voxplex_FrameSchedule_h

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace voxplex
{

/** A time between two frames of a series, or that of a frame. */
struct FramePlace
{
  std::int64_t Before = 0; ///< the number of the frame before
  double Weight = 0.0;     ///< of the frame after it: 0 to below 1; 0 is the frame before itself
};

/** The frames of a series at equal distances in time. */
struct FrameSchedule
{
  /** Of the equally spaced frames: the first is the first frame, the last is the last frame. */
  std::vector<FramePlace> Places;

  std::int64_t NumberOfFrames() const { return static_cast<std::int64_t>(this->Places.size()); }

  /** Whether the frames are those of the series. */
  bool ChangesNothing() const
  {
    return this->Places.back().Before + 1 == this->NumberOfFrames() &&
      std::all_of(this->Places.begin(), this->Places.end(),
        [](const FramePlace& place) { return place.Weight == 0.0; });
  }
};

/** There are never more equally spaced frames than this, unless the frames are equally spaced. */
inline constexpr std::int64_t MostScheduledFrames = 1000;

/** How far times may be from equal distances, in steps. */
inline constexpr double FrameTimeTolerance = 1e-3;

/**
 * @brief Chooses equally spaced frames from the first to the last time.
 *
 * 1. If distances from frame to frame differ by at most FrameTimeTolerance, the frames stay as they
 *    are.
 * 2. If all times are multiples of the smallest distance, or of a half, a third ... an eighth of it,
 *    the largest such step is taken. All frames stay, and there are frames between them.
 * 3. Otherwise the step is the smallest distance or a little less, and most frames are replaced by
 *    frames between frames.
 *
 * Costs up to eight passes over the times.
 * @param times of the frames
 * @param most the largest number of frames; it does not limit the first case
 * @throws InputError, which names frames and times, if there are fewer than two times; if they are
 *   not finite, do not increase or are too far apart; if there would be more than `most` frames
 */
FrameSchedule ScheduleFrames(
  std::span<const double> times, std::int64_t most = MostScheduledFrames);

} // namespace voxplex

#endif
