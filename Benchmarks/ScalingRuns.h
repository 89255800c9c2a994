// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ScalingRuns.h
 * @brief Meshes the same image in many configurations, in turns. Each run is a separate process.
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

/** A configuration of the mesher. */
struct Configuration
{
  double Delta = 0.0;
  unsigned Threads = 1;
  ContentionPolicy Contention = ContentionPolicy::Local;
  BalancePolicy Balance = BalancePolicy::Hierarchical;
  bool Synchronise = false; ///< use the code for several threads even with one thread
  bool Pin = false;
  bool Seeds = true;   ///< sample interfaces before the threads start
  unsigned Copies = 1; ///< independent processes at once, each with this number of threads

  bool operator==(const Configuration&) const = default;
};

/**
 * The result of one run, from its process. For several copies, elements are the sum and seconds the
 * harmonic mean, so that elements over seconds is the sum of the copies' rates. All other figures
 * are those of the first copy.
 */
struct ScalingRecord
{
  double Tetrahedra = 0.0;
  double RefinementSeconds = 0.0;
  double ExtractionSeconds = 0.0;
  double TotalSeconds = 0.0; ///< everything except reading and writing files
  double CpuSeconds = 0.0;   ///< of the total, user and system
  double SeedingSeconds = 0.0;
  std::uint64_t PeakBytes = 0;
  double Threads = 1.0; ///< refinement threads; fewer than requested if the system gave no more
  ThreadStatistics Sum; ///< sum over threads
  bool SwitchedToLocal = false;

  double SecondsWithoutPreparation() const
  {
    return this->RefinementSeconds + this->ExtractionSeconds;
  }
  double Rate() const { return this->Tetrahedra / this->RefinementSeconds; }
  double TotalRate() const { return this->Tetrahedra / this->TotalSeconds; }
  /** The overheads of all threads together. */
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

/** Distinct configurations and their runs. */
class ScalingRuns
{
public:
  /** @param image must outlive the object. Only child processes change it, each its own copy. */
  explicit ScalingRuns(LabelVolume& image)
    : Image(image)
  {
  }

  /** The index of a configuration in All(). Adds the configuration if it is not there. */
  std::size_t Add(const Configuration& what);

  /**
   * Runs every configuration `repeat` times. They take turns, and each round begins with another
   * one, so that changes in the machine's speed affect all equally. Progress is written to standard
   * error.
   */
  void Run(int repeat);

  /** Makes one run that is not stored. */
  ScalingRecord Try(const Configuration& what) const;

  const std::vector<Series>& All() const { return this->List; }
  const Series& operator[](std::size_t i) const { return this->List[i]; }

private:
  LabelVolume& Image;
  std::vector<Series> List;
};

} // namespace voxplex::benchmarks

#endif
