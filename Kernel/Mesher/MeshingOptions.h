// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingOptions.h
 * @brief The options of the mesher.
 */
#ifndef voxplex_MeshingOptions_h
#define voxplex_MeshingOptions_h

#include "Conformity/InterfaceOptions.h"
#include "Parallel/Policies.h"
#include "Refinement/RuleOptions.h"
#include "Sizing/Grading/GradingOptions.h"
#include "Sizing/InterfaceSizes.h"
#include "Sizing/SizeFunction.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace voxplex
{

/** See MeshingOptions::Gradation and Documentation/Algorithm.md. */
inline constexpr double DefaultGradation = 0.3;

/** The options of a run. Lengths are in the unit of the image's spacing. */
template <int D>
struct MeshingOptions
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
  /** Where to sample interfaces more coarsely than Delta; 3D only. */
  GradingOptions Grading;
  /**
   * Upper bound of circumradius / shortest edge. Below 1.93, termination is not proved (needs
   * Force).
   */
  double RadiusEdgeRatio = 2.0;
  /** Lower bound of the angles of interface facets, degrees, 0 to 30; 3D only. */
  double FacetAngle = 30.0;
  /** The order of the rules; 4D only. */
  RuleOrder Order = RuleOrder::RadiusEdgeFirst;
  /** Sliver removal; 4D only. */
  SliverOptions Slivers;
  /** Sliver removal; 3D only. */
  TetSliverOptions TetSlivers;
  /**
   * Connected components (through faces) with at least this number of voxels get elements, however
   * large delta is. So does the largest component of each label, however small it is. 0: components
   * are not checked. Components that still have no element are in ComponentStatistics::Lost. 3D
   * only.
   */
  std::int64_t SmallestComponent = 8;
  /**
   * If true, the components checked by SmallestComponent are sampled as finely as their thickness
   * requires from the start, however large delta is. If false, a component that is thin compared
   * with delta is only as exact as delta allows, but has at least one element. 3D only.
   */
  bool ExactComponents = false;
  /**
   * Start with points on the curves where three or more labels meet, so that edges of the mesh
   * follow these curves. 3D only.
   */
  bool SampleJunctions = true;
  /** Checks of interfaces after refinement. 3D only. */
  InterfaceOptions Interfaces;
  /**
   * Standard deviation of the label smoothing, in voxels along each axis; 0 switches it off. For
   * label images only; for isosurfaces see Isosurface::SmoothingSigma.
   */
  double SmoothingSigma = 1.0;
  /** Upper bound of circumradii, or null. */
  std::shared_ptr<const SizeFunction<D>> Size;
  /** Sampling distances of single interfaces, in place of delta. They may be larger than delta. */
  std::vector<InterfaceSize> InterfaceSizes;
  /** The largest change of Size, and of interface sizes, over a unit of length. 0: no limit. */
  double Gradation = DefaultGradation;
  /**
   * Improve shapes after refinement (Optimisation/MeshOptimiser.h), where possible to dihedral
   * angles of 15 to 155 degrees. Radius-edge ratios may then be up to 2.5 or RadiusEdgeRatio,
   * whichever is larger. The mesh is no longer Delaunay. 3D only.
   */
  bool Optimise = false;
  /**
   * Wall-clock seconds after which optimisation stops; 0: no limit. If it stops, the mesh depends
   * on the machine.
   */
  double OptimisationSeconds = 0.0;
  /** Threads; 0 means all cores. */
  unsigned Threads = 1;
  /** What a refinement thread does if another thread holds a vertex that it needs. */
  ContentionPolicy Contention = ContentionPolicy::Local;
  /** Which threads give work to an idle refinement thread. */
  BalancePolicy Balance = BalancePolicy::Hierarchical;
  /** Keep each refinement thread on a core of its own, where the system allows it. */
  bool PinThreads = false;
  /** Refine with the code for several threads even with one thread, to measure its cost. */
  bool Synchronise = false;
  /**
   * Several threads: remove simplices from the lists of poor elements when they are deleted (the
   * thesis' REMOVE_ON_THE_FLY), not when a thread takes them from the list.
   */
  bool RemoveEagerly = false;
  /**
   * If there are several threads, but not more than processors: waiting threads help others with
   * large insertions (thesis, 4.6.2).
   */
  bool FineGrained = D == 4;
  /**
   * Several threads: the approximate number of interface points for each thread that are inserted
   * before the threads start, so that all threads have work at once. 0: none, as in the thesis.
   */
  unsigned SeedsPerThread = 128;
  /**
   * Mesh even if the mesh is estimated not to fit in memory, the labels look like grey values
   * (CheckSegmented), or the ratio is below the proved bound.
   */
  bool Force = false;
  /** The memory limit in bytes for the estimate; 0 means the machine's physical memory. */
  std::uint64_t MemoryLimit = 0;

  bool LooksAfterComponents() const { return D == 3 && this->SmallestComponent > 0; }
  bool Optimises() const { return D == 3 && this->Optimise; }
};

/** The largest radius-edge ratio that optimisation allows. */
inline constexpr double OptimisedRadiusEdgeRatio = 2.5;

/**
 * The smallest radius-edge ratio for which termination is proved: sqrt(sqrt(3) + 2) (thesis, 2.3).
 */
inline constexpr double ProvedRadiusEdgeRatio = 1.9318516525781366;

/** The default delta, from the (hyper)volume of a voxel: see Documentation/Algorithm.md. */
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
