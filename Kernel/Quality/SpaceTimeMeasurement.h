// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeMeasurement.h
 * @brief Measures a pentatope mesh, and its cuts beside the frames of a series.
 */
#ifndef voxplex_SpaceTimeMeasurement_h
#define voxplex_SpaceTimeMeasurement_h

#include "Image/LabelImage.h"
#include "Image/SpaceTimeFrame.h"
#include "Mesh/SimplexMesh.h"
#include "Mesh/TimeSlice.h"
#include "Quality/MeshMeasurement.h"
#include "Quality/SpaceTimeTopology.h"

#include <cstdint>
#include <map>
#include <optional>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** The cut at the time of a frame. */
struct FrameMeasurement
{
  double Time = 0.0;
  MeshMeasurement Measured; ///< without an image if the frame is empty
};

/** A pentatope with a small normalized volume. */
struct WorstElement
{
  std::uint32_t Cell = 0;
  std::int64_t Label = 0;
  double NormalizedVolume = 0.0;
  double RadiusEdgeRatio = 0.0;
  Point<4> Place{}; ///< its centroid, in the world and the unit of times
};

/** A label of the mesh or the image, in space-time. */
struct SpaceTimeLabel
{
  std::int64_t Label = 0;
  std::uint64_t Elements = 0;
  double Volume = 0.0;
  std::uint64_t Components = 0;
  double ImageVolume = 0.0;
  double VolumeError() const { return (this->Volume - this->ImageVolume) / this->ImageVolume; }
};

struct SpaceTimeMeasurement
{
  MeshCounts Counts;
  MeshQuality Quality;
  SpaceTimeTopology Topology;
  std::vector<double> RadiusEdgeRatios;  ///< of each pentatope
  std::vector<double> NormalizedVolumes; ///< of each pentatope
  std::vector<double> Hypervolumes;      ///< of each pentatope
  std::vector<WorstElement> Worst;       ///< by increasing normalized volume
  std::vector<FrameMeasurement> Frames;
  /** Of the image, by label: the trapezoidal rule over the frames. Empty without an image. */
  std::map<std::int64_t, double> ImageHypervolumes;
  std::optional<ComponentComparison> Components; ///< of space-time; empty without an image

  /** Sorted by label. */
  std::vector<SpaceTimeLabel> Labels() const;
  /** Labels of the image that the mesh lacks; none without an image. */
  std::vector<std::int64_t> LostLabels() const;
};

class SpaceTimeMeasurer
{
public:
  /**
   * @param mesh in the world; times are multiplied by the scale
   * @param options of the cuts; those of shapes are for the pentatopes, too
   */
  SpaceTimeMeasurer(SimplexMesh<4> mesh, double timeScale, const MeasurementOptions& options);
  SpaceTimeMeasurer(const SpaceTimeMeasurer&) = delete;
  SpaceTimeMeasurer& operator=(const SpaceTimeMeasurer&) = delete;

  /** Measures the pentatopes. @throws Cancelled; std::bad_alloc */
  void MeasureElements(std::size_t worst, const std::stop_token& stop);

  /**
   * Measures a cut, MeasureMesh().
   * @param image of this time; null if there is none, or if all of it is background
   * @throws Cancelled; std::bad_alloc
   */
  void MeasureCut(
    double time, const LabelImage<3>* image, const ImageFrame& frame, const std::stop_token& stop);

  /**
   * Compares with the whole series, after the cuts.
   * @throws Cancelled; std::bad_alloc
   */
  void MeasureImage(
    const LabelImage<4>& image, const SpaceTimeFrame& frame, const std::stop_token& stop);

  const SpaceTimeMeasurement& Measurement() const { return this->All; }

private:
  SimplexMesh<4> Pentatopes;
  const double TimeScale;
  const MeasurementOptions Options;
  // What the slicer reads.
  std::vector<double> Positions;
  std::vector<double> Times; ///< in the unit of the image
  std::vector<long long> Offsets;
  std::vector<long long> Connectivity;
  std::optional<TimeSlicer> Slicer;
  SpaceTimeMeasurement All;
};

} // namespace voxplex

#endif
