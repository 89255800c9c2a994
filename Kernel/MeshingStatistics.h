// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingStatistics.h
 * @brief What a run did: counts, times, predicates.
 */
#ifndef voxplex_MeshingStatistics_h
#define voxplex_MeshingStatistics_h

#include "Image/DropComponents.h"
#include "Parallel/HardwareCounters.h"
#include "Parallel/Policies.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace voxplex
{

/** How often each rule changed the mesh, and why changes were refused. */
struct RuleStatistics
{
  std::array<std::uint64_t, 5> Fired{}; ///< insertions by R1 ... R5
  std::uint64_t FiredBySize = 0;        ///< insertions because of the size function; 4D (3D: R5)
  std::uint64_t SliversSplit = 0;       ///< free points inserted by R7; 3D (4D: R4)
  std::uint64_t SliversSampled = 0;     ///< feature points inserted by R7; 3D
  std::uint64_t Projected = 0;          ///< circumcentres moved onto the box
  std::uint64_t Removed = 0;            ///< free vertices removed near new feature vertices
  std::uint64_t RefusedTooClose = 0;    ///< points closer than the spacing floor to a vertex
  std::uint64_t RefusedNoConflict = 0;  ///< points that conflict with none of the candidates
  std::uint64_t RefusedDuplicate = 0;   ///< points equal to a vertex
  std::uint64_t RemovalsFailed = 0;     ///< vertices whose star could not be re-triangulated
  std::uint64_t ClosestSurfacePointCalls = 0;
  std::uint64_t Evaluated = 0;           ///< simplices whose rules were evaluated
  std::uint64_t Created = 0;             ///< simplices created, those that died included
  std::uint64_t CavitySimplices = 0;     ///< simplices that insertions deleted
  std::uint64_t LargestCavity = 0;       ///< most simplices that one insertion deleted
  std::uint64_t SliversFound = 0;        ///< pentatopes below the bound of normalized volume, 4D
  std::uint64_t PicksTried = 0;          ///< points of picking regions that were tried
  std::uint64_t SliversKept = 0;         ///< slivers for which no point could be inserted
  std::uint64_t LargestRegionalWork = 0; ///< most insertions of a region (RegionalWork)

  /** Of all rules. */
  std::uint64_t Insertions() const
  {
    std::uint64_t sum = this->FiredBySize + this->SliversSplit + this->SliversSampled;
    for (const std::uint64_t fired : this->Fired)
    {
      sum += fired;
    }
    return sum;
  }

  RuleStatistics& operator+=(const RuleStatistics& other)
  {
    for (std::size_t r = 0; r < this->Fired.size(); ++r)
    {
      this->Fired[r] += other.Fired[r];
    }
    this->FiredBySize += other.FiredBySize;
    this->SliversSplit += other.SliversSplit;
    this->SliversSampled += other.SliversSampled;
    this->Projected += other.Projected;
    this->Removed += other.Removed;
    this->RefusedTooClose += other.RefusedTooClose;
    this->RefusedNoConflict += other.RefusedNoConflict;
    this->RefusedDuplicate += other.RefusedDuplicate;
    this->RemovalsFailed += other.RemovalsFailed;
    this->ClosestSurfacePointCalls += other.ClosestSurfacePointCalls;
    this->Evaluated += other.Evaluated;
    this->Created += other.Created;
    this->CavitySimplices += other.CavitySimplices;
    this->LargestCavity = std::max(this->LargestCavity, other.LargestCavity);
    this->SliversFound += other.SliversFound;
    this->PicksTried += other.PicksTried;
    this->SliversKept += other.SliversKept;
    this->LargestRegionalWork = std::max(this->LargestRegionalWork, other.LargestRegionalWork);
    return *this;
  }
};

/** How often a predicate was asked and what answered. */
struct PredicateStatistics
{
  std::uint64_t Calls = 0; ///< orientation and in-sphere tests, the cached-ball filter included
  std::uint64_t StaticFailures = 0; ///< not decided by the static or cached-ball filter
  std::uint64_t ExactCalls = 0;     ///< decided by exact arithmetic only
  std::uint64_t Perturbed = 0;      ///< exact zeros, decided by the symbolic perturbation

  PredicateStatistics& operator+=(const PredicateStatistics& other)
  {
    this->Calls += other.Calls;
    this->StaticFailures += other.StaticFailures;
    this->ExactCalls += other.ExactCalls;
    this->Perturbed += other.Perturbed;
    return *this;
  }
};

/** Wall-clock seconds of each stage. */
struct StageTimes
{
  double LabelField = 0.0;        ///< label map, crop, smoothing
  double DistanceTransform = 0.0; ///< surface voxels and feature transform
  double Grading = 0.0;           ///< local feature sizes
  double Components = 0.0;        ///< connected components, before and after refinement
  double Interfaces = 0.0;        ///< junctions, and looking at the mesh's interfaces
  double Refinement = 0.0;
  double Extraction = 0.0;
  double Optimisation = 0.0;
  double Total() const
  {
    return this->LabelField + this->DistanceTransform + this->Grading + this->Components +
      this->Interfaces + this->Refinement + this->Extraction + this->Optimisation;
  }
};

/** Distances that work travels from one thread to another: within a socket, a NUMA node, the machine. */
inline constexpr unsigned StealingLevels = 3;

/**
 * What one refinement thread did, and the three ways in which it lost time (thesis, section 3.3.5).
 */
struct ThreadStatistics
{
  std::uint64_t Insertions = 0;
  std::uint64_t Removals = 0;
  std::uint64_t Rollbacks = 0;     ///< operations given up because another thread held a vertex
  std::uint64_t Waits = 0;         ///< times that the contention manager made the thread wait
  double ContentionSeconds = 0.0;  ///< in the contention manager, waiting or not
  double LoadBalanceSeconds = 0.0; ///< without work
  double RollbackSeconds = 0.0;    ///< on operations that were rolled back
  std::array<std::uint64_t, StealingLevels> Received{}; ///< gifts of work, by distance
  std::uint64_t ReceivedElements = 0;                   ///< poor elements in them
  std::uint64_t HelpedLoops = 0;       ///< loops in its insertions of which others did a part
  std::uint64_t HelpedIterations = 0;  ///< iterations that others did in these
  HardwareCounters::Counts Hardware{}; ///< empty where there are no counters

  ThreadStatistics& operator+=(const ThreadStatistics& other)
  {
    this->Insertions += other.Insertions;
    this->Removals += other.Removals;
    this->Rollbacks += other.Rollbacks;
    this->Waits += other.Waits;
    this->ContentionSeconds += other.ContentionSeconds;
    this->LoadBalanceSeconds += other.LoadBalanceSeconds;
    this->RollbackSeconds += other.RollbackSeconds;
    for (unsigned level = 0; level < StealingLevels; ++level)
    {
      this->Received[level] += other.Received[level];
    }
    this->ReceivedElements += other.ReceivedElements;
    this->HelpedLoops += other.HelpedLoops;
    this->HelpedIterations += other.HelpedIterations;
    this->Hardware += other.Hardware;
    return *this;
  }
};

/** What optimisation after refinement did. Angles are in degrees; "poor" is what is out of bounds. */
struct OptimisationFigures
{
  bool Ran = false;
  bool OutOfTime = false; ///< stopped by MeshingOptions::OptimisationSeconds
  double SmallestDihedralBefore = 0.0;
  double LargestDihedralBefore = 0.0;
  double SmallestDihedralAfter = 0.0;
  double LargestDihedralAfter = 0.0;
  std::uint64_t PoorBefore = 0;
  std::uint64_t PoorAfter = 0;
};

/** What was done for the interfaces of a mesh in 3D, besides the rules. */
struct InterfaceFigures
{
  std::uint64_t JunctionCurves = 0; ///< pieces between corners, and closed ones
  std::uint64_t Corners = 0;        ///< where four labels meet
  std::uint64_t JunctionSeeds = 0;  ///< feature points on them, at most
  unsigned Rounds = 0;              ///< times that refinement went on for the sake of interfaces
  std::uint64_t Seeds = 0;          ///< feature points inserted then, at most
  std::uint64_t NonManifoldRepaired = 0; ///< edges that were not manifold on a label's boundary
  std::uint64_t NonManifoldOpened = 0;   ///< of these, edges around which tetrahedra were cut in pieces
  std::uint64_t NonManifoldLeft = 0;     ///< that still are not; none if they were not looked for (MeshingOptions::Manifold)
};

/** One refinement in the search for a delta that makes a number of elements. */
struct MeshingRun
{
  double Delta = 0.0;
  std::uint64_t Elements = 0;
};

/**
 * Where refinement took many times the work that regions need and rules gave way (RegionalWork): 1: slivers stay, 2: also
 * facets of interfaces may be out of bounds, 3: also ratios and sizes of elements.
 */
struct YieldingReport
{
  unsigned Step = 0;
  std::vector<std::int64_t> Voxel; ///< the index of a voxel there, in the whole image
};

struct MeshingStatistics
{
  RuleStatistics Rules;
  PredicateStatistics Predicates;
  StageTimes Times;
  std::vector<ThreadStatistics> Threads; ///< one for each refinement thread
  ContentionPolicy Contention = ContentionPolicy::Local;
  BalancePolicy Balance = BalancePolicy::Hierarchical;
  /** A non-blocking contention manager made no progress and was replaced by the local one. */
  bool SwitchedToLocal = false;
  double SeedingSeconds =
    0.0;                     ///< part of Times.Refinement: the start, before all threads have work
  double Delta = 0.0;        ///< the delta that was used, in the image's unit of length
  double LargestDelta = 0.0; ///< the largest Delta(z): not Delta if graded, or with interface sizes
  double SmoothingSigma = 0.0;        ///< voxels
  std::uint64_t ElementsAskedFor = 0; ///< MeshingOptions::Elements
  /** If a number of elements was asked for: all runs, of which one made the mesh (Delta). Else empty. */
  std::vector<MeshingRun> Runs;
  std::uint64_t GradingSamples = 0; ///< interface points by which local feature sizes were measured
  std::uint64_t GradingPoles = 0;   ///< points of the medial axis that these gave
  std::uint64_t EstimatedElements = 0;
  std::uint64_t Components = 0; ///< connected components of all labels; 0 if none were looked for
  std::uint64_t ComponentSeeds = 0; ///< feature points inserted for small or thin ones, at most
  unsigned ComponentRounds = 0;     ///< times that refinement went on because one was lost
  InterfaceFigures Interfaces;
  OptimisationFigures Optimisation;
  std::vector<ComponentReport> LostComponents; ///< connected components that have no element
  std::vector<YieldingReport>
    Yielding;                 ///< the steps of each region, in the order in which they were taken
  double SizesRaisedTo = 0.0; ///< the floor of sizes, if some were below it; else 0
  std::uint64_t LabelFieldBytes = 0; ///< dense labels and smoothed values
  std::uint64_t DistanceBytes = 0;   ///< feature transform
};

} // namespace voxplex

#endif
