// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageMesher.h
 * @brief The kernel's front door: a label image, or an isosurface, in, a simplex mesh out.
 */
#ifndef voxplex_ImageMesher_h
#define voxplex_ImageMesher_h

#include "Grading/GradingOptions.h"
#include "Image/IsosurfaceImage.h"
#include "Image/LabelImage.h"
#include "Image/SizeFunction.h"
#include "Mesh/SimplexMesh.h"
#include "MeshingStatistics.h"
#include "Parallel/Policies.h"
#include "Refinement/RuleOptions.h"

#include <cstdint>
#include <functional>
#include <memory>

namespace voxplex
{

/** What the user asks for. Lengths are in the unit of the image's spacing. */
template <int D>
struct MeshingOptions
{
  /** Sampling density of interfaces (delta of the thesis); 0 derives it from the spacing (DefaultDelta). */
  double Delta = 0.0;
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
   * Connected components (through faces) of at least so many voxels get elements whatever delta; 0: as it
   * comes. Those that got none all the same are in MeshingStatistics::LostComponents. 3D only.
   */
  std::int64_t SmallestComponent = 8;
  /** Begin with points on the curves where three labels or more meet, so that the mesh's edges follow them.
   * 3D only. */
  bool SampleJunctions = true;
  /**
   * How often refinement goes on, at most, because interfaces of the image are farther from those of the mesh than
   * 1.5 delta, or because those of the mesh are not manifold; 0: never. 3D only.
   */
  unsigned InterfaceRounds = 5;
  /**
   * Standard deviation of the label smoothing, voxels along each axis; 0 switches it off. Of label images
   * only: see Isosurface::SmoothingSigma.
   */
  double SmoothingSigma = 1.0;
  /** Upper bound of circumradii, or null. */
  std::shared_ptr<const SizeFunction<D>> Size;
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
  /** Go on although the mesh is estimated not to fit in memory, or the ratio is below the proved bound. */
  bool Force = false;
  /** Bytes that the mesher may plan with; 0 means the machine's physical memory. */
  std::uint64_t MemoryLimit = 0;
};

/** How a run ended. Errors are exceptions (Error.h). */
enum class MeshingOutcome
{
  Done,
  Cancelled ///< the progress callback returned false; the mesh is empty
};

/** The radius-edge ratios that optimisation allows. */
inline constexpr double OptimisedRadiusEdgeRatio = 2.5;

/** The smallest radius-edge ratio for which termination is proved: sqrt(sqrt(3) + 2) (thesis, 2.3). */
inline constexpr double ProvedRadiusEdgeRatio = 1.9318516525781366;

/** Delta used when none is given, by the (hyper)volume of a voxel: see Documentation/Algorithm.md. */
template <int D>
double DefaultDelta(double voxelVolume);

/**
 * @brief Meshes one label image, or the inside of an isosurface.
 *
 * Run() may be called repeatedly; distinct instances may run at the same time in one process. With
 * one thread the mesh is bit-for-bit reproducible.
 */
template <int D>
class ImageMesher
{
public:
  explicit ImageMesher(MeshingOptions<D> options)
    : Options(std::move(options))
  {
  }

  /**
   * Called from the thread that called Run(), at least ten times a second, with the fraction done
   * (0 to 1, never decreasing). Returning false cancels the run; what it throws leaves Run().
   */
  std::function<bool(double fraction)> Progress;

  /**
   * @param image label image; may be released by the caller after Run() returns
   * @param mesh receives the mesh; empty when cancelled
   * @throws InputError, TooLargeError, std::bad_alloc
   */
  MeshingOutcome Run(const LabelImage<D>& image, SimplexMesh<D>& mesh);
  /** The same for what an isosurface of a grey-value image bounds. */
  MeshingOutcome Run(const IsosurfaceImage<D>& image, SimplexMesh<D>& mesh);

  const MeshingStatistics& Statistics() const { return this->Stats; }

private:
  class Stages;
  /** @param isosurface of which `image` has the labels, or null */
  MeshingOutcome Run(
    const LabelImage<D>& image, const IsosurfaceImage<D>* isosurface, SimplexMesh<D>& mesh);
  bool RunReporting(Stages& stages, const LabelImage<D>& image, SimplexMesh<D>& mesh);

  MeshingOptions<D> Options;
  MeshingStatistics Stats;
};

extern template class ImageMesher<3>;
extern template class ImageMesher<4>;
extern template double DefaultDelta<3>(double);
extern template double DefaultDelta<4>(double);

} // namespace voxplex

#endif
