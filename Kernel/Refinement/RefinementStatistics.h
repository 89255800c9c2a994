// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinementStatistics.h
 * @brief Counts and times of rules and threads in a refinement.
 */
#ifndef voxplex_RefinementStatistics_h
#define voxplex_RefinementStatistics_h

#include "Parallel/HardwareCounters.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace voxplex
{

/** The indices of rules in RuleStatistics::Fired: the thesis' numbers, see RefinementRules.h. */
template <int D>
struct RuleNumber;

/** In 3D removals (R6) and slivers (R7) are counted separately. */
template <>
struct RuleNumber<3>
{
  enum : std::size_t
  {
    SampleSpacing, ///< R1
    Ball,          ///< R2
    Facet,         ///< R3
    RadiusEdge,    ///< R4
    Size           ///< R5
  };
};

template <>
struct RuleNumber<4>
{
  enum : std::size_t
  {
    SampleSpacing, ///< R1
    Ball,          ///< R2
    RadiusEdge,    ///< R3
    Sliver,        ///< R4
    Facet          ///< R5
  };
};

/** How often each rule changed the mesh, and why changes were refused. */
struct RuleStatistics
{
  std::array<std::uint64_t, 5> Fired{}; ///< insertions by R1 ... R5, see RuleNumber
  std::uint64_t FiredBySize = 0;        ///< insertions by the size rule; 4D (3D: R5)
  std::uint64_t SliversSplit = 0;       ///< free points inserted by the sliver rule; 3D (4D: R4)
  std::uint64_t SliversSampled = 0;     ///< feature points inserted by the sliver rule; 3D
  std::uint64_t Projected = 0;          ///< circumcentres moved onto the box
  std::uint64_t Removed = 0;            ///< free vertices removed near new feature vertices
  std::uint64_t RefusedTooClose = 0;    ///< points closer than the spacing floor to a vertex
  std::uint64_t RefusedOnClosedEnd = 0; ///< points on planes between slabs that are closed; 4D
  std::uint64_t Shared = 0; ///< points of planes inserted because the other slab has them; 4D
  std::uint64_t RefusedNoConflict = 0; ///< points that conflict with none of the candidates
  std::uint64_t RefusedDuplicate = 0;  ///< points equal to a vertex
  std::uint64_t RemovalsFailed = 0;    ///< vertices whose star could not be re-triangulated
  std::uint64_t ClosestSurfacePointCalls = 0;
  std::uint64_t Evaluated = 0;           ///< simplices whose rules were evaluated
  std::uint64_t Created = 0;             ///< simplices created, including those that died
  std::uint64_t CavitySimplices = 0;     ///< simplices that insertions deleted
  std::uint64_t LargestCavity = 0;       ///< most simplices that one insertion deleted
  std::uint64_t SliversFound = 0;        ///< pentatopes below the bound of normalized volume, 4D
  std::uint64_t PicksTried = 0;          ///< points of picking regions that were tried
  std::uint64_t SliversKept = 0;         ///< slivers for which no point could be inserted
  std::uint64_t LargestRegionalWork = 0; ///< most insertions in one region (RegionalWork)

  /** The number of insertions by all rules. */
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
    this->RefusedOnClosedEnd += other.RefusedOnClosedEnd;
    this->Shared += other.Shared;
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

/**
 * Levels at which work passes from one thread to another: within a socket, a NUMA node, the
 * machine.
 */
inline constexpr unsigned StealingLevels = 3;

/**
 * The operations of one refinement thread, and the three ways in which it lost time (thesis,
 * section 3.3.5).
 */
struct ThreadStatistics
{
  std::uint64_t Insertions = 0;
  std::uint64_t Removals = 0;
  std::uint64_t Rollbacks = 0;     ///< operations given up because another thread held a vertex
  std::uint64_t Waits = 0;         ///< times when the contention manager made the thread wait
  double ContentionSeconds = 0.0;  ///< in the contention manager, waiting or not
  double LoadBalanceSeconds = 0.0; ///< without work
  double RollbackSeconds = 0.0;    ///< on operations that were rolled back
  std::array<std::uint64_t, StealingLevels> Received{}; ///< gifts of work, by level
  std::uint64_t ReceivedElements = 0;                   ///< poor elements in these gifts
  std::uint64_t HelpedLoops = 0;       ///< loops of its insertions in which other threads helped
  std::uint64_t HelpedIterations = 0;  ///< iterations that other threads did in these loops
  double HelpingSeconds = 0.0;         ///< in such loops of other threads; part of no overhead
  HardwareCounters::Counts Hardware{}; ///< empty if there are no counters

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
    this->HelpingSeconds += other.HelpingSeconds;
    this->Hardware += other.Hardware;
    return *this;
  }
};

} // namespace voxplex

#endif
