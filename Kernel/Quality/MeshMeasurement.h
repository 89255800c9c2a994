// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshMeasurement.h
 * @brief All measures of a tetrahedral mesh, and of how well it represents the image it was made
 * from.
 */
#ifndef voxplex_MeshMeasurement_h
#define voxplex_MeshMeasurement_h

#include "Image/DropComponents.h"
#include "Image/ImageFrame.h"
#include "Image/LabelImage.h"
#include "Mesh/SimplexMesh.h"
#include "Quality/InterfaceDistance.h"
#include "Quality/InterfaceTopology.h"
#include "Quality/MeshQuality.h"

#include <cstdint>
#include <map>
#include <optional>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** What to measure. */
struct MeasurementOptions
{
  double RadiusEdgeBound = 2.0;  ///< elements at or above this ratio are counted
  double FacetAngleBound = 30.0; ///< facets with an angle below this are counted; degrees
  /**
   * Smaller connected components are not looked for, except the largest component of each label.
   * Voxels.
   */
  std::int64_t SmallestComponent = 8;
  bool Distances = true;       ///< to the interfaces between voxels
  bool SmoothDistances = true; ///< to the interfaces of the label field; only with Distances
  double SmoothingSigma = 1.0; ///< of the label field, voxels
  unsigned Threads = 1;        ///< 0 means all cores
};

/** A label in an image and in a mesh. It may be missing from one of them. */
struct LabelComparison
{
  std::int64_t Label = 0;
  std::int64_t Voxels = 0;
  double ImageVolume = 0.0; ///< voxels times the volume of a voxel
  std::uint64_t Elements = 0;
  double Volume = 0.0; ///< of the mesh
  double VolumeError() const { return (this->Volume - this->ImageVolume) / this->ImageVolume; }
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

  std::uint64_t Components = 0; ///< the components that are looked for, connected through faces
  std::vector<ComponentReport> LostComponents; ///< FindLostComponents()

  HausdorffFigures Voxels; ///< to the centres of the faces between voxels of different labels
  HausdorffFigures Smooth; ///< to the interfaces of the label field
};

struct MeshCounts
{
  std::uint64_t Elements = 0;
  std::uint64_t Vertices = 0;
  std::uint64_t InterfaceFacets = 0;
  std::uint64_t FacesOfThreeElements = 0; ///< which no conforming mesh has
};

struct MeshMeasurement
{
  MeshCounts Counts;
  MeshQuality Quality;
  InterfaceTopology Topology;
  std::map<std::int64_t, std::uint64_t> Fragments; ///< CountFragments()
  std::optional<ImageComparison> Image;
};

/** Connected components of an image in a mesh. */
struct ComponentComparison
{
  std::uint64_t Wanted = 0;          ///< the components that are looked for
  std::vector<ComponentReport> Lost; ///< FindLostComponents()
};

/**
 * Looks for the components of an image in a mesh.
 * @param smallest see MeasurementOptions::SmallestComponent
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
ComponentComparison CompareComponents(const SimplexMesh<D>& mesh, const LabelImage<D>& image,
  std::int64_t smallest, unsigned threads, const std::stop_token& stop = {});

/**
 * Measures a mesh.
 *
 * The result does not depend on the number of threads. Without distances, it takes about as long as
 * writing the mesh to a file. With distances, it takes a few microseconds for each facet and each
 * face between voxels.
 *
 * @param mesh points, tetrahedra and labels in the world, positive as the axes are; it is moved into
 *   the frame, and gets interfaces (FindInterfaces())
 * @param image the image, or null
 * @param frame where the image lies, or the world's own; places in the result are in the world
 * @throws Cancelled if a stop was requested before the end; InputError if SmoothingSigma is out of
 *   range; std::bad_alloc
 */
MeshMeasurement MeasureMesh(SimplexMesh<3>& mesh, const LabelImage<3>* image,
  const ImageFrame& frame, const MeasurementOptions& options, const std::stop_token& stop = {});

} // namespace voxplex

#endif
