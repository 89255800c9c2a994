// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PatchWorker.h
 * @brief One thread's passes over the poor tetrahedra of a patch.
 */
#ifndef voxplex_PatchWorker_h
#define voxplex_PatchWorker_h

#include "Domain/Domain.h"
#include "Optimisation/Patch.h"
#include "Optimisation/Tetrahedra/Flips.h"
#include "Optimisation/Tetrahedra/InterfaceRules.h"
#include "Optimisation/Tetrahedra/Smoother.h"

#include <chrono>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** Additional measures for tetrahedra that flips and smoothing do not improve enough. */
enum class Effort
{
  Plain,
  Insertions,        ///< also inserts vertices
  MovesOffInterfaces ///< also moves vertices off interfaces
};

/** Conditions that end optimisation. */
struct OptimisationLimits
{
  std::stop_token Stop;
  std::chrono::steady_clock::time_point Deadline = std::chrono::steady_clock::time_point::max();

  bool OutOfTime() const { return std::chrono::steady_clock::now() >= this->Deadline; }
};

class PatchWorker
{
public:
  /** @param reach see Smoother */
  PatchWorker(TetrahedralComplex& complex, std::span<const std::uint32_t> blocks,
    std::uint32_t block, const Domain<3>& domain, const InterfaceRules& rules, double reach,
    const OptimisationLimits& limits)
    : Mesh(complex)
    , Limits(limits)
    , Target(complex, blocks, block)
    , Topology(this->Target, rules)
    , Geometry(this->Target, domain, rules, reach)
  {
  }

  Patch<3>& GetPatch() { return this->Target; }
  const FlipStatistics& GetFlipStatistics() const { return this->Topology.Counts(); }
  const SmoothingStatistics& GetSmoothingStatistics() const { return this->Geometry.Counts(); }

  /** Sets the tetrahedra to work on. */
  void WorkOn(std::span<const std::uint32_t> cells)
  {
    this->Work.clear();
    for (const std::uint32_t t : cells)
    {
      this->Work.push_back({ t, 0 });
    }
  }

  /**
   * Works on every tetrahedron that was set or has become poor. Skips those that were tried and
   * whose vertices' tetrahedra have not changed since.
   * @return the number of tetrahedra that were improved
   * @throws Cancelled
   */
  std::size_t Pass(Effort effort);

  /** Lets the next pass try all tetrahedra again, even if nothing changed. */
  void TryAllAgain();

  /** The tetrahedra that are poor after the last pass, in increasing order. */
  std::vector<std::uint32_t> Left() const;

private:
  struct Task
  {
    std::uint32_t Cell;
    std::uint32_t Tried; ///< the patch's clock at the last try; 0: never tried
  };

  bool IsPoor(std::uint32_t t) const { return this->Mesh.IsPoor(t); }
  bool HasChanged(const Task& task) const;
  bool Improve(std::uint32_t t, Effort effort);
  bool ImproveAsLastResort(std::uint32_t t, Effort effort);

  TetrahedralComplex& Mesh;
  const OptimisationLimits& Limits;
  Patch<3> Target;
  Flips Topology;
  Smoother Geometry;
  std::vector<Task> Work;
};

} // namespace voxplex

#endif
