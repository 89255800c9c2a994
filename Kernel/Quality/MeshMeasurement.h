// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshMeasurement.h
 * @brief All that can be said of a tetrahedral mesh, and of how well it shows the image it was made from.
 */
#ifndef voxplex_MeshMeasurement_h
#define voxplex_MeshMeasurement_h

#include "Image/DropComponents.h"
#include "Image/LabelImage.h"
#include "Mesh/SimplexMesh.h"
#include "Quality/InterfaceDistance.h"
#include "Quality/InterfaceTopology.h"
#include "Quality/MeshQuality.h"

#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** What to measure. */
struct MeasurementOptions
{
  double RadiusEdgeBound = 2.0;  ///< elements at or above it are counted
  double FacetAngleBound = 30.0; ///< facets with an angle below it are counted; degrees
  /** Voxels; smaller connected components are not looked for, but for the largest of each label. */
  std::int64_t SmallestComponent = 8;
  bool Distances = true;       ///< from the interfaces between voxels
  bool SmoothDistances = true; ///< from the interfaces of the label field; only with Distances
  double SmoothingSigma = 1.0; ///< of the label field, voxels
  unsigned Threads = 1;        ///< 0 means all cores
};

/** A label in an image and in a mesh; in one of them it may be missing. */
struct LabelComparison
{
  std::int64_t Label = 0;
  std::int64_t Voxels = 0;
  double ImageVolume = 0.0; ///< voxels times the volume of a voxel
  std::uint64_t Elements = 0;
  double Volume = 0.0; ///< of the mesh
};

/** Distances are NaN where they were not measured. */
struct ImageComparison
{
  std::vector<LabelComparison> Labels; ///< of the image or the mesh, sorted, without background
  std::vector<std::int64_t> LostLabels;
  std::vector<std::int64_t> ExtraLabels; ///< in the mesh only
  double ImageVolume = 0.0;              ///< of all labels
  double Volume = 0.0;                   ///< of all elements
  /** Sum over labels of |volume in the mesh - volume in the image| over the volume in the image. */
  double VolumeError = 0.0;

  std::uint64_t Components = 0; ///< connected through faces, those that are looked for
  std::vector<ComponentReport> LostComponents; ///< FindLostComponents()

  HausdorffFigures Voxels; ///< from the centres of the faces between voxels of different labels
  HausdorffFigures Smooth; ///< from the interfaces of the label field
};

struct MeshMeasurement
{
  MeshQuality Quality;
  InterfaceTopology Topology;
  std::optional<ImageComparison> Image;
};

/**
 * Measures a mesh, Facets and FacetLabels included (FindInterfaces() makes them).
 *
 * The result does not depend on the number of threads. Without distances it takes about as long as to write
 * the mesh to a file; with them, a few microseconds for each facet and each face between voxels.
 *
 * @param image in the mesh's frame, or null
 * @throws Cancelled if a stop was requested before the end; InputError if SmoothingSigma is out of range;
 *   std::bad_alloc
 */
MeshMeasurement MeasureMesh(const SimplexMesh<3>& mesh, const LabelImage<3>* image,
  const MeasurementOptions& options, const std::stop_token& stop = {});

} // namespace voxplex

#endif
