// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FrameInterpolation.h
 * @brief Adds frames to a space-time image where labels move far between two frames.
 */
#ifndef voxplex_FrameInterpolation_h
#define voxplex_FrameInterpolation_h

#include "Image/LabelImage.h"
#include "Image/Series/FrameSchedule.h"

#include <cstddef>
#include <span>
#include <stop_token>

namespace voxplex
{

/** Largest number of steps between two frames. */
inline constexpr unsigned MaximumFrameSteps = 8;

/**
 * The number of steps between two frames with which most interfaces move by about a voxel in each:
 * 1 to MaximumFrameSteps. It is smaller if the image would have more than about 400 million voxels.
 *
 * The motion at a voxel whose label changes from A to B is the distance to the nearest B before,
 * plus the distance to the nearest A afterwards, minus the voxel. The result follows from the motion
 * that nineteen in twenty of these voxels do not exceed. Labels that appear or vanish do not count.
 *
 * Looks at up to 20,000 voxels of every pair of frames. The result does not depend on the number of
 * threads.
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
unsigned FrameStepsFor(
  const LabelImage<4>& image, unsigned threads = 1, const std::stop_token& stop = {});

/**
 * @brief The image with `steps` - 1 further frames between two frames, by shape-based interpolation
 * (Raya and Udupa 1990).
 *
 * A voxel with the same label in both frames keeps it. A voxel whose label changes from A to B has A
 * first, and B later. Its score is the signed distance to A minus that to B, interpolated linearly
 * in time. For each pair of labels, the voxels with the smallest scores have the smaller label, and
 * their number changes linearly in time. So do the volumes of all labels. (With a threshold of 0
 * instead, a ball that moves by half its radius is 5 % too small on average.)
 *
 * Distances are measured along the axes of space in the image's unit of length, up to 8 mean voxel
 * spacings. So labels that move farther than that at once vanish and appear.
 *
 * Costs up to some microseconds for each voxel that changes. The result does not depend on the
 * number of threads.
 * @param steps 1 (a copy) to MaximumFrameSteps
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
LabelImage<4> InterpolateFrames(const LabelImage<4>& image, unsigned steps, unsigned threads = 1,
  const std::stop_token& stop = {});

/**
 * @brief The image with other frames: those of the schedule, interpolated as above.
 *
 * @param image its frames may have any distances in time; the one of its grid is not used
 * @param schedule of the image's frames
 * @param step the distance of the new frames in the grid's frame, positive
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
LabelImage<4> ScheduledFrames(const LabelImage<4>& image, const FrameSchedule& schedule,
  double step, unsigned threads = 1, const std::stop_token& stop = {});

/**
 * @brief Grey values of other frames: those of the schedule, interpolated linearly in time.
 *
 * Values that are NaN in one of the two frames are NaN between them.
 * @param values of the series' frames, one frame after the other; float or double
 * @param frame number of the values of a frame
 */
template <typename T>
UninitialisedVector<T> ScheduledValues(std::span<const T> values, std::size_t frame,
  const FrameSchedule& schedule, unsigned threads = 1);

extern template UninitialisedVector<float> ScheduledValues(
  std::span<const float>, std::size_t, const FrameSchedule&, unsigned);
extern template UninitialisedVector<double> ScheduledValues(
  std::span<const double>, std::size_t, const FrameSchedule&, unsigned);

} // namespace voxplex

#endif
