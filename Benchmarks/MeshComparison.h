// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshComparison.h
 * @brief Runs of meshers, each in a separate process, with the same measurements.
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

/** The result of one run, from its child process. */
struct Record
{
  MeshMeasures Quality;
  double RefinementSeconds;
  double TotalSeconds;
  double CpuSeconds;
  std::uint64_t PeakBytes;

  double Tetrahedra() const { return static_cast<double>(this->Quality.Tetrahedra); }
};

/**
 * One mesher of a comparison: its name, a function that meshes with a size, the size, and its runs.
 */
struct Contestant
{
  const char* Name;
  std::function<MesherRun(double size)>
    Mesh; ///< called in child processes only; may consume the image
  double Size = 0.0;
  std::vector<Record> Records{};
};

/**
 * If the numbers of tetrahedra of two meshes differ by at most this fraction, they count as equal.
 */
inline constexpr double SizeTolerance = 0.05;

/** The number of tetrahedra for a size. Makes one run, and reports it on standard error. */
double CountTetrahedra(const Contestant& contestant, double size);

/**
 * Sets contestant.Size so that the mesher makes `wanted` tetrahedra within 3 %. Uses the secant
 * method on log(tetrahedra) over log(size), with at most eight runs.
 * @param size the start of the search
 * @return the number of tetrahedra
 * @throws std::runtime_error if eight runs are not enough
 */
double TuneSize(Contestant& contestant, double size, double wanted);

/** Makes a measured run with contestant.Size, and adds it to contestant.Records. */
void AddRun(Contestant& contestant, const LabelVolumes& image);

} // namespace voxplex::benchmarks

#endif
