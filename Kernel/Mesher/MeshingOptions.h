// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingOptions.h
 * @brief What a user can ask of the mesher.
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

/** What the user asks for. Lengths are in the unit of the image's spacing. */
template <int D>
struct MeshingOptions
{
  /** Sampling density of interfaces (delta of the thesis); 0 derives it from the spacing (DefaultDelta). */
  double Delta = 0.0;
  /**
   * Elements that the mesh is to have; 0: as Delta says, which must be 0 otherwise. Refinement is repeated with other
   * deltas (DeltaSearch) until the number is met to within DeltaSearch::Tolerance; sizes and interface sizes stay
   * what they are. MeshingStatistics::Runs tells of each.
   */
  std::uint64_t Elements = 0;
  /** Where to sample interfaces more coarsely than Delta; 3D only. */
  GradingOptions Grading;
  /** Upper bound of circumradius / shortest edge; below 1.93 termination is not proved (needs Force). */
  double RadiusEdgeRatio = 2.0;
  /** Lower bound of the angles of interface facets, degrees, 0 to 30; 3D only. */
  double FacetAngle = 30.0;
  /** Which rules come first; 4D only. */
  RuleOrder Order = RuleOrder::RadiusEdgeFirst;
  /** How slivers are fought; 4D only. */
  SliverOptions Slivers;
  /** How slivers are fought; 3D only. */
  TetSliverOptions TetSlivers;
  /**
   * Connected components (through faces) of at least so many voxels get elements whatever delta, and so does the
   * largest of each label however small; 0: as it comes. Those that got none all the same are in
   * ComponentStatistics::Lost. 3D only.
   */
  std::int64_t SmallestComponent = 8;
  /**
   * Sample what SmallestComponent looks after as finely as it is thin from the start, whatever delta. Otherwise a component
   * that is thin beside delta is as exact as delta makes it, but has an element at least. 3D only.
   */
  bool ExactComponents = false;
  /** Begin with points on the curves where three labels or more meet, so that the mesh's edges follow them.
   * 3D only. */
  bool SampleJunctions = true;
  /** How far interfaces are looked after when refinement is done. 3D only. */
  InterfaceOptions Interfaces;
  /**
   * Standard deviation of the label smoothing, voxels along each axis; 0 switches it off. Of label images
   * only: see Isosurface::SmoothingSigma.
   */
  double SmoothingSigma = 1.0;
  /** Upper bound of circumradii, or null. */
  std::shared_ptr<const SizeFunction<D>> Size;
  /** Sampling densities of single interfaces, in place of delta; larger ones, too. */
  std::vector<InterfaceSize> InterfaceSizes;
  /** How much Size, and interface sizes, may change over a unit of length; 0: no limit. */
  double Gradation = DefaultGradation;
  /**
   * Improve shapes after refinement (Optimisation/MeshOptimiser.h): dihedral angles of 15 to 155 degrees where it
   * can, radius-edge ratios up to 2.5 or RadiusEdgeRatio, whichever is larger. The mesh is no longer
   * Delaunay. 3D only.
   */
  bool Optimise = false;
  /** Wall-clock seconds after which optimisation stops where it is, and the mesh depends on the machine; 0: never. */
  double OptimisationSeconds = 0.0;
  /** Threads; 0 means all cores. */
  unsigned Threads = 1;
  /** What a refinement thread does when it meets another. */
  ContentionPolicy Contention = ContentionPolicy::Local;
  /** From whom an idle refinement thread gets work. */
  BalancePolicy Balance = BalancePolicy::Hierarchical;
  /** Keep each refinement thread on a core of its own, where the system allows it. */
  bool PinThreads = false;
  /** Refine with the code for several threads even if there is one: to measure what that costs. */
  bool Synchronise = false;
  /** Several threads: take simplices out of the lists of poor elements when they die (the thesis'
   * REMOVE_ON_THE_FLY), not when they come up. */
  bool RemoveEagerly = false;
  /** Several threads, but no more than processors: those that wait help others with large insertions
   * (thesis, 4.6.2). */
  bool FineGrained = D == 4;
  /** Several threads: interface points a thread, about, that are inserted before the threads start, so
   * that all have work from the first moment; 0 for none, as in the thesis. */
  unsigned SeedsPerThread = 128;
  /** Go on although the mesh is estimated not to fit in memory, the labels look like grey values (CheckSegmented), or
   * the ratio is below the proved bound. */
  bool Force = false;
  /** Bytes that the mesher may plan with; 0 means the machine's physical memory. */
  std::uint64_t MemoryLimit = 0;

  bool LooksAfterComponents() const { return D == 3 && this->SmallestComponent > 0; }
  bool Optimises() const { return D == 3 && this->Optimise; }
};

/** The radius-edge ratios that optimisation allows. */
inline constexpr double OptimisedRadiusEdgeRatio = 2.5;

/** The smallest radius-edge ratio for which termination is proved: sqrt(sqrt(3) + 2) (thesis, 2.3). */
inline constexpr double ProvedRadiusEdgeRatio = 1.9318516525781366;

/** Delta used when none is given, by the (hyper)volume of a voxel: see Documentation/Algorithm.md. */
template <int D>
double DefaultDelta(double voxelVolume);

/** @throws InputError if an option is out of its range; Error if the build's floating-point arithmetic is not strict */
template <int D>
void CheckOptions(const MeshingOptions<D>& options);

extern template double DefaultDelta<3>(double);
extern template double DefaultDelta<4>(double);
extern template void CheckOptions<3>(const MeshingOptions<3>&);
extern template void CheckOptions<4>(const MeshingOptions<4>&);

} // namespace voxplex

#endif
