// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingStatistics.h
 * @brief Statistics of a run: the mesh, what it lacks, counts, times, predicates.
 */
#ifndef voxplex_MeshingStatistics_h
#define voxplex_MeshingStatistics_h

#include "Conformity/ComponentStatistics.h"
#include "Conformity/InterfaceStatistics.h"
#include "Geometry/PredicateStatistics.h"
#include "Image/DropComponents.h"
#include "Image/IsosurfaceImage.h"
#include "Parallel/Policies.h"
#include "Quality/MeshQuality.h"
#include "Quality/FrameVolumes.h"
#include "Quality/ShrunkLabels.h"
#include "Refinement/RefinementStatistics.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace voxplex
{

/** Wall-clock seconds of each stage. */
struct StageTimes
{
  double LabelField = 0.0;        ///< label map, crop, smoothing
  double DistanceTransform = 0.0; ///< surface voxels and feature transform
  double Grading = 0.0;           ///< local feature sizes
  double Components = 0.0;        ///< connected components, before and after refinement
  double Interfaces = 0.0;        ///< junctions, and checks of the mesh's interfaces
  double Refinement = 0.0;
  double Extraction = 0.0;
  double Optimisation = 0.0;
  double Total() const
  {
    return this->LabelField + this->DistanceTransform + this->Grading + this->Components +
      this->Interfaces + this->Refinement + this->Extraction + this->Optimisation;
  }
};

/**
 * Results of optimisation after refinement. Angles are in degrees. Poor elements violate a bound.
 * Dihedral angles are those of 3D, normalized volumes those of 4D.
 */
struct OptimisationSummary
{
  bool Ran = false;
  bool OutOfTime = false; ///< stopped by OptimisationStageOptions::Seconds
  double SmallestDihedralBefore = 0.0;
  double LargestDihedralBefore = 0.0;
  double SmallestDihedralAfter = 0.0;
  double LargestDihedralAfter = 0.0;
  double SmallestVolumeBefore = 0.0;
  double SmallestVolumeAfter = 0.0;
  std::uint64_t PoorBefore = 0;
  std::uint64_t PoorAfter = 0;
};

/** Planes t = constant that the mesh conforms to; 4D only. */
struct TimePlaneStatistics
{
  std::vector<double> Times; ///< of the planes inside, in the mesher's frame
  bool Periodic = false;
  unsigned Rounds = 0;          ///< how often points were exchanged between slabs
  std::uint64_t Vertices = 0;   ///< on planes, in the triangulation
  std::uint64_t Pairs = 0;      ///< vertices of the mesh with a twin at the other end
  std::uint64_t Refused = 0;    ///< points that a plane did not take any more
  std::uint64_t Facets = 0;     ///< of the object on planes
  std::uint64_t Relabelled = 0; ///< pentatopes beside planes whose circumcentre has another label
};

/** One refinement in the search for the delta that gives a requested number of elements. */
struct MeshingRun
{
  double Delta = 0.0;
  std::uint64_t Elements = 0;
};

/**
 * A region where refinement took many times the expected work, so that rules were relaxed
 * (RegionalWork). Step 1: slivers stay. Step 2: facets of interfaces may also violate bounds. Step
 * 3: ratios and sizes of elements may, too.
 */
struct RelaxationReport
{
  unsigned Step = 0;
  std::vector<std::int64_t> Voxel; ///< the index of a voxel of the region, in the whole image
};

/** What was meshed, if not labels. */
struct MeshedIsosurface
{
  Isosurface Surface;
  std::array<double, 2> Range{}; ///< of the image's values
};

struct MeshingStatistics
{
  int Dimension = 3;
  std::uint64_t Elements = 0;
  std::uint64_t Vertices = 0;
  std::uint64_t InterfaceFacets = 0;
  unsigned NumberOfThreads = 0; ///< TeamOptions::Threads
  std::optional<MeshedIsosurface> Isosurface;
  std::vector<ComponentReport> DroppedComponents; ///< by MeshingOptions::SmallestVolume
  std::vector<std::int64_t> LostLabels;           ///< FindLostLabels()
  std::vector<ShrunkLabel> ShrunkLabels;          ///< FindShrunkLabels(); 3D only
  double VolumeShare = 1.0;                       ///< VolumeShares::All; 3D labels only
  struct FramesOff FramesOff;                     ///< CompareFrames(); 4D labels only
  bool HasQuality = false;                        ///< MeshingOptions::MeasureQuality
  MeshQuality Quality;
  RuleStatistics Rules;
  PredicateStatistics Predicates;
  StageTimes Times;
  std::vector<ThreadStatistics> Threads; ///< one for each refinement thread
  ContentionPolicy Contention = ContentionPolicy::Local;
  BalancePolicy Balance = BalancePolicy::Hierarchical;
  /** A non-blocking contention manager made no progress and was replaced by the local one. */
  bool SwitchedToLocal = false;
  double SeedingSeconds = 0.0; ///< part of Times.Refinement: the start, until all threads have work
  double Delta = 0.0;          ///< the delta that was used, in the image's unit of length
  double LargestDelta = 0.0; ///< the largest Delta(z); Delta unless graded or with interface sizes
  double SmoothingSigma = 0.0;        ///< voxels
  unsigned FrameSteps = 1;            ///< steps between two frames (InterpolateFrames()); 4D only
  std::uint64_t ElementsAskedFor = 0; ///< SamplingOptions::Elements
  /**
   * If a number of elements was requested, all runs; one of them made the mesh (Delta). Else empty.
   */
  std::vector<MeshingRun> Runs;
  std::uint64_t GradingSamples = 0; ///< interface points used to measure local feature sizes
  std::uint64_t GradingPoles = 0;   ///< points of the medial axis derived from them
  std::uint64_t EstimatedElements = 0;
  ComponentStatistics Components;
  ComponentStatistics FrameComponents; ///< components of the frames, each for itself; 4D only
  InterfaceStatistics Interfaces;
  TimePlaneStatistics Planes;
  OptimisationSummary Optimisation;
  std::vector<RelaxationReport>
    RelaxedRegions;                  ///< the steps of all regions, in the order they were taken
  double SizesRaisedTo = 0.0;        ///< the floor of sizes if some sizes were below it, else 0
  std::uint64_t LabelFieldBytes = 0; ///< dense labels and smoothed values
  std::uint64_t DistanceBytes = 0;   ///< feature transform
};

} // namespace voxplex

#endif
