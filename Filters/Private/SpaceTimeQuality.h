// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeQuality.h
 * @brief Measures a pentatope mesh, and its cuts beside the frames of a series.
 */
#ifndef voxplex_SpaceTimeQuality_h
#define voxplex_SpaceTimeQuality_h

#include "Image/LabelImage.h"
#include "Mesh/SimplexMesh.h"
#include "Mesh/TimeSlice.h"
#include "Private/ChosenArray.h"
#include "Private/FrameSeries.h"
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
struct FrameFigures
{
  double Time = 0.0;
  std::uint64_t Elements = 0; ///< tetrahedra
  std::uint64_t Vertices = 0;
  std::uint64_t InterfaceFacets = 0;
  std::uint64_t FacesOfThreeElements = 0;
  MeshMeasurement Measured; ///< in the world; without an image if the frame is empty
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

struct SpaceTimeFigures
{
  MeshQuality Quality;
  SpaceTimeTopology Topology;
  std::vector<double> RadiusEdgeRatios;  ///< of each pentatope
  std::vector<double> NormalizedVolumes; ///< of each pentatope
  std::vector<double> Hypervolumes;      ///< of each pentatope
  std::vector<WorstElement> Worst;       ///< by increasing normalized volume
  std::vector<FrameFigures> Frames;
  /** Of the image, by label: the trapezoidal rule over the frames. Empty without an image. */
  std::map<std::int64_t, double> ImageHypervolumes;
  std::optional<ComponentComparison> Components; ///< of space-time; empty without an image
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

/** Sorted by label. */
std::vector<SpaceTimeLabel> LabelsOf(const SpaceTimeFigures& figures);
/** Labels of the image that the mesh lacks; none without an image. */
std::vector<std::int64_t> LostLabelsOf(const SpaceTimeFigures& figures);

class SpaceTimeQuality
{
public:
  /**
   * @param mesh in the world; times are multiplied by the scale
   * @param options of the cuts; those of shapes are for the pentatopes, too
   */
  SpaceTimeQuality(SimplexMesh<4> mesh, double timeScale, const MeasurementOptions& options);
  SpaceTimeQuality(const SpaceTimeQuality&) = delete;
  SpaceTimeQuality& operator=(const SpaceTimeQuality&) = delete;

  /** Measures the pentatopes. @throws Cancelled; std::bad_alloc */
  void MeasureElements(std::size_t worst, const std::stop_token& stop);

  /** Measures a cut without an image. @throws Cancelled; std::bad_alloc */
  void MeasureCut(double time, const std::stop_token& stop);
  /**
   * Measures a cut beside its frame, whose voxels that are not selected are background.
   * @throws InputError if a value is no label; Cancelled; std::bad_alloc
   */
  void MeasureCut(double time, const ChosenArray& frame, const LabelSelection& selection,
    const std::stop_token& stop);

  /**
   * Compares with the whole series, after the cuts.
   * @throws InputError, see FrameSeries::MakeLabelImage(); Cancelled; std::bad_alloc
   */
  void MeasureImage(const FrameSeries& series, const std::stop_token& stop);

  const SpaceTimeFigures& Figures() const { return this->All; }
  const SimplexMesh<4>& Mesh() const { return this->Pentatopes; }

private:
  /** The cut in the frame of an image; in the world if it is null. */
  SimplexMesh<3> Cut(double time, const ImageFrame* frame) const;
  void Add(double time, SimplexMesh<3> cut, const LabelImage<3>* image, const ImageFrame* frame,
    const std::stop_token& stop);

  SimplexMesh<4> Pentatopes;
  const double TimeScale;
  const MeasurementOptions Options;
  // What the slicer reads.
  std::vector<double> Positions;
  std::vector<double> Times; ///< in the unit of the image
  std::vector<long long> Offsets;
  std::vector<long long> Connectivity;
  std::optional<TimeSlicer> Slicer;
  SpaceTimeFigures All;
};

} // namespace voxplex

#endif
