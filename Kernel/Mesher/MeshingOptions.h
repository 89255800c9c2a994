// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingOptions.h
 * @brief The options of the mesher.
 */
#ifndef voxplex_MeshingOptions_h
#define voxplex_MeshingOptions_h

#include "Conformity/ConformityOptions.h"
#include "Refinement/Rules/RuleOptions.h"
#include "Refinement/Scheduling/TeamOptions.h"
#include "Sizing/Grading/GradingOptions.h"
#include "Sizing/InterfaceSizes.h"
#include "Sizing/SizeFunction.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace voxplex
{

/** See SamplingOptions::Gradation; Benchmarks/Notebook.md tells why. */
inline constexpr double DefaultGradation = 0.3;

/** How far apart points are. Lengths are in the unit of the image's spacing. */
template <int D>
struct SamplingOptions
{
  /**
   * Sampling distance of interfaces (delta of the thesis). 0: derived from the spacing
   * (DefaultDelta).
   */
  double Delta = 0.0;
  /**
   * Requested number of elements. 0: Delta is used instead; otherwise Delta must be 0. Refinement
   * is repeated with other deltas (DeltaSearch) until the number is met within
   * DeltaSearch::Tolerance. Sizes and interface sizes are not changed. MeshingStatistics::Runs has
   * the result of each refinement.
   */
  std::uint64_t Elements = 0;
  /** Where to sample interfaces more coarsely than Delta. */
  GradingOptions Grading;
  /** Sampling distances of single interfaces, in place of delta. They may be larger than delta. */
  std::vector<InterfaceSize> InterfaceSizes;
  /** Upper bound of circumradii, or null. */
  std::shared_ptr<const SizeFunction<D>> Size;
  /** The largest change of Size, and of interface sizes, over a unit of length. 0: no limit. */
  double Gradation = DefaultGradation;
};

/** Optimisation after refinement (Optimisation/Tetrahedra/MeshOptimiser.h, PentatopeOptimiser.h). */
struct OptimisationStageOptions
{
  /**
   * Improve shapes: in 3D to dihedral angles of 18 to 150 degrees where possible, in 4D to
   * normalized volumes of OptimisedNormalizedVolume. Radius-edge ratios of 3D may then be up to 2.5
   * or ShapeOptions::RadiusEdgeRatio, whichever is larger. The mesh is no longer Delaunay.
   */
  bool Run = false;
  /**
   * 3D only. Wall-clock seconds after which optimisation stops; 0: no limit. If it stops, the mesh
   * depends on the machine.
   */
  double Seconds = 0.0;
};

/** Hyperplanes of constant time that the mesh conforms to; 4D only. */
struct TimePlaneOptions
{
  /**
   * Times in the mesher's frame, in any order; 0 is that of the first frame. Those of the first and
   * the last frame, and repeated ones, have no effect.
   */
  std::vector<double> Times;
  /**
   * The first and the last frame are the same state; they must be equal. The two ends of the mesh
   * are congruent. If there is no plane between them, one is added half-way.
   */
  bool Periodic = false;
  /**
   * Rounds in which slabs may insert points on planes; see SlabRefinement. Fewer make worse shapes beside planes.
   */
  unsigned OpenRounds = 8;

  bool AreWanted() const { return this->Periodic || !this->Times.empty(); }
};

/** What is refused. */
struct LimitOptions
{
  /**
   * Mesh even if the mesh is estimated not to fit in memory, the labels look like grey values
   * (CheckSegmented), or the ratio is below the proved bound.
   */
  bool Force = false;
  /** The memory limit in bytes for the estimate; 0 means the machine's physical memory. */
  std::uint64_t Memory = 0;
};

/** The options of a run. */
template <int D>
struct MeshingOptions
{
  /**
   * Standard deviation of the label smoothing, in voxels along each axis; 0 switches it off. For
   * label images only; for isosurfaces see Isosurface::SmoothingSigma.
   */
  double SmoothingSigma = 1.0;
  /**
   * Connected components with less (hyper)volume are left out before all else (DropComponents()). The
   * grid's unit of length to the power D; 0 keeps all. The statistics list what was left out.
   */
  double SmallestVolume = 0.0;
  /**
   * Steps between two frames of a label image; labels are interpolated between them
   * (InterpolateFrames()). 0: as many as the motion asks for (FrameStepsFor()). At most
   * MaximumFrameSteps; 4D only.
   */
  unsigned FrameSteps = 0;
  SamplingOptions<D> Sampling;
  ShapeOptions Shape;
  SpaceTimeRuleOptions SpaceTime; ///< 4D only
  TimePlaneOptions Planes;        ///< 4D only
  ComponentOptions Components;
  InterfaceOptions Interfaces;
  OptimisationStageOptions Optimisation;
  TeamOptions Team = TeamOptions::Default<D>();
  LimitOptions Limits;
  bool MeasureQuality = false; ///< of the finished mesh, for MeshingStatistics::Quality

  bool KeepsComponents() const { return this->Components.Smallest > 0; }
};

/** The largest radius-edge ratio that optimisation allows in 3D. */
inline constexpr double OptimisedRadiusEdgeRatio = 2.5;

/** Optimisation improves pentatopes with a smaller normalized volume. */
inline constexpr double OptimisedNormalizedVolume = 0.05;

/**
 * Below this radius-edge ratio, meshes can become very large: Force only. In 3D termination is proved from
 * sqrt(sqrt(3) + 2) = 1.932 on (thesis, theorem 2.2), which the thesis rounds to this. In 4D the
 * proof asks for 16 (theorem 4.1).
 */
inline constexpr double SmallestRadiusEdgeRatio = 1.93;

/** The default delta: twice the edge of a (hyper)cube with the (hyper)volume of a voxel. */
template <int D>
double DefaultDelta(double voxelVolume);

/**
 * @throws InputError if an option is out of its range; Error if the build's floating-point
 * arithmetic is not strict
 */
template <int D>
void CheckOptions(const MeshingOptions<D>& options);

extern template double DefaultDelta<3>(double);
extern template double DefaultDelta<4>(double);
extern template void CheckOptions<3>(const MeshingOptions<3>&);
extern template void CheckOptions<4>(const MeshingOptions<4>&);

} // namespace voxplex

#endif
