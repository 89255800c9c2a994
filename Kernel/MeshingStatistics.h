// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingStatistics.h
 * @brief What a run did: counts, times, predicates.
 */
#ifndef voxplex_MeshingStatistics_h
#define voxplex_MeshingStatistics_h

#include "Parallel/HardwareCounters.h"
#include "Parallel/Policies.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxplex
{

/** How often each rule changed the mesh, and why changes were refused. */
struct RuleStatistics
{
  std::array<std::uint64_t, 5> Fired{}; ///< insertions by R1 ... R5
  std::uint64_t Projected = 0;          ///< R2 circumcentres outside the box, moved onto it
  std::uint64_t Removed = 0;            ///< free vertices removed by R6
  std::uint64_t RefusedTooClose = 0;    ///< R3 points closer than the spacing floor to a vertex
  std::uint64_t RefusedNoConflict = 0;  ///< points that conflict with none of the candidates
  std::uint64_t RefusedDuplicate = 0;   ///< points equal to a vertex
  std::uint64_t RemovalsFailed = 0;     ///< vertices whose star could not be re-triangulated
  std::uint64_t ClosestSurfacePointCalls = 0;
  std::uint64_t Evaluated = 0; ///< simplices whose rules were evaluated
  std::uint64_t Created = 0;   ///< simplices created, those that died included

  RuleStatistics& operator+=(const RuleStatistics& other)
  {
    for (std::size_t r = 0; r < this->Fired.size(); ++r)
    {
      this->Fired[r] += other.Fired[r];
    }
    this->Projected += other.Projected;
    this->Removed += other.Removed;
    this->RefusedTooClose += other.RefusedTooClose;
    this->RefusedNoConflict += other.RefusedNoConflict;
    this->RefusedDuplicate += other.RefusedDuplicate;
    this->RemovalsFailed += other.RemovalsFailed;
    this->ClosestSurfacePointCalls += other.ClosestSurfacePointCalls;
    this->Evaluated += other.Evaluated;
    this->Created += other.Created;
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
  double Refinement = 0.0;
  double Extraction = 0.0;
  double Total() const
  {
    return this->LabelField + this->DistanceTransform + this->Refinement + this->Extraction;
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
  HardwareCounters::Counts Hardware{};                  ///< empty where there are no counters
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
    0.0;              ///< part of Times.Refinement: the start, before all threads have work
  double Delta = 0.0; ///< the delta that was used, in the image's unit of length
  double SmoothingSigma = 0.0; ///< voxels
  std::uint64_t EstimatedElements = 0;
  double SizesRaisedTo = 0.0;        ///< the floor of sizes, if some were below it; else 0
  std::uint64_t LabelFieldBytes = 0; ///< dense labels and smoothed values
  std::uint64_t DistanceBytes = 0;   ///< feature transform
};

} // namespace voxplex

#endif
