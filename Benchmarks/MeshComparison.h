// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshComparison.h
 * @brief Runs of meshers, each in a process of its own, measured alike.
 */
#ifndef voxplex_MeshComparison_h
#define voxplex_MeshComparison_h

#include "MeshMeasures.h"
#include "MesherRun.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace voxplex::benchmarks
{

/** One run, as its child process reports it. */
struct Record
{
  MeshMeasures Quality;
  double RefinementSeconds;
  double TotalSeconds;
  double CpuSeconds;
  std::uint64_t PeakBytes;

  double Tetrahedra() const { return static_cast<double>(this->Quality.Tetrahedra); }
};

/** One mesher of a comparison: its name, how it meshes with a size, the size, and its runs. */
struct Contestant
{
  const char* Name;
  std::function<MesherRun(double size)>
    Mesh; ///< called in child processes only: may consume the image
  double Size = 0.0;
  std::vector<Record> Records{};
};

/** By how much the numbers of tetrahedra of two meshes of a like size may differ. */
inline constexpr double SizeTolerance = 0.05;

/** Tetrahedra that a size gives; one run, its progress on standard error. */
double CountTetrahedra(const Contestant& contestant, double size);

/**
 * Sets contestant.Size so that the mesher makes `wanted` tetrahedra within 3 %: secants of
 * log(tetrahedra) over log(size), at most eight runs.
 * @param size where to start
 * @return the number of tetrahedra
 * @throws std::runtime_error if eight runs do not do
 */
double TuneSize(Contestant& contestant, double size, double wanted);

/** One measured run with contestant.Size, added to contestant.Records. */
void AddRun(Contestant& contestant, const LabelVolumes& image);

} // namespace voxplex::benchmarks

#endif
