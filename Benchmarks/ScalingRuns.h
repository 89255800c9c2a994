// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ScalingRuns.h
 * @brief The same image meshed in many configurations, in turns, each run a process of its own.
 */
#ifndef voxplex_ScalingRuns_h
#define voxplex_ScalingRuns_h

#include "LabelVolume.h"
#include "Mesher/MeshingStatistics.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxplex::benchmarks
{

/** How an image is meshed. */
struct Configuration
{
  double Delta = 0.0;
  unsigned Threads = 1;
  ContentionPolicy Contention = ContentionPolicy::Local;
  BalancePolicy Balance = BalancePolicy::Hierarchical;
  bool Synchronise = false; ///< the code for several threads even if there is one
  bool Pin = false;
  bool Seeds = true;   ///< interfaces are sampled before the start
  bool Eager = false;  ///< eager removal from the lists of poor elements
  unsigned Copies = 1; ///< independent processes at once, each of so many threads

  bool operator==(const Configuration&) const = default;
};

/**
 * One run, as its process reports it. Of several copies: elements are the sum, seconds the harmonic mean,
 * so that elements over seconds is the sum of the copies' rates; all else is of the first copy.
 */
struct ScalingRecord
{
  double Tetrahedra = 0.0;
  double RefinementSeconds = 0.0;
  double ExtractionSeconds = 0.0;
  double TotalSeconds = 0.0; ///< everything but files
  double CpuSeconds = 0.0;   ///< of the total, user and system
  double SeedingSeconds = 0.0;
  std::uint64_t PeakBytes = 0;
  double Threads = 1.0; ///< that refined: fewer than asked for if the system gave no more
  ThreadStatistics Sum; ///< over threads
  bool SwitchedToLocal = false;

  double SecondsWithoutPreparation() const
  {
    return this->RefinementSeconds + this->ExtractionSeconds;
  }
  double Rate() const { return this->Tetrahedra / this->RefinementSeconds; }
  double TotalRate() const { return this->Tetrahedra / this->TotalSeconds; }
  /** Of all threads together. */
  double OverheadSeconds() const
  {
    return this->Sum.ContentionSeconds + this->Sum.LoadBalanceSeconds + this->Sum.RollbackSeconds;
  }
};

struct Series
{
  Configuration What;
  std::vector<ScalingRecord> Records;
};

/** Configurations, each once, and their runs. */
class ScalingRuns
{
public:
  /** @param image must outlive this; only child processes change it, each its own copy */
  explicit ScalingRuns(LabelVolume& image)
    : Image(image)
  {
  }

  /** The place of a configuration among All(); it is added unless it is there. */
  std::size_t Add(const Configuration& what);

  /** Runs every configuration so many times. They take turns, and each round begins with another of
   * them, so that drifts of the machine hit all alike. Progress is written to standard error. */
  void Run(int repeat);

  /** One run that is not kept. */
  ScalingRecord Try(const Configuration& what) const;

  const std::vector<Series>& All() const { return this->List; }
  const Series& operator[](std::size_t i) const { return this->List[i]; }

private:
  LabelVolume& Image;
  std::vector<Series> List;
};

} // namespace voxplex::benchmarks

#endif
