// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeRun.h
 * @brief One mesh of a space-time phantom, and its measures.
 */
#ifndef voxplex_SpaceTimeRun_h
#define voxplex_SpaceTimeRun_h

#include "../Testing/Phantoms/SpaceTimePhantoms.h"
#include "Mesher/ImageMesher.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxplex::benchmarks
{

/** The number of labels of the phantoms: 1 and 2. */
inline constexpr std::size_t MostLabels = 2;
inline constexpr std::size_t MostFrames = 64;

/** The same measure of the image and of the mesh. */
struct Compared
{
  double Image;
  double Mesh;

  /** The relative error; 0 if both are equal. */
  double Error() const { return this->Image == this->Mesh ? 0.0 : this->Mesh / this->Image - 1.0; }
};

/**
 * How well a mesh fits the image it was made from. Labels are numbered from 0 here: label 1 is [0].
 */
struct Fit
{
  std::size_t Frames = 0;
  std::array<std::array<Compared, MostFrames>, MostLabels> Volume{}; ///< in every frame, 3D
  std::array<Compared, MostLabels> Hypervolume{};
  double LateralFacets = 0.0;
  double FacetsOffInterface = 0.0; ///< lateral facets with a vertex that is on no interface
};

/** The result of a run, from its process. */
struct SpaceTimeRecord
{
  double Pentatopes = 0.0;
  double BoundaryTetrahedra = 0.0;
  double Vertices = 0.0;
  double ShortestEdge = 0.0;
  double RadiusEdgeMax = 0.0;
  double RadiusEdgeMean = 0.0;
  double RadiusEdgeDeviation = 0.0;
  double VolumeMin = 0.0; ///< normalized
  double VolumeMean = 0.0;
  double VolumeDeviation = 0.0;
  double Inverted = 0.0;
  double AverageCavity = 0.0; ///< mean number of pentatopes that an insertion deletes
  double LargestCavity = 0.0;
  double SliversKept = 0.0;
  double FrameSteps = 0.0;
  double LostComponents = 0.0; ///< those of frames included
  double PreparationSeconds = 0.0;
  double GradingSeconds = 0.0;
  double GradingSamples = 0.0;
  double RefinementSeconds = 0.0;
  double ExtractionSeconds = 0.0;
  double TotalSeconds = 0.0;
  std::uint64_t PeakBytes = 0;
  // Averages over refinement threads:
  double ContentionSeconds = 0.0;
  double LoadBalanceSeconds = 0.0;
  double RollbackSeconds = 0.0;
  double Rollbacks = 0.0;
  Fit Image; ///< empty unless requested

  double Rate() const { return this->Pentatopes / this->RefinementSeconds; }
};

/**
 * Meshes the scalars of a phantom and measures the mesh. Peak memory is the peak until the end of
 * meshing.
 * @param fit whether to compare with the image; takes one pass over the mesh for each frame
 */
SpaceTimeRecord MeshPhantom(const std::vector<std::uint8_t>& scalars, const GridGeometry<4>& grid,
  const MeshingOptions<4>& options, bool fit);

} // namespace voxplex::benchmarks

#endif
