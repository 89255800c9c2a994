// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FrameSeries.h
 * @brief Gathers the images of a time series as one array of labels or grey values.
 *
 * An image of the series is called a frame here. LabelImage and IsosurfaceImage want the voxels of all
 * frames in one array: x fastest, then y, z, time. Labels are kept in 8, 16 or 64 bits each, as few as those seen
 * so far need. The type of the images' scalars does not count. Grey values are kept as float if
 * that holds the values of their type exactly, otherwise as double.
 */
#ifndef voxplex_FrameSeries_h
#define voxplex_FrameSeries_h

#include "Base/UninitialisedVector.h"
#include "Image/IsosurfaceImage.h"
#include "Image/LabelImage.h"
#include "Image/Series/FrameSchedule.h"
#include "Image/SpaceTimeFrame.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace voxplex
{

class FrameSeries
{
public:
  /**
   * Starts anew.
   * @param isOfLabels whether frames have labels; otherwise they have grey values
   * @param selection the labels to mesh, if there are labels
   * @throws InputError if there are no equally spaced frames for the times (ScheduleFrames())
   */
  void Start(std::vector<double> times, bool isOfLabels, const LabelSelection& selection = {});
  /** Forgets everything and releases the memory. */
  void Clear();

  std::size_t NumberOfFrames() const { return this->Times.size(); }
  /** Frames added so far: the next one's number. */
  std::size_t NumberOfFramesAdded() const { return this->Added; }
  bool IsComplete() const { return this->Added == this->Times.size(); }
  /** "frame 2 (time 0.5)"; frames are counted from 0. */
  std::string NameOf(std::size_t frame) const;
  double TimeOf(std::size_t frame) const { return this->Times[frame]; }

  /**
   * Copies the values of the next frame: those at 0, stride, 2 stride, ...
   * @param frame where it lies
   * @param arrayName in which the image has them
   * @param threads 0 means all cores
   * @throws InputError, which names the frames, if the grid or the array's name is not the first
   * frame's, or if there is a value that cannot be a label; std::bad_alloc
   */
  template <typename T>
  void Add(const T* values, std::size_t stride, const ImageFrame& frame,
    const std::string& arrayName, unsigned threads);
  bool IsOfLabels() const { return this->HasLabels; }

  /**
   * Where the complete series lies: its grid has equally spaced frames from the first to the last
   * time.
   * @throws InputError if equally spaced frames would have too many voxels
   */
  SpaceTimeFrame MakeFrame(double timeScale) const;

  /**
   * The labels of the complete series. Frames that are not equally spaced are interpolated
   * (ScheduledFrames()).
   * @param grid of MakeFrame()
   * @throws what LabelImage::FromScalars() throws
   */
  LabelImage<4> MakeLabelImage(const GridGeometry<4>& grid, unsigned threads) const;

  /**
   * The isosurface of the complete series, whose values are grey. They are interpolated linearly in
   * time if frames are not equally spaced; the series then has the interpolated ones.
   * @param grid of MakeFrame()
   * @return refers to values of this object
   * @throws what IsosurfaceImage::FromScalars() throws
   */
  IsosurfaceImage<4> MakeIsosurface(
    const GridGeometry<4>& grid, const Isosurface& surface, unsigned threads);

private:
  FrameSchedule MakeSchedule() const;
  std::size_t VoxelsOfFrame() const;
  template <typename T>
  void CopyLabels(const T* values, std::size_t stride, unsigned threads);
  template <typename T>
  void CopyGreyValues(const T* values, std::size_t stride, unsigned threads);
  /** Copies into the present type. */
  template <typename T>
  void Copy(const T* values, std::size_t stride, unsigned threads);
  /** Makes room for values of type U. */
  template <typename U>
  void WidenTo(unsigned threads);
  void CheckSameGrid(const ImageFrame& frame, const std::string& arrayName) const;

  std::vector<double> Times;
  std::size_t Added = 0;
  ImageFrame FirstFrame;
  std::string ArrayName;
  bool HasLabels = true;
  LabelSelection Selection;
  /** Of all frames; those not yet added are uninitialised. Alternatives in order of width. */
  std::variant<UninitialisedVector<std::uint8_t>, UninitialisedVector<std::uint16_t>,
    UninitialisedVector<std::int64_t>, UninitialisedVector<float>, UninitialisedVector<double>>
    Values;
};

} // namespace voxplex

#endif
